"""Narrow gaps: a path over the pixel or two of paper between two lines, against paths that keep to theirs.

Broken on purpose, with `OVER` four times as large or a quarter, or `LONG_WIDTHS` ten times as large, tests
here fail.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.remarks.narrow_gaps import NarrowGaps
from morfax.tracer.drawing import narrow
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.narrow import Strips, narrow_gaps
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline

MIDDLE_MM, RADIUS_MM, APART_MM, DPI = (20.0, 20.0), 14.0, 0.85, 150.0  # two pixels of paper
OVER_MM = 24.0  # along the path: there it goes from one line to the other


def rings(apart_mm: float, dpi: float = DPI) -> list[Points]:
    """Two circles round one middle."""
    return [arc(MIDDLE_MM, RADIUS_MM + side * apart_mm / 2) for side in (-1, 1)]


def going_over() -> Points:
    """A way along the inner ring that goes over to the outer one within a millimetre."""
    turns = np.linspace(0, 6.2, 4000)
    share = np.clip(turns * RADIUS_MM - OVER_MM, 0.0, 1.0)
    radius_mm = RADIUS_MM + APART_MM * (share - 0.5)
    return MIDDLE_MM + radius_mm[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])


def test_a_path_that_goes_over_is_told_with_its_place() -> None:
    drawing = inked(*rings(APART_MM), dpi=DPI, seed=1)
    inner, over = rings(APART_MM)[0], going_over()
    kept, found = narrow_gaps(drawing, [(inner, WIDTH_MM), (over, WIDTH_MM)])
    assert kept is None
    assert found is not None
    turn = (OVER_MM + 0.5) / RADIUS_MM
    there = MIDDLE_MM + RADIUS_MM * np.array([np.cos(turn), np.sin(turn)])
    assert np.hypot(*np.subtract(found.place_mm, there)) < 1.0
    assert found.length_mm > RADIUS_MM


@pytest.mark.parametrize("apart_mm", [0.85, 1.0, 1.5])
def test_paths_that_keep_to_their_lines_are_not_told(apart_mm: float) -> None:
    drawing = inked(*rings(apart_mm), dpi=DPI, seed=1)
    assert narrow_gaps(drawing, [(way, WIDTH_MM) for way in rings(apart_mm)]) == [None, None]


@pytest.mark.parametrize("finer", [1, 2])
def test_a_strip_is_narrow_up_to_two_pixels_of_the_scan(finer: int) -> None:
    """However much finer its pixels are made; three are a gap that noise does not bridge."""
    darkness = np.ones((60, 100), np.float32)
    darkness[20 : 20 + 2 * finer, 10:90] = darkness[40 : 40 + 3 * finer, 10:90] = 0
    strips = Strips.of(Drawing(darkness, 0.1, finer=finer))
    assert set(strips.rows.tolist()) == set(range(20, 20 + 2 * finer))
    long_mm, across_mm = 0.1 * 82, 0.1 * (2 * finer + 2)  # with a pixel about it
    assert strips.lengths_mm == pytest.approx(math.hypot(long_mm, across_mm))


def test_a_wider_gap_and_a_short_one_are_not_told() -> None:
    wide = inked(*rings(1.5), dpi=DPI, seed=1)
    assert narrow_gaps(wide, [(arc(MIDDLE_MM, RADIUS_MM), WIDTH_MM)]) == [None]
    short = inked(
        polyline((5, 5), (11, 5)), polyline((5, 5 + APART_MM), (11, 5 + APART_MM)), dpi=DPI
    )
    between = polyline((5, 5 + APART_MM / 2), (11, 5 + APART_MM / 2))
    assert narrow_gaps(short, [(between, WIDTH_MM)]) == [None]


def test_lines_that_the_head_mixes_up_are_told_in_words_figures_and_picture() -> None:
    """Pixels of 100 dpi: noise bridges the gap, and the head changes from line to line."""
    drawing = inked(*rings(0.95), dpi=100.0, seed=3)
    traced = trace_ink(drawing)
    off_mm = [_off_mm(line.xy_mm, 0.95) for line in traced.lines]
    told = NarrowGaps.along(drawing, traced)
    assert max(off_mm) > 0.3  # else this drawing shows nothing
    (said,) = told.remarks()
    assert "over the paper between two lines" in said and "scan at 200 dpi" in said
    assert told.figures()["narrow_gaps"] and told.marked_mm
    (said,) = NarrowGaps.along(replace(drawing, is_rendered=True), traced).remarks()
    assert "line to the other; give --dpi 200 or more to part" in said


def test_lines_side_by_side_that_are_followed_well_are_not_told() -> None:
    drawing = inked(*rings(1.25), dpi=DPI, seed=3)
    traced = trace_ink(drawing)
    assert max(_off_mm(line.xy_mm, 1.25) for line in traced.lines) < 0.05
    assert not tuple(NarrowGaps.along(drawing, traced).remarks())


def _off_mm(way: Points, apart_mm: float) -> float:
    """How far a way is from the nearer of the two rings, at most."""
    from_middle = np.abs(np.hypot(*(way - MIDDLE_MM).T) - RADIUS_MM)
    return float(np.abs(from_middle - apart_mm / 2).max())


@pytest.mark.parametrize("strip_px", [3_000, 20_000])
def test_strips_of_a_sheet_are_looked_at_some_rows_at_a_time(
    strip_px: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Gaps that go on from some rows to the next are one, as on the whole sheet."""
    drawing = inked(*rings(APART_MM), *rings(3.0), dpi=DPI, seed=1)
    whole = Strips.of(drawing)
    lines = [(rings(APART_MM)[0], WIDTH_MM), (going_over(), WIDTH_MM)]
    found = narrow_gaps(drawing, lines)
    monkeypatch.setattr(narrow, "FEW_PX", strip_px)
    assert all(map(np.array_equal, Strips.of(drawing), whole))
    assert narrow_gaps(drawing, lines) == found
