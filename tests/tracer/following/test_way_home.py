"""The way home: a planned course ends at home where it passes home on home's heading."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from morfax.tracer.following.way_home import WayHome
from morfax.tracer.head.stance import Stance
from morfax.tracer.limits import NEAR

WIDTH_MM, AWAY_MM, FAR_MM = 0.5, 5.0, 20.0
HOME = np.array([10.0, 5.0])


def home(heading_rad: float = 0.0) -> WayHome:
    """Home at 10, 5 mm."""
    view: Any = None  # a course is laid without looking
    return WayHome(Stance(HOME, heading_rad, view), AWAY_MM)


def along(first_mm: float, last_mm: float, aside_mm: float = 0.0) -> np.ndarray:
    """A course to the right, a place every 0.2 mm, as far from home as given."""
    x_mm = np.arange(first_mm, last_mm + 0.1, 0.2)
    return HOME + np.column_stack([x_mm, np.full(len(x_mm), aside_mm)])


@pytest.mark.parametrize("before_mm", [0.2, 0.4, 3.0])
def test_a_course_over_home_ends_there(before_mm: float) -> None:
    """However near to home it begins; its stretches before stay as they are, those behind go."""
    first = along(-6.0, -before_mm)
    course = home().on_course(
        [first, along(-before_mm, 2.0), along(2.0, 3.0)], FAR_MM, WIDTH_MM
    )
    assert course is not None and len(course) == 2
    assert np.array_equal(course[0], first)
    assert course[1][0] == pytest.approx(first[-1]) and course[1][-1] == pytest.approx(HOME)
    assert np.all(np.diff(course[1][:, 0]) > 0)


def test_a_course_that_only_begins_at_home_goes_on() -> None:
    assert home().on_course([along(0.0, 2.0)], FAR_MM, WIDTH_MM) is None


@pytest.mark.parametrize(("aside", "is_over"), [(0.9, True), (1.1, False)])
def test_home_is_on_the_line_within_three_tenths_of_its_width(
    aside: float, is_over: bool
) -> None:
    way = along(-2.0, 2.0, aside * NEAR * WIDTH_MM)
    assert (home().on_course([way], FAR_MM, WIDTH_MM) is not None) is is_over


def test_a_head_that_has_hardly_set_out_is_not_home() -> None:
    ways = [along(-2.0, 2.0)]
    assert home().on_course(ways, 0.99 * AWAY_MM, WIDTH_MM) is None
    assert home().on_course(ways, 1.01 * AWAY_MM, WIDTH_MM) is not None


def test_a_course_that_crosses_home_s_line_is_not_home() -> None:
    assert home(math.pi / 2).on_course([along(-2.0, 2.0)], FAR_MM, WIDTH_MM) is None
    assert home(math.pi).on_course([along(-2.0, 2.0)], FAR_MM, WIDTH_MM) is None
