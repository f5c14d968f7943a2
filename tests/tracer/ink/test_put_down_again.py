"""Ink that no stroke has followed is followed when the others have been, if it is a line's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Bare, Thinned
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.put_down_again import _There, put_down_again
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.ink.track import InkStroke
from tests.tracer.inked import Points, inked, polyline

WIDTH_MM, STEP_MM = 0.5, 0.002
BAR, POST = polyline((6, 10), (40, 10)), polyline((20, 10), (20, 26))
NEAR_MM = 0.03  # of a clean line's middle


def put_down(lines: list[Points], ways: list[Points]) -> list[InkStroke]:
    """The strokes that are added to some ways along lines."""
    sheet = inked(*lines, width_mm=WIDTH_MM, seed=1).sheet
    left = ink_left(sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink, None, are_strokes=True)
    strokes = [
        InkStroke(way := evenly(points, STEP_MM), len(way) * STEP_MM, False, WIDTH_MM)
        for points in ways
    ]
    thinned = Thinned.of(sheet, felt.graph, left)
    return list(put_down_again(felt, thinned, strokes, Settings()))


def test_a_line_that_was_left_is_followed_from_the_line_it_leaves_to_its_end() -> None:
    (stroke,) = put_down([BAR, POST], [BAR])
    ends = sorted(stroke.way_mm[[0, -1]].tolist(), key=lambda end: end[1])
    assert ends[0] == pytest.approx((20, 10), abs=0.1)  # on the bar's middle
    assert ends[1] == pytest.approx((20, 26), abs=0.15)  # where the pen was lifted
    assert nearest_mm(stroke.way_mm, evenly(POST, STEP_MM)).max() < NEAR_MM
    lengths_mm = stroke.led.lengths_mm(stroke.way_mm)
    assert lengths_mm[0] > 0.7 * lengths_mm.sum()  # by its own cell


def test_the_part_of_a_line_that_was_left_is_followed_round_its_corner() -> None:
    bent = polyline((6, 10), (40, 10), (40, 20), (30, 20))
    (stroke,) = put_down([bent], [polyline((6, 10), (36, 10))])
    assert min(np.hypot(*(stroke.way_mm - (40, 20)).T)) < 0.1
    assert stroke.length_mm == pytest.approx(4 + 10 + 10, abs=0.5)
    assert nearest_mm(stroke.way_mm, evenly(bent, STEP_MM)).max() < NEAR_MM


@pytest.mark.parametrize(("known", "strokes"), [(0.7, 1), (0.3, 0)])
def test_ink_of_which_hardly_any_has_a_width_is_no_line(
    known: float, strokes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    stations = _There._stations

    def with_few(there: _There, part: Bare) -> Run:
        run = stations(there, part)
        widths_mm = run.widths_mm.copy()
        widths_mm[round(known * len(widths_mm)) :] = np.nan
        return replace(run, widths_mm=widths_mm)

    monkeypatch.setattr(_There, "_stations", with_few)
    assert len(put_down([BAR, POST], [BAR])) == strokes


def test_along_ink_of_strokes_on_both_its_sides_and_along_tips_the_head_does_not_go() -> None:
    # 1.5 widths apart, with ink between them: the middle of all the ink is no line's
    sides = [polyline((6, y), (40, y)) for y in (9.62, 10.38)]
    assert put_down([*sides, BAR], sides) == []
    assert put_down([BAR], [polyline((6, 10), (39.2, 10))]) == []
    assert put_down([BAR], [BAR]) == put_down([BAR], []) == []
