"""Boxed lines: some lines with the boxes about them, so that those near a place are found without the others.

Signals: lines in; those that reach into a box (mm) out.

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
    """Some lines, and the boxes about them: their least and greatest x and y, (n, 2) mm."""

    lines: list[Line]
    low_mm: Array
    high_mm: Array

    @classmethod
    def of(cls, lines: Sequence[Line]) -> BoxedLines:
        """Some lines."""
        boxes = np.array([bounds(line.places_mm) for line in lines]).reshape(-1, 2, 2)
        return cls(list(lines), boxes[:, 0], boxes[:, 1])

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


def reaches(places_mm: Array, low_mm: Array, high_mm: Array) -> bool:
    """Whether the box about some places (n, 2) mm reaches into another."""
    first_mm, last_mm = bounds(places_mm)
    return bool(np.all(first_mm < high_mm) and np.all(last_mm > low_mm))
