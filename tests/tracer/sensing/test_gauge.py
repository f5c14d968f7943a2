"""The gauge, and the kernels that seek corners and forks: as in plain Python, and as numpy has it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view

from morfax.motion.arrays import Array
from morfax.tracer.junctions import rings
from morfax.tracer.sensing import gauge as organ
from morfax.tracer.sensing.gauge import gauge
from morfax.tracer.sensing.photocell import Cells

PITCH_MM, WIDTH_MM = 0.1, 0.5
LAST_DIGITS = 1e-12  # mm: sums in another order


def cells_of(width_mm: float) -> Cells:
    """A line along X at the middle of a sheet of 10 mm, its edges a pixel soft."""
    y = (np.arange(100) + 0.5) * PITCH_MM - 5.0
    across = np.clip((0.5 * width_mm - np.abs(y)) / PITCH_MM + 0.5, 0.0, 1.0)
    return Cells(np.repeat(across[:, None], 100, axis=1).astype(np.float32), PITCH_MM, 0.5)


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.7, 1.2])
def test_a_line_is_gauged_as_plain_python_has_it(width_mm: float) -> None:
    pose, cells = (3.0, 5.0, 0.05), cells_of(width_mm)
    told = gauge(cells, pose, (WIDTH_MM, WIDTH_MM), 0.06, 0.1)
    plain = organ.gauge.py_func(cells, pose, (WIDTH_MM, WIDTH_MM), 0.06, 0.1)
    np.testing.assert_allclose(told, plain, atol=LAST_DIGITS)


def test_the_width_is_the_lines_and_the_usual_one_follows_by_a_share() -> None:
    _, width_mm, usual_mm = gauge(cells_of(0.7), (3.0, 5.0, 0.0), (0.5, 0.5), 0.06, 0.1)
    assert width_mm == pytest.approx(0.7, abs=0.01)  # a tenth of a pixel
    assert usual_mm == pytest.approx(0.5 + 0.1 * (width_mm - 0.5), abs=LAST_DIGITS)


@pytest.mark.parametrize("width_mm", [0.2, 1.0])
def test_another_line_is_not_gauged(width_mm: float) -> None:
    told = gauge(cells_of(width_mm), (3.0, 5.0, 0.0), (0.5, 0.5), 0.06, 0.1)
    assert all(math.isnan(value) for value in told)


def corner_by_numpy(seen: Array, first: int) -> int:
    """The same search with arrays: -1 without a corner."""
    places, reach = seen[:, :2], rings.CHORD + rings.SKIPPED
    middle = np.arange(max(first, reach), len(seen) - reach - rings.LEANS)
    if not len(middle):
        return -1
    before = places[middle - rings.SKIPPED] - places[middle - reach]
    after = places[middle + reach] - places[middle + rings.SKIPPED]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = np.abs(np.arctan2(cross, np.sum(before * after, axis=1)))
    padded = np.pad(turned, rings.CHORD, mode="symmetric")
    most = turned == sliding_window_view(padded, 2 * rings.CHORD + 1).max(axis=1)
    sharp = np.flatnonzero((turned > rings.TURNS_OFF) & most)
    return int(middle[sharp[0]]) if len(sharp) else -1


@pytest.mark.parametrize("seed", range(40))
def test_a_corner_is_found_where_arrays_find_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 80))
    headings = np.cumsum(rng.normal(0, 0.05, count)) + 0.9 * (np.arange(count) > count // 2)
    ways = np.column_stack([np.cos(headings), np.sin(headings)])
    seen = np.column_stack([np.cumsum(0.05 * ways, axis=0), np.full(count, WIDTH_MM)])
    first = int(rng.integers(0, 20))
    found = int(rings.corner_at(seen, first))
    assert found == corner_by_numpy(seen, first) == rings.corner_at.py_func(seen, first)


def test_a_fork_is_found_where_ink_goes_straight_on() -> None:
    cells = cells_of(WIDTH_MM)
    # felt along the line for 2 mm, then away from it in an arc
    along = np.arange(80) * 0.05
    aside = np.where(along > 2.0, 0.5 * (along - 2.0) ** 2, 0.0)
    seen = np.column_stack([2.0 + along, 5.0 + aside, np.full(80, WIDTH_MM)])
    fork = int(rings.fork_at(cells, WIDTH_MM, seen, 0))
    assert fork == rings.fork_at.py_func(cells, WIDTH_MM, seen, 0)
    assert 2.0 + along[fork] < 5.0
    assert rings.fork_at(cells, WIDTH_MM, seen[:40], 0) == -1  # straight: nothing bends away
    # the ink itself bends away, and paper is straight on
    bent = cells._replace(darkness=np.where(np.arange(100) < 40, cells.darkness, 0.0))
    bent = bent._replace(darkness=bent.darkness.astype(np.float32))
    assert rings.fork_at(bent, WIDTH_MM, seen, 0) == -1
