"""The ways beside a line: against shapely's buffer, with a scan's noise, about narrow and tiny lines, and how
they are run.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from morfax.motion import arm
from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.motion.feed import run_along
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.offset import DriveCurve, guided, offset
from morfax.motion.polyline import Nearest
from tests.motion.polygons import SQUARE, UM, circle, polygon

shapely = pytest.importorskip("shapely")
EXACT_MM = 0.5 * UM  # places known to 0.05 um, nearer by 0.2 um at most; asked: 1 um


def star(seed: int) -> Array:
    """A polygon about 0,0 with four to ten vertices, corners both ways."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, math.tau, rng.integers(4, 11)))
    radii = rng.uniform(4, 12, len(angles))
    return polygon(*zip(radii * np.cos(angles), radii * np.sin(angles), strict=True))


def test_an_island_near_the_wall_of_a_pocket_is_not_passed_between() -> None:
    wall, island = circle(20), circle(5) + np.array([13, 0])  # 2 mm between them
    guides = [DriveCurve(wall, True, True), DriveCurve(island, True, False)]
    assert len(offset(guides, 0.9)) == 2
    (way,) = offset(guides, 1.5)
    edges = shapely.MultiLineString([wall, island])
    assert shapely.distance(shapely.points(way.points_mm), edges).min() > 1.5 - EXACT_MM


@settings(max_examples=40)
@given(seed=st.integers(0, 10_000), radius_mm=st.floats(0.2, 4), left=st.booleans())
def test_the_ways_are_the_edges_of_the_buffer(seed: int, radius_mm: float, left: bool) -> None:
    line = star(seed)
    part = shapely.Polygon(line)
    assume(part.is_valid)
    ways = offset([DriveCurve(line, True, left)], radius_mm)
    buffer = part.buffer(
        -radius_mm if left == part.exterior.is_ccw else radius_mm, quad_segs=500
    )
    rings = [
        ring
        for each in getattr(buffer, "geoms", [buffer])
        for ring in (each.exterior, *each.interiors)
    ]
    edges = [np.array(ring.coords) for ring in rings if ring.length > 0.2]
    ours = [way.points_mm for way in ways if shapely.LineString(way.points_mm).length > 0.2]
    assert len(ours) == len(edges) and all(way.closed for way in ways)
    if ours:
        assert (
            distance(ours, edges).hausdorff_mm < 5 * UM
        )  # shapely's own arcs are 4 mm * (1 - cos(90°/1000))
        near = shapely.distance(shapely.points(np.vstack(ours)), shapely.LineString(line))
        assert near.min() > radius_mm - EXACT_MM


@settings(max_examples=5)
@given(seed=st.integers(0, 10_000), radius_mm=st.floats(1, 9.9))
def test_the_noise_of_a_scan_makes_no_gouge_and_no_gap(seed: int, radius_mm: float) -> None:
    line = circle(10, noise_mm=0.5 * UM, seed=seed)
    (way, *others) = offset([DriveCurve(line, True, True)], radius_mm)
    assert way.closed and not others
    near = shapely.distance(shapely.points(way.points_mm), shapely.LineString(line))
    assert near.min() > radius_mm - EXACT_MM and near.max() < radius_mm + EXACT_MM


@pytest.mark.parametrize("left", [True, False])
def test_a_line_that_comes_back_along_itself_is_gone_round_its_tip(left: bool) -> None:
    spike = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 0.0]])
    (way,) = offset([DriveCurve(spike, False, left)], 2.0)
    near = shapely.distance(shapely.points(way.points_mm), shapely.LineString(spike))
    assert abs(near - 2.0).max() < EXACT_MM
    length_mm = np.hypot(*np.diff(way.points_mm, axis=0).T).sum()
    assert length_mm == pytest.approx(20 + 2 * math.pi, abs=EXACT_MM)
    assert way.points_mm[:, 0].max() == pytest.approx(12.0, abs=EXACT_MM)


