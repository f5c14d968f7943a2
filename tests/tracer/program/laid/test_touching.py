"""Where lines touch, and how two ways there are exchanged, apart from a sheet's other lines."""

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
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.laid.ways import STEP_MM, circle, off_mm, run_along, steps_mm

WIDTH_MM = 0.5
UM = 1e-3


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
