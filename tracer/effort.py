"""Effort: how much of a sheet is looked at or worked on, in several rooms; more takes time and tells little.

Chosen by trial.
"""

from __future__ import annotations

EVERY_MM = 0.05  # between the places that stand for a way where it is held against another
LOOKED_MM = 0.1  # between the places of a way that are looked at one by one
SOME_PLACES = 40  # of a line, which show where it runs
# between the places at which an edge is looked for: a quarter of what cells average
FINE_WIDTHS = 1 / 16  # of a line: its profiles are as fine as a pixel where it is up to 16 wide
FINE_PX = 0.25
MANY = 100  # lines, patches, pieces of a line: of more not each is looked at
ROUNDS = 6  # times that a fit is made anew from the one before, at the most
# pixels that are worked on at a time: 4 MB of darkness; so many tell a figure of a sheet
FEW_PX = 1 << 20
