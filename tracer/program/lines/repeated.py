"""Repeated lines: a closed line in several pieces is followed from more than one of them, and cut once.

    ╭──  ──╮      a line with gaps is several patches of ink. One along which a line was followed is not
    │      │──    followed again; but where much of a patch is something else, a leader, an arrow, it is, and
    ╰──  ──╯      the head comes round by the same way

Signals: lines that were followed on a sheet in; the same without repeats out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import bounds
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.line import Line
from morfax.tracer.limits import NEAR

ALIKE = 0.9  # the shorter of two to the longer
BOX_MM = 5.0  # between the edges of their boxes, at the most: a spur is no longer
SAME = 0.95  # of each of two is beside the other; the rest are spurs, and bridges across gaps


def without_repeats(lines: Sequence[Line]) -> list[Line]:
    """The lines; of closed ones along one way the shortest, which runs out along no spur."""
    kept = list[Line]()
    for line in sorted(lines, key=lambda line: line.length_mm):
        if not any(_are_one(line, other) for other in kept):
            kept.append(line)
    chosen = {id(line) for line in kept}
    return [line for line in lines if id(line) in chosen]


def _are_one(line: Line, other: Line) -> bool:
    """Whether two lines are closed and run along one way."""
    if {line.ending, other.ending} != {"closed"}:
        return False
    lengths_mm = sorted([line.length_mm, other.length_mm])
    if lengths_mm[0] < ALIKE * lengths_mm[1]:
        return False
    near_mm = NEAR * min(line.width_mm, other.width_mm)
    if np.max(np.abs(np.subtract(bounds(line.loop_mm), bounds(other.loop_mm)))) > BOX_MM:
        return False
    ways = evenly(line.loop_mm, EVERY_MM), evenly(other.loop_mm, EVERY_MM)
    return all(
        float(np.mean(nearest_mm(one, two) < near_mm)) > SAME for one, two in (ways, ways[::-1])
    )
