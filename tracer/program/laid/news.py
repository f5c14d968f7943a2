"""News: about which places lines have changed since each was last looked at for narrow bays.

    ─╮ ╭──    a bay that was mended may show another beside it, on its own line or on one near by; lines
     ╰─╯      further off are as they were, and what was found of them still holds

Signals: lines as they were laid anew, and the places that they left unexplained before and leave now, in;
whether a line, and what of it, has to be looked at again out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.bars import ABOUT
from morfax.tracer.program.against_ink.own_ink import BesideInk
from morfax.tracer.program.against_ink.unexplained import Unexplained
from morfax.tracer.program.laid.line_parts import REACH
from morfax.tracer.program.laid.way_ink import Relaid

Left = TypeVar("Left", Unexplained, BesideInk)


class News(NamedTuple):
    """The boxes (n, 2) mm in which something is new."""

    low_mm: Array
    high_mm: Array

    @classmethod
    def of(
        cls,
        relaid: Sequence[Relaid],
        before: Sequence[Unexplained],
        now: Sequence[Unexplained],
    ) -> News:
        """What is new of some lines, and of what they left unexplained before and leave now."""
        left = set(before).symmetric_difference(now)
        places = np.array([place.place_mm for place in left]).reshape(-1, 2)
        reach_mm = np.array([place.length_mm for place in left]).reshape(-1, 1)
        news = [each.places_mm for each in relaid]
        return cls(np.vstack([places - reach_mm, *news]), np.vstack([places + reach_mm, *news]))

    def concerns(self, line: Line, left: Sequence[Unexplained]) -> bool:
        """Whether anything is new where bays of a line, or bars of the ink left beside it, may be."""
        low_mm, high_mm = bounds(line.places_mm)
        longest_mm = max(
            (place.length_mm for place in near_box(left, low_mm, high_mm, line.width_mm)),
            default=0.0,
        )
        # bars are looked for as far beyond the place left, and each place as far beyond the line
        reach_mm = (1 + ABOUT) * longest_mm + 2 * REACH * line.width_mm
        return self.is_near(low_mm, high_mm, reach_mm)

    def is_near(self, low_mm: Array, high_mm: Array, reach_mm: float) -> bool:
        """Whether anything is new in a box, or so far about it."""
        is_near = (self.low_mm < high_mm + reach_mm) & (self.high_mm > low_mm - reach_mm)
        return bool(is_near.all(axis=1).any())


def near_box(
    left: Sequence[Left], low_mm: Array, high_mm: Array, width_mm: float
) -> list[Left]:
    """Those of some places left unexplained that lie as near to a box as they are long, or a width nearer."""
    (left_mm, low), (right_mm, high) = low_mm.tolist(), high_mm.tolist()
    found = list[Left]()
    for place in left:
        (x, y), reach_mm = place.place_mm, place.length_mm + width_mm
        if (
            left_mm - reach_mm < x < right_mm + reach_mm
            and low - reach_mm < y < high + reach_mm
        ):
            found.append(place)
    return found
