"""A photograph becomes a flat sheet to scale: marks or edges of the sheet are found, a camera is fitted to them.

It asks `motion` only, and knows pictures and millimetres. `drawing` asks it, before a picture becomes darkness;
`jobs` prints the sheet with its marks, and tells how well the fit went.
"""
