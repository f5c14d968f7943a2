"""How pictures look: sizes of letters, widths of lines, points; one for all reports."""

from __future__ import annotations

from typing import Any

TITLE_PT = 10.0
NAME_PT = 9.0  # of a part of a picture, or of a place in it
WORDS_PT = 8.0  # legends, and what stands at lines
NUMBERS_PT = 7.0  # along axes
LINE_PT = 1.2  # paths
THIN_PT = 0.8  # curves over time, and what paths are held against
SEE_THROUGH = 0.8  # of a legend's ground
GRID: dict[str, Any] = {"linewidth": 0.4, "alpha": 0.4}
