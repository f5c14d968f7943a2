"""Passes: how one line is cut. Where the tool brakes and rests, how high it is, tabs, and depth after depth.

The room asks the operator. `program.program` asks it, and the cutter.
"""
