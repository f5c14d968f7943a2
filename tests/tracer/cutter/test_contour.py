"""The contour: straight on where guide lines leave it, and the feet of places on it on the cutter's path."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.offset import OffsetPath
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.tracer.cutter.contour import Beside, Cut
from morfax.tracer.cutter.start_places import _Path as StartPath
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.operator.operator import Operator
from tests.tracer.inked import UM

RADIUS_MM = 2.0
STEP_MM = 10.0 / 6000  # of a head at 10 mm/s


def cut_of(line: Line) -> Cut:
    """What is cut of a line."""
    cut = Cut.of(line, Operator(), 1)
    assert cut is not None
    return cut


def along(way_mm: Array) -> Array:
    """Positions of a head along a way, (n, 2) mm."""
    length_mm = lengths_mm(way_mm)[-1]
    return at_lengths(way_mm, np.linspace(0.0, length_mm, round(length_mm / STEP_MM) + 1))


def arc_and_guide(after_mm: float) -> Line:
    """An arc of 10 mm radius, a guide line of 3 mm outwards from its middle, and the arc on for a length."""
    angles = np.linspace(0, 1, 4000)
    arc = 10 * np.column_stack([np.cos(angles), np.sin(angles)])
    out = along(np.vstack([arc[-1], 1.3 * arc[-1]]))
    angles = np.linspace(1, 1 + after_mm / 10, max(2, round(after_mm / STEP_MM)))
    rest = 10 * np.column_stack([np.cos(angles), np.sin(angles)])
    xy_mm = np.vstack([arc, out[1:], out[::-1][1:], rest[1:]])
    tip = len(arc) + len(out) - 2
    guide = GuideLine(len(arc) - 1, tip, 2 * tip - len(arc) + 1)
    return Line(xy_mm, "ended", 0.5, 10.0 + after_mm, guides=(guide,))


@pytest.mark.parametrize(("after_mm", "within_mm"), [(10.0, 0.2 * UM), (0.7, 2 * UM)])
def test_a_contour_bends_on_where_a_guide_line_leaves_it(
    after_mm: float, within_mm: float
) -> None:
    """The bridge of 1 mm lies on the circle; less well where the contour ends 0.2 mm after it."""
    places = cut_of(arc_and_guide(after_mm)).places_mm
    assert np.abs(np.hypot(*places.T) - 10).max() < within_mm
    assert np.diff(lengths_mm(places)).max() < 0.1  # no gap
    turned = math.atan2(*places[-1][::-1])
    assert turned == pytest.approx(1 + after_mm / 10, abs=1e-6)


@pytest.mark.parametrize("between_mm", [0.2, 0.8])
def test_one_bridge_goes_over_two_guide_lines_at_about_one_place(between_mm: float) -> None:
    """Nothing is left of the contour between them, as 0.5 mm is left out to either side of each."""
    x_mm = np.arange(0, 10, STEP_MM)
    leaves = [3000, 3000 + round(between_mm / STEP_MM)]
    parts, guides, at = list[Array](), list[GuideLine](), 0
    for first, leave in zip([0, leaves[0]], leaves, strict=True):
        on = np.column_stack([x_mm[first:leave], 0 * x_mm[first:leave]])
        out = np.column_stack([np.full(600, x_mm[leave]), STEP_MM * np.arange(600)])
        parts += [on, out, out[::-1]]
        begin = at + len(on)
        guides.append(GuideLine(begin, begin + 600, begin + 1199))
        at = begin + 1200
    parts.append(np.column_stack([x_mm[leaves[1] :], 0 * x_mm[leaves[1] :]]))
    line = Line(np.vstack(parts), "ended", 0.5, 10.0, guides=tuple(guides))
    places = cut_of(line).places_mm
    assert np.abs(places[:, 1]).max() < 0.1 * UM
    assert np.diff(places[:, 0]).min() > 0 and np.diff(places[:, 0]).max() < 0.1
    assert places[[0, -1], 0] == pytest.approx([0, x_mm[-1]])


@pytest.mark.parametrize("tick_mm", [19.7, 19.85, 20.0, 20.15])
def test_a_foot_is_straight_across_where_the_head_wavers_by_some_um(tick_mm: float) -> None:
    """About a tick the head wavers, and so does the path: its nearest place is 0.1 mm beside the foot."""
    x_mm = np.linspace(0, 40, 24001)
    wave_mm = 4 * UM * np.exp(-(((x_mm - 20) / 0.25) ** 2))
    line = Line(np.column_stack([x_mm, -wave_mm]), "ended", 0.5, 40.0)
    path = np.column_stack([x_mm, RADIUS_MM - wave_mm])
    beside = Beside(cut_of(line), True, RADIUS_MM, [OffsetPath(path, False, 0)])
    place = line.xy_mm[round(tick_mm * 600)]
    # 1 um of wave under a cubic over 3 mm to either side turns the arm of 2 mm by less than 10 um
    assert beside.mm(beside.foot(place))[0] == pytest.approx(place[0], abs=10 * UM)


def test_a_path_that_the_arm_meets_on_its_way_is_another_path() -> None:
    """There the foot is at the nearest place of all paths."""
    x_mm = np.linspace(0, 40, 4001)
    line = Line(np.column_stack([x_mm, 0 * x_mm]), "ended", 0.5, 40.0)
    slanting = np.column_stack([x_mm, 1.0 + 0.5 * (x_mm - 20)])
    straight = np.column_stack([x_mm, 0 * x_mm + RADIUS_MM])
    paths = [OffsetPath(straight, False, 0), OffsetPath(slanting, False, 1)]
    beside = Beside(cut_of(line), True, RADIUS_MM, paths)
    foot = beside.foot(np.array([20.0, 0.0]))
    assert foot.path == 1
    assert beside.mm(foot) == pytest.approx([19.6, 0.8], abs=1 * UM)


def test_a_corner_has_a_heading_before_and_one_after_it() -> None:
    """Leads at a corner keep clear of both sides; on a side there is one heading."""
    square = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0], [0.0, 0.0]])
    line = Line(along(square), "closed", 0.5, 80.0)
    path = StartPath(Beside(cut_of(line), True, 0.0, [OffsetPath(along(square), True, 0)]), 0)
    quarter = (len(path.points_mm) - 1) / 4
    place, before, after = path.about(quarter)
    assert place == pytest.approx([20, 0], abs=STEP_MM)
    assert before == pytest.approx([1, 0], abs=0.02) and after == pytest.approx(
        [0, 1], abs=0.02
    )
    place, before, after = path.about(1.5 * quarter)
    assert place == pytest.approx([20, 10], abs=STEP_MM)
    assert before == pytest.approx([0, 1], abs=1e-6) and after == pytest.approx(before)
