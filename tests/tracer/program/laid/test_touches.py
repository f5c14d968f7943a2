"""Where outlines touch, or one nearly touches itself, each side keeps to its own rim."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import length_mm, lengths_mm
from morfax.motion.usual import THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.laid import touches
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.smooth_ways import BothWays
from morfax.tracer.program.laid.turned_back import Touch
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.laid.ways import STEP_MM, run_along, steps_mm

WIDTH_MM = 0.5
UM = 1e-3
LEVEL = math.radians(7)


def circle(x: float, y: float, radius_mm: float) -> Points:
    """A circle."""
    angles = np.linspace(0, math.tau, 361)
    return np.column_stack([x + radius_mm * np.cos(angles), y + radius_mm * np.sin(angles)])


def turned(points: Points) -> Points:
    """Points turned by a few degrees about (20, 15): no line runs along the pixels."""
    c, s = math.cos(LEVEL), math.sin(LEVEL)
    return (points - [20, 15]) @ np.array([[c, s], [-s, c]]) + [20, 15]


def plate() -> Points:
    """A plate of 28 x 20 mm."""
    return polyline((6, 5), (34, 5), (34, 25), (6, 25), (6, 5))


def peanut(apart_mm: float) -> Points:
    """A figure of two lobes whose sides come so near to each other."""
    lobes = (
        shapely.Point(12, 15)
        .buffer(7, quad_segs=90)
        .union(shapely.Point(28, 15).buffer(7, quad_segs=90))
    )
    whole = lobes.union(shapely.box(12, 12, 28, 18)).difference(
        shapely.Point(20, 15 + 8 + apart_mm / 2).buffer(8, quad_segs=90)
    )
    whole = whole.difference(shapely.Point(20, 15 - 8 - apart_mm / 2).buffer(8, quad_segs=90))
    return polyline(*((float(x), float(y)) for x, y in whole.exterior.coords))


def closed(*drawn: Points, width_mm: float = WIDTH_MM, dpi: float = 300) -> list[Line]:
    """The closed contours of a sheet, the longest first."""
    trace = trace_lines(inked(*drawn, width_mm=width_mm, dpi=dpi, seed=1))
    lines = [line for line in trace.lines if line.ending == "closed"]
    return sorted(lines, key=lambda line: -line.length_mm)


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


@pytest.mark.parametrize("apart_widths", [0.05, 0.4, 0.75, 0.95])
def test_a_hole_that_touches_the_outline_from_within_keeps_to_its_rim(
    apart_widths: float,
) -> None:
    """Within 80 um, a pixel of 300 dpi; where the head goes over to the other it is 0.15 mm off or more."""
    radius_mm = 7.0
    drawn = [plate(), circle(19, 5 + radius_mm + apart_widths * WIDTH_MM, radius_mm)]
    truths = [turned(each) for each in drawn]
    lines = closed(*truths)
    assert len(lines) == 2
    for line, truth in zip(lines, truths, strict=True):
        assert off_mm(line, truth) < 80 * UM


def test_an_outline_that_comes_near_to_itself_does_not_go_over_to_its_other_side() -> None:
    """Within 60 um, half a pixel of 200 dpi; a figure of eight is 0.2 mm off."""
    truth = turned(peanut(0.42))
    (line,) = closed(truth, width_mm=0.35, dpi=200)
    assert off_mm(line, truth) < 60 * UM


def test_circles_that_cross_at_a_small_angle_still_cross(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two circles of 8 mm whose middles are 1.4 mm apart: they cross at 10 degrees. The head's ways explain
    their ink, and no rims are felt.
    """
    monkeypatch.setattr(touches, "_rims", None)
    truths = [turned(circle(19, 15, 8)), turned(circle(20.4, 15, 8))]
    lines = closed(*truths)
    assert len(lines) == 2
    first, second = (shapely.LinearRing(line.loop_mm) for line in lines)
    crossings = first.intersection(second)
    assert isinstance(crossings, shapely.MultiPoint) and len(crossings.geoms) == 2


def test_circles_of_which_one_just_leaves_the_other_are_as_round_as_drawn() -> None:
    """They cross at 5.4 degrees: within 30 um. Within their rims, or as the head ran, they are 66 um off."""
    apart_mm = math.sqrt(9**2 + 6**2 - 2 * 9 * 6 * math.cos(math.radians(5.4)))
    truths = [turned(circle(19, 15, 9)), turned(circle(19 + apart_mm, 15, 6))]
    lines = closed(*truths)
    assert len(lines) == 2
    for line, truth in zip(lines, truths, strict=True):
        assert off_mm(line, truth) < 30 * UM


