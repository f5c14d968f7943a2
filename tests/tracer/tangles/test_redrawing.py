"""Tangles explained by redrawing their ink: which legs belong together, and over which vertices, where inks
of several legs run together.

Bounds: 30 um for a place of the path, as the issue allows where lines come within a width of each other; at
the vertex of a tip the pen's round is all that tells, and the aperture of 0.15 mm rounds that off: half the
width.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace import trace
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.redrawing import Redrawing, matchings
from morfax.tracer.tangles.sketch import Sketch, redrawings
from morfax.tracer.tangles.tangle import Tangle, tangle_ahead
from tests.tracer.inked import UM, inked, polyline

WIDTH_MM = 0.5
SEEDS = pytest.mark.parametrize("seed", [None, 1, 2])
ACROSS = polyline((4, 10), (24, 10))
BLUNT = polyline((4, 8), (14, 10), (14.3, 10.4), (14.1, 10.6), (4, 10.6))


def seen(drawing: Drawing) -> View:
    return View(behind_aperture(drawing, 0.15), WIDTH_MM)


def tangle(
    *lines: Array, start: tuple[float, float] = (11.0, 10.0), seed: int | None = None
) -> tuple[View, Tangle]:
    """The tangle ahead of the line that goes right from a place on it."""
    view = seen(inked(*lines, seed=seed))
    return view, tangle_ahead(
        view, leg_of(view.feel(np.array(start), 0.0, 4.0), True, view.leg_mm)
    )


def best(view: View, found: Tangle) -> Redrawing:
    return redrawings(Sketch.of(view, found))[0]


@pytest.mark.parametrize(("legs", "count"), [(2, 1), (3, 3), (4, 3), (6, 15)])
def test_every_way_to_join_legs_in_pairs_is_there_once(legs: int, count: int) -> None:
    found = matchings(legs)
    assert len(found) == count == len({frozenset(pairs) for pairs in found})
    assert all(len(pairs) == legs // 2 for pairs in found)


def test_a_pen_s_ink_is_half_dark_at_its_edge_and_has_the_line_s_width() -> None:
    """At half a width the error function is at its middle; the sum over all distances is the width."""
    away = np.linspace(-1, 1, 2001)
    drawn = np.empty(len(away))
    pen.ink(np.abs(away), 0.25, 0.07, drawn)
    assert drawn[1250] == pytest.approx(0.5, abs=1e-9)
    assert drawn.sum() * 1e-3 == pytest.approx(0.5, abs=1 * UM)


@SEEDS
def test_a_crossing_has_four_legs_and_joins_those_that_are_straight(seed: int | None) -> None:
    view, found = tangle(ACROSS, polyline((10, 4), (18, 16)), seed=seed)
    assert found.whole and len(found.legs) == 4
    way = best(view, found)
    headings = [
        math.cos(found.legs[a].heading_rad - found.legs[b].heading_rad) for a, b in way.pairs
    ]
    assert abs(headings[0]) > 0.99 and way.strokes == ()


@SEEDS
def test_two_corners_that_touch_are_not_taken_for_a_crossing(seed: int | None) -> None:
    """Their vertices are half a width apart: what a crossing would leave beside itself is 60 um broad."""
    left, right = (
        polyline((8, 10), (13.6, 10), (8, 14)),
        polyline((20, 10), (14.1, 10), (20, 14)),
    )
    view, found = tangle(left, right, start=(9.5, 10.0), seed=seed)
    assert len(found.legs) == 4
    way = best(view, found)
    partner = next(b for a, b in way.pairs if a == 0)
    assert found.legs[partner].end_mm[0] < 13.6  # the leg on its own side


@SEEDS
@pytest.mark.parametrize("half_mm", [0.5, 0.8, 1.2])
def test_the_head_goes_into_no_tick_that_crosses_its_line(
    half_mm: float, seed: int | None
) -> None:
    run = trace(
        inked(ACROSS, polyline((14, 10 - half_mm), (14, 10 + half_mm)), seed=seed), (8.0, 10.0)
    )
    assert distance(run.xy_mm[::4], ACROSS).path_to_reference.max_mm < 30 * UM


@SEEDS
def test_a_vertex_settles_where_the_pen_turned(seed: int | None) -> None:
    corner = polyline((4, 10), (14, 10), (16, 20))
    view, found = tangle(corner, seed=seed)
    (vertex,) = best(view, found).vertices[0]
    assert np.hypot(*(vertex - corner[1])) < 25 * UM


@SEEDS
@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
def test_a_line_goes_into_a_blunt_tip_where_its_inks_run_together(
    width_mm: float, seed: int | None
) -> None:
    """Two legs 13 degrees apart and a short edge between their ends: one path, all of it."""
    run = trace(inked(BLUNT, width_mm=width_mm, seed=seed))
    assert run.ending == "ended"
    apart = distance(run.xy_mm[::4], BLUNT)
    assert apart.path_to_reference.p95_mm < 30 * UM
    assert apart.hausdorff_mm < 0.4 * width_mm
    assert run.length_mm == pytest.approx(length_mm(BLUNT), abs=2 * width_mm)


@pytest.mark.parametrize(
    ("degrees", "is_tip"), [(0.5, True), (2.9, True), (3.1, False), (90, False)]
)
def test_a_vertex_is_a_tip_where_the_pen_goes_back_on_itself(
    degrees: float, is_tip: bool
) -> None:
    """Two strands: the first bends at its second vertex, the other has none."""
    away = 5 * np.array([-math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    vertices = np.array([[2.0, 1.0], [7.0, 1.0]])
    ends = np.zeros((2, 2, 3))
    ends[0, 0, :2], ends[0, 1, :2] = (0.0, 1.0), vertices[1] + away
    drawn = pen.Drawn(ends, np.array([2, 0]), 0)
    assert pen.tips(drawn, vertices) == pen.tips.py_func(drawn, vertices) == is_tip
