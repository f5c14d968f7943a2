"""The bent rule: arcs touch both sides of their corners, and what is wrong is the pen's ink along it."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.tangles import bent_rule, pen
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.seen_ink import SeenInk

UM = 1e-3
FIRST, LAST = np.array([0.0, 0.0]), np.array([4.0, 0.0])
CORNERS = np.array([[1.0, 0.0], [1.2, 2.0], [2.6, 2.1], [2.8, 0.1]])
RADIUS_MM, HALF_MM, SOFTNESS_MM = 0.3, 0.25, 0.05


def rule_of(*rounded: bool, radius_mm: float = RADIUS_MM) -> Rule:
    corners = CORNERS[: len(rounded)]
    return Rule(FIRST, LAST, corners, np.array(rounded), radius_mm, HALF_MM)


def seen() -> SeenInk:
    """Places about the rule, and darkness of a pen along a way that lies beside it."""
    x, y = np.meshgrid(np.arange(-0.5, 4.5, 0.17), np.arange(-0.6, 2.8, 0.17))
    places = np.column_stack([x.ravel(), y.ravel()])
    known_mm = np.hypot(*(places - LAST).T)
    ink = SeenInk(places, np.zeros(len(places)), known_mm, HALF_MM, SOFTNESS_MM, 0.03, 0.0)
    moved = rule_of(False, True, True, False)._replace(corners_mm=CORNERS + 0.07)
    return ink._replace(darkness=ink.drawn_along(moved.way, 0.3))


def turns_of(way: Array) -> Array:
    """By how much a way turns at each place within it, rad."""
    headings = [math.atan2(*(b - a)[::-1]) for a, b in pairwise(way)]
    return np.abs(np.diff(np.unwrap(headings)))


def test_a_sharp_rule_is_its_corners_and_a_rounded_one_leaves_its_sides_where_it_touches_them() -> (
    None
):
    sharp = rule_of(False, False, False, False)
    assert np.array_equal(sharp.way, np.vstack([FIRST, CORNERS, LAST]))
    assert [len(part) for part in sharp.stretches()] == [2] * 5
    way = rule_of(False, True, True, False).way
    # no place of it turns by more than two of an arc's steps, but for the sharp corners
    assert np.sum(turns_of(way) > 2 * bent_rule.ARC_RAD) == 2
    # an arc lies within its corner: as far from it as a circle that touches both sides; its places are
    # up to three degrees beside its middle
    away_mm = np.hypot(*(way - CORNERS[1]).T).min()
    half_turn = 0.5 * abs(np.diff(np.unwrap([math.atan2(2.0, 0.2), math.atan2(0.1, 1.4)]))[0])
    assert away_mm == pytest.approx(RADIUS_MM * (1 / math.cos(half_turn) - 1), abs=2 * UM)


def test_an_arc_takes_half_of_a_side_that_it_shares_and_almost_all_of_its_own() -> None:
    shared = rule_of(False, True, True, False, radius_mm=9.0).way
    assert np.hypot(*(shared - CORNERS[1:3].mean(axis=0)).T).min() < UM
    own = rule_of(False, False, True, radius_mm=9.0).way
    beyond_mm = (1 - bent_rule.KEPT) * np.hypot(*(CORNERS[2] - CORNERS[1]))
    begins = CORNERS[2] + beyond_mm * (CORNERS[1] - CORNERS[2]) / np.hypot(
        *(CORNERS[2] - CORNERS[1])
    )
    assert np.hypot(*(own - begins).T).min() < UM


def test_a_corner_that_hardly_turns_has_no_radius_or_lies_nowhere_is_sharp() -> None:
    assert len(rule_of(True, radius_mm=0.0).way) == 3
    in_line = Rule(FIRST, LAST, np.array([[1.0, 1e-4]]), np.array([True]), 0.3, HALF_MM)
    assert len(in_line.way) == 3
    for nowhere in (math.nan, math.inf):
        thrown = in_line._replace(corners_mm=np.array([[nowhere, 1.0]]))
        assert len(thrown.way) == 3


def test_the_kernels_are_what_the_plain_python_is() -> None:
    ink, rule = seen().for_kernel(), rule_of(False, True, True, False)
    figures = np.r_[rule.corners_mm.ravel(), RADIUS_MM, HALF_MM]
    kernels = {name: getattr(bent_rule, name) for name in ("bent", "wrong", "changes")}
    ends = np.array([FIRST, LAST]), rule.rounded
    compiled, plain = np.empty(len(ink.places_mm)), np.empty(len(ink.places_mm))
    near, nearly = (np.empty((len(ink.places_mm), 3)) for _ in range(2))
    kernels["wrong"](ink, ends, figures, near, compiled)
    kernels["wrong"].py_func(ink, ends, figures, nearly, plain)
    assert np.allclose(compiled, plain, atol=1e-9)  # darkness: 1e-9 of ink's
    assert np.allclose(near, nearly, atol=1e-9)
    ways = [np.empty((bent_rule.most_places.py_func(4), 3)) for _ in range(2)]
    counts = [
        bend(ends, rule.corners_mm, RADIUS_MM, np.zeros(4, np.int64), way)
        for bend, way in zip((kernels["bent"], kernels["bent"].py_func), ways, strict=True)
    ]
    assert counts[0] == counts[1]
    assert np.allclose(ways[0][: counts[0]], ways[1][: counts[0]], atol=1e-9)  # mm
    change, again = (np.empty((len(ink.places_mm), len(figures))) for _ in range(2))
    kernels["changes"](ink, ends, figures, near, change)
    kernels["changes"].py_func(ink, ends, figures, near, again)
    assert np.allclose(change, again, atol=1e-4)  # of ink's darkness per mm


def test_what_is_wrong_is_the_ink_along_the_way_and_changes_say_how_it_goes_on() -> None:
    ink, rule = seen(), rule_of(False, True, True, False)
    figures = np.r_[rule.corners_mm.ravel(), RADIUS_MM, HALF_MM]
    ends, out = (np.array([FIRST, LAST]), rule.rounded), np.empty(len(ink.darkness))
    near, other = np.empty((len(out), 3)), np.empty((len(out), 3))
    bent_rule.wrong(ink.for_kernel(), ends, figures, near, out)
    wrong = ink.drawn_along(rule.way, HALF_MM) - ink.darkness
    assert np.allclose(out, wrong, atol=1e-9)  # of ink's darkness
    change = np.empty((len(ink.darkness), len(figures)))
    bent_rule.changes(ink.for_kernel(), ends, figures, near, change)
    for k, step in enumerate(1e-5 * np.eye(len(figures))):
        after, before = (np.empty(len(ink.darkness)) for _ in range(2))
        bent_rule.wrong(ink.for_kernel(), ends, figures + step, other, after)
        bent_rule.wrong(ink.for_kernel(), ends, figures - step, other, before)
        off = np.abs((after - before) / 2e-5 - change[:, k])
        # where two pieces are as near, ink has no slope
        assert np.quantile(off, 0.98) < 1e-4 * np.abs(change).max()
    assert np.abs(change).max(axis=0).min() > 0.1  # and each figure changes something


def test_a_rule_that_is_moved_keeps_the_places_of_its_arcs() -> None:
    """So many that what a figure moves is the way, and not the number of its places; also where there is no
    room for an arc any more.
    """
    rule, out = rule_of(False, True, True, False), np.empty((bent_rule.most_places(4), 3))
    ends, counts = (np.array([FIRST, LAST]), rule.rounded), np.zeros(4, np.int64)
    places = bent_rule.bent(ends, CORNERS, RADIUS_MM, counts, out)
    assert counts[[0, 3]].tolist() == [1, 1] and counts[1:3].min() > 5
    assert places == counts.sum() + 2
    for corners in (CORNERS + np.eye(4)[1][:, None] * (0.1, -0.8), CORNERS * (1.0, 0.0)):
        bent = counts.copy()
        assert bent_rule.bent(ends, corners, RADIUS_MM, bent, out) == places
        assert np.array_equal(bent, counts)
    # a corner that was sharp stays sharp
    sharp = np.ones(4, np.int64)
    assert bent_rule.bent(ends, CORNERS, RADIUS_MM, sharp, out) == 6


def test_the_pen_of_a_rule_leaves_what_is_known_anyway() -> None:
    ink = seen()
    assert isinstance(ink.for_kernel(), pen.Ink)
    everywhere = ink._replace(known_mm=np.zeros(len(ink.darkness)))
    out, rule = np.empty(len(ink.darkness)), rule_of(False)
    figures = np.r_[rule.corners_mm.ravel(), HALF_MM]
    ends = np.array([FIRST, LAST]), rule.rounded
    bent_rule.wrong(everywhere.for_kernel(), ends, figures, np.empty((len(out), 3)), out)
    assert np.allclose(out + ink.darkness, 1.0)