def test_a_figure_of_eight_along_two_circles_that_touch_is_two_lines() -> None:
    """Its way explains the ink as well, but goes on from leg to leg less smoothly than theirs."""
    apart_mm = 7 + 8 + 0.1 * WIDTH_MM
    drawn = [arc((12, 15), 7), arc((12 + apart_mm, 15), 8, 180, -180)]
    found = touches.touching(Setup(inked(*drawn, seed=1).sheet), [run_along(np.vstack(drawn))])
    assert [line.ending for line in found] == ["closed", "closed"]
    for line in found:
        assert min(off_mm(line, truth) for truth in drawn) < 20 * UM


def test_a_figure_of_eight_that_was_drawn_is_one_line() -> None:
    """Straight on where it crosses itself at 12 degrees."""
    lean = 6.0
    far_mm = 10 / math.cos(math.radians(lean))
    radius_mm = 10 * math.tan(math.radians(lean))
    right = arc((20 + far_mm, 15), radius_mm, -90 - lean, 90 + lean)
    left = arc((20 - far_mm, 15), radius_mm, 270 + lean, 90 - lean)
    drawn = np.vstack([right, left, right[:1]])
    found = touches.touching(Setup(inked(drawn, seed=1).sheet), [run_along(drawn)])
    assert len(found) == 1 and off_mm(found[0], drawn) < 20 * UM


def from_place(outline: shapely.Polygon, first: tuple[float, float]) -> Points:
    """An outline, counter-clockwise, from the place nearest to another round to that."""
    ring = shapely.geometry.polygon.orient(outline).exterior
    places = np.array(ring.segmentize(0.1).coords)[:-1]
    at = int(np.argmin(np.hypot(*(places - first).T)))
    return np.vstack([places[at:], places[: at + 1]])


def test_a_line_that_steps_over_within_the_ink_of_two_is_two() -> None:
    """Plates whose sides run together 0.7 widths apart, run as a figure of eight that steps from side to
    side: it leaves 0.0045 of a square for each width, which explained their ink; their rims leave 0.002.
    """
    other_mm = 20 + 0.7 * WIDTH_MM
    left = from_place(shapely.box(8, 8, 18, 22).buffer(2, quad_segs=60), (20, 14))
    right = from_place(
        shapely.box(other_mm + 2, 10, 32, 18).buffer(2, quad_segs=60), (other_mm, 14)
    )
    truths = [turned(left), turned(right)]
    # a step of 1 mm
    over = [way[np.hypot(*(way - way[0]).T) >= 0.5] for way in (left, right[::-1])]
    found = touches.touching(
        Setup(inked(*truths, seed=1).sheet), [run_along(turned(np.vstack(over)))]
    )
    assert [line.ending for line in found] == ["closed", "closed"]
    for line in found:
        assert min(off_mm(line, truth) for truth in truths) < 30 * UM


