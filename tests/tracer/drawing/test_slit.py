"""The slit sees a line as it is drawn, through what else it takes to be quick."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.tracer.drawing import slit
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.grain import slit_for
from morfax.tracer.drawing.slit import Darkness
from tests.tracer.drawing.test_grain import BLACK_LEVELS, FAINT, PITCH_MM, pencilled
from tests.tracer.inked import polyline


def a_line_of(width_mm: float) -> Darkness:
    """The darkness of a pencilled line with grain."""
    levels = pencilled(polyline((8, 12), (40, 15)), 0.35, 1, width_mm)
    return np.asarray((235 - levels) / (BLACK_LEVELS * FAINT), np.float32)


def slit_of(width_mm: float) -> slit.Slit:
    """The slit for such a line."""
    found = slit_for(0.35, width_mm / PITCH_MM, PITCH_MM)
    assert found is not None
    return found


@pytest.mark.parametrize("heading_deg", [0.0, 30.0, 90.0])
def test_the_slit_is_as_long_and_as_wide_as_it_is_told(heading_deg: float) -> None:
    """By the moments of its weights; what it is cut off beyond makes it a tenth shorter."""
    own, heading = slit.Slit(6.0, 1.5, 8.0), math.radians(heading_deg)
    weights = slit._kernel(own, heading)
    half = len(weights) // 2
    down, right = np.mgrid[-half : half + 1, -half : half + 1]
    along = right * math.cos(heading) + down * math.sin(heading)
    across = down * math.cos(heading) - right * math.sin(heading)
    assert weights.sum() == pytest.approx(1.0, abs=1e-5)
    assert math.sqrt((weights * along**2).sum()) == pytest.approx(6.0, rel=0.1)
    assert math.sqrt((weights * across**2).sum()) == pytest.approx(1.5, rel=0.01)


@pytest.mark.parametrize(
    ("width_mm", "by", "differs"),
    [(0.7, 1, 0.015), (1.0, 1, 0.015), (1.6, 2, 0.01), (3.0, 4, 0.01)],
)  # where it is not reduced, the direction is told by a smaller one
def test_a_slit_sees_the_same_on_a_reduced_picture(
    monkeypatch: pytest.MonkeyPatch, width_mm: float, by: int, differs: float
) -> None:
    """A page of a broad pencil took 27 s, and one of 38 Mpx as long. The ink's rims stay within a tenth of a
    pixel, on the mean; paper, whose noise is 0.12 of the ink's darkness, within an eighth of that.
    """
    darkness, own = a_line_of(width_mm), slit_of(width_mm)
    assert own.by == by
    reduced = slit.behind(own, darkness)
    monkeypatch.setattr(slit, "_tile", lambda own, darkness: slit._best(own, darkness).darkness)
    plain = slit.behind(own, darkness)
    columns = slice(round(12 / PITCH_MM), round(36 / PITCH_MM))
    assert 0 < np.sqrt(np.mean((reduced - plain)[:, columns] ** 2)) < differs
    for edge in (0, -1):  # the first and the last row of ink
        rows = [
            np.array([np.flatnonzero(column > INK)[edge] for column in seen[:, columns].T])
            for seen in (reduced, plain)
        ]
        assert abs(float(np.mean(rows[0] - rows[1]))) < 0.1


@pytest.mark.parametrize("see", [slit._see, slit._see.py_func])
def test_about_ink_the_slit_sees_what_a_filter_sees(see: Callable[..., Any]) -> None:
    """What weighs less than a hundredth of the middle is left out: so exact it is."""
    own, picture = (
        slit.Slit(5.0, 0.6, 6.0),
        np.random.default_rng(1).random((90, 80), np.float32),
    )
    row, column = np.array([0, 40, 89]), np.array([79, 30, 0])
    direction = np.array([0, 3, 12], np.uint8)
    padded = np.pad(picture, own.half_px, mode="edge")
    seen = np.empty(3, np.float32)
    see(padded, row, column, direction, *slit._weights(own), seen)
    for k, i, j, dark in zip(direction.tolist(), row, column, seen, strict=True):
        about = padded[i : i + 2 * own.half_px + 1, j : j + 2 * own.half_px + 1]
        exact = float((about * slit._kernel(own, slit._heading(k))).sum())
        assert dark == pytest.approx(exact, abs=0.02)


@pytest.mark.parametrize("keep", [slit._keep_better, slit._keep_better.py_func])
def test_the_direction_that_fits_best_is_kept(keep: Callable[..., Any]) -> None:
    best, seen = np.full((2, 2), -np.inf, np.float32), np.zeros((2, 2), np.float32)
    direction = np.zeros((2, 2), np.uint8)
    for k, fits in ((3, [[1.0, 2.0], [3.0, 4.0]]), (7, [[2.0, 2.0], [1.0, 5.0]])):
        fit = np.array(fits, np.float32)
        keep(k, fit, 10 * fit, best, seen, direction)
    assert direction.tolist() == [[7, 3], [3, 7]]
    assert best.tolist() == [[2.0, 2.0], [3.0, 5.0]]
    assert seen.tolist() == [[20.0, 20.0], [30.0, 50.0]]
