"""The head on its two screws: its kernels, settings and tuning, and where it has been.

It asks `sensing` what the cells see. `junctions`, `tangles` and `following` ask it to follow a line, to run a
course from memory, and whether a line has been followed already.
"""
