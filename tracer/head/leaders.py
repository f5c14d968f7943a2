"""Who led: for each position of a run, whether the swinging cell, stations or memory brought the head there.

Signals: positions by number and who led the head to them in; runs of one leader, and shares of the way, out.

    swinging cell   the cell's own places on the drum, more than half of the window
    stations        the line felt ahead of the head, or the places felt with which the drum was filled
    memory          a course through a corner or a junction, or onto home
    redrawn ink     a course through a tangle

A course leads on after its end, until the places that the cell has seen since then fill half of the window.

Source: our own; the patent's head has its cell alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.long_array import blocks, one_in

CELL, STATIONS, MEMORY, REDRAWN = 0, 1, 2, 3
LEADERS = ("swinging cell", "stations", "memory", "redrawn ink")


@dataclass(frozen=True, slots=True)
class Led:
    """Runs of positions under one leader: the first position of each run, and its leader."""

    firsts: tuple[int, ...] = ()
    leaders: tuple[int, ...] = ()

    def of(self, count: int, first: int = 0) -> NDArray[np.int8]:
        """The leader of each of `count` positions from one on."""
        end = first + count
        bounds = np.clip(np.append(self.firsts, end), first, end).astype(int)
        return np.repeat(np.array(self.leaders, np.int8), np.diff(bounds))

    def thinned(self, positions: Array, every: int) -> tuple[Array, NDArray[np.int8]]:
        """One position in so many, (n, 2) mm, and the leader of each."""
        return one_in(positions, every), self.of(len(positions))[::every]

    @classmethod
    def along(cls, leaders: NDArray[np.int8]) -> Led:
        """The runs of a leader for each position."""
        # bytes are compared: differences of figures would take eight times the room
        changes = 1 + np.flatnonzero(leaders[1:] != leaders[:-1])
        firsts = np.append(0, changes)[: len(leaders)]
        return cls(tuple(firsts.tolist()), tuple(leaders[firsts].tolist()))

    def turned_round(self, count: int) -> Led:
        """The same for the way back over so many positions."""
        return Led.along(self.of(count)[::-1])

    def lengths_mm(self, positions: Array) -> Array:
        """How far each of the `LEADERS` led along positions (n, 2) mm."""
        led_mm, first = np.zeros(len(LEADERS)), 0
        for block in blocks(positions, before=1):
            _add_lengths(block, self.of(len(block) - 1, first + 1), led_mm)
            first += len(block) - 1
        return led_mm

    def runs(self, positions: Array) -> Iterator[tuple[int, Array]]:
        """Each run's leader and its positions, with the one before them."""
        bounds = [*self.firsts, len(positions)]
        for leader, first, end in zip(self.leaders, bounds, bounds[1:], strict=False):
            if first < len(positions):
                yield leader, positions[max(0, first - 1) : end]


def share_of_cell(lengths_mm: Array) -> float:
    """The share that the swinging cell led, of how far each of the `LEADERS` did."""
    return float(lengths_mm[CELL] / max(lengths_mm.sum(), NOT_ZERO))


@njit(cache=True, _nrt=False)
def _add_lengths(positions, leaders, led_mm):  # type: ignore[no-untyped-def]
    """Add to what each leader led, mm: the steps between positions (n, 2) mm to the leaders at their ends."""
    for k in range(len(leaders)):
        dx = positions[k + 1, 0] - positions[k, 0]
        dy = positions[k + 1, 1] - positions[k, 1]
        led_mm[leaders[k]] += math.sqrt(dx * dx + dy * dy)


@dataclass(slots=True)
class Log:
    """The carriage's log of who led it."""

    _firsts: list[int] = field(default_factory=list)
    _leaders: list[int] = field(default_factory=list)

    def add(self, first: int, leader: int) -> None:
        """Write down who leads from a position on."""
        if not self._leaders or self._leaders[-1] != leader:
            self._firsts.append(first)
            self._leaders.append(leader)

    def back_to(self, count: int) -> None:
        """Strike out what was written of positions from one on."""
        while len(self._firsts) > 1 and self._firsts[-1] >= count:
            del self._firsts[-1], self._leaders[-1]

    def led(self) -> Led:
        """The log so far."""
        return Led(tuple(self._firsts), tuple(self._leaders))
