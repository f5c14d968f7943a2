"""The spline that explains the ink: its corners are those that are drawn, no more and no fewer."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.plane import unit
from morfax.motion.polyline import evenly, nearest_mm, with_places
from morfax.tracer.program.against_ink.off_ink import REACH, ink_about
from morfax.tracer.program.laid import spline_fit
from morfax.tracer.program.laid.spline_fit import (
    about_corners,
    corners_of,
    explained,
    left_by,
    turns_rad,
)
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, inked, polyline

STEP_MM = STEP_WIDTHS * WIDTH_MM
NOISE = 0.01  # what a spline that lies on its ink leaves about a place, at most


def bend(deflection_deg: float, leg_mm: float = 3.0) -> Points:
    """Two legs that meet at a sharp corner."""
    turned = math.radians(deflection_deg)
    return np.array(
        [
            [10 - leg_mm, 10],
            [10, 10],
            [10 + leg_mm * math.cos(turned), 10 + leg_mm * math.sin(turned)],
        ]
    )


def seen(truth: Points, own: Points, pen_mm: float = WIDTH_MM) -> SeenInk:
    """The ink about a stretch of a line that goes on at both its ends, drawn with a pen."""
    onward = own[-1] + 4 * unit(own[-1] - own[-2])
    before, behind = np.array([own[0] - [4, 0], own[0]]), np.array([own[-1], onward])
    drawn = np.vstack([before[:1], truth, behind[1:]])
    drawing = inked(drawn, seed=1, width_mm=pen_mm)
    return ink_about(drawing, own, WIDTH_MM, REACH, [(before, 0.0), (behind, 0.0)])


def cut_short(way: Points, by_mm: float) -> Points:
    """A way a step from place to place, as a head runs that averages over so much to either side."""
    places = evenly(way, STEP_MM)
    over = round(by_mm / STEP_MM)
    padded = np.pad(places, ((over, over), (0, 0)), mode="reflect", reflect_type="odd")
    ones = np.ones(2 * over + 1) / (2 * over + 1)
    return np.column_stack([np.convolve(column, ones, "valid") for column in padded.T])


def test_how_far_a_way_turns_is_told_about_each_place() -> None:
    """By the legs of a quarter of a width before and after it; at its ends it turns by nothing."""
    way = evenly(bend(60), STEP_MM)
    turned = np.degrees(turns_rad(way))
    corner = int(np.argmin(np.hypot(*(way - [10, 10]).T)))
    assert turned[corner] == pytest.approx(60, abs=1)
    assert turned[corner + 3 :].max() < 1e-6 and turned[: corner - 2].max() < 1e-6
    assert turned[0] == turned[-1] == 0
    # the same to the right, and over the heading of 180 degrees
    for degrees in (0, 100, 175, 260):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        for mirrored in (1, -1):
            other = way @ np.array([[c, s], [-s, c]]) * [1, mirrored]
            assert np.degrees(turns_rad(other)) == pytest.approx(turned, abs=1e-6)


@pytest.mark.parametrize(("deflection_deg", "count"), [(20, 0), (40, 1), (90, 1), (150, 1)])
def test_a_turn_of_more_than_30_degrees_is_a_corner(deflection_deg: float, count: int) -> None:
    way = evenly(bend(deflection_deg), STEP_MM)
    found = corners_of(turns_rad(way))
    assert len(found) == count
    if count:
        assert np.hypot(*(way[found[0]] - [10, 10])) < STEP_MM
        (near,) = np.flatnonzero(np.diff(about_corners(way).astype(int), prepend=0) == 1)
        assert near == found[0] - 1 and about_corners(way).sum() == 3


def test_corners_that_are_nearer_than_what_shows_them_are_one() -> None:
    turned = np.zeros(40)
    turned[[10, 12, 20, 30]] = np.radians([50, 60, 45, 25])
    assert corners_of(turned) == [12, 20]


@pytest.mark.parametrize("deflection_deg", [60, 90, 120])
def test_a_corner_that_was_cut_short_is_put_back(deflection_deg: float) -> None:
    """Within 30 um, a third of a pixel; the head's own way passes it by 80 um or more. The ends stay."""
    truth = bend(deflection_deg)
    own = cut_short(truth, 0.3)
    ink = seen(truth, own)
    spline = explained(ink, own, STEP_MM, NOISE)
    vertex = np.array([[10.0, 10.0]])
    assert spline is not None
    assert nearest_mm(vertex, spline.way)[0] < 30 * UM < 80 * UM < nearest_mm(vertex, own)[0]
    assert spline.way[[0, -1]] == pytest.approx(own[[0, -1]])
    assert spline.misfit < 0.5 * left_by(ink, own, about_corners(own))


