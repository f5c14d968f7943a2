"""Scans of two levels: the rims of their ink are laid where they were drawn, and no ink is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.drawing import two_levels
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.two_levels import with_rims

SIDE_PX, FINER = 160, 16  # of a sheet, and places looked at in each pixel, along each side
ROWS, COLUMNS = (np.arange(SIDE_PX)[:, None] + 0.5, np.arange(SIDE_PX)[None] + 0.5)
SPOTS = (np.arange(FINER) + 0.5) / FINER - 0.5


def shares(inside: object) -> np.ndarray:
    """How much of each pixel lies in ink that is told of each place, by rows and columns."""
    found = [inside(ROWS + down, COLUMNS + right) for down in SPOTS for right in SPOTS]  # type: ignore[operator]
    return np.mean(found, axis=0)


def band(degrees: float, half_px: float = 2.3):  # type: ignore[no-untyped-def]
    """Whether places lie in a straight line of ink that runs by so many degrees off the rows."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return lambda y, x: np.abs((y - 80.3) * c + (x - 80.1) * s) < half_px


def ring(radius_px: float, half_px: float = 2.3):  # type: ignore[no-untyped-def]
    """Whether places lie in a circle of ink."""
    return lambda y, x: np.abs(np.hypot(y - 79.7, x - 80.4) - radius_px) < half_px


def off(inside) -> tuple[float, float]:  # type: ignore[no-untyped-def]
    """How much the pixels of a sheet of two levels differ from what a lens would show, RMS of those on a rim:
    as it is, and with its rims laid.
    """
    seen = shares(inside)
    hard = (seen > INK).astype(np.float32)
    # away from the sheet's edges
    on_rim = (seen > 0) & (seen < 1)
    on_rim[:30] = on_rim[-30:] = on_rim[:, :30] = on_rim[:, -30:] = False
    return tuple(
        float(np.sqrt(np.mean((some - seen)[on_rim] ** 2)))
        for some in (hard, with_rims(hard.copy()))
    )  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("degrees", "most"), [(4, 0.05), (11, 0.05), (27, 0.1), (39, 0.05), (62, 0.1), (85, 0.05)]
)
def test_a_straight_line_has_no_steps(degrees: float, most: float) -> None:
    """Steps of two pixels and one, at 27 degrees, are alike over a long way, and tell less of the place."""
    as_it_is, laid = off(band(degrees))
    assert as_it_is > 0.2
    assert laid < most


@pytest.mark.parametrize(("radius_px", "most"), [(12, 0.12), (30, 0.09), (45, 0.09)])
def test_a_circle_keeps_its_radius(radius_px: float, most: float) -> None:
    """A path that only took the shortest way through the steps would lie a tenth of a pixel inside."""
    assert off(ring(radius_px))[1] < most
    seen = shares(ring(radius_px))
    laid = with_rims((seen > INK).astype(np.float32))
    away_px = np.hypot(ROWS - 79.7, COLUMNS - 80.4)
    assert np.average(away_px, weights=laid) == pytest.approx(
        np.average(away_px, weights=seen), abs=0.06
    )


def test_a_corner_stays_sharp() -> None:
    """Two straight lines, one on each side of the corner: no rim is laid across it."""

    def wedge(y: np.ndarray, x: np.ndarray) -> np.ndarray:
        return (y - 60.2 > 0.3 * (x - 60.0)) & (x - 60.0 > 0.15 * (y - 60.2))

    seen = shares(wedge)
    laid = with_rims((seen > INK).astype(np.float32))
    near = np.s_[50:75, 50:75]
    assert np.abs(laid - seen)[near].max() < 0.5
    assert np.sqrt(np.mean((laid - seen)[near] ** 2)) < 0.05


def test_specks_lines_of_a_pixel_and_ink_at_the_edge_of_the_sheet_stay() -> None:
    hard = np.zeros((40, 60), np.float32)
    hard[5, 5] = 1.0  # a speck
    hard[np.arange(10, 30), np.arange(10, 30)] = 1.0  # pixels that touch by their corners
    hard[20:, 50:] = 1.0
    laid = with_rims(hard.copy())
    assert laid[5, 5] > INK
    assert laid[np.arange(13, 27), np.arange(13, 27)] == pytest.approx(0.75, abs=0.13)
    assert (laid[26:34, 56:] == 1.0).all()
    assert laid.sum() == pytest.approx(hard.sum(), rel=0.03)


def test_what_is_neither_stays_as_it_is() -> None:
    """A pale line among pixels of two levels."""
    hard = np.zeros((60, 60), np.float32)
    hard[20:24] = 1.0
    hard[40:43] = 0.3
    laid = with_rims(hard.copy())
    assert (laid[40:43] == hard[40:43]).all()
    # a corner is a little round
    assert laid[20:24, 7:-7] == pytest.approx(1.0, abs=0.01)


def test_rims_are_laid_about_the_ink_alone_and_lighter_paper_is_paper(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of 25 Mpx of paper about a ring all were gone through eight times, and written."""
    asked = list[tuple[int, ...]]()
    lay = two_levels._lay_rims
    monkeypatch.setattr(
        two_levels, "_lay_rims", lambda part: asked.append(part.shape) or lay(part)
    )
    small = (shares(ring(60.0)) > INK).astype(np.float32)
    large = np.zeros((3 * SIDE_PX, 5 * SIDE_PX), np.float32)
    part = np.s_[SIDE_PX : 2 * SIDE_PX, 2 * SIDE_PX : 3 * SIDE_PX]
    large[part] = small
    large[0, 0] = -0.01
    laid = with_rims(large)
    assert laid is large and laid[0, 0] == 0.0
    assert np.array_equal(laid[part], with_rims(small))
    across_px = round(2 * (60.0 + 2.3)) + 2
    assert asked[0] == asked[1] == pytest.approx((across_px, across_px), abs=1)
    assert laid.sum() == pytest.approx(small.sum(), rel=1e-6)


def test_what_is_lighter_than_paper_is_found_in_any_stretch_of_a_row() -> None:
    """In vectors by the bits of the numbers, and as a plain loop has it."""
    sheet = (
        np.random.default_rng(5)
        .normal(0.0, 1.0, (3, 2 * two_levels.BARE_PX + 9))
        .astype(np.float32)
    )
    bare = np.abs(sheet)
    bare[0, 0] = bare[1, two_levels.BARE_PX] = bare[2, -1] = -0.25
    for some in (sheet, bare):
        for lighten in (two_levels._no_lighter, two_levels._no_lighter.py_func):
            paper = some.copy()
            lighten(paper)
            assert np.array_equal(paper, np.maximum(some, 0.0))
