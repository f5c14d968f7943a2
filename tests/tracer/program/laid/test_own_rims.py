"""Closed lines that touch, each within its own rim."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.motion.crossings import crossings_of
from morfax.motion.polyline import evenly, nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.program.laid.own_rims import within_own_rims
from morfax.tracer.program.laid.rim_way import kinks_of
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import found_lines, trace_lines
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.program.laid.ways import run_along

WIDTH_MM = 0.45


def off_mm(line: Line, truth: Points) -> float:
    """How far a closed line is from the truth, or that from it, at most, mm."""
    way, true = with_places(line.loop_mm, 0.02), with_places(np.asarray(truth), 0.02)
    return max(nearest_mm(way, true).max(), nearest_mm(true, way).max())


def triangle_about(radius_mm: float, apart_mm: float) -> Points:
    """A triangle whose sides are so far from a circle about (10, 10)."""
    normals = [math.radians(a) for a in (5, 130, 250)]
    sides = np.array([[math.cos(a), math.sin(a)] for a in normals])
    reach = np.full(2, radius_mm + apart_mm)
    corners = [np.linalg.solve(sides[[k, (k + 1) % 3]], reach) for k in range(3)]
    return polyline(
        *[(10 + x, 10 + y) for x, y in corners], (10 + corners[0][0], 10 + corners[0][1])
    )


@pytest.mark.parametrize("apart_mm", [0.0, 0.2])
def test_a_circle_and_the_triangle_whose_sides_it_touches_are_both_traced(
    apart_mm: float,
) -> None:
    """Each within 60 um, and nothing is told: the circle was missing, and the triangle 150 um off."""
    circle = arc((10, 10), 3.0, 0, 360)
    triangle = triangle_about(3.0, apart_mm)
    trace = trace_lines(inked(triangle, circle, width_mm=WIDTH_MM, seed=1), "contours")
    outer, inner = sorted(trace.lines, key=lambda line: -line.length_mm)
    assert (outer.ending, inner.ending) == ("closed", "closed")
    assert off_mm(outer, triangle) < 60 * UM
    assert off_mm(inner, circle) < 60 * UM
    assert not trace.unexplained


def lines_of(*drawn: Points, seed: int = 1) -> list[Line]:
    """The contours of a scan of some lines."""
    return list(trace_lines(inked(*drawn, width_mm=WIDTH_MM, seed=seed), "contours").lines)


def test_a_bar_across_an_outline_makes_no_rooms_of_it() -> None:
    """Ways round both rooms explain all the ink, too, but turn sharply on each other where the bar ends."""
    outline = polyline((5, 5), (25, 5), (25, 17), (5, 17), (5, 5))
    (line, *others) = lines_of(outline, polyline((13, 5), (13, 17)))
    assert off_mm(line, outline) < 60 * UM
    assert not [other for other in others if other.ending == "closed"]


def test_circles_that_cross_are_not_the_way_round_both_and_that_between() -> None:
    """Those turn sharply where the circles cross."""
    circles = [arc((10, 10), 5.0), arc((16, 10), 4.0)]
    lines = lines_of(*circles)
    assert len(lines) == 2
    for circle in circles:
        assert min(off_mm(line, circle) for line in lines) < 60 * UM


def test_plates_beside_each_other_are_each_one_line() -> None:
    """Half a line apart, the shorter with rounded corners: both within 60 um."""
    apart_mm, r = 0.5 * WIDTH_MM, 1.5
    first = polyline((5, 5), (17, 5), (17, 19), (5, 19), (5, 5))
    x, y = 17 + apart_mm, 8.0
    second = np.vstack(
        [
            arc((x + r, y + r), r, 180, 270),
            arc((x + 9 - r, y + r), r, 270, 360),
            arc((x + 9 - r, y + 7 - r), r, 0, 90),
            arc((x + r, y + 7 - r), r, 90, 180),
            [(x, y + r)],
        ]
    )
    lines = lines_of(first, second)
    assert [line.ending for line in lines] == ["closed", "closed"]
    for plate in (first, second):
        assert min(off_mm(line, plate) for line in lines) < 60 * UM


def test_a_right_line_is_kept_to_the_byte() -> None:
    """A ring whose hole a chain of touches does not reach is run as the head ran along it."""
    circles = [arc((8, 10), 3.0), arc((14.2, 10), 3.0)]
    drawing = inked(*circles, width_mm=WIDTH_MM, seed=1)
    setup = Setup(drawing.sheet)
    found = found_lines(setup, "contours").lines
    assert len(found) == 2
    kept = within_own_rims(setup, setup.sheet.patch_at(found[0].xy_mm[0]), found)
    assert [one is other for one, other in zip(kept, found, strict=True)] == [True, True]


def test_lines_that_leave_ink_go_and_a_way_within_the_rim_comes() -> None:
    """Given but one of two circles that touch, both are told, and the longer comes first."""
    circles = [arc((8, 10), 3.0), arc((15.2, 10), 4.0)]
    setup = Setup(inked(*circles, width_mm=WIDTH_MM, seed=1).sheet)
    one = max(found_lines(setup, "contours").lines, key=lambda line: -line.length_mm)
    lines = within_own_rims(setup, setup.sheet.patch_at(one.xy_mm[0]), [one])
    assert len(lines) == 2
    assert off_mm(lines[0], circles[1]) < 60 * UM
    assert off_mm(lines[1], circles[0]) < 60 * UM


def test_kinks_are_where_a_way_turns_more_than_about_them() -> None:
    """A square's corners, and no place of a circle."""
    square = polyline((0, 0), (4, 0), (4, 4), (0, 4), (0, 0))
    even = evenly(square, 0.05)
    kinks = kinks_of(even)
    corners = np.array([(0, 0), (4, 0), (4, 4), (0, 4)], float)
    assert nearest_mm(corners, even[kinks]).max() < 0.1
    assert nearest_mm(even[kinks], corners).max() < 1.0
    assert not len(kinks_of(evenly(arc((0, 0), 2.0), 0.05)))


