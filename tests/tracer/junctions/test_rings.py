"""Rings about a junction: the legs and corners that are found there, against known geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.junctions import arcs
from morfax.tracer.junctions.arcs import ARC
from morfax.tracer.junctions.rings import corner_in, fork_in, legs_around
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

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


def test_of_a_ring_the_cell_sees_what_hangs_on_the_ring_within_and_looks_no_further() -> None:
    """To the bit; a line that begins beyond that ring is not looked at."""
    drawing = inked(
        polyline((4, 10), (24, 10)), polyline((14, 2), (14, 20)), polyline((17, 12), (20, 14))
    )
    cells, inner = view(drawing).cells, np.empty(0, ARC)
    for centre in (np.array([14.0, 10.0]), np.array([14.3, 10.2])):
        for radius_mm in np.arange(0.2, 5.0, 0.05):
            ring_mm = radius_mm, WIDTH_MM, math.nan
            every = photocell.ring(cells, centre, radius_mm)
            of_it = arcs._ring_on(cells, centre, radius_mm, inner)
            is_on = [any(arcs._overlap(*own, *a) for own in _ends(inner)) for a in every]
            hang = every[is_on] if len(inner) else every
            assert np.array_equal(of_it, hang)
            inner = arcs.outward(cells, centre, ring_mm, inner)
            assert np.array_equal(_ends(inner), hang)
        assert len(every) > len(hang) > 0


def _ends(inner: Array) -> Array:
    """Where some arcs begin and end."""
    return np.column_stack([inner["begin"], inner["end"]])


def _unit(angle: Array) -> Array:
    return np.column_stack([np.cos(angle), np.sin(angle)])


# legs about a place


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


def legs_seen(drawing: Drawing, centre: tuple[float, float], trail: Array) -> list[float]:
    """Headings of the legs out of a junction, degrees -1..359, in order; each leg must lie on its line."""
    legs = legs_around(view(drawing), np.array(centre), trail)
    for leg in legs:
        aside = (leg.end_mm - centre) @ [-math.sin(leg.heading_rad), math.cos(leg.heading_rad)]
        assert abs(aside) < ALONG_PIXELS_MM + 4 * UM
        assert leg.width_mm == pytest.approx(WIDTH_MM, abs=40 * UM)
    return sorted((math.degrees(leg.heading_rad) + 1) % 360 - 1 for leg in legs)


# the way in, along X to the middle
WEST = np.column_stack([np.arange(4, 9.5, 0.05), np.full(110, 10.0)])
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


@pytest.mark.parametrize("along_deg", [0.0, 90.0, 210.0])
@pytest.mark.parametrize("forks", [True, False])
def test_a_fork_is_where_ink_goes_straight_on_and_the_line_bends_away(
    along_deg: float, forks: bool
) -> None:
    """A line of 6 mm that bends to the left on a radius of 3 mm; another goes straight on, or none does."""
    a = math.radians(along_deg)
    turned = np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
    middle = np.array([16.0, 14.0])
    bend = np.radians(np.arange(0, 91, 1.0))
    line = np.vstack([[-6.0, 0.0], 3 * np.column_stack([np.sin(bend), 1 - np.cos(bend)])])
    lines = [line @ turned + middle, np.array([[0.0, 0.0], [6.0, 0.0]]) @ turned + middle]
    seen = stations(evenly(lines[0], 0.05))
    found = fork_in(view(inked(*lines[: 1 + forks])), seen, 0)
    assert (found is not None) is forks
