"""Straight on: which stretches go straight on into which, and what these tell of the width of a line.

Signals: a graph and what was felt along its stretches in; stretches, by their numbers, out. Hatching on a
frame of another width is not of its line.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import unit
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.broad import SHORT_WIDTHS
from morfax.tracer.ink.felt import usual_width_mm
from morfax.tracer.ink.graph import RING, Graph
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.swelling import TWO
from morfax.tracer.limits import ABOUT_WIDTHS, WIDER

# All limits below were chosen by trial on drawings of nets.
FAR = 6  # stretches straight on to either side
STRAIGHT_COS = 0.85  # 32 degrees
AS_BROAD = 0.06  # of its width: two stretches that differ by less are one line's
HALF = 0.5


class Measured(NamedTuple):
    """A felt stretch: its length and usual width, mm, and at what share of its stations that is known."""

    length_mm: float
    width_mm: float
    known: float

    @classmethod
    def of(cls, run: Run) -> Measured:
        """Measure a stretch."""
        known = float(np.mean(np.isfinite(run.widths_mm)))
        return cls(length_mm(run.places_mm), usual_width_mm(run), known)


@dataclass(frozen=True, slots=True)
class StraightOn:
    """Which stretches go straight on into which: hatching on a frame of another width is not of its line."""

    graph: Graph
    felt: list[Run]
    at: dict[int, list[int]]

    def through(self, number: int) -> set[int]:
        """A stretch, and those into which it goes straight on at its ends, a few to either side."""
        found = {number}
        for last in (False, True):
            here: tuple[int, bool] | None = (number, last)
            for _ in range(FAR):
                here = self._onto(*here) if here is not None else None
                if here is None or here[0] in found:
                    break
                found.add(here[0])
        return found

    def onward(self, number: int) -> tuple[int, int]:
        """How many stretches go straight on from either end of a stretch; a ring goes on into itself."""
        if self.graph.stretches[number].nodes[0] == RING:
            return 1, 1
        return len(self._ahead(number, False)), len(self._ahead(number, True))

    def _onto(self, number: int, last: bool) -> tuple[int, bool] | None:
        """The stretch straight on from an end of another, and its far end; None if none is straight on.

        A ring has no end.
        """
        ahead = self._ahead(number, last)
        return max(ahead, key=lambda way: way[0])[1:] if ahead else None

    def _ahead(self, number: int, last: bool) -> list[tuple[float, int, bool]]:
        """The stretches straight on from an end of another: how straight, which, and its far end."""
        node = self.graph.stretches[number].nodes[last]
        way, found = -self._away(number, last), list[tuple[float, int, bool]]()
        for other in self.at.get(node, ()):
            for other_last in (False, True):
                if other == number or self.graph.stretches[other].nodes[other_last] != node:
                    continue
                straight = float(self._away(other, other_last) @ way)
                if straight > STRAIGHT_COS:
                    found.append((straight, other, not other_last))
        return found

    def _away(self, number: int, last: bool) -> Array:
        """The direction in which a stretch leaves the node at its end, (x, y)."""
        run = self.felt[number]
        places = run.places_mm[::-1] if last else run.places_mm
        far = min(len(places) - 1, round(ABOUT_WIDTHS * run.view.width_mm / run.view.step_mm))
        return unit(places[far] - places[0])


def of_two_lines(
    straight: StraightOn, measured: Sequence[Measured], pen_mm: float
) -> Iterator[int]:
    """Short stretches of ink broader than a clean sheet's pen that do not go on as broad: two lines' ink.

    A line of a broader pen goes on as broad, however often others cross it.
    """
    for n, (long_mm, width_mm, _) in enumerate(measured):
        is_short = long_mm < SHORT_WIDTHS * width_mm
        if not (is_short and WIDER * pen_mm < width_mm < TWO * pen_mm):
            continue
        further = straight.through(n) - {n}
        alike = {m for m in further if abs(measured[m].width_mm / width_mm - 1) < AS_BROAD}
        all_mm, alike_mm = (
            sum(measured[m].length_mm for m in some) for some in (further, alike)
        )
        if alike_mm < HALF * all_mm:
            yield n
