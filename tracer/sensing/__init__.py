"""What the cells see: at a place, along a ray, round a ring, along a line; and the legs fitted to it.

It asks `drawing`. All rooms above see the sheet through a `View`; their own kernels take its `Cells`.
"""
