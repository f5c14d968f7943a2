"""Waiting rows: where the screws are, row by row, until the frames that need it are made.

Signals in: positions of the axes (n, axes) mm at the motion rate, block by block; out: displacements from the
start, cycles, by the number of their row since the start of the tape.

    displacement = (position - start) · cycles per mm

    room   |  gone  |  waiting rows          |  free  |    new rows go behind those that wait; where there is
           0        first - room's first     end           no more room, those that wait move to its front

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

ROWS_AT_ONCE = 32  # that fill the vectors of the processor


class WaitingRows:
    """The displacements of a tape's axes; `end`: the number of rows that have come so far."""

    def __init__(self, start_mm: Array, cycles_per_mm: float) -> None:
        self._cycles_per_mm, self._starts_mm = cycles_per_mm, np.tile(start_mm, ROWS_AT_ONCE)
        self._room = np.empty((0, len(start_mm)))
        self._room_at = 0  # the row at the room's beginning
        self._first, self.end = 0, 0

    def feed(self, positions_mm: Array) -> Array:
        """Take the next positions (n, axes) mm; their displacements, cycles, until more rows come."""
        self._make_room(len(positions_mm))
        at, self.end = self.end - self._room_at, self.end + len(positions_mm)
        cycles = self._room[at : self.end - self._room_at]
        places = np.ascontiguousarray(positions_mm, np.float64)
        _displace(places.ravel(), self._starts_mm, self._cycles_per_mm, cycles.ravel())
        return cycles

    def rows(self, first: int, end: int) -> Array:
        """The rows from one to another, as far as they have come, cycles."""
        return self._room[first - self._room_at : min(end, self.end) - self._room_at]

    def around(self, first: int, end: int) -> Array:
        """The same; before the first row of the tape and behind the last the screws stand there."""
        rows = self.rows(max(first, 0), end)
        if first >= 0 and end <= self.end:
            return rows
        before = np.repeat(rows[:1], max(-first, 0), axis=0)
        behind = np.repeat(rows[-1:], max(end - self.end, 0), axis=0)
        return np.concatenate([before, rows, behind])

    def drop(self, before: int) -> None:
        """Forget the rows before one."""
        self._first = max(before, self._first)

    def _make_room(self, count: int) -> None:
        """Have room for so many rows behind those that wait."""
        if self.end - self._room_at + count <= len(self._room):
            return
        waiting, room = self.rows(self._first, self.end), self._room
        if 2 * (len(waiting) + count) > len(room):
            room = np.empty((4 * (len(waiting) + count), room.shape[1]))
        room[: len(waiting)] = waiting
        self._room, self._room_at = room, self._first


@njit(cache=True, nogil=True, _nrt=False)
def _displace(positions_mm, start_mm, cycles_per_mm, cycles):  # type: ignore[no-untyped-def]
    """Fill the displacements of positions, row after row; as many at once as `start_mm` is long."""
    for first in range(0, len(positions_mm), len(start_mm)):
        places = positions_mm[first : first + len(start_mm)]
        out = cycles[first : first + len(start_mm)]
        for k in range(len(places)):
            out[k] = (places[k] - start_mm[k]) * cycles_per_mm
