"""Blocks of rows: rows that are put before others, with and without room for them."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.phases import Phases

ROOM = 4


def block(first_row: int, rows: int, room: int = 0) -> Phases:
    """Rows whose places are their numbers, with room before them."""
    numbers = np.arange(first_row - room, first_row + rows, dtype=np.float64)
    numbers[:room] = np.nan
    rows = [np.repeat(numbers[:, None], columns, axis=1).copy()[room:] for columns in (3, 3, 4)]
    return Phases(first_row, *rows, room)


@pytest.mark.parametrize("held", [0, 1, ROOM, ROOM + 1])
@pytest.mark.parametrize("room", [0, ROOM])
def test_rows_are_put_before_others(held: int, room: int) -> None:
    joined = block(10 - held, held).joined(block(10, 5, room))
    assert joined.first_row == 10 - held and joined.room == 0
    for rows in (joined.cycles, joined.surprise, joined.levels):
        assert (rows == np.arange(10 - held, 15)[:, None]).all()


def test_room_goes_along_where_rows_are_moved_and_not_where_they_are_cut() -> None:
    rows = block(10, 5, ROOM)
    assert rows.moved(3).room == ROOM and rows.moved(3).first_row == 13
    assert rows.cut(1, 3).room == 0
