"""Steps: the moves of a program with where each begins and whether the tool was on; and their reach.

Signals in: the moves that the follower has read. Signals out: steps in mm, their lengths and bounds.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from morfax.player.gcode.arc_words import TURN, Place
from morfax.player.gcode.moves import DWELL, RAPID, Move

_QUARTER = math.pi / 2


class Step(NamedTuple):
    """A move from a place to another; `in_work` if the tool cuts, burns or draws on the way."""

    move: Move
    begin_mm: Place
    on: bool  # the tool
    in_work: bool

    @property
    def is_rapid(self) -> bool:
        """Whether it is a G0."""
        return self.move.kind == RAPID

    @property
    def moves(self) -> bool:
        """Whether it goes anywhere."""
        return self.move.kind != DWELL and (
            self.begin_mm != self.move.end_mm or bool(self.move.turned_rad)
        )

    @property
    def across(self) -> bool:
        """Whether X or Y move."""
        return self.begin_mm[:2] != self.move.end_mm[:2] or bool(self.move.turned_rad)

    @property
    def lowest_mm(self) -> float:
        """The lowest Z on the way."""
        return min(self.begin_mm[2], self.move.end_mm[2])

    @property
    def length_mm(self) -> float:
        """The length of the way."""
        if self.move.turned_rad:
            return abs(self.move.turned_rad) * math.dist(self.begin_mm[:2], self.move.centre_mm)
        return math.dist(self.begin_mm, self.move.end_mm)

    def bounds_mm(self) -> tuple[Place, Place]:
        """The lowest and the highest place on the way, for each axis."""
        low = tuple(map(min, self.begin_mm, self.move.end_mm))
        high = tuple(map(max, self.begin_mm, self.move.end_mm))
        if not self.move.turned_rad:
            return (low[0], low[1], low[2]), (high[0], high[1], high[2])
        (x, y), radius = self.move.centre_mm, math.dist(self.begin_mm[:2], self.move.centre_mm)
        first = math.atan2(self.begin_mm[1] - y, self.begin_mm[0] - x)
        last = first + max(
            -TURN, min(self.move.turned_rad, TURN)
        )  # more turns reach no further
        first, last = min(first, last), max(first, last)
        quarters = range(math.ceil(first / _QUARTER), math.floor(last / _QUARTER) + 1)
        xs = [low[0], high[0], *(x + radius * math.cos(k * _QUARTER) for k in quarters)]
        ys = [low[1], high[1], *(y + radius * math.sin(k * _QUARTER) for k in quarters)]
        return (min(xs), min(ys), low[2]), (max(xs), max(ys), high[2])


def bounds_mm(steps: Iterable[Step]) -> tuple[Place, Place] | None:
    """The lowest and the highest place of some steps, for each axis; None without any."""
    lows, highs = [], []
    for step in steps:
        low, high = step.bounds_mm()
        lows.append(low)
        highs.append(high)
    if not lows:
        return None
    (x, y, z), (to_x, to_y, to_z) = (
        map(chosen, zip(*places, strict=True)) for chosen, places in ((min, lows), (max, highs))
    )
    return (x, y, z), (to_x, to_y, to_z)
