"""How pictures look: sizes of letters, widths of lines, points, what lies on what; one for all reports."""

from __future__ import annotations

from typing import Any

TITLE_PT = 10.0
WORDS_PT = 8.0  # legends, names, what stands at lines, numbers along small axes
LINE_PT = 1.0  # paths
THIN_PT = 0.8  # curves over time, and what paths are held against
BOLD_PT = 2 * THIN_PT  # paths whose colour tells a figure
SPOT_PT = WORDS_PT  # a mark at a place, and as far from it are its words
BESIDE_PT, BELOW_PT = (SPOT_PT, SPOT_PT), (SPOT_PT, -SPOT_PT - WORDS_PT)
AWAY_PT = 6.0  # from axes to their numbers, on to their names, and to a title
SEE_THROUGH = 0.8  # the ground of legends and of words
# what lies on what: the ground is 0, what paths are held against 1, paths 2
ON_PATHS, SPOTS, ON_SPOTS, NAMES = 3, 4, 5, 6
GRID: dict[str, Any] = {"linewidth": THIN_PT / 2, "alpha": 0.4}
