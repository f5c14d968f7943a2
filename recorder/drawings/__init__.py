"""Drawings for other programs and from them: what is cut as DXF, SVG or HPGL, written and read back.

The room asks recorder/gcode for the plan of lines and arcs; `media` asks it, and the jobs for what it reads.
"""
