"""Waiting rows: displacements by their number, however they come and go."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.recorder.tape import waiting_rows as organ
from morfax.recorder.tape.waiting_rows import WaitingRows

START_MM = np.array([1.0, -2.0])
CYCLES_PER_MM = 20.0


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def rows(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> WaitingRows:
    """Rows that a compiled kernel makes, and plain Python."""
    if request.param:
        monkeypatch.setattr(organ, "_displace", organ._displace.py_func)
    return WaitingRows(START_MM, CYCLES_PER_MM)


def test_rows_are_found_by_their_number_while_others_come_and_go(rows: WaitingRows) -> None:
    positions = np.random.default_rng(1).normal(size=(6000, 2))
    wanted, first = (positions - START_MM) * CYCLES_PER_MM, 0
    for size in np.random.default_rng(2).integers(0, 200, 30).tolist():
        end = rows.end + size
        assert np.array_equal(rows.feed(positions[rows.end : end]), wanted[end - size : end])
        assert rows.end == end
        first = max(first, end - 150)
        rows.drop(first)
        assert np.array_equal(rows.rows(first, end + 7), wanted[first:end])
    assert rows.end > 1500


def test_the_screws_stand_before_the_first_row_and_behind_the_last(rows: WaitingRows) -> None:
    made = rows.feed(np.arange(6.0).reshape(3, 2)).copy()
    assert np.array_equal(rows.around(-1, 3), made[[0, 0, 1, 2]])
    assert np.array_equal(rows.around(1, 5), made[[1, 2, 2, 2]])
    assert np.array_equal(rows.around(0, 3), made)
