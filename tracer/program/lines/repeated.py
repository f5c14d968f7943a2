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

from morfax.motion.arrays import Array, bounds
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.effort import EVERY_MM
from morfax.tracer.following.line import Line
from morfax.tracer.limits import NEAR

# the shorter of two to the longer; and of each what is beside the other: the rest are spurs, and bridges
ALIKE = 0.9
BOX_MM = 5.0  # between the edges of their boxes, at the most: a spur is no longer


def without_repeats(lines: Sequence[Line]) -> list[Line]:
    """The lines; of closed ones along one way the shortest, which runs out along no spur."""
    closed = [line for line in lines if line.ending == "closed"]
    closed.sort(key=lambda line: line.length_mm)
    # the boxes of all at once: on a plate of many holes each was made anew for every other line
    boxes = np.array([np.hstack(_box_mm(line)) for line in closed]).reshape(-1, 4)
    kept = list[int]()
    for number, line in enumerate(closed):
        apart_mm = np.abs(boxes[kept] - boxes[number]).max(axis=1)
        near = (closed[kept[k]] for k in np.flatnonzero(apart_mm <= BOX_MM).tolist())
        if not any(_are_one(line, other) for other in near):
            kept.append(number)
    chosen = {id(closed[number]) for number in kept}
    return [line for line in lines if line.ending != "closed" or id(line) in chosen]


def _box_mm(line: Line) -> tuple[Array, Array]:
    """The box about a closed line without what leads to it, mm."""
    return bounds(line.loop_mm) if line.loop_from else line.box_mm


def _are_one(line: Line, other: Line) -> bool:
    """Whether two closed lines, of which neither reaches further, run along one way."""
    lengths_mm = sorted([line.length_mm, other.length_mm])
    if lengths_mm[0] < ALIKE * lengths_mm[1]:
        return False
    near_mm = NEAR * min(line.width_mm, other.width_mm)
    ways = evenly(line.loop_mm, EVERY_MM), evenly(other.loop_mm, EVERY_MM)
    return all(
        float(np.mean(nearest_mm(one, two) < near_mm)) > ALIKE
        for one, two in (ways, ways[::-1])
    )
