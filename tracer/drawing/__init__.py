"""The drawing on its table: an image file becomes darkness on a sheet in mm; strokes, shapes, noise.

It asks `motion` only. `sensing` sees the sheet through cells; `following` and `program` ask which strokes
there are; the jobs measure a path against the ink, without the head (`deviation`).
"""
