"""Guide lines: the junctions that the head has come to, and the guide lines that it has taken there.

Signals: places and travel of the head in; the number of a junction out, and for each guide line the positions
where the head left for it, where it ended, and where the head came back from it.

         3 back  1 leave
    ─────────┬┬────────▶        a guide line is taken where the operator says left or right; at its end the
             │▲                 head turns round, comes back to the junction on it, and goes on along the line
             ▼│ 2 tip           that it had left

Source: patent ES 361967, section on use: guide lines, to drill points for instance, and back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from morfax.motion.arrays import Array

# until it has come further than this, the head has not left a junction; by trial
AGAIN_MM = 4.0
BACK_MM = 0.05  # so near to the junction the head is back


@dataclass(frozen=True, slots=True)
class GuideLine:
    """A guide line off the line that is followed, by positions: where the line was left, the guide's end, and
    where the line went on.
    """

    leave: int
    tip: int
    back: int


@dataclass(slots=True)
class _Taken:
    """A guide line that was taken: the junction's place, and how many positions there were then, at the tip,
    and when the head came back.
    """

    place_mm: Array
    left: int
    tip: int | None = None
    back: int | None = None


@dataclass(slots=True)
class PassedJunctions:
    """The junctions that the head has come to, in order, and the guide lines that it has taken there."""

    places_mm: list[tuple[float, float]] = field(default_factory=list)
    _travel_mm: float = -AGAIN_MM
    _taken: list[_Taken] = field(default_factory=list)

    def next(self, travel_mm: float) -> int:
        """The number, from 0, of a junction that the head comes to now: it may still be at the last one."""
        still = travel_mm - self._travel_mm < AGAIN_MM and bool(self.places_mm)
        return len(self.places_mm) - still

    def come_to(self, place_of: Callable[[], Array], travel_mm: float) -> None:
        """Count a junction, unless it is still the last one; then nobody asks for its place, mm."""
        if self.next(travel_mm) == len(self.places_mm):
            x, y = place_of()
            self.places_mm.append((float(x), float(y)))
        self._travel_mm = travel_mm

    def take(self, place_mm: Array, positions: int) -> None:
        """Take a guide line at a junction."""
        self._taken.append(_Taken(place_mm, positions))

    def turn_round(self, positions: int) -> bool:
        """The line has ended: whether it was a guide line, on which the head is to come back."""
        out = [guide for guide in self._taken if guide.tip is None]
        if out:
            out[-1].tip = positions - 1
        return bool(out)

    def comes_back(self, place_mm: Array, within_mm: float) -> bool:
        """Whether the head comes back on a guide line to where it took it."""
        return any(
            np.hypot(*(guide.place_mm - place_mm)) < within_mm for guide in self._out_on()
        )

    def is_back(self, positions: int, travel_mm: float) -> None:
        """The head is back from the guide line that it was on, and still at that junction."""
        for guide in self._out_on():
            guide.back = positions
        self._travel_mm = travel_mm

    def _out_on(self) -> list[_Taken]:
        """The guide line from whose end the head is on its way back, if it is."""
        return [guide for guide in self._taken if guide.tip is not None and guide.back is None]

    def guides(self, positions: Array) -> tuple[GuideLine, ...]:
        """The guide lines that the head has come back from, by positions (n, 2) mm."""
        return tuple(
            GuideLine(
                guide.left + _nearest(positions[guide.left : guide.tip], guide.place_mm),
                guide.tip,
                guide.tip + _first_near(positions[guide.tip :], guide.place_mm),
            )
            for guide in self._taken
            if guide.tip is not None and guide.back is not None
        )


def _nearest(positions: Array, place_mm: Array) -> int:
    """The position that is nearest to a place."""
    return int(np.argmin(np.hypot(*(positions - place_mm).T)))


def _first_near(positions: Array, place_mm: Array) -> int:
    """The position nearest to a place when the way first comes within `BACK_MM` of it; else at all."""
    away = np.hypot(*(positions - place_mm).T)
    near = np.flatnonzero(away < BACK_MM)
    if not len(near):
        return int(np.argmin(away))
    leaves = np.diff(np.r_[near, near[-1] + 2]) > 1
    first = near[: int(np.argmax(leaves)) + 1]
    return int(first[np.argmin(away[first])])
