"""The compass lays small loops where their ink is: circles, slots and polygons of known size."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import cross
from morfax.motion.polyline import area_mm2, length_mm, with_places
from morfax.tracer.tangles import compass, core_ink
from morfax.tracer.tangles.compass import Core, explained
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.pen import Ink
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM, arc
from tests.tracer.tangles.pen_ink import HALF_MM, apart_mm, ink_along

PITCH_MM, SIDE_PX = 0.1, 60

CIRCLE = arc((3.0, 3.1), 0.6)
SLOT = np.vstack([arc((2.4, 3.0), 0.5, 90, 270), arc((3.6, 3.0), 0.5, -90, 90)])
TRIANGLE = np.array([(2.0, 2.2), (4.0, 2.4), (2.7, 4.0)])
OBLONG = np.array([(2.1, 2.3), (3.3, 2.0), (3.9, 3.8), (2.7, 4.1)])


def closed(way: Array) -> Array:
    """A way with its first place at its end."""
    return np.vstack([way, way[:1]])


def ink_of(way: Array, noise: float = 0.0, half_mm: float = HALF_MM) -> SeenInk:
    """The ink that a pen leaves along a closed way."""
    return ink_along(closed(way), PITCH_MM, SIDE_PX, noise, half_mm)


def off_mm(core: Core, way: Array) -> float:
    """How far the core's way is from a closed way, and that from it, at most."""
    return apart_mm(np.vstack(core.stretches()), closed(way))


@pytest.mark.parametrize(
    ("way", "points"), [(CIRCLE, 1), (SLOT, 2), (TRIANGLE, 3), (OBLONG, 4)]
)
def test_a_loop_of_a_known_shape_is_laid_true_with_the_fewest_points(
    way: Array, points: int
) -> None:
    core = explained(ink_of(way))
    assert core is not None and len(core.points_mm) == points
    # the places are compared 2 um apart, and a fit ends where a step gains nothing
    assert off_mm(core, way) < 5 * UM
    assert core.half_mm == pytest.approx(HALF_MM, abs=2 * UM)


def test_a_speck_beside_a_narrow_slot_moves_nothing() -> None:
    """Four pixels of the scan at two widths from the slot's middle."""
    narrow = np.vstack([arc((1.5, 3.0), 0.2, 90, 270), arc((4.5, 3.0), 0.2, -90, 90)])
    ink = ink_of(narrow, noise=0.02)
    specks = np.array([(2.05, 4.05), (2.15, 4.05), (2.05, 4.15), (2.15, 4.15)])
    with_speck = ink._replace(
        places_mm=np.vstack([ink.places_mm, specks]),
        darkness=np.append(ink.darkness, np.ones(4)),
        known_mm=np.append(ink.known_mm, np.full(4, math.inf)),
    )
    core = explained(with_speck)
    assert core is not None and off_mm(core, narrow) < 0.2 * PITCH_MM


@pytest.mark.parametrize("way", [CIRCLE, SLOT, TRIANGLE, OBLONG])
def test_noise_of_a_scan_moves_a_loop_by_a_tenth_of_a_pixel_at_most(way: Array) -> None:
    core = explained(ink_of(way, noise=0.04))
    assert core is not None and off_mm(core, way) < 0.2 * PITCH_MM


def test_the_pen_may_be_broader_than_was_felt() -> None:
    core = explained(ink_of(CIRCLE, half_mm=1.15 * HALF_MM))
    assert core is not None
    assert core.half_mm == pytest.approx(1.15 * HALF_MM, abs=2 * UM)
    assert off_mm(core, CIRCLE) < 5 * UM


def test_no_loop_is_laid_off_the_ink_of_a_ring_with_a_tail() -> None:
    """A letter: no core explains it, and the sides of one that tries leave the ink that was looked at."""
    ring = arc((2.57, 2.79), 0.79, 246, 606)
    tail = np.array([(3.9, 1.62), (5.01, 0.83)])
    ink = ink_of(np.vstack([ring, tail, tail[:1]]), noise=0.05)
    core = explained(ink)
    dark = ink.places_mm[ink.darkness > 0.5]
    if core is not None:
        way = with_places(np.vstack(core.stretches()), 2 * UM)
        away = np.hypot(*(way[:, None] - dark).T).min(axis=0)
        assert away.max() < 3 * HALF_MM


def test_a_way_is_on_its_ink_where_no_side_leaves_it() -> None:
    ink = ink_of(TRIANGLE)
    assert ink.holds(np.vstack(Core(TRIANGLE, 0.0, HALF_MM).stretches()))
    # a corner half a width and two and a half from the ink of a side
    # ... and one so far off that nobody looks along its sides
    for aside_mm, is_on in ((1.0 * HALF_MM, True), (5.0 * HALF_MM, False), (1e11, False)):
        corner = 0.5 * (TRIANGLE[0] + TRIANGLE[1]) - (0.0, HALF_MM + aside_mm)
        beside = np.vstack([TRIANGLE[:1], [corner], TRIANGLE[1:]])
        assert ink.holds(np.vstack(Core(beside, 0.0, HALF_MM).stretches())) == is_on


