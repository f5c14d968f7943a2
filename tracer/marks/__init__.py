"""What the draughtsman drew for the operator: ticks and dots that stop the machine, and the reference point.

It asks `sensing`. `junctions` asks for dots at a line's end, `following` for the reference point and for the
marks of a line, `program` for the dots that stand alone.
"""
