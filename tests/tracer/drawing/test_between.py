"""Between pixels: darkness goes straight from each pixel to the next, and beyond the sheet as asked for."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.between import between

RNG = np.random.default_rng(3)
SHEET = RNG.uniform(0, 1, (7, 9)).astype(np.float32)
ROUNDING = 1e-15  # of darkness 0..1


def test_on_pixels_it_is_theirs_and_between_them_the_mean() -> None:
    rows, columns = np.meshgrid(np.arange(7.0), np.arange(9.0), indexing="ij")
    assert np.array_equal(between(SHEET, rows, columns, edge_goes_on=True), SHEET)
    middle = between(SHEET, np.array([2.5]), np.array([4.5]), edge_goes_on=False)
    assert middle[0] == pytest.approx(SHEET[2:4, 4:6].astype(float).mean(), abs=ROUNDING)


def test_a_plane_is_read_without_error() -> None:
    rows, columns = np.meshgrid(np.arange(16.0), np.arange(16.0), indexing="ij")
    plane = (rows / 32 + columns / 64).astype(np.float32)  # exact in binary
    at = RNG.uniform(0, 15, (2, 200))
    read = between(plane, at[0], at[1], edge_goes_on=True)
    assert read == pytest.approx(at[0] / 32 + at[1] / 64, abs=ROUNDING)


@pytest.mark.parametrize(
    ("row", "column"), [(-0.01, 4.0), (6.01, 4.0), (3.0, -5.0), (3.0, 8.5)]
)
def test_beyond_the_sheet_is_paper_or_its_edge(row: float, column: float) -> None:
    at = np.array([row]), np.array([column])
    assert between(SHEET, *at, edge_goes_on=False)[0] == 0.0
    edge = SHEET[int(np.clip(row, 0, 6)), int(np.clip(column, 0, 8))]
    assert between(SHEET, *at, edge_goes_on=True)[0] == pytest.approx(float(edge), abs=ROUNDING)


def test_a_place_that_is_none_has_no_darkness() -> None:
    at = np.array([np.nan, 1.0]), np.array([1.0, np.nan])
    assert np.isnan(between(SHEET, *at, edge_goes_on=True)).all()
