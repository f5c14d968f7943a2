"""Partners at a junction: all legs at once, by the least turning."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.ink.outlines import turned_by
from morfax.tracer.ink.partners import (
    SMOOTHLY,
    is_corner,
    likeliest,
    meeting_place,
    partners,
    turnings,
)
from morfax.tracer.ink.run import with_arc
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.sensing.leg import Leg, leg_of

WIDTH_MM = 0.5
NOISE_RAD = math.radians(1.0)  # more than felt legs are off
NO_STATIONS = np.empty((0, 3))


def leg(
    from_deg: float, away_mm: float = 0.8, aside_mm: float = 0.0, bend_per_mm: float = 0.0
) -> Leg:
    """A leg that comes in from a direction, its clean end so far from the origin."""
    outward = math.radians(from_deg)
    way = np.array([math.cos(outward), math.sin(outward)])
    end = away_mm * way + aside_mm * np.array([-way[1], way[0]])
    return Leg(
        end, math.remainder(outward + math.pi, math.tau), bend_per_mm, WIDTH_MM, NO_STATIONS
    )


def paired(legs: list[Leg]) -> set[frozenset[int]]:
    return {frozenset(pair) for pair in partners(turnings(legs, WIDTH_MM))}


@pytest.mark.parametrize("apart_deg", [12.0, 25.0, 60.0])
def test_three_lines_through_one_place(apart_deg: float) -> None:
    turns = [0.0, apart_deg, 2 * apart_deg]
    legs = [leg(turn, 1.5) for turn in turns] + [leg(turn + 180, 1.5) for turn in turns]
    assert paired(legs) == {frozenset({k, k + 3}) for k in range(3)}


def test_a_line_that_ends_on_another_has_no_partner() -> None:
    assert paired([leg(0), leg(90), leg(180)]) == {frozenset({0, 2})}


def test_lines_that_end_on_both_sides_of_another_are_no_line() -> None:
    """They miss each other by more than half a width."""
    legs = [leg(0, 2.0), leg(180, 2.0), leg(90, aside_mm=0.35), leg(-90, aside_mm=0.35)]
    assert paired(legs) == {frozenset({0, 1})}


def test_three_walls_that_meet_are_a_corner_and_an_end() -> None:
    assert len(paired([leg(0), leg(120), leg(240)])) == 1


def test_a_corner_where_another_line_passes_takes_no_partner_from_that() -> None:
    """It turns by 90 degrees, or by 81 onto the other line, which would then bend by 9."""
    legs = [leg(99, 1.5), leg(279, 4.0), leg(180, 1.5), leg(270, 4.0)]
    assert paired(legs) == {frozenset({0, 1}), frozenset({2, 3})}


def test_a_bend_felt_along_a_short_leg_beside_other_ink_exchanges_no_partners() -> None:
    """Two lines cross at 9 degrees; over the chord the bend would turn one of them by 30 degrees."""
    legs = [leg(0, 4.0), leg(180, 4.0, bend_per_mm=0.26), leg(9, 4.0), leg(189, 4.0)]
    assert paired(legs) == {frozenset({0, 1}), frozenset({2, 3})}


@pytest.mark.parametrize(("turned_deg", "partner"), [(4.0, 2), (9.0, 1)])
def test_of_two_ways_on_that_ten_widths_nearer_may_turn_by_some_degrees(
    turned_deg: float, partner: int
) -> None:
    assert paired([leg(180, 1.0), leg(0, 6.0), leg(turned_deg, 1.0)]) == {
        frozenset({0, partner})
    }


def test_bends_are_allowed_for() -> None:
    """Two circles of 5 mm that touch from outside: each goes on round, neither onto the other."""
    bend = 1 / 5.0
    up = 0.1  # where the circles are 1 mm before they touch, from the line between them
    legs = [
        Leg(
            np.array([-1.0, side * up]),
            -side * math.atan(0.2),
            side * bend,
            WIDTH_MM,
            NO_STATIONS,
        )
        for side in (1, -1)
    ]
    legs += [
        Leg(
            np.array([1.0, side * up]),
            math.pi + side * math.atan(0.2),
            -side * bend,
            WIDTH_MM,
            NO_STATIONS,
        )
        for side in (1, -1)
    ]
    assert paired(legs) == {frozenset({0, 2}), frozenset({1, 3})}


def on_circle(centre: float, radius_mm: float, at_deg: float, ahead: int) -> Leg:
    """The leg of 1 rad of a circle that ends at an angle, on the circle's way ahead or back."""
    turned = math.radians(at_deg) - ahead * np.linspace(1.0, 0.0, 20)
    places = np.column_stack([centre + radius_mm * np.cos(turned), radius_mm * np.sin(turned)])
    seen = np.column_stack([places, np.full(20, WIDTH_MM)])
    return with_arc(leg_of(seen, True, 2 * radius_mm))


