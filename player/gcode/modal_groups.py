"""The G and M codes that the control plays, by their modal groups: of each group a line takes one.

Source: RS-274-D, the modal groups of LinuxCNC; the subset is what CAM programs write for a mill in a plane.
"""

from __future__ import annotations

MOTION, UNITS, DISTANCE, BLENDING = "motion", "units", "distance mode", "blending"
GROUPS = {
    MOTION: ("G0", "G1", "G2", "G3"),
    UNITS: ("G20", "G21"),
    DISTANCE: ("G90", "G91"),
    "dwell": ("G4",),
    "plane": ("G17",),
    "coordinate system": ("G54",),
    "feed mode": ("G94",),
    "cutter compensation": ("G40",),
    "tool length": ("G49",),
    "canned cycle": ("G80",),
    BLENDING: ("G61", "G64"),
    "stop": ("M0", "M2", "M30"),
    "spindle": ("M3", "M4", "M5"),
}
CODES = {(code[0], float(code[1:])): group for group, codes in GROUPS.items() for code in codes}
READ = (
    "G0 G1 G2 G3 G4 G17 G20 G21 G40 G49 G54 G61 G64 G80 G90 G91 G94, "
    "X Y Z I J R F P S T N, M0 M2 M3 M4 M5 M30"
)
