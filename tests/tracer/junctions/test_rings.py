"""Rings about a junction: what is felt of legs, where they meet and ink ends, against known geometry."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.arrays import Array
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.junctions.rings import corner_in, legs_around
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg, centre_at, leg_of, meet, turn
from morfax.tracer.sensing.photocell import LEVEL
from morfax.tracer.sensing.probe import end_of, reach_of_ink, stroke_end
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline

ALONG_PIXELS_MM = 6 * UM  # a line along pixels of 85 um is seen 5 um off its middle
NO_STATIONS = np.empty((0, 3))


def view(drawing: Drawing) -> View:
    """As a head sees the drawing that stands on a line of 0.5 mm."""
    return View(photocell.behind_aperture(drawing, 0.15), WIDTH_MM + 25 * UM)


def stations(curve: Array, width_mm: float = WIDTH_MM) -> Array:
    """Places as the cells would report them."""
    return np.column_stack([curve, np.full(len(curve), width_mm)])


def straight(end: tuple[float, float], heading_deg: float) -> Leg:
    return Leg(np.array(end, float), math.radians(heading_deg), 0.0, WIDTH_MM, NO_STATIONS)


# legs


@given(a=st.floats(-10, 10), b=st.floats(-10, 10))
def test_a_turn_is_the_short_way_round(a: float, b: float) -> None:
    assert -math.pi <= turn(a, b) <= math.pi
    assert math.cos(turn(a, b)) == pytest.approx(math.cos(b - a), abs=1e-12)
    assert math.sin(turn(a, b)) == pytest.approx(math.sin(b - a), abs=1e-12)


@given(heading=st.floats(-3, 3), along_mm=st.floats(-1, 1))
def test_a_leg_that_bends_is_a_circle_to_the_third_order(
    heading: float, along_mm: float
) -> None:
    bend = 0.2
    leg = Leg(np.array([3.0, 4.0]), heading, bend, WIDTH_MM, NO_STATIONS)
    centre = leg.end_mm + np.array([-math.sin(heading), math.cos(heading)]) / bend
    radius = np.hypot(*(leg.at(along_mm) - centre))
    assert radius == pytest.approx(1 / bend, abs=bend**3 * along_mm**4 / 4 + 1e-12)
    assert leg.heading_at(along_mm) == pytest.approx(
        heading + bend * along_mm, abs=abs(bend * along_mm) ** 3 + 1e-12
    )


@pytest.mark.parametrize("last", [False, True])
@pytest.mark.parametrize("bend_per_mm", [0.0, 0.1, -0.3])
def test_a_leg_is_fitted_to_what_was_felt(bend_per_mm: float, last: bool) -> None:
    x = np.arange(0, 1.2, 0.05)
    told = Leg(np.array([5.0, 5.0]), 0.7, bend_per_mm, WIDTH_MM, NO_STATIONS)
    leg = leg_of(stations(told.at(x)), last, 1.2)
    at_end = float((leg.end_mm - told.end_mm) @ [math.cos(0.7), math.sin(0.7)])
    assert at_end > 0.8 if last else at_end < 0.4
    assert leg.end_mm == pytest.approx(told.at(at_end), abs=1 * UM)
    # 2 um over a leg of 1 mm, and a parabola for a circle
    assert leg.heading_rad == pytest.approx(
        told.heading_at(at_end), abs=2e-3 + 0.2 * abs(bend_per_mm) ** 3
    )
    assert leg.bend_per_mm == pytest.approx(bend_per_mm, abs=0.02 + 0.05 * abs(bend_per_mm))


def test_noise_bends_no_straight_leg() -> None:
    random = np.random.default_rng(3)
    bends = []
    for _ in range(20):
        seen = stations(
            np.column_stack([np.arange(0, 1.2, 0.05), random.normal(5, 4 * UM, 24)])
        )
        bends.append(leg_of(seen, True, 1.2).bend_per_mm)
    assert np.mean(np.array(bends) == 0) > 0.9  # a bend must stand out fivefold


def test_the_centre_of_what_was_felt_is_averaged() -> None:
    circle = arc((0, 0), 5, 0, 60)
    random = np.random.default_rng(1)
    seen = stations(
        circle[:: max(1, len(circle) // 100)]
        + random.normal(0, 4 * UM, (len(circle[:: max(1, len(circle) // 100)]), 2))
    )
    leg = centre_at(seen, len(seen) // 2, 0.7)
    assert np.hypot(*leg.end_mm) == pytest.approx(5, abs=3 * UM)  # of 4 um, 27 stations
    tangent = math.atan2(leg.end_mm[1], leg.end_mm[0]) + math.pi / 2
    assert abs(turn(leg.heading_rad, tangent)) < 5e-3  # 4 um over 1.4 mm


@pytest.mark.parametrize("deflection_deg", [30.0, 60.0, 90.0, 144.0, -90.0])
def test_legs_meet_at_their_vertex(deflection_deg: float) -> None:
    a = math.radians(deflection_deg)
    incoming = straight((-0.6, 0), 0)
    outgoing = straight((0.8 * math.cos(a), 0.8 * math.sin(a)), deflection_deg)
    assert meet(incoming, outgoing) == pytest.approx((0.6, 0.8), abs=1e-9)


def test_legs_that_bend_meet_where_their_curves_cross() -> None:
    """Two circles of 5 mm about (0, 5) and (5, 0), both through the origin, at right angles."""
    incoming = Leg(
        5 * np.array([-math.sin(0.1), 1 - math.cos(0.1)]), -0.1, 0.2, WIDTH_MM, NO_STATIONS
    )
    outgoing = Leg(
        5 * np.array([1 - math.cos(0.1), math.sin(0.1)]),
        math.pi / 2 - 0.1,
        -0.2,
        WIDTH_MM,
        NO_STATIONS,
    )
    met = meet(incoming, outgoing)
    assert met is not None
    assert incoming.at(met[0]) == pytest.approx(
        np.zeros(2), abs=1 * UM
    )  # a parabola for a circle over 0.5 mm
    assert outgoing.at(-met[1]) == pytest.approx(np.zeros(2), abs=1 * UM)


def test_legs_in_line_do_not_meet() -> None:
    assert meet(straight((0, 0), 0), straight((2, 0), 0.5)) is None
    assert meet(straight((0, 0), 0), straight((2, 0.3), 0)) is None


# corners that were felt clean


@pytest.mark.parametrize("deflection_deg", [25.0, 40.0, -30.0])
def test_a_sharp_corner_is_found_where_it_is(deflection_deg: float) -> None:
    a = math.radians(deflection_deg)
    s = np.arange(-30, 31)[:, None] * 0.05
    line = np.where(s < 0, s * [1, 0], s * [math.cos(a), math.sin(a)])
    found = corner_in(stations(line), 0)
    assert found is not None and abs(found - 30) <= 3  # chords leave out three stations


def test_of_two_corners_close_together_the_first_is_found() -> None:
    """As on the top of a tooth of 0.9 mm, 18 stations."""
    headings = np.radians(np.repeat([0.0, 60.0, 120.0], [30, 18, 30]))
    found = corner_in(stations(np.cumsum(0.05 * _unit(headings), axis=0)), 0)
    assert found is not None and abs(found - 29) <= 3


def test_a_smooth_bend_is_no_corner() -> None:
    for radius_mm in (3.0, 10.0):
        assert (
            corner_in(stations(radius_mm * _unit(np.arange(60) * 0.05 / radius_mm)), 0) is None
        )


def _unit(angle: Array) -> Array:
    return np.column_stack([np.cos(angle), np.sin(angle)])


# ink


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


def test_a_centre_on_the_way_in_has_the_legs_ahead_of_it_only() -> None:
    """Straight on and almost straight on meet anywhere: the head looks about a place behind it then, and must
    not turn round there.
    """
    drawing = inked(polyline((4, 10), (24, 10)), polyline((16, 10), (16, 20)))
    trail = np.column_stack([np.arange(4, 15.6, 0.05), np.full(232, 10.0)])
    for behind_mm in (0.2, 0.5, 1.0):
        headings = [
            leg.heading_rad
            for leg in legs_around(view(drawing), trail[-1] - [behind_mm, 0], trail)
        ]
        assert headings and max(abs(heading) for heading in headings) < math.radians(95)


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


def legs_seen(drawing: Drawing, centre: tuple[float, float], trail: Array) -> list[float]:
    """Headings of the legs out of a junction, degrees -1..359, in order; each leg must lie on its line."""
    legs = legs_around(view(drawing), np.array(centre), trail)
    for leg in legs:
        aside = (leg.end_mm - centre) @ [-math.sin(leg.heading_rad), math.cos(leg.heading_rad)]
        assert abs(aside) < ALONG_PIXELS_MM + 4 * UM
        assert leg.width_mm == pytest.approx(WIDTH_MM, abs=40 * UM)
    return sorted((math.degrees(leg.heading_rad) + 1) % 360 - 1 for leg in legs)


WEST = np.column_stack(
    [np.arange(4, 9.5, 0.05), np.full(110, 10.0)]
)  # the way in, along X to the middle
CENTRE = (10.0, 10.0)


@pytest.mark.parametrize(
    "out_deg",
    [[90], [30], [-45], [144], [90, 270], [0, 90], [0, 90, 270], [0, 60, 240], [120, 240]],
)
def test_the_legs_of_a_knot_are_found_with_their_headings(out_deg: list[float]) -> None:
    """Corner, acute tip, junctions, crossings and a Y; the way in is none of them."""
    ends = [
        (10 + 6 * math.cos(math.radians(d)), 10 + 6 * math.sin(math.radians(d)))
        for d in out_deg
    ]
    drawing = inked(polyline((4, 10), CENTRE), *[polyline(CENTRE, end) for end in ends])
    found = legs_seen(drawing, CENTRE, WEST)
    assert found == pytest.approx(
        sorted(d % 360 for d in out_deg), abs=0.5
    )  # 9 um over a leg of 1 mm


def test_the_end_of_a_line_has_no_legs() -> None:
    assert (
        legs_seen(inked(polyline((4, 10), CENTRE), polyline((16, 16), (16, 18))), CENTRE, WEST)
        == []
    )


def test_a_line_close_by_is_no_leg() -> None:
    """Its ink is on the rings, but not joined to the junction's."""
    drawing = inked(polyline((4, 10), CENTRE, (10, 16)), polyline((11, 7), (11, 16)))
    assert legs_seen(drawing, CENTRE, WEST) == pytest.approx([90], abs=0.5)


def test_lines_swell_and_fade() -> None:
    """The width and darkness of a line are taken anew where it is met again, but only if it is like the line
    followed.
    """
    wider = inked(polyline((4, 5), (16, 5)), width_mm=0.62)
    found = view(wider).like(np.array([9.0, 5.0]), 0.0)
    assert found.width_mm == pytest.approx(0.62, abs=40 * UM)
    faint = Drawing(0.6 * inked(polyline((4, 5), (16, 5))).darkness, wider.pitch_mm)
    assert view(faint).like(np.array([9.0, 5.0]), 0.0).level >= LEVEL * 0.5
    other = view(inked(polyline((4, 6), (16, 6)), width_mm=1.5))
    assert other.like(np.array([9.0, 6.0]), 0.0) is other
