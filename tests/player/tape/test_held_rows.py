"""Held rows: any stretch of blocks that were added is what one array of them would hold."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.held_rows import HeldRows
from morfax.player.tape.phases import Phases

AXES, FIRST_ROW = 2, 100
LENGTHS = (5, 1, 0, 7, 3)  # rows of the blocks


def block(first_row: int, rows: int) -> Phases:
    """A block whose places tell their row and axis."""
    numbers = first_row + np.arange(rows)
    cycles = np.column_stack([numbers + 0.25 * axis for axis in range(AXES)])
    levels = np.zeros((rows, AXES + 1), np.float32)
    return Phases(first_row, cycles, cycles.astype(np.float32), levels)


def held() -> HeldRows:
    """Some blocks, the first of which begins at FIRST_ROW."""
    rows, first = HeldRows(), FIRST_ROW
    for length in LENGTHS:
        rows.add(block(first, length))
        first += length
    return rows


@pytest.mark.parametrize("dropped", [0, 3, 5, 6, 15])
def test_any_stretch_is_what_one_array_would_hold(dropped: int) -> None:
    rows, count = held(), sum(LENGTHS) - dropped
    rows.drop(dropped)
    assert (rows.first_row, len(rows)) == (FIRST_ROW + dropped, count)
    for first in range(count + 1):
        for last in range(first, count + 3):
            wanted = block(rows.first_row + first, min(last, count) - first)
            found = rows.cut(first, last)
            assert found.first_row == wanted.first_row
            assert np.array_equal(found.cycles, wanted.cycles)
            assert np.array_equal(found.surprise, wanted.surprise)
            assert np.array_equal(rows.axis(1, first, last), wanted.cycles[:, 1])


def test_a_place_between_two_rows_lies_between_them_over_the_edge_of_a_block_too() -> None:
    rows = held()
    for at in np.arange(0.0, len(rows) - 1.0, 0.5).tolist():
        assert rows.places(at)[1] == FIRST_ROW + at + 0.25
    assert rows.places(-3.0)[0] == FIRST_ROW
    assert rows.places(1e6)[0] == FIRST_ROW + len(rows) - 1


def test_rows_that_are_laid_anew_take_the_place_of_all() -> None:
    rows = held()
    rows.drop(2)
    rows.become(block(FIRST_ROW + 2, 9))
    assert (rows.first_row, len(rows)) == (FIRST_ROW + 2, 9)
    rows.add(block(FIRST_ROW + 11, 4))
    assert np.array_equal(rows.cut(0, 13).cycles, block(FIRST_ROW + 2, 13).cycles)
