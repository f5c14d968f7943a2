"""A strip bends between weights as splines do, and comes to lie on the ink about it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly
from morfax.tracer.tangles import moved_way
from morfax.tracer.tangles.seen_ink import SeenInk
from morfax.tracer.tangles.spline import Strip, Weights, wrong_along
from tests.tracer.inked import UM, arc
from tests.tracer.tangles.pen_ink import HALF_MM, apart_mm, ink_along

PITCH_MM, SIDE_PX, STEP_MM = 0.085, 90, 0.05
# from a side round a relief of twice the pen's radius, which begins and ends at corners, to the other side
RELIEF = np.vstack([(1.0, 3.6), arc((3.6, 3.6), 0.9, 180, 450), (3.6, 6.5)])
CORNERS = (2.7, 3.6), (3.6, 4.5)


def along(way: Array, *corners: tuple[float, float]) -> tuple[Array, list[int]]:
    """Places a step apart along a way, and which of them are nearest to some corners."""
    places = evenly(way, STEP_MM)
    return places, [int(np.argmin(np.hypot(*(places - at).T))) for at in corners]


def strip_of(places: Array, corners: list[int], every: float = 7.5) -> Strip:
    """A strip along some places with weights about so many places apart."""
    return Strip.along(places, STEP_MM, Weights.apart(len(places), corners, every), 0.06)


def test_weights_stand_at_the_ends_and_corners_and_evenly_between() -> None:
    weights = Weights.apart(41, [10], 7.5)
    assert weights.at.tolist() == [0, 10, 17.5, 25, 32.5, 40]
    assert np.flatnonzero(weights.sharp).tolist() == [1]


def test_a_strip_lies_on_a_straight_line_and_on_an_arc() -> None:
    """Within 2 um, also of an arc of 0.9 mm, with weights 0.38 mm apart."""
    line, _ = along(np.array([(1.0, 1.0), (5.0, 3.0)]))
    assert apart_mm(strip_of(line, []).way_mm, line) < 2 * UM
    bend, _ = along(arc((3.6, 3.6), 0.9, 90, 300))
    assert apart_mm(strip_of(bend, []).way_mm, bend) < 2 * UM


def test_a_strip_is_broken_at_its_corners_and_nowhere_else() -> None:
    places, corners = along(RELIEF, *CORNERS)
    strip = strip_of(places, corners)
    at = np.flatnonzero(strip.sharp)
    assert np.hypot(*(strip.way_mm[at] - places[corners]).T).max() < 1e-9
    steps = np.diff(strip.way_mm, axis=0)
    turned = np.abs(np.diff(np.unwrap(np.arctan2(*steps.T[::-1]))))
    assert set(np.flatnonzero(turned > 0.2) + 1) == set(at.tolist())


@pytest.mark.parametrize("noise", [0.0, 0.03])
def test_a_strip_settles_on_the_ink_of_a_relief_whose_corners_were_off(noise: float) -> None:
    """Within 25 um, a quarter of a pixel: the head's way lies 0.1 mm outside, its corners 0.15 mm off."""
    ink = ink_along(RELIEF, PITCH_MM, SIDE_PX, noise)
    begin, end = (2.55, 3.6), (3.6, 4.65)
    felt = np.vstack([(1.0, 3.6), begin, arc((3.6, 3.6), 1.0, 190, 440), end, (3.6, 6.5)])
    places, corners = along(felt, begin, end)
    true = np.vstack([RELIEF[:-1], places[-1]])
    assert apart_mm(places, true) > 90 * UM
    assert apart_mm(strip_of(places, corners).settled(ink), true) < 25 * UM


def test_a_strip_without_weights_to_move_stays() -> None:
    line, _ = along(np.array([(1.0, 1.0), (1.3, 1.0)]))
    strip = strip_of(line, [])
    assert strip.figures == 0
    ink = ink_along(line, PITCH_MM, SIDE_PX, 0.0)
    assert np.array_equal(strip.settled(ink), strip.way_mm)


def corner_ink(extra: float) -> tuple[SeenInk, Array, Array]:
    """The ink of a right corner, its way and where it turns; with so much more ink outside of that."""
    way = np.array([(1.0, 3.0), (4.0, 3.0), (4.0, 6.5)])
    ink = ink_along(way, PITCH_MM, SIDE_PX, 0.0)
    outside = np.all((ink.places_mm - way[1]) * (1, -1) > 0.7 * HALF_MM, axis=1)
    outside &= np.all((ink.places_mm - way[1]) * (1, -1) < HALF_MM, axis=1)
    dark = np.where(outside, np.maximum(ink.darkness, extra), ink.darkness)
    return ink._replace(darkness=dark), way, np.array([False, True, False])


def test_ink_that_comes_to_a_point_at_a_corner_is_not_wrong_and_elsewhere_it_is() -> None:
    pointed, way, sharp = corner_ink(1.0)
    assert np.abs(wrong_along(pointed, way, sharp)).max() < 0.02
    assert wrong_along(pointed, way, np.zeros(3, bool)).min() < -0.3


def test_a_pen_that_draws_on_paper_at_a_corner_is_wrong() -> None:
    """A corner that was drawn rounded: there is paper where a pen that turns at the corner leaves ink."""
    round_way = np.vstack([(1.0, 3.0), arc((3.0, 4.0), 1.0, -90, 0), (4.0, 6.5)])
    ink = ink_along(round_way, PITCH_MM, SIDE_PX, 0.0)
    _, way, sharp = corner_ink(0.0)
    assert wrong_along(ink, way, sharp).max() > 0.5


def test_what_each_figure_changes_is_the_slope_of_what_is_wrong() -> None:
    """Against steps of a tenth of a micrometre, within a thousandth of the steepest slope; the kernels do
    what plain Python does.
    """
    places, corners = along(RELIEF, *CORNERS)
    strip, ink = strip_of(places, corners), ink_along(RELIEF, PITCH_MM, SIDE_PX, 0.03)
    figures = np.random.default_rng(3).normal(0, 0.02, strip.figures)
    seen, way = ink.for_kernel(), strip.moved(figures)
    slopes, plain = (np.empty((len(seen.places_mm), strip.figures)) for _ in range(2))
    moved, near = (way, strip.moves, strip.sharp), np.empty((len(seen.places_mm), 3))
    moved_way.nearest(seen.places_mm, way, near)
    moved_way.changes(seen, moved, near, slopes)
    moved_way.changes.py_func(seen, moved, near, plain)
    assert np.allclose(slopes, plain, atol=1e-9)
    by = 1e-4
    for k in range(strip.figures):
        step = by * np.eye(strip.figures)[k]
        after, before = (
            wrong_along(ink, strip.moved(figures + sign * step), strip.sharp)
            for sign in (1, -1)
        )
        off = np.abs((after - before) / (2 * by) - slopes[:, k])
        # where the nearest place jumps from one side of a bend to the other there is no slope
        assert np.quantile(off, 0.98) < 1e-3 * np.abs(slopes).max()


def test_the_nearest_piece_of_a_way_is_that_of_plain_python() -> None:
    rng = np.random.default_rng(2)
    places, way = rng.uniform(0, 5, (40, 2)), rng.uniform(0, 5, (12, 2))
    found, plain = np.empty((40, 3)), np.empty((40, 3))
    moved_way.nearest(places, way, found)
    moved_way.nearest.py_func(places, way, plain)
    assert np.allclose(found, plain)
    away_mm, piece, share = found.T
    first = way[piece.astype(int)]
    foot = first + share[:, None] * (way[piece.astype(int) + 1] - first)
    assert np.allclose(np.hypot(*(places - foot).T), away_mm)
