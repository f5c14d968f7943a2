"""Nets: the lines of ink on which lines cross or touch, by its junctions.

The room asks the lines of the sheet and the chains of `ink`. The traces of `program` ask it.
"""
