"""Junctions: places where the cells do not see one clean line, and the way on that the head chooses there.

Corners, crossings, touching lines, gaps, a change of pen. The room asks `head` and `marks`, and not
`tangles` beside it; `following` asks it which leg leads on and by what course.
"""
