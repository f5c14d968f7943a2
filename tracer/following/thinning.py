"""TODO."""

from __future__ import annotations

THINNED = 30  # of the positions one in so many tells where a line is: every 50 um at 10 mm/s
