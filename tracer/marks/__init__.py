"""What the draughtsman drew for the operator: ticks and dots that stop the machine, and the reference point.

It asks `sensing`. `following` looks for a reference point and for dots at a line's ends; `program` asks for the
marks of a line that has been followed.
"""
