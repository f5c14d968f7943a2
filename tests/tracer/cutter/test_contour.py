"""The contour: straight on where guide lines leave it, and the feet of places on it on the cutter's path."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.offset import OffsetPath
from morfax.motion.polyline import APART_MM, at_lengths, evenly, lengths_mm
from morfax.tracer.cutter.contour import Beside, Cut, heading, nearest_place, planned
from morfax.tracer.cutter.start_places import _Path as StartPath
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace
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


@pytest.mark.parametrize(("turned_deg", "bridged"), [(10, True), (30, False), (-30, False)])
def test_a_contour_keeps_its_corner_where_a_guide_line_leaves_it_there(
    turned_deg: float, bridged: bool
) -> None:
    """A bend of 10 degrees is bridged by a cubic; at a corner each side ends half a millimetre off it."""
    turned = math.radians(turned_deg)
    corner = np.array([10.0, 0.0])
    leg = along(np.array([[0.0, 0.0], corner]))
    after = along(
        np.vstack([corner, corner + 10 * np.array([math.cos(turned), math.sin(turned)])])
    )
    out = along(np.vstack([corner, corner + np.array([0.0, 3.0])]))
    xy_mm = np.vstack([leg, out[1:], out[::-1][1:], after[1:]])
    tip = len(leg) + len(out) - 2
    guide = GuideLine(len(leg) - 1, tip, 2 * tip - len(leg) + 1)
    places = cut_of(Line(xy_mm, "ended", 0.5, 20.0, guides=(guide,))).places_mm
    gap_mm = np.diff(lengths_mm(places)).max()
    if bridged:
        assert gap_mm < 0.1
    else:
        assert gap_mm == pytest.approx(math.cos(turned / 2), abs=2 * STEP_MM)


def test_a_closed_contour_comes_together_within_a_millimetre_of_its_ends() -> None:
    """It ends 20 um off its beginning: both come 10 um, the other places stay where they are."""
    angles = np.linspace(0, math.tau, 20_000)
    grows = 10 + 20 * UM * angles / math.tau
    spiral = grows[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    places = cut_of(Line(spiral, "closed", 0.5, 62.8)).places_mm
    assert places[-1] == pytest.approx(places[0], abs=1e-9)
    assert places[0] == pytest.approx([10 + 10 * UM, 0], abs=1e-6)
    moved_mm = np.hypot(*(places - spiral).T)
    from_start = lengths_mm(spiral)
    from_end = from_start[-1] - from_start
    shares = np.clip(1 - np.minimum(from_start, from_end), 0, 1)
    assert moved_mm == pytest.approx(10 * UM * shares, abs=1e-9)


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("radius_mm", [1.2, 10.0, 1000.0])
def test_the_heading_of_a_circle_is_its_tangent(radius_mm: float, closed: bool) -> None:
    """Over 1 mm to either side a circle of 1.2 mm is a cubic within 15 um, and turns by 48 degrees."""
    turn = math.tau if closed else math.pi / 4
    angles = np.linspace(0, turn, 200_000)
    every = evenly(radius_mm * np.column_stack([np.cos(angles), np.sin(angles)]), APART_MM)
    for here in (0, len(every) // 2):
        if not closed and here == 0:
            continue
        angle = here * APART_MM / radius_mm
        way = heading(every, here, closed)
        assert way is not None and np.hypot(*way) == pytest.approx(1)
        across = float(way @ [math.cos(angle), math.sin(angle)])
        along_it = float(way @ [-math.sin(angle), math.cos(angle)])
        # where the places of a closed line begin and end, two are nearer than the others
        assert abs(across) < (0.01 if closed else 1e-3) and along_it > 0.99


@pytest.mark.parametrize(
    ("from_corner_mm", "has_one"),
    [(0.0, False), (0.5, False), (0.9, False), (1.1, True), (4.0, True)],
)
def test_a_place_within_a_millimetre_of_a_corner_has_no_heading(
    from_corner_mm: float, has_one: bool
) -> None:
    way = along(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]))
    every = evenly(way, APART_MM)
    found = heading(every, round((10 - from_corner_mm) / APART_MM), False)
    assert (found is not None) == has_one
    if found is not None:
        assert found == pytest.approx([1, 0], abs=0.02)


def test_the_nearest_place_of_a_path_is_on_a_piece_or_at_a_corner() -> None:
    path = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 0.0], [10.0, 5.0]])  # one place twice
    for place, away_mm, at in (
        ((2.5, 3.0), 3.0, 0.25),
        ((-3.0, -4.0), 5.0, 0.0),
        ((14.0, 2.0), 4.0, 2.4),
        ((9.0, 9.0), math.sqrt(17), 3.0),
    ):
        found_mm, found = nearest_place(path, np.array(place), 7)
        assert found_mm == pytest.approx(away_mm) and found.at == pytest.approx(at)
        assert found.path == 7


def straight(**more: object) -> Line:
    """A line of 10 mm to the right."""
    return replace(Line(along(np.array([[0.0, 0.0], [10.0, 0.0]])), "ended", 0.5, 10.0), **more)  # type: ignore[arg-type]


def test_nothing_is_cut_of_a_guide_line_without_a_tick_and_from_its_tick_on_with_one() -> None:
    guide = straight(reference_mm=(-3.0, 0.0))
    assert Cut.of(guide, Operator(), 1) is None
    ticked = replace(guide, marks=(Mark("tick", (4.0, 0.0), 4.0 / STEP_MM - 0.5),))
    cut = cut_of(ticked)
    assert cut.first == round(4.0 / STEP_MM) and cut.down_at == 4.0 / STEP_MM - 0.5
    assert cut.places_mm[0] == pytest.approx([4.0, 0.0], abs=STEP_MM)
    assert cut.length_mm == pytest.approx(6.0, abs=STEP_MM) and not cut.closed


def test_nothing_is_cut_of_a_line_that_was_never_begun() -> None:
    assert Cut.of(replace(straight(), xy_mm=np.zeros((1, 2))), Operator(), 1) is None


def test_stops_are_numbered_on_from_line_to_line_whether_they_are_cut_or_not() -> None:
    ticks = tuple(Mark("tick", (x, 0.0), x / STEP_MM) for x in (2.0, 5.0))
    lines = (
        straight(marks=ticks),
        replace(straight(number=2), xy_mm=np.zeros((1, 2))),
        straight(marks=ticks[:1], number=3),
    )
    numbers = [(line.numbers, cut is not None) for line, cut in planned(Trace(lines))]
    assert numbers == [((1, 2), True), ((), False), ((3,), True)]


def test_where_the_arm_does_not_reach_a_path_the_foot_is_at_the_nearest_place() -> None:
    """The path ends before the place: its end is the foot, 0.5 mm aside of the arm."""
    path = np.array([[0.0, RADIUS_MM], [4.5, RADIUS_MM]])
    beside = Beside(cut_of(straight()), True, RADIUS_MM, [OffsetPath(path, False, 0)])
    assert beside.mm(beside.foot(np.array([5.0, 0.0]))) == pytest.approx([4.5, RADIUS_MM])
    right = Beside(cut_of(straight()), False, RADIUS_MM, [OffsetPath(-path, False, 0)])
    assert right.mm(right.foot(np.array([5.0, 0.0]))) == pytest.approx(
        [0.0, -RADIUS_MM], abs=1e-6
    )


def test_paths_are_met_in_the_order_of_the_line_that_crosses_them() -> None:
    low, high = (np.array([[0.0, y], [9.0, y]]) for y in (1.0, 2.0))
    beside = Beside(
        cut_of(straight()), True, 1.0, [OffsetPath(high, False, 0), OffsetPath(low, False, 1)]
    )
    met = list(beside.met(np.array([[4.5, 0.0], [4.5, 4.0]])))
    assert [place.path for _, place in met] == [1, 0]
    assert [at for at, _ in met] == pytest.approx([0.25, 0.5])
    assert [place.at for _, place in met] == pytest.approx([0.5, 0.5])


@pytest.mark.parametrize("degrees", [3.0, 100.0, 250.0])
def test_on_a_circle_the_foot_is_at_the_end_of_the_radius(degrees: float) -> None:
    """And not where another path is nearer: the heading is that of the contour at the place."""
    angles = np.linspace(0, math.tau, 37_700)
    unit = np.column_stack([np.cos(angles), np.sin(angles)])
    line = Line(10 * unit, "closed", 0.5, 62.8)
    tongue = np.array([[9.0, -0.5], [9.0, 0.5]]) @ np.array(
        [[math.cos(math.radians(degrees + 4)), math.sin(math.radians(degrees + 4))],
         [-math.sin(math.radians(degrees + 4)), math.cos(math.radians(degrees + 4))]]
    )  # fmt: skip
    paths = [OffsetPath(12 * unit, True, 0), OffsetPath(tongue, False, 1)]
    beside = Beside(cut_of(line), False, 2.0, paths)
    out = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    foot = beside.foot(10 * out)
    assert foot.path == 0
    assert beside.mm(foot) == pytest.approx(12 * out, abs=10 * UM)
