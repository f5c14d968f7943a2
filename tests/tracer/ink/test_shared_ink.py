"""Lines that run together for a while keep their partners, and stay in the ink that they share."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import uniform_filter1d

from morfax.motion.contour import distance
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.felt import feel_along
from morfax.tracer.ink.shared_ink import (
    SLACK,
    SharedInk,
    _averaged,
    _off,
    kept_in_ink,
    off_rims_mm,
)
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, inked, polyline


@pytest.mark.parametrize("side", [1, -1])
def test_a_way_is_bent_to_its_own_rim_as_a_whole(side: int) -> None:
    """Two lines apart by half a width; the way of one lies between, its headings at the ends are off."""
    lines = [polyline((5, y), (35, y)) for y in (10.0, 10.0 + 0.5 * WIDTH_MM)]
    view = View(photocell.behind_aperture(inked(*lines, seed=1), 0.1), WIDTH_MM)
    middle = 10.0 + 0.25 * WIDTH_MM
    felt = feel_along(view, polyline((6, middle), (34, middle)))
    at = np.linspace(8, 32, 500)
    own, beside = (middle + 0.25 * s * WIDTH_MM for s in (side, -side))
    way = np.column_stack([at, own - side * 0.1 * np.sin(np.pi * (at - 8) / 24) ** 2])
    other = np.column_stack([at, np.full(len(at), beside)])
    kept = kept_in_ink(way, SharedInk([felt]), WIDTH_MM, [other])
    # no place of it is further from its rim than the slack, so that none was moved by itself
    assert np.abs(way[:, 1] - own).max() < SLACK * WIDTH_MM + 50 * UM
    assert np.abs(kept[:, 1] - own).max() < 20 * UM  # half a pixel's noise at a rim


def test_of_a_way_of_one_place_no_rim_tells() -> None:
    """Ink that thins out to nothing has no width by which the way would be long."""
    line = polyline((5, 10), (35, 10))
    felt = feel_along(View(photocell.behind_aperture(inked(line), 0.1), WIDTH_MM), line)
    way = polyline((20, 10), (20.04, 10))
    assert off_rims_mm(way, SharedInk([felt]), 0.01, []) == 0.0


ACROSS = np.linspace(-12.0, 12.0, 400)


def bow(aside_mm: float) -> Points:
    """An arc of 30 mm radius about, its lowest place so far to one side."""
    return np.column_stack([20 + ACROSS, 10 + (ACROSS - aside_mm) ** 2 / 60])


def test_a_way_beside_the_ink_is_moved_into_it() -> None:
    line = polyline((5, 10), (35, 10))
    view = View(photocell.behind_aperture(inked(line, seed=1), 0.1), WIDTH_MM)
    felt = feel_along(view, polyline((6, 10), (34, 10)))
    # a bow that leaves the ink by 0.3 mm half way
    at = np.linspace(8, 32, 500)
    way = np.column_stack([at, 10 + 0.3 * np.sin(np.pi * (at - 8) / 24)])
    kept = kept_in_ink(way, SharedInk([felt]), WIDTH_MM)
    inner = np.abs(at - 20) < 10
    assert np.abs(kept[inner, 1] - 10).max() < SLACK * WIDTH_MM + 15 * UM
    assert np.array_equal(kept[[0, -1]], way[[0, -1]])
    # ink across the way says nothing
    crossing = feel_along(view, polyline((6, 10), (34, 10)))
    steep = np.column_stack([20 + 0.5 * (at - 20), 10 + 0.5 * (at - 20)])
    assert np.array_equal(kept_in_ink(steep, SharedInk([crossing]), WIDTH_MM), steep)


def test_beyond_its_ends_ink_moves_no_way() -> None:
    view = View(
        photocell.behind_aperture(inked(polyline((5, 10), (35, 10)), seed=1), 0.1), WIDTH_MM
    )
    ink = SharedInk([feel_along(view, polyline((10, 10), (30, 10)))])
    x = np.linspace(8.0, 32.0, 241)
    aside_mm = _off(np.column_stack([x, np.full(241, 10.1)]), ink, WIDTH_MM, []).aside
    assert not aside_mm[(x < 9.8) | (x > 30.2)].any()
    assert np.abs(aside_mm[(x > 11) & (x < 29)] + 0.1).max() < 20 * UM  # onto its middle


@pytest.mark.parametrize("deg", [80.0, 50.0])
def test_a_line_that_only_crosses_moves_no_way(deg: float) -> None:
    """At a crossing one station of the ink is three widths broad: its rims belong to neither line.

    (Fails without `is_crossed` in `_off`: the way was 0.13 mm off at a crossing of 80 degrees.)
    """
    way = np.column_stack([np.linspace(-0.5, 0.5, 101), np.zeros(101)])
    broad = replace(
        feel_along(
            View(
                photocell.behind_aperture(inked(polyline((5, 5), (15, 5)), seed=1), 0.1),
                WIDTH_MM,
            ),
            polyline((6, 5), (14, 5)),
        ),
        places_mm=np.array([[0.1, 0.2]]),
        headings_rad=np.zeros(1),
        widths_mm=np.array([3 * WIDTH_MM]),
    )
    angle = np.radians(deg)
    other = np.linspace(-0.6, 0.6, 101)[:, None] * (np.cos(angle), np.sin(angle))
    assert np.array_equal(kept_in_ink(way, SharedInk([broad]), WIDTH_MM, [other]), way)


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_two_bows_that_share_their_ink_are_two_strokes_each_near_its_own_line(
    seed: int,
) -> None:
    one, other = bow(-1.5), bow(1.5)
    run = trace_ink(inked(one, other, seed=seed), Settings())
    assert len(run.lines) == 2
    assert run.ink is not None and run.ink.followed_share > 0.99
    for truth in (one, other):
        off = min(
            (distance(line.xy_mm[::4], truth).path_to_reference for line in run.lines),
            key=lambda summary: summary.rms_mm,
        )
        # moved place by place, 12 um; bent along its rim as a whole, 5 to 7
        assert off.rms_mm < 9 * UM and off.max_mm < 0.1 * WIDTH_MM


@pytest.mark.parametrize("deg", [10.0, 18.0])
def test_where_two_lines_part_neither_is_moved_by_the_rims_before(deg: float) -> None:
    """Beyond the ink that they share no rim is known. (29 to 37 um without `ABREAST`.)"""
    along = 15 * np.array([np.cos(np.radians(deg)), np.sin(np.radians(deg))])
    one = polyline((5, 10), (35, 10))
    other = np.array([20, 10]) + np.outer((-1, 1), along)
    for seed in (1, 2):
        run = trace_ink(inked(one, other, seed=seed), Settings())
        for truth in (one, other):
            off = [distance(line.xy_mm[::4], truth).path_to_reference for line in run.lines]
            assert min(summary.max_mm for summary in off) < 15 * UM  # a sixth of a pixel


@pytest.mark.parametrize("seed", [1, 2])
def test_two_bows_that_touch_do_not_cross(seed: int) -> None:
    """Where they are nearest their ink is more than one and a half widths broad. (They crossed there.)"""
    outer = np.column_stack([20 + ACROSS, 10 + ACROSS**2 / 60])
    inner = np.column_stack([20 + ACROSS, 10.3 + ACROSS**2 / 40])
    run = trace_ink(inked(outer, inner, seed=seed), Settings())
    for truth in (outer, inner):
        off = [distance(line.xy_mm[::4], truth).path_to_reference for line in run.lines]
        assert min(summary.max_mm for summary in off) < 15 * UM


def test_a_circle_that_touches_a_line_is_no_corner_there() -> None:
    """Between clean ends it turns by 87 degrees, as a corner might; its own rim is felt all along."""
    circle = arc((14, 6.8), 2.8)
    drawing = inked(polyline((4, 4), (24, 4)), circle, width_mm=0.35, dpi=200, seed=1)
    closed = [line for line in trace_ink(drawing).lines if line.ending == "closed"]
    assert len(closed) == 1
    away_mm = np.hypot(*(closed[0].xy_mm - (14, 6.8)).T)
    # a pixel is 0.127 mm
    assert np.abs(away_mm - 2.8).max() < 0.1


def test_moves_are_averaged_as_scipy_does_to_the_last_bit() -> None:
    random = np.random.default_rng(2)
    for places in (0.3, 1.6, 2.0, 7.0, 12.2, 90.0):
        moves = random.normal(size=(40, 2))
        theirs = uniform_filter1d(moves, max(1, round(places)), axis=0, mode="nearest")
        assert np.array_equal(_averaged(moves, places), theirs)


def test_a_way_whose_leg_was_felt_anew_is_the_same_line() -> None:
    """Where a closed line is cut open its leg is: the corners of such a line were left out, 1.5 mm of it were
    off, and it kept aside of itself.
    """
    way, corners = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]), np.array([(4.0, 0.0)])
    ink = SharedInk(ways=[way, way + 5.0], vertices=[corners, None])
    felt_anew = way[[0, -1]] + ((0.0, 0.0), (5e-5, 0.0))
    assert ink.turns_at(felt_anew) is corners
    assert [other[0, 0] for other in ink.besides(felt_anew)] == [5.0]
