"""The junctions that the head has come to, and the guide lines that it has taken there.

Signals: places and travel of the head in; the number of a junction out, and for each guide line the positions
where it was left for, ended, and come back from.

         3 back  1 leave
    ─────────┬┬────────▶        a guide line is taken where the operator says left or right; where it ends the head turns round, and
             │▲                 comes back to the junction on it, and goes on along the line that it had left
             ▼│ 2 tip

Source: patent ES 361967, section on use: guide lines, to drill points for instance, and back.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from morfax.motion.arrays import Array

AGAIN_MM = 4.0  # the head has not left a junction before it has come further than this


@dataclass(frozen=True, slots=True)
class Guide:
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
class Junctions:
    """Those that the head has come to, in order, and the guide lines that were taken there."""

    places_mm: list[tuple[float, float]] = field(default_factory=list)
    _travel_mm: float = -AGAIN_MM
    _taken: list[_Taken] = field(default_factory=list)

    def next(self, travel_mm: float) -> int:
        """The number, from 0, of a junction that the head comes to now: it may not have left the last one
        yet.
        """
        return len(self.places_mm) - (
            travel_mm - self._travel_mm < AGAIN_MM and bool(self.places_mm)
        )

    def come_to(self, place_mm: Array, travel_mm: float) -> None:
        """Count a junction, unless it is the last one still."""
        if self.next(travel_mm) == len(self.places_mm):
            self.places_mm.append((float(place_mm[0]), float(place_mm[1])))
        self._travel_mm = travel_mm

    def take(self, place_mm: Array, positions: int) -> None:
        """A guide line is taken at a junction."""
        self._taken.append(_Taken(place_mm, positions))

    def turn_round(self, positions: int) -> bool:
        """The line has ended: whether it was a guide line, from which the head is to come back."""
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
        """The head is back from the guide line that it is on: at that junction still."""
        for guide in self._out_on():
            guide.back = positions
        self._travel_mm = travel_mm

    def _out_on(self) -> list[_Taken]:
        """The guide line from whose end the head is on its way back, if it is."""
        return [guide for guide in self._taken if guide.tip is not None and guide.back is None]

    def guides(self, positions: Array) -> tuple[Guide, ...]:
        """The guide lines that the head has come back from, by positions (n, 2) mm."""
        return tuple(
            Guide(
                _nearest(positions, guide.left, guide.tip, guide.place_mm),
                guide.tip,
                _nearest(
                    positions, guide.tip, len(positions), guide.place_mm, first_within_mm=0.05
                ),
            )
            for guide in self._taken
            if guide.tip is not None and guide.back is not None
        )


def _nearest(
    positions: Array,
    first: int,
    last: int,
    place_mm: Array,
    first_within_mm: float | None = None,
) -> int:
    """The position from first to last that is nearest to a place, or of those that are near enough the first
    run of them.
    """
    away = np.hypot(*(positions[first:last] - place_mm).T)
    if first_within_mm is not None and away.min() < first_within_mm:
        near = np.flatnonzero(away < first_within_mm)
        near = near[: int(np.argmax(np.diff(np.r_[near, near[-1] + 2]) > 1)) + 1]
        return first + int(near[np.argmin(away[near])])
    return first + int(np.argmin(away))
