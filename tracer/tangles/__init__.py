"""Tangles: ink of several lines that runs together for longer than a corner, and the way on that explains it.

The room asks `head` and `marks`, and not `junctions` beside it; `following` asks it for the way out of a
tangle (`memory`).
"""