def test_a_way_that_cuts_a_loop_short_leaves_ink_unexplained() -> None:
    """A chord cuts off a segment as high as half the line is wide."""
    ink = ink_of(CIRCLE)
    at = np.linspace(0, math.tau, len(CIRCLE))
    radius = np.minimum(0.6, (0.6 - HALF_MM) / np.maximum(np.cos(at), 1e-3))
    short = np.column_stack([3.0 + radius * np.cos(at), 3.1 + radius * np.sin(at)])
    assert ink.misfit_along(closed(CIRCLE)) < 1e-3
    assert ink.misfit_along(closed(short)) > 0.3


@pytest.mark.parametrize(
    ("core", "long_mm"),
    [
        (Core(np.array([(1.0, 1.0)]), 0.5, HALF_MM), math.pi),
        (Core(np.array([(1.0, 1.0), (2.0, 1.0)]), 0.5, HALF_MM), math.pi + 2),
        (Core(OBLONG, 0.0, HALF_MM), length_mm(closed(OBLONG))),
        (Core(OBLONG[::-1], 0.3, HALF_MM), length_mm(closed(OBLONG)) + 0.3 * math.tau),
    ],
)
def test_the_way_of_a_core_is_closed_and_as_long_as_its_sides_and_arcs(
    core: Core, long_mm: float
) -> None:
    stretches = core.stretches()
    way = np.vstack(stretches)
    assert np.allclose(way[0], way[-1])
    # chords of two degrees are shorter than their arcs by 5e-5
    assert length_mm(way) == pytest.approx(long_mm, rel=1e-4)
    assert core.length_mm == pytest.approx(long_mm)
    assert len(stretches) == (1 if core.radius_mm else len(core.points_mm) + 1)


def from_core(x: float, y: float, points: NDArray[np.float64]) -> float:
    """The distance of a place from the core of some points, by the kernels' plain Python."""
    sides = core_ink._sides.py_func(points)
    from_core_mm, side, share = core_ink._from_core.py_func(x, y, points, sides)
    foot = points[side] + share * sides[side, :2]
    assert math.dist(foot, (x, y)) == pytest.approx(abs(from_core_mm))
    return float(from_core_mm)


def test_the_distance_from_a_polygon_is_negative_within() -> None:
    square: NDArray[np.float64] = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])
    assert from_core(1.0, 0.5, square) == pytest.approx(-0.5)
    assert from_core(1.0, -0.5, square) == pytest.approx(0.5)
    assert from_core(3.0, 3.0, square) == pytest.approx(math.sqrt(2))
    assert from_core(1.0, 0.5, square[:1]) == pytest.approx(math.hypot(1.0, 0.5))
    assert from_core(1.0, 0.5, square[:2]) == pytest.approx(0.5)


def test_a_root_is_taken_for_the_nearest_sides_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    angles = np.linspace(0, 2 * math.pi, 13)[:-1]
    polygon, roots, hypot = np.column_stack([np.cos(angles), np.sin(angles)]), [], math.hypot

    def counted(x: float, y: float) -> float:
        roots.append((x, y))
        return hypot(x, y)

    monkeypatch.setattr(math, "hypot", counted)
    assert from_core(2.0, 0.0, polygon) == pytest.approx(1.0)
    assert len(roots) == 2  # both sides at the nearest corner, which is the first


def test_a_core_that_turns_back_and_forth_is_none() -> None:
    square = np.array([(0.0, 0), (2, 0), (2, 2), (0, 2)])
    dented = np.array([(0.0, 0), (2, 0), (0.5, 0.5), (0, 2)])
    crossed = np.array([(0.0, 0), (2, 2), (2, 0), (0, 2)])
    for points, is_convex in (
        (square, True),
        (square[::-1], True),
        (dented, False),
        (crossed, False),
    ):
        assert Core(points, 0.0, HALF_MM).is_convex == is_convex
    assert Core(square[:1], 1.0, HALF_MM).is_convex and Core(square[:2], 1.0, HALF_MM).is_convex


@pytest.mark.parametrize(
    "polygon", [TRIANGLE, OBLONG, OBLONG[::-1]], ids=["3", "4", "clockwise"]
)
def test_a_polygon_is_set_in_by_half_a_width_on_every_side(polygon: Array) -> None:
    inner = compass._within(polygon, HALF_MM)
    assert area_mm2(inner) > 0 and len(inner) == len(polygon)
    for corner in inner:
        sides = zip(polygon, np.roll(polygon, -1, axis=0), strict=True)
        off_mm = sorted(abs(cross(b - a, corner - a)) / math.dist(a, b) for a, b in sides)
        # a corner is half a width from its own two sides, and further from the others
        assert off_mm[:2] == pytest.approx([HALF_MM, HALF_MM]) and off_mm[-1] > HALF_MM