@pytest.mark.parametrize("deflection_deg", [90, 120])
def test_a_corner_that_is_seen_stays_one_and_is_run_in_two_pieces(
    deflection_deg: float,
) -> None:
    """Within 10 um; they meet there."""
    truth = bend(deflection_deg)
    own = cut_short(truth, 0.15)
    spline = explained(seen(truth, own), own, STEP_MM, NOISE)
    assert spline is not None and len(spline.corners) == 1
    first, second = spline.stretches()
    assert np.array_equal(first[-1], second[0])
    assert np.hypot(*(first[-1] - [10, 10])) < 10 * UM
    assert np.array_equal(np.vstack([first, second[1:]]), spline.way)


def test_a_round_bend_has_no_corner() -> None:
    """An arc of 0.4 mm that the head cut short; the spline lies on it within 20 um."""
    truth = np.vstack([[[7.0, 10.0]], arc((10, 10.4), 0.4, -90, 0), [[10.4, 13.4]]])
    own = cut_short(truth, 0.5)
    ink = seen(truth, own)
    spline = explained(ink, own, STEP_MM, NOISE)
    assert spline is not None and spline.corners == () and len(spline.stretches()) == 1
    assert nearest_mm(spline.way, with_places(truth, 2 * UM)).max() < 20 * UM
    assert spline.cost == spline.misfit + spline_fit.PRICE * spline.figures


def test_a_way_out_and_back_along_a_tick_has_no_spline() -> None:
    own = evenly(polyline((7, 10), (10, 10), (10, 12), (10.001, 10), (13, 10)), STEP_MM)
    drawing = inked(polyline((7, 10), (13, 10)), polyline((10, 10), (10, 12)), seed=1)
    assert explained(ink_about(drawing, own, WIDTH_MM, REACH), own, STEP_MM, NOISE) is None


@pytest.mark.parametrize("broader", [1.3, 1.5, 1.8])
def test_no_spline_swings_from_rim_to_rim_of_ink_that_is_broader_than_the_line(
    broader: float,
) -> None:
    """It lay up to 0.4 widths off the middle, to one side and the other, ten times in as many widths."""
    own = cut_short(bend(90), 0.3)
    assert explained(seen(bend(90), own, broader * WIDTH_MM), own, STEP_MM, NOISE) is None


def test_a_stretch_that_crosses_itself_has_a_spline() -> None:
    """A loop of 2 by 3 mm that the head cut short; the spline lies on it within 0.1 mm, at the crossing."""
    turns = np.linspace(-2, 2, 801)
    drawn = np.column_stack([12 + 2.2 * (turns**3 - turns), 8 + 2.6 * turns**2])
    truth = drawn[100:-100]
    own = cut_short(truth, 0.3)
    others = [(drawn[:101], 0.0), (drawn[-101:], 0.0)]
    ink = ink_about(inked(drawn, seed=1), own, WIDTH_MM, REACH, others)
    spline = explained(ink, own, STEP_MM, NOISE)
    assert spline is not None and math.isfinite(spline.cost)
    assert nearest_mm(spline.way, with_places(truth, 2 * UM)).max() < 100 * UM
