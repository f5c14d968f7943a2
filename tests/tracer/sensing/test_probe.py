"""Probes of ink: where it ends, and how many strokes leave a place, against known geometry."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.probe import (
    end_of,
    is_tip,
    lines_from,
    lines_on,
    reach_of_ink,
    stroke_end,
)
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline, together

NO_STATIONS = np.empty((0, 3))
PEN_MM = 20 * UM  # a round's edge seen by an aperture of 0.15 mm


def view(drawing: Drawing) -> View:
    """As a head sees the drawing that stands on a line of 0.5 mm."""
    return View(photocell.behind_aperture(drawing, 0.15), WIDTH_MM + 25 * UM)


def straight(end: tuple[float, float], heading_deg: float) -> Leg:
    return Leg(np.array(end, float), math.radians(heading_deg), 0.0, WIDTH_MM, NO_STATIONS)


def test_the_ink_ahead_is_measured_to_its_end() -> None:
    """The pen's round reaches half a width beyond where it was lifted."""
    eyes = view(inked(polyline((4, 5), (10, 5))))
    incoming = straight((9, 5), 0)
    ink = reach_of_ink(eyes, incoming, 5.0)
    assert ink == pytest.approx(
        1.25, abs=20 * UM
    )  # a round's edge seen by an aperture of 0.15 mm
    assert end_of(eyes, incoming) == pytest.approx(1.0, abs=20 * UM)


def test_ink_beyond_reach_has_no_end() -> None:
    assert (
        reach_of_ink(view(inked(polyline((4, 5), (30, 5)))), straight((9, 5), 0), 5.0) is None
    )


def test_without_a_step_to_go_the_end_is_farther_than_asked() -> None:
    eyes = view(inked(polyline((4, 5), (10, 5))))
    assert reach_of_ink(eyes, straight((9, 5), 0), 0.0) is None
    assert reach_of_ink(eyes, straight((10, 6), 0), 5.0) == 0.0  # on paper already


def test_the_last_place_that_is_looked_at_is_within_what_was_asked() -> None:
    """Samples are half a pixel apart; an end half a step before the last of them is found."""
    eyes = view(inked(polyline((4, 5), (10, 5))))
    leg = straight((9, 5), 0)
    end_mm = reach_of_ink(eyes, leg, 5.0)
    assert end_mm is not None
    step_mm = STEP_PX * eyes.pitch_mm
    asked = (math.ceil(end_mm / step_mm) + 1) * step_mm + 1e-6
    assert reach_of_ink(eyes, leg, asked) == end_mm
    assert reach_of_ink(eyes, leg, asked - 2 * step_mm) is None


@pytest.mark.parametrize(("beyond_mm", "is_found"), [(4.6, True), (5.4, False)])
def test_the_pen_is_sought_for_six_widths_and_2_mm(beyond_mm: float, is_found: bool) -> None:
    """5.15 mm of ink, of which half a width is the pen's round."""
    eyes = view(inked(polyline((4, 5), (9 + beyond_mm, 5))))
    found = end_of(eyes, straight((9, 5), 0))
    if is_found:
        assert found == pytest.approx(beyond_mm, abs=PEN_MM)
    else:
        assert found is None


@pytest.mark.parametrize("aside_mm", [0.15, -0.15])
def test_ink_beside_a_leg_s_middle_is_measured_there(aside_mm: float) -> None:
    """On its middle the ink ends; 0.15 mm to one side a thin line goes on."""
    thin = polyline((10, 5 + aside_mm), (13, 5 + aside_mm))
    drawing = together((polyline((4, 5), (10, 5)), WIDTH_MM), (thin, 0.2))
    reach = reach_of_ink(view(drawing), straight((9, 5), 0), 6.0, aside_mm)
    other = reach_of_ink(view(drawing), straight((9, 5), 0), 6.0, -aside_mm)
    assert reach is None or reach > 3.5
    assert other is not None and other < 1.2


@pytest.mark.parametrize("bend_per_mm", [0.1, -0.2])
def test_the_ink_is_measured_round_a_leg_s_bend(bend_per_mm: float) -> None:
    leg = Leg(np.array([8.0, 8.0]), 0.4, bend_per_mm, WIDTH_MM, NO_STATIONS)
    drawing = inked(leg.at(np.linspace(-2, 2.5, 200)))
    found = reach_of_ink(view(drawing), leg, 5.0)
    assert found == pytest.approx(2.5 + WIDTH_MM / 2, abs=40 * UM)


CENTRE = (10.0, 10.0)


def strokes(*headings_deg: float) -> Drawing:
    """Strokes of 5 mm that leave the middle."""
    ends = [(10 + 5 * math.cos(a), 10 + 5 * math.sin(a)) for a in np.radians(headings_deg)]
    return inked(*[polyline(CENTRE, end) for end in ends])