def test_the_line_may_be_run_either_way_and_the_cutter_goes_with_it() -> None:
    there, back = (
        offset([DriveCurve(SQUARE, True, True)], 3)[0],
        offset([DriveCurve(SQUARE[::-1], True, False)], 3)[0],
    )
    assert distance(there.points_mm, back.points_mm).hausdorff_mm < 0.1 * UM
    areas = [
        np.sum(
            w.points_mm[:-1, 0] * w.points_mm[1:, 1] - w.points_mm[1:, 0] * w.points_mm[:-1, 1]
        )
        for w in (there, back)
    ]
    assert areas[0] > 0 > areas[1]


def test_at_a_corner_of_20_degrees_the_tool_stops() -> None:
    turned = math.radians(20)
    corner = np.array(
        [[0.0, 0.0], [5.0, 0.0], [5 + 5 * math.cos(turned), 5 * math.sin(turned)]]
    )
    xy_mm = run_along(corner, 10.0, 500.0)
    speed = np.hypot(*np.diff(xy_mm, axis=0).T) * MOTION_RATE_HZ
    middle = np.hypot(*(xy_mm[1:] - corner[1]).T) < 1.0
    assert speed[middle].min() < 0.3  # from 10: what the mean over 2 ms leaves of a stop


@pytest.mark.parametrize("feed_mm_s", [10.0, 90.0])
@pytest.mark.parametrize(("left", "radius_mm"), [(False, 1.5), (True, 3.0)])
def test_a_way_is_run_at_its_feed_and_within_its_acceleration(
    feed_mm_s: float, left: bool, radius_mm: float
) -> None:
    (way,) = offset([DriveCurve(star(3), True, left)], radius_mm)
    xy_mm = run_along(way.points_mm, feed_mm_s, 500)
    velocity = np.diff(xy_mm, axis=0) * MOTION_RATE_HZ
    speed = np.hypot(*velocity.T)
    assert speed.max() < feed_mm_s * (1 + 1e-6)
    assert speed.max() > (0.99 * feed_mm_s if feed_mm_s < 20 else 35)
    assert (
        np.hypot(*np.diff(velocity, axis=0).T).max() * MOTION_RATE_HZ < 1.05 * 500
    )  # along and across together
    assert xy_mm[0] == pytest.approx(way.points_mm[0]) and xy_mm[-1] == pytest.approx(
        way.points_mm[-1]
    )
    assert distance(xy_mm, way.points_mm).hausdorff_mm < 0.3 * UM


def test_an_open_line_has_a_way_on_either_side() -> None:
    line = np.array([[0.0, 0], [10, 0], [10, 10]])
    (left,), (right,) = (offset([DriveCurve(line, False, side)], 2) for side in (True, False))
    assert (
        not left.closed
        and distance(left.points_mm, np.array([[0.0, 2], [8, 2], [8, 10]])).hausdorff_mm
        < 0.1 * UM
    )
    length_mm = np.hypot(*np.diff(right.points_mm, axis=0).T).sum()
    assert length_mm == pytest.approx(20 + math.pi, abs=2 * UM)


# a head that comes to a contour and back to it: 2 mm with a kink of some um, in units of 0.1 um
KINK = (
    "0,0 588,-114 1322,-257 4357,-855 5058,-992 5744,-1124 5924,-1159 6151,-1208 6281,-1237 6395,-1264 "
    "6508,-1291 6653,-1328 6894,-1393 7150,-1465 7421,-1546 7675,-1625 7976,-1722 8229,-1806 8544,-1913 "
    "9707,-2317 10026,-2400 10377,-2493 10730,-2587 11068,-2679 11356,-2758 11693,-2852 12182,-2990 "
    "12468,-3072 12723,-3146 12963,-3217 13249,-3304 13568,-3401 14299,-3627 15077,-3871 15679,-4063 "
    "16186,-4227 16738,-4411 17290,-4598 17762,-4761 18217,-4922 18686,-5092 19233,-5294 "
)


