"""Courses: the ways that the head runs from memory, against geometry."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.polyline import APART_MM
from morfax.tracer.head.course import through_nodes
from morfax.tracer.junctions.corner import SHARP, Corner, missing_ink_mm, through_corner
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked
from tests.tracer.inked import corner as drawn_corner

NO_STATIONS = np.empty((0, 3))


def heading(way: Array, at: int) -> float:
    """Heading of the step at an index, rad."""
    step = way[1] - way[0] if at == 0 else way[-1] - way[-2]
    return math.atan2(step[1], step[0])


@given(
    start=st.tuples(st.floats(-5, 5), st.floats(-5, 5)),
    way=st.floats(-3, 3),
    length_mm=st.floats(0.2, 5),
    headings=st.tuples(st.floats(-0.6, 0.6), st.floats(-0.6, 0.6)),
)
def test_a_cubic_leaves_and_arrives_on_its_headings(
    start: tuple[float, float], way: float, length_mm: float, headings: tuple[float, float]
) -> None:
    a, b = (
        np.array(start),
        np.array(start) + length_mm * np.array([math.cos(way), math.sin(way)]),
    )
    line = curves.hermite(a, way + headings[0], b, way + headings[1])
    assert line[0] == pytest.approx(a) and line[-1] == pytest.approx(b)
    assert np.hypot(*np.diff(line, axis=0).T).max() < 2 * APART_MM
    step = (
        APART_MM / length_mm
    )  # the first chord has turned by half of what the cubic turns on it
    assert abs(math.remainder(heading(line, 0) - way - headings[0], math.tau)) < 4 * step + 1e-6
    assert (
        abs(math.remainder(heading(line, -1) - way - headings[1], math.tau)) < 4 * step + 1e-6
    )


@pytest.mark.parametrize("radius_mm", [2.0, 5.0])
def test_a_cubic_is_a_circle_to_its_fourth_order(radius_mm: float) -> None:
    """Over an arc of 0.3 rad: R·a⁴/384 of radial error and less."""
    a = np.array([radius_mm, 0.0])
    b = radius_mm * np.array([math.cos(0.3), math.sin(0.3)])
    line = curves.hermite(a, math.pi / 2, b, math.pi / 2 + 0.3)
    assert np.abs(np.hypot(*line.T) - radius_mm).max() < radius_mm * 0.3**4 / 384 + 0.3 * UM


def test_speeds_obey_bends_and_braking() -> None:
    quarter = 2 * np.column_stack(
        [np.sin(np.linspace(0, math.pi / 2, 200)), 1 - np.cos(np.linspace(0, math.pi / 2, 200))]
    )
    way = np.vstack([np.column_stack([np.linspace(-3, 0, 150)[:-1], np.zeros(149)]), quarter])
    allowed = curves.speeds(way, 50.0, 500.0, 0.0)
    assert allowed[-1] == 0 and allowed.max() <= 50
    assert (
        allowed[200:300].max() <= math.sqrt(500 * 2) * 1.001
    )  # v² / R = a on a radius of 2 mm
    steps = np.hypot(*np.diff(way, axis=0).T)
    assert np.all(
        allowed[:-1] ** 2 - allowed[1:] ** 2 <= 2 * 500 * steps + 1e-9
    )  # never more braking than that


def test_places_that_repeat_are_left_out() -> None:
    way = np.array([[0.0, 0], [0, 0], [1, 0], [1, 1e-9], [1, 1]])
    assert curves.distinct(way).tolist() == [[0, 0], [1, 0], [1, 1]]


def at_corner(
    deflection_deg: float, radius_mm: float, seed: int | None = None
) -> tuple[View, Corner]:
    """A drawn corner, its legs as they are, 1.2 mm before and after the vertex."""
    line = drawn_corner(deflection_deg, radius_mm)
    drawing = inked(line, seed=seed)
    vertex = drawn_corner(deflection_deg)[1]
    out = math.radians(deflection_deg)
    incoming = Leg(vertex - [1.2, 0], 0.0, 0.0, WIDTH_MM, NO_STATIONS)
    outgoing = Leg(
        vertex + 1.2 * np.array([math.cos(out), math.sin(out)]), out, 0.0, WIDTH_MM, NO_STATIONS
    )
    eyes = View(photocell.behind_aperture(drawing, 0.15), WIDTH_MM)
    corner = Corner.of(incoming, outgoing)
    assert corner is not None
    assert (corner.beyond_mm, corner.before_mm) == pytest.approx((1.2, 1.2), abs=1e-9)
    return eyes, corner


def through(eyes: View, corner: Corner) -> list[Array]:
    """The course of a head that stands 0.5 mm before the incoming leg's clean end."""
    stands = corner.incoming.at(-0.5), corner.incoming.heading_rad
    return through_corner(eyes, stands, corner, 0.0)


@pytest.mark.parametrize("deflection_deg", [60.0, 90.0, 120.0, 144.0])
def test_a_sharp_corner_goes_through_its_vertex(deflection_deg: float) -> None:
    eyes, corner = at_corner(deflection_deg, 0.0)
    stretches = through(eyes, corner)
    assert len(stretches) == 2  # the head stops and swivels between them
    vertex = drawn_corner(deflection_deg)[1]
    assert stretches[0][-1] == pytest.approx(vertex, abs=1e-9) and stretches[1][
        0
    ] == pytest.approx(vertex, abs=1e-9)


@pytest.mark.parametrize(
    ("deflection_deg", "radius_mm"), [(60.0, 1.0), (90.0, 0.3), (90.0, 0.5), (120.0, 0.3)]
)
def test_a_rounded_corner_goes_round_on_its_radius(
    deflection_deg: float, radius_mm: float
) -> None:
    eyes, corner = at_corner(deflection_deg, radius_mm)
    missed = radius_mm * (1 / math.cos(math.radians(deflection_deg) / 2) - 1)
    assert missing_ink_mm(eyes, corner) == pytest.approx(missed, abs=20 * UM)
    (way,) = through(eyes, corner)
    nearest = np.hypot(*(way - drawn_corner(deflection_deg)[1]).T).min()
    assert nearest == pytest.approx(
        missed, abs=25 * UM
    )  # the ink's edge is a round, seen by an aperture


def test_a_sharp_corner_misses_no_ink() -> None:
    for deflection_deg in (60.0, 90.0, 120.0):
        eyes, corner = at_corner(deflection_deg, 0.0)
        assert missing_ink_mm(eyes, corner) < SHARP * WIDTH_MM


def test_a_way_through_nodes_is_its_cubics_one_after_the_other() -> None:
    rng = np.random.default_rng(1)
    nodes = [(rng.uniform(-1, 1, 2), float(rng.uniform(-7, 7))) for _ in range(5)]
    parts = [curves.hermite(*a, *b) for a, b in pairwise(nodes)]
    assert np.array_equal(through_nodes(nodes), np.vstack(parts))
