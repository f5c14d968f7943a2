"""Where outlines touch, or one nearly touches itself, each side keeps to its own rim."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.program.laid import touches
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.laid.ways import circle, off_mm, run_along

WIDTH_MM = 0.5
UM = 1e-3
LEVEL = math.radians(7)


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
