"""Boxed lines: some lines with the boxes about them, so that those near a place are found without the others.

Signals: lines in; those that reach into a box (mm), and their parts within it, out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array, bounds
from morfax.tracer.following.line import Line


class BoxedLines(NamedTuple):
    """Some lines, their places (m, 2) mm, and the boxes about these: their least and greatest x and y,
    (n, 2) mm.
    """

    lines: list[Line]
    places_mm: list[Array]
    low_mm: Array
    high_mm: Array

    @classmethod
    def of(cls, lines: Sequence[Line]) -> BoxedLines:
        """Some lines."""
        boxes = np.array([line.box_mm for line in lines]).reshape(-1, 2, 2)
        return cls(list(lines), [line.places_mm for line in lines], boxes[:, 0], boxes[:, 1])

    def reach(self, low_mm: Array, high_mm: Array) -> NDArray[np.bool_]:
        """Which of the lines (n,) have a box that reaches into another."""
        return np.asarray(((self.low_mm < high_mm) & (self.high_mm > low_mm)).all(axis=1))

    def reaching(
        self, low_mm: Array, high_mm: Array, but: Line | None = None
    ) -> Iterator[Line]:
        """The lines whose boxes reach into another, but for one."""
        for k in np.flatnonzero(self.reach(low_mm, high_mm)).tolist():
            if self.lines[k] is not but:
                yield self.lines[k]

    def parts(
        self, low_mm: Array, high_mm: Array, but: Line | None = None, around_mm: float = 0.0
    ) -> Iterator[tuple[Line, Array]]:
        """The parts within a box and around it of the lines that reach into it, but for one, each with its
        line.
        """
        for k in np.flatnonzero(self.reach(low_mm, high_mm)).tolist():
            if self.lines[k] is not but:
                way = self.places_mm[k]
                for part in parts_of(way, within(way, low_mm - around_mm, high_mm + around_mm)):
                    yield self.lines[k], part


def within(way: Array, low_mm: Array, high_mm: Array) -> NDArray[np.int64]:
    """The numbers of the places of a way (n, 2) mm within a box."""
    x, y = way.T
    (left_mm, low), (right_mm, high) = low_mm, high_mm
    return np.flatnonzero((x > left_mm) & (x < right_mm) & (y > low) & (y < high))


def parts_of(way: Array, chosen: NDArray[np.int64]) -> Iterator[Array]:
    """Some places of a way by their numbers, from one round to the next: those that follow one another are
    a part.
    """
    if len(chosen):
        for part in np.split(chosen, np.flatnonzero(np.diff(chosen) > 1) + 1):
            yield way[part % len(way)]


def reaches(places_mm: Array, low_mm: Array, high_mm: Array) -> bool:
    """Whether the box about some places (n, 2) mm reaches into another."""
    first_mm, last_mm = bounds(places_mm)
    return bool(np.all(first_mm < high_mm) and np.all(last_mm > low_mm))
