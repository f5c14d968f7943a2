"""Lobes: the closed ways that a line makes which turns where it crosses itself, each from there to there.

    ╲  ╱       a tip that touches another line: the head goes from a leg of the tip into that line, round it
     ╲╱        and back to the other leg. The legs cross where the tip is, and the lobe beyond the crossing
    ─╱╲─       is the line with that tip

Signals: closed lines in; their lobes, and where each begins, out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import closed_up, evenly, nearest_mm
from morfax.tracer.following.line import Line
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.program.laid.kept_parts import LEAST
from morfax.tracer.program.laid.rim_way import kinks_of
from morfax.tracer.sensing.view import STEP_WIDTHS


def lobes(lines: Sequence[Line], width_mm: float) -> Iterator[Array]:
    """The lobes (n, 2) mm of closed lines, not closed up, each from its tip on; those that are too short for
    a part of a line are none.
    """
    for line in lines:
        if line.is_open:
            continue
        way = evenly(closed_up(line.loop_mm), STEP_WIDTHS * width_mm)[:-1]
        found = np.sort(crossings_of(closed_up(way), np.arange(len(way))), axis=1)
        kinks_mm = way[kinks_of(way)] if len(found) else way
        for first, last in found.tolist():
            at, to = int(first), int(last)
            tip = way[at] + (first - at) * (way[(at + 1) % len(way)] - way[at])
            if nearest_mm(tip[None], kinks_mm).min(initial=np.inf) > CLEAR_WIDTHS * width_mm:
                continue
            for begin, count in ((at, to - at), (to, len(way) - to + at)):
                if count > LEAST / STEP_WIDTHS:
                    yield np.vstack([tip, way[(begin + 1 + np.arange(count)) % len(way)]])
