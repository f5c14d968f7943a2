"""A line of the drawing, from where the head is put down until the line closes, ends or is lost.

The room asks the head, the junctions and the tangles. The operator, the program and the cutter ask it.
"""