def test_of_one_line_that_crosses_itself_steeply_in_its_ink_the_rims_are_felt(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In the mouth of a keyhole its sides may be run across each other at 88 degrees; of two lines that cross
    by more than 60 degrees none goes over to the other.
    """
    asked = list[bool | None]()
    monkeypatch.setattr(touches, "_rims", lambda *told: asked.append(told[-1]))
    high = math.degrees(math.asin(0.3 / 5))
    left, right = arc((10, 15), 5, high, 360 - high), arc((30, 15), 5, 180 + high, 540 - high)
    there, back = polyline((19.8, 14.7), (20.2, 15.3)), polyline((20.2, 14.7), (19.8, 15.3))
    line = run_along(np.vstack([left, there, right[::-1], back, left[:1]]))
    truth = np.vstack([left, right, left[:1]])
    touches.touching(Setup(inked(truth, seed=1).sheet), [line])
    assert asked and set(asked) == {True}


def test_a_hole_that_touches_three_sides_is_a_line_though_half_of_its_way_is_theirs() -> None:
    """A circle of 2.5 mm in a triangle of which each side comes to it; it was missing, and told."""
    angles = np.radians([97, 217, 337, 97])
    triangle = (20, 15) + 5.1 * np.column_stack([np.cos(angles), np.sin(angles)])
    hole = circle(20, 15, 2.5)
    lines = closed(triangle, hole)
    assert len(lines) == 2
    for line, truth in zip(lines, (triangle, hole), strict=True):
        assert off_mm(line, truth) < 60 * UM


def test_a_circle_that_leaves_a_side_and_comes_back_is_a_line_of_its_own() -> None:
    """It crosses the side at 8 degrees, twice. The way round goes out along the circle and back along the
    side, as the junctions show it; between the tips runs no line.
    """
    angle = math.radians(8)
    middle = 19.0, 25 + 6 * math.cos(angle)
    truths = [plate(), arc(middle, 6)]
    parted = math.acos(math.cos(angle) - 0.3 * WIDTH_MM / 6)
    far_mm, parted_deg = 6 * math.sin(parted), math.degrees(parted)
    above = arc(middle, 6, parted_deg - 90, 270 - parted_deg)
    right, left = (19 + far_mm, 25.0), (19 - far_mm, 25.0)
    corners = np.array([(6, 5), (34, 5), (34, 25), right, *above, left, (6, 25), (6, 5)])
    found = touches.touching(Setup(inked(*truths, seed=1).sheet), [run_along(corners)])
    assert [line.ending for line in found] == ["closed", "closed"]
    for line in found:
        assert min(off_mm(line, truth) for truth in truths) < 30 * UM


def beside(apart_mm: float, long_mm: float, other_way: bool = False) -> list[Line]:
    """Two closed lines that run beside each other for so long, so far apart; then away at right angles."""
    end, above = 5 + long_mm, 20 + apart_mm
    low = polyline((5, 20), (end, 20), (end, 6), (5, 6), (5, 20))
    high = polyline((5, above), (5, 35), (end, 35), (end, above), (5, above))
    return [run_along(low), run_along(high[::-1] if other_way else high)]


def touches_of(lines: list[Line]) -> list[Touch]:
    """Where lines touch."""
    return list(touches._touches(lines, range(len(lines))))


@pytest.mark.parametrize(
    ("apart_mm", "long_mm", "touch"),
    [(0.6, 10, True), (0.7, 10, False), (0.6, 2, False), (0.6, 28, True), (0.6, 32, False)],
)
def test_lines_touch_that_run_together_for_some_widths(
    apart_mm: float, long_mm: float, touch: bool
) -> None:
    """Nearer than 1.3 widths of 0.5 mm, where they leave one ink, for 5 to 60 widths."""
    assert bool(touches_of(beside(apart_mm, long_mm))) == touch


@pytest.mark.parametrize("other_way", [False, True])
def test_a_touch_is_told_with_legs_of_two_widths_on_either_line(other_way: bool) -> None:
    """The one line begins with it, so that its leg is before the beginning; it runs 10 mm along it."""
    (touch,) = touches_of(beside(0.6, 10.0, other_way))
    assert touch.lines == (0, 1)
    for first_mm, last_mm in zip(touch.first_mm, touch.last_mm, strict=True):
        assert last_mm - first_mm == pytest.approx(10.0 + 2 * 2 * WIDTH_MM, abs=0.6)
    assert touch.first_mm[0] == pytest.approx(-2 * WIDTH_MM, abs=0.3)
    assert touch.is_parallel == other_way


@pytest.mark.parametrize(("apart_mm", "is_one"), [(0.5, True), (0.8, False)])
def test_a_line_that_runs_beside_itself_touches_itself_once(
    apart_mm: float, is_one: bool
) -> None:
    """A slot in from the right that goes on as a slit of 9 mm, 18 widths."""
    bar = shapely.box(11, 15, 20, 15 + apart_mm)
    plate = shapely.box(5, 5, 30, 25).difference(bar).difference(shapely.box(20, 13, 32, 18))
    found = touches_of([run_along(np.array(plate.exterior.coords))])
    assert len(found) == is_one


def test_how_steeply_ways_cross_is_their_steepest_crossing() -> None:
    """0 of ways that do not cross."""
    x = np.linspace(0, 20, 401)
    level = np.column_stack([x, 0 * x])
    for degrees in (3.0, 10.0, 30.0):
        slope = math.tan(math.radians(degrees))
        other = np.column_stack([x, slope * (x - 10.02)])
        for ways in (touches._Ways(level, other), touches._Ways(other, level)):
            assert math.degrees(touches._steepest_rad(ways)) == pytest.approx(degrees, abs=0.1)
    assert touches._steepest_rad(touches._Ways(level, level + np.array((0, 0.3)))) == 0


def along_mm(line: Line, place: tuple[float, float], nth: int = 0) -> float:
    """How far along a line it comes by a place, mm, the first time or a later one."""
    away = np.hypot(*(line.loop_mm - place).T)
    near = np.flatnonzero(away < 2 * STEP_MM * THINNED)
    times = np.split(near, np.flatnonzero(np.diff(near) > 1) + 1)
    at = times[nth][np.argmin(away[times[nth]])]
    return float(lengths_mm(line.loop_mm)[at])


def side(*places: tuple[float, float]) -> LaidWay:
    """A way within a rim."""
    return LaidWay((polyline(*places),), 0.5 * WIDTH_MM)


def assert_run(line: Line, truth: Points, side_mm: float) -> None:
    """A line lies on a true one within 20 um, and only its sides are run from memory.

    A part of a line ends at one of its thinned places, so a step there is up to 50 um long.
    """
    assert off_mm(line, truth) < 20 * UM
    assert line.length_mm == pytest.approx(length_mm(truth), rel=2e-3)
    assert steps_mm(line).max() < THINNED * STEP_MM
    assert line.led.lengths_mm(line.xy_mm)[REDRAWN] == pytest.approx(side_mm, rel=0.03)


def test_a_line_that_went_over_to_its_other_side_is_run_round_one_lobe_the_other_way() -> None:
    """Two rounds with a bar of 0.6 mm between them, as a figure of eight: its sides are straight again."""
    high = math.asin(0.3 / 5)
    left = arc((10, 15), 5, math.degrees(high), 360 - math.degrees(high))
    right = arc((30, 15), 5, 180 + math.degrees(high), 540 - math.degrees(high))
    truth = np.vstack([left, right, left[:1]])
    over = polyline((19.5, 14.7), (20.5, 15.3))
    line = run_along(
        np.vstack([left, over, right[::-1], [[20.5, 14.7], [19.5, 15.3]], left[:1]])
    )
    ends = [along_mm(line, place) for place in ((18, 14.7), (22, 15.3), (22, 14.7), (18, 15.3))]
    touch = Touch((0, 0), (ends[0], ends[2]), (ends[1], ends[3]), False)
    rims = BothWays(side((18, 14.7), (22, 14.7)), side((18, 15.3), (22, 15.3)), True, 0.0)
    (found,) = touches._exchanged(Setup(inked(truth).sheet), line, touch, rims)
    assert_run(found, truth, 8.0)


def test_a_line_that_went_over_to_the_one_beside_it_and_back_is_two_lines() -> None:
    """A round of 8 mm and one of 7.6 mm within it, run as one line of two turns."""
    angles = np.linspace(0.5, 0.5 + 2 * math.tau, 1441)
    radius_mm = np.interp(angles, [6.18, 6.38, 12.47, 12.67], [8.0, 7.6, 7.6, 8.0])
    line = run_along(
        np.column_stack([20 + radius_mm * np.cos(angles), 15 + radius_mm * np.sin(angles)])
    )
    rounds = [circle(20, 15, each) for each in (8.0, 7.6)]
    sides = [arc((20, 15), each, -20, 20) for each in (8.0, 7.6)]
    outer, inner = ([tuple(way[0]), tuple(way[-1])] for way in sides)
    firsts = along_mm(line, outer[0]), along_mm(line, inner[0])
    lasts = along_mm(line, inner[1]), along_mm(line, outer[1])
    touch = Touch((0, 0), firsts, lasts, True)
    rims = BothWays(*(LaidWay((way,), 0.5 * WIDTH_MM) for way in sides), True, 0.0)
    found = touches._exchanged(Setup(inked(*rounds).sheet), line, touch, rims)
    assert len(found) == 2
    for each, truth in zip(sorted(found, key=lambda one: -one.length_mm), rounds, strict=True):
        assert_run(each, truth, length_mm(truth) * 40 / 360)


@pytest.mark.parametrize(("first_mm", "last_mm"), [(5.0, 15.0), (76.0, 84.0)])
def test_a_stretch_has_a_place_each_step_also_over_the_line_s_beginning(
    first_mm: float, last_mm: float
) -> None:
    line = run_along(polyline((15, 5), (25, 5), (25, 25), (5, 25), (5, 5), (15, 5)))
    stretch = touches._stretch(line, first_mm, last_mm, 0.25)
    come_mm = lengths_mm(stretch)
    off_mm = 60 * UM  # the places of a line lie 50 um apart, so may end and beginning
    assert come_mm == pytest.approx(0.25 * np.arange(len(stretch)), abs=off_mm)
    assert come_mm[-1] == pytest.approx(last_mm - first_mm, abs=off_mm)


def test_ways_within_rims_that_leave_as_much_are_not_laid_again() -> None:
    """Of a page of gears one touch was laid a hundred times, from 0.04595 to 0.04589 and so on: 8 of 26 s."""
    ways = (
        LaidWay((polyline((0, 0), (9, 0)),), 0.25),
        LaidWay((polyline((9, 1), (0, 1)),), 0.25),
    )
    touch = Touch((0, 1), (0.0, 0.0), (9.0, 9.0), True)
    rims = BothWays(*ways, False, 0.0459)
    assert touches._most_left(0.0460, touch, rims) < rims.left
    assert touches._most_left(0.0480, touch, rims) > rims.left