@pytest.mark.parametrize("half_deg", [60.0, 75.0, 92.0])
def test_a_circle_goes_on_over_half_a_turn(half_deg: float) -> None:
    """In the ink that it shares with one that is larger: the parabolas of its legs bend a quarter too little
    at their ends, and its ways turned by 35 degrees more than these: it had no partner.
    """
    legs = [on_circle(0.0, 2.7, -half_deg, 1), on_circle(0.0, 2.7, half_deg, -1)]
    legs += [on_circle(-3.5, 6.3, -0.6 * half_deg, 1), on_circle(-3.5, 6.3, 0.6 * half_deg, -1)]
    assert legs[0].bend_per_mm < 0.85 / 2.7
    assert [each.arc_per_mm for each in legs[:2]] == pytest.approx(
        [1 / 2.7, -1 / 2.7], rel=0.01
    )
    turned = turnings(legs, WIDTH_MM)
    assert max(turned[0, 1], turned[2, 3]) < SMOOTHLY
    assert paired(legs) == {frozenset({0, 1}), frozenset({2, 3})}
    assert turned_by(legs[0], legs[1].turned_round()) < SMOOTHLY


def test_a_leg_that_is_no_arc_bends_as_its_parabola() -> None:
    """It is straight for 1.5 mm, then turns within another 1.5: no arc tells how it goes on."""
    along = np.linspace(0.0, 3.0, 40)
    aside = 0.3 * np.maximum(along - 1.5, 0.0) ** 2
    bent = leg_of(np.column_stack([along, aside, np.full(40, WIDTH_MM)]), True, 3.0)
    assert bent.bend_per_mm > 0
    assert with_arc(bent).arc_per_mm is None


def test_of_many_lines_each_has_its_own_partner() -> None:
    """Six lines through one place. One leg is off by so much that it is straighter on from its neighbour's
    partner: taken first, that pair would leave two legs that are no line.
    """
    turns = [0.0, 12.0, 45.0, 80.0, 115.0, 150.0]
    legs = [leg(turn, 1.5) for turn in turns] + [leg(turn + 180, 1.5) for turn in turns]
    assert paired(legs) == {frozenset({k, k + 6}) for k in range(6)}
    legs[1], legs[6] = leg(6.0, 1.5), leg(186.5, 1.5)
    assert paired(legs) == {frozenset({k, k + 6}) for k in range(6)}


def test_the_meeting_place_is_nearest_to_all_lines() -> None:
    assert meeting_place([leg(10), leg(100), leg(250)]) == pytest.approx([0, 0], abs=1e-9)


@pytest.mark.parametrize(("away_mm", "is_felt", "is_vertex"), [(1, 1, 1), (4, 1, 0), (4, 0, 1)])
def test_a_vertex_far_within_shared_ink_is_told_by_no_leg(
    away_mm: float, is_felt: bool, is_vertex: bool
) -> None:
    """Eight widths beyond both legs a bend of 17 degrees was laid as a vertex, 0.28 mm beside its line."""
    corner = Corner.of(leg(180, away_mm), leg(24, away_mm).turned_round())
    assert corner is not None
    assert is_corner(corner, WIDTH_MM, is_felt=bool(is_felt)) == bool(is_vertex)


def _costs(legs: int, turned_deg: dict[tuple[int, int], float]) -> Array:
    """By how much each leg turns onto each other, rad; all that is not given are no line."""
    costs = np.full((legs, legs), math.inf)
    for (a, b), deg in turned_deg.items():
        costs[a, b] = costs[b, a] = math.radians(deg)
    return costs


def test_of_many_legs_all_ways_to_pair_them_are_held_against_each_other() -> None:
    """The straightest pair leaves three legs alone, and no exchange of two partners helps: all three turn."""
    through = {(k, k + 4): 3.0 for k in range(4)}
    costs = _costs(13, through | {(8, 9): 19.0, (8, 10): 122.0, (9, 11): 24.0})
    first, second = likeliest(costs, 2)
    assert set(first) == {*through, (8, 10), (9, 11)}
    assert set(second) == {*through, (8, 9)}
