"""A photograph becomes a flat sheet to scale: marks or edges of the sheet are found, a camera fitted to them.

It asks `motion` only. The jobs ask it before a picture becomes a drawing, and lay out the sheet with marks.
"""