def test_of_a_hull_the_corners_that_matter_most_are_left() -> None:
    spare = 0.5 * (OBLONG + np.roll(OBLONG, -1, axis=0)) * 1.001
    hull = np.empty((8, 2))
    hull[::2], hull[1::2] = OBLONG, spare
    assert compass._reduced(hull, 4).tolist() == OBLONG.tolist()


@pytest.mark.parametrize("turned_rad", [0.0, 0.4, 2.0])
def test_a_slot_is_as_long_and_as_wide_as_its_ink(turned_rad: float) -> None:
    """A box of 2.5 x 1.5 mm with a pen of 0.5: places 1 mm apart, on a radius of 0.5."""
    c, s = math.cos(turned_rad), math.sin(turned_rad)
    box = np.array([(-1.25, -0.75), (1.25, -0.75), (1.25, 0.75), (-1.25, 0.75)])
    hull = box @ np.array([[c, s], [-s, c]])
    slot = compass._slot(hull, 2, HALF_MM)
    assert abs(slot.points_mm[1] - slot.points_mm[0]) == pytest.approx(
        [abs(c), abs(s)], abs=1e-6
    )
    assert slot.points_mm.mean(axis=0) == pytest.approx([0.0, 0.0], abs=1e-6)
    assert slot.radius_mm == pytest.approx(0.5, abs=1e-6)
    circle = compass._slot(hull, 1, HALF_MM)
    assert circle.points_mm == pytest.approx(np.zeros((1, 2)), abs=1e-6)
    assert circle.radius_mm == pytest.approx(0.75, abs=1e-6)  # half of the mean of 2 and 1


@pytest.mark.parametrize("radius_mm", [0.3, 0.8])
def test_a_ring_is_told_from_the_same_shape_filled(radius_mm: float) -> None:
    """Filled, the shape leaves its middle unexplained: what is light there is a pen's width less."""
    way = arc((3.0, 3.0), radius_mm)
    core = Core(np.array([(3.0, 3.0)]), radius_mm, HALF_MM)
    ink = ink_of(way)
    within = np.hypot(*(ink.places_mm - 3.0).T) < radius_mm
    missing = np.where(within, 1.0 - ink.darkness, 0.0)
    assert compass.filled_misfit(ink, core) == pytest.approx(
        ink.misfit(ink.darkness + missing), rel=0.02
    )


@pytest.mark.parametrize(
    ("points", "radius_mm"),
    [(CIRCLE[:1], 0.6), (OBLONG[:2], 0.5), (OBLONG, 0.2), (OBLONG, 0.0)],
)
def test_what_each_figure_of_a_core_changes_is_the_slope_of_its_ink(
    points: Array, radius_mm: float
) -> None:
    """Against steps of 10 nm; where two sides are as near, ink has no slope: one place in a hundred."""
    places, size = ink_of(OBLONG).places_mm, points.size
    figures = np.r_[points.ravel(), [radius_mm] if radius_mm else [], HALF_MM]

    def drawn(figures: Array) -> Array:
        out = np.empty(len(places))
        now_mm = float(figures[size]) if radius_mm else 0.0
        core = figures[:size].reshape(-1, 2), now_mm, float(figures[-1])
        core_ink.ink(places, core, 0.06, False, out)
        return out

    slopes, plain = (np.empty((len(places), len(figures))) for _ in range(2))
    core = np.ascontiguousarray(points), radius_mm, HALF_MM
    core_ink.changes(places, core, 0.06, slopes)
    core_ink.changes.py_func(places, core, 0.06, plain)
    assert np.allclose(slopes, plain, atol=1e-9)
    for k, step in enumerate(1e-5 * np.eye(len(figures))):
        off = np.abs((drawn(figures + step) - drawn(figures - step)) / 2e-5 - slopes[:, k])
        assert np.quantile(off, 0.99) < 1e-4 * np.abs(slopes).max()


@pytest.mark.parametrize("way", [CIRCLE, SLOT, TRIANGLE, OBLONG])
def test_a_loop_at_the_far_corner_of_a_sheet_is_laid_in_a_few_steps(
    way: Array, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A figure that was moved by a share of itself was moved by half of what ink fades over there."""
    here, far = ink_of(way, noise=0.04), np.array([210.0, 297.0])
    core, fitted = explained(here), compass.fitted

    def in_few(drawn: Figured, ink: Ink, figures: Array, most: int) -> Array:
        return fitted(drawn, ink, figures, min(most, 30))

    monkeypatch.setattr(compass, "fitted", in_few)
    there = explained(here._replace(places_mm=here.places_mm + far))
    assert core is not None and there is not None
    assert np.abs(there.points_mm - far - core.points_mm).max() < 1e-3 * UM
