"""The folding rule lays narrow bays where their ink is: notches of known size."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.tangles import folding_rule
from morfax.tracer.tangles.folding_rule import Rule, explained
from morfax.tracer.tangles.seen_ink import SeenInk
from tests.tracer.inked import UM, arc
from tests.tracer.tangles.pen_ink import HALF_MM, apart_mm, ink_along

PITCH_MM, SIDE_PX = 0.085, 90
FIRST, LAST = np.array([1.0, 6.0]), np.array([6.0, 6.0])
SQUARE = np.array([(3.1, 6), (3.1, 3), (3.9, 3), (3.9, 6)])
ROUND = np.vstack([(3.1, 6), arc((3.5, 3.4), 0.4, 180, 360), (3.9, 6)])
POINTED = np.array([(3.0, 6), (3.5, 3), (4.0, 6)])


def way_of(corners: Array) -> Array:
    """The way along a bay between the two ends."""
    return np.vstack([FIRST, corners, LAST])


def ink_of(corners: Array, noise: float = 0.0) -> SeenInk:
    """The ink that a pen leaves along a bay."""
    return ink_along(way_of(corners), PITCH_MM, SIDE_PX, noise)


def off_mm(rule: Rule, corners: Array) -> float:
    """How far the rule's way is from a bay, and that from it, at most."""
    return apart_mm(rule.way, way_of(corners))


@pytest.mark.parametrize(
    "corners", [SQUARE, ROUND, POINTED], ids=["square", "round", "pointed"]
)
@pytest.mark.parametrize("noise", [0.0, 0.03])
def test_a_bay_is_laid_true_round_its_bar_of_ink(corners: Array, noise: float) -> None:
    """Within 30 um: the ink is 6 pixels wide, and its edges are 0.7 pixels soft."""
    ink = ink_of(corners, noise)
    legs = np.vstack([FIRST, [2.5, 6], [4.5, 6], LAST])
    rule = explained(ink, folding_rule.round_bar(ink, legs))
    assert rule is not None and off_mm(rule, corners) < 30 * UM


def test_a_rule_whose_sides_change_places_within_their_ink_is_laid_without_that() -> None:
    """Within the ink of both sides of a slender tip a pen may cross over, which no ink shows."""
    tip = np.array([(3.3, 6), (3.5, 1), (3.7, 6)])
    changed = folding_rule.sharp(FIRST, LAST, tip[::-1], HALF_MM)
    rule = explained(ink_of(tip), [changed])
    assert rule is not None and off_mm(rule, tip) < 30 * UM


@pytest.mark.parametrize("corners", [SQUARE, ROUND], ids=["square", "round"])
def test_a_bay_whose_end_the_head_cut_short_is_laid_true(corners: Array) -> None:
    cut = np.array([(3.1, 6), (3.15, 3.6), (3.5, 3.5), (3.85, 3.6), (3.9, 6)])
    ink = ink_of(corners)
    rule = explained(ink, folding_rule.along(way_of(cut), HALF_MM))
    assert rule is not None and off_mm(rule, corners) < 30 * UM


def test_a_tip_is_laid_though_its_sides_run_together() -> None:
    """One of 4 degrees, as of a comb's tooth, to within 20 um; another rule ran out into its ink and back."""
    needle = np.array([(3.3, 6.0), (3.5, 0.8), (3.7, 6.0)])
    cut = np.array([(3.3, 6.0), (3.47, 1.2), (3.53, 1.2), (3.7, 6.0)])
    rule = explained(ink_along(needle, PITCH_MM, SIDE_PX), folding_rule.along(cut, HALF_MM))
    assert rule is not None and apart_mm(rule.way, needle) < 20 * UM


def test_of_rules_about_a_bar_those_far_from_its_ink_are_left_out() -> None:
    """They come to no bay; one that lies a tenth of a line beside it does."""
    near, out = (
        folding_rule.sharp(FIRST, LAST, corners, HALF_MM)
        for corners in (SQUARE + 0.05, SQUARE * (1, -1) + (0, 12))
    )
    ink = ink_of(SQUARE)
    assert [rule is near for rule in folding_rule.not_far(ink, [out, near])] == [True]
    laid = explained(ink, [near])
    assert laid is not None and off_mm(laid, SQUARE) < 30 * UM


def test_one_line_out_is_no_bay() -> None:
    """A tick of one line is followed out and back, and no two sides explain it."""
    tick = np.array([(3.5, 6), (3.5, 3), (3.5, 6)])
    ink = ink_of(tick)
    legs = np.vstack([FIRST, [3, 6], [4, 6], LAST])
    rules = [*folding_rule.along(way_of(tick), HALF_MM), *folding_rule.round_bar(ink, legs)]
    rule = explained(ink, rules)
    assert rule is None or rule.misfit > 0.035 * rule.length_mm / (2 * HALF_MM)


def test_a_rounded_corner_is_an_arc_that_touches_both_sides() -> None:
    corners = np.array([(3.5, 6.0)])
    rule = Rule(FIRST, np.array([3.5, 1.0]), corners, np.array([True]), 0.5, HALF_MM)
    (way,) = rule.stretches()
    from_middle = np.hypot(*(way[1:-1] - (3.0, 5.5)).T)
    assert from_middle == pytest.approx(np.full(len(way) - 2, 0.5))
    assert way[1] == pytest.approx((3.0, 6.0)) and way[-2] == pytest.approx((3.5, 5.5))


def test_arcs_take_no_more_than_half_of_the_side_between_them() -> None:
    """So a radius of half the width makes the end of a notch half a circle, and a larger one, too."""
    corners = np.array([(3.1, 6), (3.1, 3), (3.9, 3), (3.9, 6)])
    rounded = np.array([False, True, True, False])
    for radius_mm in (0.4, 2.0):
        rule = Rule(FIRST, LAST, corners, rounded, radius_mm, HALF_MM)
        end = rule.way[rule.way[:, 1] < 3.4 - UM]
        assert np.hypot(*(end - (3.5, 3.4)).T) == pytest.approx(np.full(len(end), 0.4))


def test_sharp_corners_part_the_way_into_stretches() -> None:
    rule = Rule(FIRST, LAST, SQUARE, np.zeros(4, bool), 0.0, HALF_MM)
    assert len(rule.stretches()) == 5 and rule.figures == 8


@pytest.mark.parametrize(("times", "is_laid"), [(1.0, True), (1.6, False)])
def test_a_pen_that_is_1_4_times_as_broad_explains_nothing(times: float, is_laid: bool) -> None:
    ink = ink_along(way_of(SQUARE), PITCH_MM, SIDE_PX, half_mm=times * HALF_MM)
    legs = np.vstack([FIRST, [2.5, 6], [4.5, 6], LAST])
    assert (explained(ink, folding_rule.round_bar(ink, legs)) is not None) == is_laid


@pytest.mark.parametrize(
    "corners", [SQUARE, ROUND, POINTED], ids=["square", "round", "pointed"]
)
def test_rules_begin_on_the_line_that_the_bay_leaves(corners: Array) -> None:
    """However far its tip is from there: in steps of a fiftieth of a bar's length."""
    ink = ink_of(corners)
    begun = list(folding_rule.round_bar(ink, np.vstack([FIRST, [2.5, 6], [4.5, 6], LAST])))
    feet = np.array([rule.corners_mm[[0, -1]] for rule in begun if len(rule.corners_mm) > 2])
    assert len(feet) > 0
    assert feet[..., 1] == pytest.approx(np.full(feet.shape[:2], 6.0), abs=4 / 50)
    assert (feet[:, 0, 0] < feet[:, 1, 0]).all()  # in the order of the line
