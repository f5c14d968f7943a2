"""How pictures look: sizes of letters, widths of lines, points, what lies on what; one for all reports."""

from __future__ import annotations

from typing import Any

TITLE_PT = 10.0
NAME_PT = 9.0  # of a part of a picture, or of a place in it
WORDS_PT = 8.0  # legends, and what stands at lines
NUMBERS_PT = 7.0  # along axes
BOLD_PT = 1.8  # paths whose colour tells a figure
LINE_PT = 1.2  # paths
THIN_PT = 0.8  # curves over time, and what paths are held against
SPOT_PT = 7.0  # a mark at a place, and as far from it are its words
BESIDE_PT, BELOW_PT = (SPOT_PT, SPOT_PT), (SPOT_PT, -SPOT_PT - NUMBERS_PT)
SEE_THROUGH = 0.8  # the ground of legends and of words
# what lies on what: the ground is 0, what paths are held against 1, paths 2
ON_PATHS, SPOTS, ON_SPOTS, NAMES = 3, 4, 5, 6
GRID: dict[str, Any] = {"linewidth": 0.4, "alpha": 0.4}
