"""The head on its two screws: what its kernels do every period, how it is set and tuned, and where it has been.

It asks `sensing` what the cells see. `junctions`, `tangles` and `following` ask it to follow a line, to run a
course from memory, and whether a line has been followed already.
"""
