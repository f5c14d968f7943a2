"""Gouges: a cutter's middle that comes nearer to a line than its radius."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Motion
from morfax.motion.polyline import Nearest
from morfax.tracer.cutter.gouges import refuse_gouges
from tests.tracer.inked import UM

LINE = np.array([[0.0, 0.0], [40.0, 0.0]])
RADIUS_MM = 3.0


def motion(x_mm: Array, y_mm: Array, z_mm: float | Array) -> list[Motion]:
    """A motion, in one block."""
    return [Motion(np.column_stack([x_mm, y_mm, z_mm + 0 * x_mm]), 6000.0, 0.0)]


def beside(away_mm: float, z_mm: float) -> list[Motion]:
    """A run along the line, at a distance from it."""
    x_mm = np.linspace(0, 40, 400)
    return motion(x_mm, 0 * x_mm + away_mm, z_mm)


def check(blocks: list[Motion]) -> None:
    """Look for gouges of a cutter of 6 mm beside the line."""
    refuse_gouges(iter(blocks), Nearest([LINE], RADIUS_MM), 2 * RADIUS_MM)


@pytest.mark.parametrize("too_near_mm", [6 * UM, 0.1, 0.4])
def test_a_cutter_nearer_than_its_radius_is_refused(too_near_mm: float) -> None:
    check(beside(3.0, -1.0))
    check(beside(3.0 - too_near_mm, 2.0))  # above the work
    check(beside(3.0 - too_near_mm, 0.01))  # and hardly above it
    for z_mm in (-1.0, -0.01):
        with pytest.raises(MotionFault, match="would cut into the part at"):
            check(beside(3.0 - too_near_mm, z_mm))


def test_what_the_offset_and_the_feed_s_smoothing_leave_is_no_gouge() -> None:
    """Both together stay within 5 um."""
    check(beside(3.0 - 4 * UM, -1.0))


@pytest.mark.parametrize("first", range(100, 120))
def test_a_gouge_of_a_hundredth_of_a_second_is_found_wherever_it_begins(first: int) -> None:
    """At 10 mm/s and 6 kHz that is 0.1 mm of way: 60 positions; a sixth of it is found as well."""
    x_mm = np.linspace(0, 1, 600)
    y_mm = np.full(600, 3.0)
    y_mm[first : first + 10] = 2.9
    with pytest.raises(MotionFault, match="would cut into the part at"):
        check(motion(x_mm, y_mm, -1.0))


def test_a_tool_that_only_stands_or_drills_there_gouges_nothing() -> None:
    """A hole is drilled where it was drawn, however near to a line."""
    still = np.full(600, 10.0)
    check(motion(still, 0.1 * still, np.linspace(2.0, -5.0, 600)))


def test_the_place_that_is_told_is_the_deepest() -> None:
    x_mm = np.linspace(0, 40, 24001)
    y_mm = 3.0 - 0.3 * np.exp(-(((x_mm - 27.3) / 2) ** 2))
    with pytest.raises(MotionFault, match=r"cutter of 6 mm .* at 27\.3,2\.7 mm"):
        check(motion(x_mm, y_mm, -1.0))
