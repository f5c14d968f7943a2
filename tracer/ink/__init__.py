"""All the ink of a sheet: its net of lines, each junction of it solved once, and the head along every chain.

The room asks the head and the junctions' ways; `program` puts its strokes in order.
"""
