"""A whole card, as text."""

from __future__ import annotations

WHOLE = """\
# a plate with two holes
start = "2mm"
passes = [
    "2mm",
    "4mm",  # the last is the depth
]
restart = "manual"
turns = ["straight", "left"]
override = [3]

[speeds]
trace = "600mm/min"
feed = "5mm/s"
rapid = 50

[[stop]]
number = 1
moves = [
    { down = "7mm", feed = "2mm/s" },
    { dwell = "500ms" },
    { up = "0.1in" },
]
restart = "automatic"

[[stop]]
drill = { depth = "8mm", peck = "3mm", dwell = 0.2 }
"""