def crescent(x: float, y: float, radius_mm: float, from_deg: float) -> Points:
    """A crescent about a place whose horns are 30 degrees sharp, the lower one so far up from the right."""
    outer = arc((0, 0), radius_mm, from_deg, 360 - from_deg)
    horn, heading = outer[0], math.radians(from_deg + 90 + 30)
    inner_mm = horn[1] / math.sin(heading + math.pi / 2)
    middle = horn[0] + abs(inner_mm) * math.cos(heading + math.pi / 2)
    to_deg = math.degrees(math.atan2(horn[1], horn[0] - middle)) % 360
    inner = arc((middle, 0), abs(inner_mm), 360 - to_deg, to_deg)
    return np.vstack([outer, inner, outer[:1]]) + np.array([x, y])


@pytest.mark.parametrize(("apart", "seed"), [(0.3, 4), (0.6, 1), (0.6, 3)])
def test_a_horn_that_touches_a_ring_is_no_way_into_it(apart: float, seed: int) -> None:
    """Given the way from a leg of the horn round the ring to its other leg, both are told, not that."""
    moon = crescent(10, 10, 5.0, 40.0)
    heading = math.radians(40 + 90 + 180 + 15)  # of the upper horn, between its two sides
    ahead = np.array([math.cos(heading), math.sin(heading)])
    x, y = moon[0] + (apart * WIDTH_MM + 2.0) * ahead
    back = math.degrees(heading) + 180
    ring = arc((float(x), float(y)), 2.0, back, back + 360)
    into = arc((float(x), float(y)), 2.0, back + 3, back + 357)
    ways = [np.vstack([moon[4:-4], each, moon[4:5]]) for each in (into, into[::-1])]
    way = max(ways, key=lambda each: len(crossings_of(each, np.arange(len(each) - 1))))
    setup = Setup(inked(moon, ring, width_mm=WIDTH_MM, seed=seed).sheet)
    lines = within_own_rims(setup, setup.sheet.patch_at(moon[0]), [run_along(way)])
    assert len(lines) == 2
    for each in (moon, ring):
        assert min(off_mm(line, each) for line in lines) < 60 * UM


