"""The ground floor: what all other packages speak: motion and paths, axes and drives, polylines and offset
paths, units, faults and files.

It asks nothing of the other packages; all of them ask it.
"""
