"""The edge ahead of the head: corners brought back to their vertex, tips as they are, the way past them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.junctions.edge_ahead import TIP_STATIONS, EdgeAhead
from morfax.tracer.sensing.edge_scout import CIRCLE_PX
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, inked, polyline

SQUARE_MM = polyline((4, 4), (14, 4), (14, 14), (4, 14), (4, 4))
VERTEX = np.array([14.0, 4.0])


@pytest.fixture(scope="module")
def ahead() -> EdgeAhead:
    """The lower edge of a filled square from x = 6 mm on, and round its corner at 14, 4."""
    drawing = inked(polyline((20.0, 20.0), (20.1, 20.0)), width_mm=0.05, specks=[SQUARE_MM])
    view = View(behind_aperture(drawing, 0.1), 0.5, on_edge=True)
    felt = view.feel_edge(np.array([6.0, 4.0]), 0.0, 14.0)
    assert len(felt) * view.step_mm > 13.0
    return EdgeAhead(view, felt, 5)


def test_a_corner_is_where_its_legs_meet_and_not_where_the_lens_has_rounded_it(
    ahead: EdgeAhead,
) -> None:
    (corner,) = ahead.corners
    assert np.hypot(*(ahead.felt[:, :2] - VERTEX).T).min() > 20 * UM
    # a filled outline is inked half a fine pixel, 5 um, beyond itself
    assert corner.places == pytest.approx(VERTEX[None, :], abs=12 * UM)
    assert np.hypot(*(ahead.felt[corner.first, :2] - VERTEX)) < 1.0


def test_nodes_go_from_the_first_station_to_the_last_but_for_the_corner(
    ahead: EdgeAhead,
) -> None:
    at = [node.at for node in ahead.nodes]
    (corner,) = ahead.corners
    assert (at[0], at[-1]) == (0, len(ahead.felt) - 1)
    assert {corner.first, corner.last} <= set(at)
    apart_mm = np.diff(at) * ahead.view.step_mm
    # a third of half the length that is averaged, but across the corner
    assert np.sort(apart_mm)[-2] < ahead.view.leg_mm / 2


def test_the_way_past_a_corner_goes_by_its_vertex_up_to_plain_edge(ahead: EdgeAhead) -> None:
    plan = ahead.plan((ahead.felt[5, :2], 0.0), 1.0, 0.5)
    assert plan is not None
    way = np.vstack(plan.stretches)
    assert way[0] == pytest.approx(ahead.felt[5, :2]) and len(plan.stretches) == 2
    assert np.hypot(*(way - VERTEX).T).min() < 12 * UM
    assert plan.leg.heading_rad == pytest.approx(math.pi / 2, abs=math.radians(0.5))
    assert 4.0 < plan.leg.end_mm[1] < 7.0
    assert ahead.plan((ahead.felt[-1, :2], math.pi / 2), 1.0, 0.5) is None


def test_a_tip_too_narrow_for_its_legs_stays_where_the_lens_shows_it(ahead: EdgeAhead) -> None:
    """Out along X for 30 stations, and back at 170 degrees."""
    step, back = ahead.view.step_mm, math.radians(170)
    out = np.column_stack([np.arange(31) * step, np.zeros(31)])
    home = out[-1] + step * np.arange(1, 31)[:, None] * [math.cos(back), math.sin(back)]
    felt = np.column_stack([np.vstack([out, home]), np.full(61, 0.3)])
    (tip,) = EdgeAhead(ahead.view, felt, 0)._tips([])
    assert (tip.first, tip.last) == (30 - TIP_STATIONS, 30 + TIP_STATIONS)
    assert tip.places == pytest.approx(felt[30:31, :2])


@pytest.mark.parametrize("ratio", [0.6, 1.0])
def test_the_softness_is_told_by_how_steep_a_circle_finds_the_edge(
    ahead: EdgeAhead, ratio: float
) -> None:
    """`ratio`: the circle's radius in deviations of the lens. The circle itself blurs by its radius / √2."""
    steep = (ratio - ratio**3 / 8 + ratio**5 / 64) / math.sqrt(math.tau)
    felt = np.column_stack([ahead.felt[:20, :2], np.full(20, steep)])
    radius_mm = CIRCLE_PX * ahead.view.pitch_mm
    told_mm = math.hypot(radius_mm / ratio, radius_mm / math.sqrt(2))
    assert EdgeAhead(ahead.view, felt, 0).softness_mm == pytest.approx(told_mm, rel=1e-3)
