"""Ramps, holding tabs and pecks against their closed forms: a rectangle, a circle, an open line, a hole."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.settings.depths import of_tabs
from morfax.motion.faults import MotionFault
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Tabs, Work
from morfax.tracer.program.program import Trace
from tests.tracer.program.passes.cuts import (
    RADIUS_MM,
    UM,
    at_depth,
    circle,
    cut,
    line,
    slopes,
)

RECTANGLE = [(0, 20), (0, 0), (60, 0), (60, 40), (0, 40), (0, 20)]


# tabs


def test_tabs_of_a_rectangle_stand_evenly_and_as_high_and_wide_as_asked() -> None:
    """Four shares of 50 mm from the middle of the left side: the first share's middle is 5 mm from a corner,
    which leaves 0.5 mm more than the tab of 3 mm and the cutter's half mm need.
    """
    work = Work(5.0, tabs=Tabs(4), cutter_mm=2.0)
    outline = line(RECTANGLE)
    positions_mm = cut(work, outline)
    trace = Trace((outline,), Operator(work))
    places_mm = [tab.place_mm for tab in trace.tabs[0]]
    expected_mm = [(5, 0), (55, 0), (55, 40), (5, 40)]
    assert np.abs(np.subtract(places_mm, expected_mm)).max() < 1 * UM
    on_top = at_depth(positions_mm, 4.0)
    for x_mm, y_mm in expected_mm:
        here = on_top[np.hypot(*(on_top - (x_mm, y_mm)).T) < 10]
        assert np.ptp(here[:, 0]) == pytest.approx(3.0 + 2.0, abs=1 * UM)
        assert here[:, 0].mean() == pytest.approx(x_mm, abs=0.2)
        assert np.ptp(here[:, 1]) == 0 and here[0, 1] == y_mm
    assert len(slopes(positions_mm)) == 0  # Z goes up and down while X and Y stand
    assert positions_mm[:, 2].min() == -5.0


def test_a_tab_in_a_corner_is_moved_along_until_it_is_clear_of_it() -> None:
    """Begun 15 mm from a corner, the shares' middles are 10 mm beyond the corners; 10 mm more and they would
    be in them.
    """
    begun = [
        (25, 0),
        (60, 0),
        (60, 40),
        (0, 40),
        (0, 0),
        (25, 0),
    ]  # middles at 25, 75, 125, 175 mm
    tabs = Trace((line(begun),), Operator(Work(5.0, tabs=Tabs(4, width_mm=8.0)))).tabs[0]
    assert np.abs(np.subtract(tabs[0].place_mm, (50, 0))).max() < 1 * UM
    in_corner = [
        (35, 0),
        (60, 0),
        (60, 40),
        (0, 40),
        (0, 0),
        (35, 0),
    ]  # the first at the corner itself
    tabs = Trace((line(in_corner),), Operator(Work(5.0, tabs=Tabs(4, width_mm=8.0)))).tabs[0]
    for tab in tabs:
        away_mm = np.abs(np.subtract(tab.place_mm, [[0, 0], [60, 0], [60, 40], [0, 40]]))
        assert np.hypot(*away_mm.T).min() > 4.0 + 0.9


@pytest.mark.parametrize(("path_radius_mm", "remarks"), [(1.4, 0), (1.6, 1)])
def test_a_hole_that_the_cutter_mills_away_needs_no_tabs(
    path_radius_mm: float, remarks: int
) -> None:
    """A cutter of 3 mm reaches the middle of a circle of 1.4 mm radius; 1.6 mm leave a core of 0.1 mm."""
    work = Work(tabs=Tabs(4, 3.0, 1.0), cutter_mm=3.0)
    hole = circle(path_radius_mm, (5.0, 5.0))
    told = list(of_tabs(Trace([hole, circle()], Operator(work))))
    assert len(told) == remarks and all("come loose" in text for text in told)


def test_tabs_of_a_circle_stand_evenly_and_only_in_the_passes_below_their_top() -> None:
    work = Work(4.0, passes_mm=(2.0,), tabs=Tabs(3, width_mm=6.0, height_mm=1.5))
    positions_mm = cut(work, circle())
    on_top = at_depth(positions_mm, 2.5)
    angles = np.degrees(np.arctan2(*on_top.T[::-1])) % 360
    half_deg = math.degrees(3.0 / RADIUS_MM)
    for middle_deg in (60, 180, 300):
        here = angles[np.abs(angles - middle_deg) < 30]
        assert here.min() == pytest.approx(middle_deg - half_deg, abs=0.01)
        assert here.max() == pytest.approx(middle_deg + half_deg, abs=0.01)
    # the pass at 2 mm goes round without a rest on a tab
    first_pass = at_depth(positions_mm, 2.0)
    assert np.hypot(*np.diff(first_pass, axis=0).T).max() < 2 * UM


@pytest.mark.parametrize(
    ("tabs", "cutter_mm", "says"),
    [
        (Tabs(4, width_mm=80.0), 0.0, "4 tabs of 80 mm would hold more than half of line 1"),
        (Tabs(20, width_mm=3.0), 3.0, "which is 200.0 mm round; give --tabs 16, or narrower"),
        (Tabs(1, width_mm=300.0), 0.0, "a tab of 300 mm would hold more than half of line 1"),
        (
            Tabs(4, height_mm=5.0),
            0.0,
            "tabs of 5 mm are not lower than line 1 is cut deep, 5 mm",
        ),
    ],
)
def test_tabs_without_room_are_refused_in_one_line(
    tabs: Tabs, cutter_mm: float, says: str
) -> None:
    with pytest.raises(MotionFault) as refused:
        cut(Work(5.0, tabs=tabs, cutter_mm=cutter_mm), line(RECTANGLE))
    assert says in str(refused.value) and "\n" not in str(refused.value)


def test_a_star_of_short_sides_has_no_place_clear_of_its_corners() -> None:
    angles = np.linspace(0, 2 * math.pi, 25)
    radii = np.where(np.arange(25) % 2, 16.0, 20.0)  # sides of 6.1 mm
    star = line(np.column_stack([radii * np.cos(angles), radii * np.sin(angles)]))
    narrow = Trace((star,), Operator(Work(5.0, tabs=Tabs(4, width_mm=1.5))))
    assert len(narrow.tabs[0]) == 4
    with pytest.raises(
        MotionFault, match=r"tab 1 of line 1 has no place about .* clear of corners"
    ):
        cut(Work(5.0, tabs=Tabs(4), cutter_mm=3.0), star)


def test_a_hole_gets_as_many_tabs_as_it_has_room_for_and_none_where_all_is_milled_away() -> (
    None
):
    outline, hole = (
        line(RECTANGLE),
        circle(6.0, (20, 20)),
    )  # 37.7 mm round: half of it for 3 tabs of 6
    small = circle(2.0, (45, 20))  # the path of a cutter of 6 mm in a hole of 10
    holes = replace(hole, number=2), replace(small, number=3)
    trace = Trace((*holes, outline), Operator(Work(5.0, tabs=Tabs(4), cutter_mm=3.0)))
    assert [len(tabs) for tabs in trace.tabs] == [3, 0, 4]
    wide = Trace((*holes, outline), Operator(Work(5.0, tabs=Tabs(4, 1.0), cutter_mm=6.0)))
    assert [len(tabs) for tabs in wide.tabs] == [2, 0, 4]
