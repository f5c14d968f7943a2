"""Drawings for other programs: what a motion cuts, as DXF, SVG or HPGL, for CAM, laser and cutting plotters.

The room asks recorder/gcode for the plan of lines and arcs; `media.record` asks it.
"""
