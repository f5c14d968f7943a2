"""Over paper: no line goes on through a crossing over bare paper.

Signals: a crossing and how its lines go on in; how they go on without those that lead over paper out.

    ──╮       ╭──     two legs of a wide crossing may be nearly in line; where their ink goes another way
      ╰───────╯       round, no line leads straight across between them. Each has another partner, or ends

Where the head follows a line alone it may cross a gap in it; at a crossing there is ink.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from morfax.tracer.head.course import FAINT
from morfax.tracer.ink.crossing_ink import WaysOn
from morfax.tracer.ink.partners import Pair, partners, without_partner

if TYPE_CHECKING:
    from morfax.tracer.ink.crossing import Crossing


def without_paper(crossing: Crossing, told: WaysOn) -> WaysOn:
    """How lines go on through a crossing, if no way leads over bare paper for longer than its line is wide.

    The legs of one that does take other partners, if they may, or end.
    """
    costs = crossing.turnings_rad.copy()
    while bare := list(_over_paper(crossing, told)):
        for a, b in bare:
            costs[a, b] = costs[b, a] = math.inf
        kept = [pair for pair in told.pairs if pair not in bare]
        alone = without_partner(kept, len(crossing.legs))
        more = [(alone[a], alone[b]) for a, b in partners(costs[np.ix_(alone, alone)])]
        corners = {pair: told.corners[pair] for pair in kept if pair in told.corners}
        told = WaysOn(tuple(sorted((*kept, *more))), corners)
    return told


def _over_paper(crossing: Crossing, told: WaysOn) -> Iterator[Pair]:
    """The pairs whose ways lead over bare paper for longer than their line is wide."""
    for pair, way in zip(told.pairs, crossing.as_drawn(told).ways_mm, strict=True):
        view = crossing.views[pair[0]]
        long_mm = np.hypot(*np.diff(way, axis=0).T)
        is_bare = view.darkness_along(way[1:]) < FAINT * view.level
        come_mm = np.cumsum(long_mm * is_bare)
        # since the last place on ink
        since_mm = come_mm - np.maximum.accumulate(np.where(is_bare, 0.0, come_mm))
        if np.any(since_mm > crossing.legs[pair[0]].width_mm):
            yield pair
