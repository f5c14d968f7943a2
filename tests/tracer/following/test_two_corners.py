"""Two corners beside one another are two corners, and a round is an arc, by the ink that a pen leaves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.tracer.following import follower, two_corners
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.head_runs import followed
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import likeness
from tests.tracer.inked import UM, arc, inked, polyline

TURN = np.radians(60)
# a third of a pixel of 85 um: of 30 such drawings two corners are 3 to 11 um off, of 6 rounds 18 to 28 um
CORNER_MM = 30 * UM
STEP_CUT_OFF_MM = 40 * UM  # as one bend, or by one vertex, a step of 0.6 mm is 44 to 70 um off
CUT_OFF_MM = 60 * UM  # an arc in place of two corners 0.6 to 0.75 mm apart is 69 to 96 um off
FLOOR_MM = 0.6  # high: the floor, or the arc in its place
NEAR_STEP_MM = 2.0  # both of its ends


def own_way(line: Array, seed: int) -> Line:
    """The head's own way along a closed line, before stretches of it are bent onto their ink."""
    sheet = inked(line, width_mm=0.5, seed=seed).sheet
    run = followed(Setup(sheet, Settings(), Operator()), None)
    assert run.fault is None
    return run


def valley(side_mm: float) -> Array:
    """A bar with a valley in its lower side, whose floor is so long; closed."""
    down = 4 * np.array([np.cos(TURN), -np.sin(TURN)])
    first = np.array([20.0, 20.0])
    low = first + down
    floor = low + np.array([side_mm, 0.0])
    up = floor + down * np.array([1.0, -1.0])
    bar = (first, low, floor, up, (up[0] + 10, 20), (up[0] + 10, 30), (10, 30), (10, 20), first)
    return polyline(*(tuple(place) for place in bar))


def rounded_valley(radius_mm: float) -> Array:
    """The same with a floor that is an arc."""
    down = 4 * np.array([np.cos(TURN), -np.sin(TURN)])
    first = np.array([20.0, 20.0])
    low = first + down
    centre = low + radius_mm * np.array([np.sin(TURN), np.cos(TURN)])
    ends_deg = np.degrees([-np.pi / 2 - TURN, -np.pi / 2 + TURN])
    floor = arc(tuple(centre), radius_mm, *ends_deg)
    up = floor[-1] + down * np.array([1.0, -1.0])
    bar = (up, (up[0] + 10, 20), (up[0] + 10, 30), (10, 30), (10, 20), first, low)
    return np.vstack([polyline(*(tuple(place) for place in bar)), floor])


def worst_mm(line: Array, seed: int) -> float:
    """How far the valley's floor and its ends are at the most from the path of the head."""
    run = own_way(line, seed)
    floor = line[line[:, 1] < line[:, 1].min() + FLOOR_MM]
    return distance(run.xy_mm[::4], floor).reference_to_path.max_mm


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("widths", [1.2, 1.5, 1.8])
def test_two_corners_with_a_short_side_between_are_both_sharp(widths: float, seed: int) -> None:
    assert worst_mm(valley(widths * 0.5), seed) < CORNER_MM


