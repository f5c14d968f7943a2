"""The way along a line: how far each of its positions has come, and where the tool comes to rest on it.

Signals: a line in; lengths in mm for its positions, positions for lengths, and rests out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.work import Action


class Rest(NamedTuple):
    """Where X and Y come to rest: the position, and what is done there, or which end of a tab it is."""

    at: float
    action: Action | None = None
    tab: Literal["first", "last"] | None = None


@dataclass(frozen=True, slots=True)
class Way:
    """Positions of a line, where they are, and how far each has come, mm."""

    positions: NDArray[np.int64]
    places_mm: Array
    mm: Array

    @classmethod
    def whole(cls, line: Line) -> Way:
        """The way along all positions of a line."""
        return cls._of(line, np.arange(len(line.xy_mm)))

    @classmethod
    def loop(cls, line: Line) -> Way:
        """The way that is run at each depth: without the lead line, leads and guide lines."""
        ranges = line.ranges(line.first, line.last)
        return cls._of(line, np.concatenate([np.arange(a, b) for a, b in ranges]))

    @classmethod
    def _of(cls, line: Line, positions: NDArray[np.int64]) -> Way:
        """The way along some positions."""
        places_mm = line.xy_mm[positions]
        return cls(positions, places_mm, lengths_mm(places_mm))

    @property
    def length_mm(self) -> float:
        """Its length."""
        return float(self.mm[-1])

    def mm_at(self, position: float) -> float:
        """How far a position has come, mm."""
        return float(np.interp(position, self.positions, self.mm))

    def position(self, mm: float) -> float:
        """Which position has come so far, fractions included."""
        moving = np.r_[True, np.diff(self.mm) > 0]
        return float(np.interp(mm, self.mm[moving], self.positions[moving]))

    def rest(self, mm: float) -> Rest | None:
        """The rest after a length, mm; None if the way is not so long, or begins behind it."""
        return Rest(self.position(mm)) if 0 <= mm <= self.length_mm else None

    def place(self, mm: float) -> tuple[float, float]:
        """Where the way is after a length, mm."""
        x, y = at_lengths(self.places_mm, np.array([mm]))[0]
        return float(x), float(y)


def in_order(rests: Sequence[Rest], last: float) -> list[Rest]:
    """Rests along a way, in their order, up to a position, at which the tool rests too."""
    here = [rest for rest in rests if rest.at <= last]
    return [*sorted(here, key=lambda rest: rest.at), Rest(last)]