def test_a_kink_of_some_um_does_not_part_the_way() -> None:
    line = np.array([place.split(",") for place in KINK.split()], float) * 0.1 * UM
    (way,) = offset(
        [DriveCurve(line, False, True)], 5.0
    )  # in two pieces, when a curl within the tolerance led back
    assert (
        distance(way.points_mm, np.array([way.points_mm[0], way.points_mm[-1]])).hausdorff_mm
        < 0.2
    )
    assert np.abs(Nearest([line], 5.0).distances_mm(way.points_mm) - 5.0).max() < 1 * UM


@pytest.mark.parametrize("radius_mm", [0.5, 2.0, 3.0, 8.0])
def test_a_kink_among_short_steps_is_no_end_of_the_way(radius_mm: float) -> None:
    """Six degrees towards the tool, and 0.03 mm of line beside them: the ways beside the vertex do not meet
    where it would have them.
    """
    half = np.r_[
        np.full(620, 186.3 / 620), -6.3
    ]  # degrees that each step turns; twice that closes
    heading = np.radians(np.cumsum(np.r_[half, half]))
    line = np.cumsum(0.03 * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0)
    ways = offset([DriveCurve(np.vstack([line, line[:1]]), True, False)], radius_mm)
    assert [way.closed for way in ways] == [True]
    true = shapely.Polygon(line).buffer(radius_mm, quad_segs=512).exterior
    assert max(true.distance(shapely.Point(point)) for point in ways[0].points_mm) < 2 * UM
    assert np.hypot(*np.diff(ways[0].points_mm, axis=0).T).sum() == pytest.approx(
        true.length, rel=1e-3
    )


def scanned(line: Array, seed: int) -> Array:
    """A closed line as a head would run it, with waves of 0.3 to 3 mm as a scan's noise makes them."""
    rng, along = (
        np.random.default_rng(seed),
        np.r_[0, np.cumsum(np.hypot(*np.diff(line, axis=0).T))],
    )
    at = np.linspace(0, along[-1], round(along[-1] / 0.005), endpoint=False)
    points = np.column_stack([np.interp(at, along, column) for column in line.T])
    for column in points.T:
        for waves in rng.integers(along[-1] / 3, along[-1] / 0.3, 12):
            column += (
                0.3
                * UM
                * rng.normal()
                * np.cos(math.tau * waves * at / along[-1] + rng.uniform(0, math.tau))
            )
    return np.vstack([points, points[:1]])


@pytest.mark.parametrize(("seed", "radius_mm"), [(1, 20.0), (2, 50.0), (3, 150.0), (5, 80.0)])
def test_round_a_part_much_smaller_than_the_tool_goes_one_way(
    seed: int, radius_mm: float
) -> None:
    line = scanned(star(seed), seed)
    ways = offset(
        [DriveCurve(line, True, not shapely.Polygon(line).exterior.is_ccw)], radius_mm
    )
    assert [way.closed for way in ways] == [
        True
    ]  # of noise alone up to 27 pieces, when arms swung back through each vertex
    off_mm = (
        shapely.distance(shapely.points(ways[0].points_mm), shapely.LineString(line))
        - radius_mm
    )
    assert np.abs(off_mm).max() < EXACT_MM
    true = shapely.Polygon(line).buffer(radius_mm, quad_segs=8000).exterior
    assert np.hypot(*np.diff(ways[0].points_mm, axis=0).T).sum() == pytest.approx(
        true.length, rel=1e-3
    )


def test_in_a_hole_much_narrower_than_the_tool_the_arm_swings_no_further_than_round() -> None:
    """It took minutes: 300 m, back through a thousand vertices."""
    guide, radius_mm = DriveCurve(circle(5, 0.5 * UM), True, True), 150.0
    swung = arm.swung(guided(guide, radius_mm), True, radius_mm)
    assert np.hypot(*np.diff(swung, axis=0).T).sum() < 2 * math.tau * radius_mm
    assert offset([guide], radius_mm) == []