@pytest.mark.parametrize(
    ("headings_deg", "count"),
    [([40], 1), ([0, 90], 2), ([0, 180], 2), ([10, 130, 250], 3), ([0, 90, 180, 270], 4)],
)
def test_the_strokes_that_leave_a_place_are_counted(
    headings_deg: list[float], count: int
) -> None:
    eyes, centre = view(strokes(*headings_deg)), np.array(CENTRE)
    assert lines_from(eyes, centre, 1.0) == lines_on(eyes, centre, 1.0) == count
    assert is_tip(eyes, centre) == (count == 1)


def test_a_stroke_that_does_not_touch_is_on_the_ring_and_leaves_nothing() -> None:
    """Another line 0.7 mm from the tip's middle, a ring of 1 mm crosses it twice."""
    drawing = inked(polyline((5, 10), CENTRE), polyline((10.9, 6), (10.9, 14)))
    eyes, centre = view(drawing), np.array(CENTRE)
    assert lines_on(eyes, centre, 1.2) > 1 and lines_from(eyes, centre, 1.2) == 1
    assert is_tip(eyes, centre)


def test_a_hairline_gap_parts_a_stroke_and_a_speck_beside_its_middle_does_not() -> None:
    drawing = inked(polyline((5, 10), (15, 10)))
    pitch, eyes, centre = drawing.pitch_mm, view(drawing), np.array(CENTRE)
    assert lines_from(eyes, centre, 1.0) == 2
    column, middle = int(10.5 / pitch), len(drawing.darkness) - 1 - int(10 / pitch)
    through, beside = drawing.darkness.copy(), drawing.darkness.copy()
    through[:, column : column + 3] = 0.0  # 0.25 mm of paper right across
    beside[middle - 1 : middle + 1, column : column + 1] = 0.0
    assert lines_from(view(Drawing(through, pitch)), centre, 1.0) == 1
    assert lines_from(view(Drawing(beside, pitch)), centre, 1.0) == 2


@pytest.mark.parametrize("pixels", [1, 2])
def test_a_speck_on_a_ring_is_no_stroke(pixels: int) -> None:
    drawing = strokes(0, 180)
    pitch = drawing.pitch_mm
    row, column = len(drawing.darkness) - 1 - int(11 / pitch), int(10 / pitch)
    drawing.darkness[row : row + pixels, column : column + pixels] = 1.0
    assert lines_on(view(drawing), np.array(CENTRE), 1.0) == 2


@pytest.mark.parametrize(("hair_mm", "count"), [(0.15, 2), (0.25, 3)])
def test_ink_below_four_tenths_of_the_line_s_width_is_no_stroke(
    hair_mm: float, count: int
) -> None:
    line, hair = polyline((4, 10), (16, 10)), polyline(CENTRE, (10, 16))
    eyes = view(together((line, WIDTH_MM), (hair, hair_mm)))
    assert lines_on(eyes, np.array(CENTRE), 1.5) == count


@pytest.mark.parametrize("pixels", [1, 2])
def test_a_speck_of_paper_on_a_thin_line_is_not_its_end(pixels: int) -> None:
    """Half a width before the speck a ray of cells through it sees no line beyond; but the line is felt on
    past it.
    """
    drawing = inked(polyline((4, 4), (24, 14)), width_mm=0.3)
    for along_mm in np.arange(1.5, 3.5, 0.03):
        x, y = np.array([10, 7]) + along_mm * np.array([2, 1]) / math.sqrt(5)
        darkness = drawing.darkness.copy()
        row, column = len(darkness) - 1 - int(y / drawing.pitch_mm), int(x / drawing.pitch_mm)
        darkness[row, column : column + pixels] = 0.0
        eyes = replace(view(Drawing(darkness, drawing.pitch_mm)), width_mm=0.325)
        leg = leg_of(
            eyes.feel(np.array([10.0, 7.0]), math.atan2(1, 2), 1.2), False, eyes.leg_mm
        )
        assert stroke_end(eyes, leg, 5.0) is None


@pytest.mark.parametrize("dpi", [300.0, 600.0, 1200.0])
def test_a_place_on_a_line_is_no_tip_however_finely_it_is_scanned(dpi: float) -> None:
    """The ring about it reaches beyond the pen's round: within it all is ink, as at a tip."""
    way_on, tip = inked(polyline((6, 10), (14, 10)), dpi=dpi), inked(polyline((6, 10), CENTRE))
    assert not is_tip(view(way_on), np.array(CENTRE))
    assert is_tip(view(tip), np.array(CENTRE))
