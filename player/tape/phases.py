"""Phases: a block of rows at the motion rate, as the discriminator makes them and all behind it hand them on.

Signals: cycles (n, axes), tape against reference; surprise (n, axes), how far each phase lay from the
predicted one, cycles; levels (n, tracks), amplitude.

Source: our own. Questions: none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import Fault

Number = TypeVar("Number", bound=np.generic)


class Uncertain(NamedTuple):
    """The first row of a block that is not certain, and its fault."""

    row: int
    fault: Fault


@dataclass(frozen=True, slots=True)
class Phases:
    """A block of rows at the motion rate; row 0 is row `first_row` of the tape.

    `room`: so many rows before the first are there in the arrays, and nobody's; what comes before these rows
    is put there.
    """

    first_row: int
    cycles: Array
    surprise: NDArray[np.float32]
    levels: NDArray[np.float32]
    room: int = 0

    def __len__(self) -> int:
        return len(self.cycles)

    def joined(self, after: Phases) -> Phases:
        """These rows and the rows after them; nothing else may be put before those, where they had room."""
        return Phases(
            self.first_row,
            _put_before(self.cycles, after.cycles, after.room),
            _put_before(self.surprise, after.surprise, after.room),
            _put_before(self.levels, after.levels, after.room),
        )

    def moved(self, rows: int) -> Phases:
        """The same rows, further on the tape by this many."""
        first_row = self.first_row + rows
        return Phases(first_row, self.cycles, self.surprise, self.levels, self.room)

    def cut(self, first: int, last: int) -> Phases:
        """The rows from `first` to before `last`."""
        rows = slice(max(first, 0), max(last, first, 0))
        return Phases(
            self.first_row + rows.start,
            self.cycles[rows],
            self.surprise[rows],
            self.levels[rows],
        )


def _put_before(rows: NDArray[Number], after: NDArray[Number], room: int) -> NDArray[Number]:
    """Rows and those after them, which may have room for so many rows before them."""
    whole = after.base
    if not room or len(rows) > room or whole is None:
        return np.concatenate([rows, after])
    whole[room - len(rows) : room] = rows
    joined: NDArray[Number] = whole[room - len(rows) :]
    return joined