@pytest.mark.parametrize("seed", [1, 2])
def test_an_inner_corner_that_touches_a_circle_is_no_way_into_it(seed: int) -> None:
    """A star's: with the circle it became one closed line that left some ink, and nothing was told."""
    angles = np.arange(11) * math.pi / 5 + math.pi / 2
    reach = np.where(np.arange(11) % 2, 4.0, 8.0)
    star = 12 + np.column_stack([reach * np.cos(angles), reach * np.sin(angles)])
    middle = star[1] - (star[1] - 12) / 4.0 * 1.95
    circle = arc((float(middle[0]), float(middle[1])), 1.8, 0, 360)
    trace = trace_lines(inked(star, circle, width_mm=0.5, seed=seed), "contours")
    assert [line.ending for line in trace.lines] == ["closed", "closed"]
    for each in (star, circle):
        assert min(off_mm(line, each) for line in trace.lines) < 60 * UM


def beam(left_mm: float, low_mm: float = 5) -> Points:
    """The outline of a beam of 12 mm whose flanges are 8 mm long and 1 mm high, from a place up."""
    half = [(-4, 0), (4, 0), (4, 1), (1.5, 2), (1.5, 10), (4, 11), (4, 12), (-4, 12)]
    half += [(-4, 11), (-1.5, 10), (-1.5, 2), (-4, 1), (-4, 0)]
    return np.array(half, float) + np.array([left_mm + 4, low_mm])


@pytest.mark.parametrize(("apart", "seed"), [(0.4, 1), (0.4, 2), (0.6, 1), (0.6, 3)])
def test_flanges_whose_ends_run_together_are_two_beams(apart: float, seed: int) -> None:
    """Two letters whose serifs touch: each within 60 um; the way round both crosses between the ends."""
    beams = [beam(5), beam(13 + apart * WIDTH_MM)]
    trace = trace_lines(inked(*beams, width_mm=WIDTH_MM, seed=seed), "contours")
    assert [line.ending for line in trace.lines] == ["closed", "closed"]
    for each in beams:
        assert min(off_mm(line, each) for line in trace.lines) < 60 * UM
    assert not trace.unexplained


@pytest.mark.parametrize("seed", [1, 2])
def test_a_bar_as_broad_as_two_lines_between_two_beams_is_a_side_of_each(seed: int) -> None:
    """One flange of each: the way round both left the bar's ink, and nothing was told."""
    beams = [beam(5, 16), beam(13 + 0.4 * WIDTH_MM, 5)]
    trace = trace_lines(inked(*beams, width_mm=WIDTH_MM, seed=seed), "contours")
    assert [line.ending for line in trace.lines] == ["closed", "closed"]
    for each in beams:
        assert min(off_mm(line, each) for line in trace.lines) < 60 * UM


def test_a_way_round_two_beams_that_leaves_the_bar_between_them_goes() -> None:
    """It turns less than both do, by four corners; but half a box and more of ink is no cut corner."""
    beams = [beam(5, 16), beam(13 + 0.4 * WIDTH_MM, 5)]
    bar = shapely.box(13, 16, 13 + 0.4 * WIDTH_MM, 17)
    both = shapely.unary_union([*map(shapely.Polygon, beams), bar])
    setup = Setup(inked(*beams, width_mm=WIDTH_MM, seed=1).sheet)
    line = run_along(np.array(both.exterior.coords))
    lines = within_own_rims(setup, setup.sheet.patch_at(line.xy_mm[0]), [line])
    assert len(lines) == 2
    for each in beams:
        assert min(off_mm(line, each) for line in lines) < 60 * UM


@pytest.mark.parametrize("seed", [1, 2])
def test_plates_whose_corners_just_meet_are_both_traced(seed: int) -> None:
    """The first as the head ran along it, the other within its rim: it was left out, and nothing was told."""
    x = 15 + 1.05 * WIDTH_MM
    first = polyline((5, 5), (15, 6), (11, 20), (5, 20), (5, 5))
    second = polyline((x, 6), (25, 5), (25, 20), (19, 20), (x, 6))
    lines = lines_of(first, second, seed=seed)
    assert [line.ending for line in lines] == ["closed", "closed"]
    for each in (first, second):
        assert min(off_mm(line, each) for line in lines) < 60 * UM
