"""The line ahead of a leg: caught again beside where it was lost, and looked for no further than is said."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.line_ahead import Ahead, caught_again, looks_mm, straight_on
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, Points, inked, polyline

WIDTH_MM = 0.5
Y_MM = 12.0


def _leg(drawing: Drawing, until_mm: float) -> tuple[View, Leg]:
    """The view of a drawing, and the leg of its line along Y = 12 mm up to there."""
    view = View(behind_aperture(drawing, 0.15), WIDTH_MM)
    begin = np.array([until_mm - 2 * view.leg_mm, Y_MM])
    return view, leg_of(view.feel(begin, 0.0, 2 * view.leg_mm), True, view.leg_mm)


def _lost_and_aside(off_deg: float, gap_mm: float) -> tuple[Points, Points]:
    """A line that ends at x = 12 mm, and one that goes on behind a gap, its ink's end that far off ahead."""
    off = math.radians(off_deg)
    start = 12.0 + gap_mm * math.cos(off), Y_MM + gap_mm * math.sin(off)
    return polyline((4, Y_MM), (12, Y_MM)), polyline(start, (start[0] + 8, start[1]))


@pytest.mark.parametrize(("off_deg", "gap_mm"), [(-60.0, 2.0), (0.0, 1.0), (60.0, 2.0)])
def test_a_line_that_was_lost_is_caught_again_up_to_75_degrees_aside(
    off_deg: float, gap_mm: float
) -> None:
    lines = _lost_and_aside(off_deg, gap_mm)
    view, incoming = _leg(inked(*lines), 11.0)
    trail = Trail(incoming.end_mm, view.step_mm)
    caught = caught_again(view, incoming, trail, 3.0)
    assert caught is not None
    # on the other line, clear of its own end, and along it
    assert caught.end_mm[1] == pytest.approx(lines[1][0, 1], abs=10 * UM)
    assert lines[1][0, 0] < caught.end_mm[0] < lines[1][0, 0] + 3
    assert abs(caught.heading_rad) < math.radians(1)


def test_neither_a_line_too_far_nor_one_far_aside_is_caught() -> None:
    view, incoming = _leg(inked(*_lost_and_aside(0.0, gap_mm=4.0)), 11.0)
    trail = Trail(incoming.end_mm, view.step_mm)
    assert caught_again(view, incoming, trail, 3.0) is None
    # straight up from where the line is lost: 90 degrees off its heading
    view, incoming = _leg(
        inked(polyline((4, Y_MM), (12, Y_MM)), polyline((12, 14.5), (12, 22))), 11.0
    )
    assert caught_again(view, incoming, Trail(incoming.end_mm, view.step_mm), 3.5) is None


@pytest.mark.parametrize(("gap_mm", "blot_to_mm"), [(0.5, 14.0), (1.0, 14.5)])
def test_the_line_is_looked_for_no_further_than_is_said(
    gap_mm: float, blot_to_mm: float
) -> None:
    """Behind a blot as long as the heading is held, the leg is felt to its end; nothing beyond matters."""
    blot = [polyline((12, y), (blot_to_mm, y)) for y in np.arange(Y_MM - 1.5, Y_MM + 1.6, 0.25)]
    drawing = inked(polyline((4, Y_MM), (24, Y_MM)), *blot)
    view, incoming = _leg(drawing, 11.3)
    found = straight_on(view, incoming, gap_mm)
    assert found is not None and found.end_mm[0] > blot_to_mm
    # all that lies further away is ink
    pitch_mm, (rows, columns) = drawing.pitch_mm, drawing.darkness.shape
    x, y = np.meshgrid(np.arange(columns) + 0.5, rows - np.arange(rows) - 0.5)
    away_mm = np.hypot(x * pitch_mm - incoming.end_mm[0], y * pitch_mm - incoming.end_mm[1])
    darkness = np.where(away_mm > looks_mm(view, gap_mm), 1.0, drawing.darkness)
    view, incoming = _leg(Drawing(darkness.astype(np.float32), pitch_mm), 11.3)
    again = straight_on(view, incoming, gap_mm)
    assert again is not None
    assert np.array_equal(again.end_mm, found.end_mm) and np.array_equal(again.seen, found.seen)


def test_however_many_gaps_are_asked_for_no_place_is_looked_at_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A leg is followed on by its own bend and straight; a gap over 1 mm, by a circle of its own, is not."""
    view, incoming = _leg(
        inked(polyline((4, Y_MM), (12, Y_MM)), polyline((12.9, Y_MM), (22, Y_MM))), 12.0
    )
    gaps_mm = np.arange(0.1, 1.0, 0.1).tolist()
    each = [straight_on(view, incoming, gap_mm) for gap_mm in gaps_mm]
    looked, dark = Counter[tuple[float, ...]](), View.dark

    def counted(view: View, place: Points) -> bool:
        looked[tuple(np.asarray(place).tolist())] += 1
        return dark(view, place)

    monkeypatch.setattr(View, "dark", counted)
    ahead = Ahead(view, incoming)
    found = [ahead.over(gap_mm) for gap_mm in gaps_mm]
    assert looked and max(looked.values()) <= 2
    assert each[0] is None and each[-1] is not None
    assert [leg is None for leg in found] == [leg is None for leg in each]
    for one, other in zip(found, each, strict=True):
        assert one is None or (other is not None and np.array_equal(one.seen, other.seen))
