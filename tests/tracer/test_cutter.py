"""The cutter beside the lines: sides by nesting and by travel, corners rolled round, what is left in corners listed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from motion.contour import distance
from motion.faults import MotionFault
from motion.motion import thin
from tests.tracer.inked import UM, arc, inked, polyline
from tracer.cutter import Cutter, with_cutter
from tracer.deviation import deviation, touched
from tracer.sequence import trace
from tracer.tour import trace_lines

FEED_MM_S = 10.0
FOLLOWED_MM = 25 * UM  # as the head follows a corner or a circle on a scan
SQUARE = polyline((12, 8), (20, 8), (20, 24), (8, 24), (8, 8), (12, 8))


@pytest.mark.parametrize(("side", "radius_mm"), [("outside", 12.0), ("inside", 6.0)])
def test_beside_a_circle_runs_the_circle_that_is_larger_or_smaller_by_the_radius(side: str, radius_mm: float) -> None:
    drawing = inked(arc((16, 16), 9), seed=1)
    beside, unreached = with_cutter(trace(drawing), Cutter(6, side), FEED_MM_S)  # type: ignore[arg-type]
    assert distance(thin(beside), arc((16, 16), radius_mm)).hausdorff_mm < FOLLOWED_MM
    assert not unreached and beside.ending == "closed"
    found = deviation(drawing, touched(drawing, thin(beside), 3))
    assert found.rms_mm < 4 * UM and found.missed_share == 0


def test_inside_a_square_four_corners_are_left_and_listed() -> None:
    beside, unreached = with_cutter(trace(inked(SQUARE, seed=2)), Cutter(6, "inside"), FEED_MM_S)
    assert len(unreached) == 4
    for stretch in unreached:
        assert stretch.left_mm == pytest.approx(3 * (math.sqrt(2) - 1), abs=FOLLOWED_MM)
        assert stretch.length_mm == pytest.approx(6, abs=0.5)  # from where the cutter touches one leg to the other
        assert min(np.hypot(*(SQUARE - stretch.place_mm).T)) < FOLLOWED_MM
    assert (
        distance(thin(beside), np.array([[11, 11], [17, 11], [17, 21], [11, 21], [11.0, 11]])).hausdorff_mm
        < FOLLOWED_MM
    )
    _, outside = with_cutter(trace(inked(SQUARE, seed=2)), Cutter(6), FEED_MM_S)
    assert not outside


def test_outside_of_a_part_is_the_inside_of_its_holes() -> None:
    part = inked(arc((26, 20), 16), arc((20, 20), 5), arc((34, 20), 4), seed=3)
    beside, _ = with_cutter(trace_lines(part), Cutter(3), FEED_MM_S)
    radii = [line.length_mm / math.tau for line in beside.lines]
    assert radii == pytest.approx([3.5, 2.5, 17.5], abs=FOLLOWED_MM) or radii == pytest.approx(
        [2.5, 3.5, 17.5], abs=FOLLOWED_MM
    )
    pocket, _ = with_cutter(trace_lines(part), Cutter(3, "inside"), FEED_MM_S)
    assert sorted(line.length_mm / math.tau for line in pocket.lines) == pytest.approx([5.5, 6.5, 14.5], abs=0.05)


def test_a_cutter_wider_than_the_hole_is_refused_in_one_line() -> None:
    with pytest.raises(
        MotionFault, match="a cutter of 12 mm goes nowhere inside of the lines; give a smaller --cutter"
    ):
        with_cutter(trace(inked(arc((9, 9), 5))), Cutter(12, "inside"), FEED_MM_S)


def test_an_open_line_has_a_left_and_a_right_and_no_outside() -> None:
    line = trace(inked(polyline((4, 6), (24, 9)), seed=1))
    with pytest.raises(MotionFault, match="line 1 is open: it has no outside; give --side left or right"):
        with_cutter(line, Cutter(4), FEED_MM_S)
    ways = {side: thin(with_cutter(line, Cutter(4, side), FEED_MM_S)[0]) for side in ("left", "right")}  # type: ignore[arg-type]
    middle = 0.5 * (ways["left"].runs()[0].mean(axis=0) + ways["right"].runs()[0].mean(axis=0))
    assert middle == pytest.approx([14, 7.5], abs=0.3)
    assert distance(ways["left"], ways["right"]).hausdorff_mm == pytest.approx(4, abs=0.05)


def test_a_figure_of_eight_has_no_outside() -> None:
    t = np.linspace(0, math.tau, 2001)
    eight = np.column_stack([24 + 18 * np.sin(t), 14 + 9 * np.sin(2 * t)])
    with pytest.raises(MotionFault, match="crosses itself: it has no outside"):
        with_cutter(trace(inked(eight, seed=1)), Cutter(2), FEED_MM_S)
