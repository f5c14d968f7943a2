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
from morfax.motion.compiled import njit
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

    def stretches(self, low_mm: Array, high_mm: Array) -> Iterator[Array]:
        """The stretches (n, 2) mm of the lines, from place to place, that reach into a box."""
        for k in np.flatnonzero(self.reach(low_mm, high_mm)).tolist():
            comes_round = self.lines[k].comes_round
            yield from reaching(self.places_mm[k], low_mm, high_mm, comes_round=comes_round)

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
    numbers = np.empty(len(way), np.int64)
    return numbers[: _within(way, low_mm, high_mm, numbers)]


@njit(cache=True, _nrt=False)
def _within(way, low_mm, high_mm, numbers):  # type: ignore[no-untyped-def]
    """Note the numbers of the places within a box; how many they are."""
    count = 0
    for k in range(len(way)):
        x, y = way[k, 0], way[k, 1]
        if low_mm[0] < x < high_mm[0] and low_mm[1] < y < high_mm[1]:
            numbers[count] = k
            count += 1
    return count


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


def reaching(
    way: Array, low_mm: Array, high_mm: Array, *, comes_round: bool = False
) -> Iterator[Array]:
    """The stretches of a way (n, 2) mm, from place to place and maybe from the last to the first, whose boxes
    reach into another.
    """
    edges = np.empty((len(way) // 2 + 1, 2), np.int64)
    count = _reaching(way, low_mm, high_mm, comes_round, edges)
    for first, last in edges[:count].tolist():
        comes_home = last == len(way)
        yield np.vstack([way[first:], way[:1]]) if comes_home else way[first : last + 1]


@njit(cache=True, _nrt=False)
def _reaching(way, low_mm, high_mm, comes_round, edges):  # type: ignore[no-untyped-def]
    """Note the first and the last place of each stretch that reaches into a box; how many they are."""
    count, is_before = 0, False
    for k in range(len(way) - 1 + comes_round):
        following, reaches_in = k + 1 if k + 1 < len(way) else 0, True
        for axis in range(2):
            least, most = way[k, axis], way[following, axis]
            if least > most:
                least, most = most, least
            reaches_in &= least < high_mm[axis] and most > low_mm[axis]
        if reaches_in:
            if not is_before:
                edges[count, 0] = k
                count += 1
            edges[count - 1, 1] = k + 1
        is_before = reaches_in
    return count