@pytest.mark.parametrize("widths", [1.2, 1.5])
def test_by_an_arc_they_are_cut_off(widths: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(follower, "or_two_corners", lambda planner, felt, plan: plan)
    assert worst_mm(valley(widths * 0.5), 1) > CUT_OFF_MM


@pytest.mark.parametrize("radius_mm", [0.6, 1.2])
def test_a_round_stays_an_arc(radius_mm: float, monkeypatch: pytest.MonkeyPatch) -> None:
    laid = list[bool]()
    chosen = follower.or_two_corners

    def noted(planner, felt, plan):  # type: ignore[no-untyped-def]
        found = chosen(planner, felt, plan)
        laid.append(found is not plan)
        return found

    monkeypatch.setattr(follower, "or_two_corners", noted)
    assert worst_mm(rounded_valley(radius_mm), 1) < CORNER_MM
    assert laid and not any(laid)


def stepped(side_mm: float, turn_deg: float) -> Array:
    """A bar with a step in its lower side, which is so long and so steep; closed."""
    steep = np.radians(turn_deg)
    low = np.array([20.0, 20.0])
    high = low + side_mm * np.array([np.cos(steep), np.sin(steep)])
    bar = ((10, 20), low, high, (34, high[1]), (34, 30), (10, 30), (10, 20))
    return polyline(*(tuple(place) for place in bar))


def worst_at_step_mm(line: Array, seed: int) -> float:
    """How far the ends of the step are at the most from the path of the head."""
    run = own_way(line, seed)
    near = line[np.hypot(*(line - (20.0, 20.0)).T) < NEAR_STEP_MM]
    return distance(run.xy_mm[::4], near).reference_to_path.max_mm


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("turn_deg", [45, 60, 75])
@pytest.mark.parametrize("widths", [1.2, 1.5])
def test_both_corners_of_a_step_are_sharp(widths: float, turn_deg: float, seed: int) -> None:
    assert worst_at_step_mm(stepped(widths * 0.5, turn_deg), seed) < CORNER_MM


@pytest.mark.parametrize(("turn_deg", "seed"), [(45, 1), (60, 3), (75, 2)])
def test_as_one_bend_or_by_one_vertex_they_are_cut_off(
    turn_deg: float, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(follower, "or_two_corners", lambda planner, felt, plan: plan)
    monkeypatch.setattr(follower, "or_two_before", lambda planner, seen, choice, plan: plan)
    assert worst_at_step_mm(stepped(0.6, turn_deg), seed) > STEP_CUT_OFF_MM


def leg_from(x: float, y: float) -> Leg:
    """A straight leg to the right."""
    return Leg(np.array([x, y]), 0.0, 0.0, 0.5, np.empty((0, 3)))


def test_sides_of_a_step_begin_at_30_60_and_90_degrees_about_its_middle() -> None:
    view = cast(View, SimpleNamespace(width_mm=0.5))
    round_mm = np.linspace([0.0, 0.0], [2.0, 0.6], 41)
    sides = two_corners._stepping(view, leg_from(0.0, 0.0), leg_from(2.0, 0.6), round_mm)
    assert sides is not None
    turns_deg = np.degrees([sides.turns_rad(along_mm) for along_mm in sides.along_mm])
    assert turns_deg == pytest.approx(np.array([[a, -a] for a in (30.0, 60.0, 90.0)]))
    for along_mm in sides.along_mm:
        middle = sides.incoming.at(along_mm[0]) + sides.outgoing.at(along_mm[1])
        assert 0.5 * middle == pytest.approx([1.0, 0.3])


def test_of_several_ways_by_two_corners_the_one_that_gains_most_is_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gains = iter([0.1, 0.3, 0.2])
    sides = two_corners._Sides(leg_from(0, 0), leg_from(2, 1), np.zeros((1, 2)), 1.0)

    def better(*_: object) -> two_corners._Two:
        return two_corners._Two(sides, np.array([1.0, -1.0]), next(gains))

    for name, instead in (
        ("is_rough", lambda *_: False),
        ("is_as_felt", lambda *_: True),
        ("_as_felt", lambda *_: np.zeros((2, 2))),
        ("_beside_another", lambda *_: [sides] * 3),
        ("_better", better),
        ("_plan", lambda _, two: two.gain),
    ):
        monkeypatch.setattr(two_corners, name, instead)
    felt = cast(Any, SimpleNamespace(seen=np.zeros((9, 3))))
    planner = cast(Any, SimpleNamespace(view=None))
    assert two_corners.or_two_corners(planner, felt, None) == 0.3


class LikeTwo:
    """Ink about any place of which two corners leave nothing, legs a little, and a round way much."""

    @classmethod
    def about(cls, *_: object) -> LikeTwo:
        return cls()

    def misfit(self, places: Array) -> float:
        return {two_corners.PLACES: 1.0, 2 * two_corners.PLACES: 0.0}.get(len(places), 10.0)


@pytest.mark.parametrize(
    ("moved_mm", "is_found"), [((0.1, -0.1), True), ((0.1, -1.1), False), ((1.1, -0.1), False)]
)
def test_neither_end_of_a_side_moves_farther_than_there_is_room(
    moved_mm: tuple[float, float], is_found: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Farther on there is other ink, which a side explains as well."""
    monkeypatch.setattr(likeness, "Patch", LikeTwo)
    monkeypatch.setattr(likeness.Pen, "of", lambda *_: None)
    monkeypatch.setattr(
        two_corners, "_settled", lambda _, __, along_mm, ___: along_mm + moved_mm
    )
    stands = np.array([-5.0, 0.0]), 0.0
    planner = cast(Any, SimpleNamespace(view=SimpleNamespace(width_mm=0.5), stands=stands))
    sides = two_corners._Sides(leg_from(0, 0), leg_from(2, 0.6), np.array([[0.5, -0.5]]), 1.0)
    round_mm = np.linspace([0.0, 0.0], [2.0, 0.6], 41)
    found = two_corners._better(planner, sides, round_mm, two_corners.OVER_FELT)
    assert (found is not None) is is_found
