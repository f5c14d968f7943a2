"""Legs: a place of a leg, what is fitted to stations, and where two legs meet, against known geometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg, centre_at, leg_of, meet, turn
from morfax.tracer.sensing.parabola import BITTEN, OUTLIERS
from tests.tracer.inked import UM, WIDTH_MM, arc

NOTHING = np.empty((0, 3))


def stations(curve: Array, width_mm: float = WIDTH_MM) -> Array:
    """Places as the cells would report them."""
    return np.column_stack([curve, np.full(len(curve), width_mm)])


def straight(end: tuple[float, float], heading_deg: float) -> Leg:
    return Leg(np.array(end, float), math.radians(heading_deg), 0.0, WIDTH_MM, NOTHING)


@pytest.mark.parametrize("seed", range(5))
def test_a_place_of_a_leg_is_the_same_alone_and_among_others(seed: int) -> None:
    chance = np.random.default_rng(seed)
    along_mm = chance.normal(size=50)
    leg = Leg(
        chance.normal(size=2), float(chance.normal()), float(chance.normal()), 0.5, NOTHING
    )
    every = leg.at(along_mm)
    assert all(
        (leg.at(float(s)) == place).all() for s, place in zip(along_mm, every, strict=True)
    )
    assert all(leg.place(s) == tuple(place) for s, place in zip(along_mm, every, strict=True))


def test_two_bent_legs_meet_where_both_have_the_same_place() -> None:
    incoming = Leg(np.array([0.0, 0.0]), 0.1, 0.05, 0.5, NOTHING)
    outgoing = Leg(np.array([3.0, 2.5]), math.radians(80), -0.04, 0.5, NOTHING)
    met = meet(incoming, outgoing)
    assert met is not None
    beyond_mm, before_mm = met
    away = incoming.at(beyond_mm) - outgoing.at(-before_mm)
    assert np.hypot(*away) < 0.01 * UM and beyond_mm > 0 and before_mm > 0


@given(a=st.floats(-10, 10), b=st.floats(-10, 10))
def test_a_turn_is_the_short_way_round(a: float, b: float) -> None:
    assert -math.pi <= turn(a, b) <= math.pi
    assert math.cos(turn(a, b)) == pytest.approx(math.cos(b - a), abs=1e-12)
    assert math.sin(turn(a, b)) == pytest.approx(math.sin(b - a), abs=1e-12)


@given(heading=st.floats(-3, 3), along_mm=st.floats(-1, 1))
def test_a_leg_that_bends_is_a_circle_to_the_third_order(
    heading: float, along_mm: float
) -> None:
    bend = 0.2
    leg = Leg(np.array([3.0, 4.0]), heading, bend, WIDTH_MM, NOTHING)
    centre = leg.end_mm + np.array([-math.sin(heading), math.cos(heading)]) / bend
    radius = np.hypot(*(leg.at(along_mm) - centre))
    assert radius == pytest.approx(1 / bend, abs=bend**3 * along_mm**4 / 4 + 1e-12)
    assert leg.heading_at(along_mm) == pytest.approx(
        heading + bend * along_mm, abs=abs(bend * along_mm) ** 3 + 1e-12
    )


@pytest.mark.parametrize("last", [False, True])
@pytest.mark.parametrize("bend_per_mm", [0.0, 0.1, -0.3])
def test_a_leg_is_fitted_to_what_was_felt(bend_per_mm: float, last: bool) -> None:
    x = np.arange(0, 1.2, 0.05)
    told = Leg(np.array([5.0, 5.0]), 0.7, bend_per_mm, WIDTH_MM, NOTHING)
    leg = leg_of(stations(told.at(x)), last, 1.2)
    at_end = float((leg.end_mm - told.end_mm) @ [math.cos(0.7), math.sin(0.7)])
    assert at_end > 0.8 if last else at_end < 0.4
    assert leg.end_mm == pytest.approx(told.at(at_end), abs=1 * UM)
    # 2 um over a leg of 1 mm, and a parabola for a circle
    assert leg.heading_rad == pytest.approx(
        told.heading_at(at_end), abs=2e-3 + 0.2 * abs(bend_per_mm) ** 3
    )
    assert leg.bend_per_mm == pytest.approx(bend_per_mm, abs=0.02 + 0.05 * abs(bend_per_mm))


def test_noise_bends_no_straight_leg() -> None:
    random = np.random.default_rng(3)
    bends = []
    for _ in range(20):
        seen = stations(
            np.column_stack([np.arange(0, 1.2, 0.05), random.normal(5, 4 * UM, 24)])
        )
        bends.append(leg_of(seen, True, 1.2).bend_per_mm)
    assert np.mean(np.array(bends) == 0) > 0.9  # a bend must stand out fivefold


def test_the_centre_of_what_was_felt_is_averaged() -> None:
    circle = arc((0, 0), 5, 0, 60)
    random = np.random.default_rng(1)
    seen = stations(
        circle[:: max(1, len(circle) // 100)]
        + random.normal(0, 4 * UM, (len(circle[:: max(1, len(circle) // 100)]), 2))
    )
    leg = centre_at(seen, len(seen) // 2, 0.7)
    assert np.hypot(*leg.end_mm) == pytest.approx(5, abs=3 * UM)  # of 4 um, 27 stations
    tangent = math.atan2(leg.end_mm[1], leg.end_mm[0]) + math.pi / 2
    assert abs(turn(leg.heading_rad, tangent)) < 5e-3  # 4 um over 1.4 mm


@pytest.mark.parametrize("widths_off", [0.01, 0.2])
def test_the_centre_of_what_was_felt_is_a_weighted_parabola(widths_off: float) -> None:
    """1 - (x/h)² towards the middle, and less where the width is off by more than is usual: three robust
    standard deviations, a fifteenth of the width at the least.
    """
    chance = np.random.default_rng(6)
    x = np.arange(-1.0, 1.0, 0.05)
    seen = stations(np.column_stack([x, 0.1 * x**3 + chance.normal(0, 5 * UM, len(x))]))
    seen[:, 2] *= 1 + widths_off * chance.normal(size=len(x))
    i, half_mm = 22, 0.7
    near = np.hypot(*(seen[:, :2] - seen[i, :2]).T) < half_mm
    d = seen[near, :2] - seen[i, :2]
    heading = math.atan2(*(d[-1] - d[0])[::-1])
    t, n = (
        np.array([math.cos(heading), math.sin(heading)]),
        np.array([-math.sin(heading), math.cos(heading)]),
    )
    off = np.abs(seen[near, 2] / np.median(seen[near, 2]) - 1)
    usual = max(OUTLIERS * 1.4826 * float(np.median(off)), BITTEN)
    weights = np.maximum(1 - (d @ t / half_mm) ** 2, 0.05) / (1 + (off / usual) ** 4)
    bend, slope, offset = np.polyfit(d @ t, d @ n, 2, w=np.sqrt(weights))
    leg = centre_at(seen, i, half_mm)
    assert leg.end_mm == pytest.approx(seen[i, :2] + offset * n, abs=1e-9)
    assert leg.heading_rad == pytest.approx(heading + math.atan(slope), abs=1e-9)
    assert leg.bend_per_mm == pytest.approx(2 * bend / (1 + slope**2) ** 1.5, abs=1e-8)


@pytest.mark.parametrize("deflection_deg", [30.0, 60.0, 90.0, 144.0, -90.0])
def test_legs_meet_at_their_vertex(deflection_deg: float) -> None:
    a = math.radians(deflection_deg)
    incoming = straight((-0.6, 0), 0)
    outgoing = straight((0.8 * math.cos(a), 0.8 * math.sin(a)), deflection_deg)
    assert meet(incoming, outgoing) == pytest.approx((0.6, 0.8), abs=1e-9)


def test_legs_that_bend_meet_where_their_curves_cross() -> None:
    """Two circles of 5 mm about (0, 5) and (5, 0), both through the origin, at right angles."""
    incoming = Leg(
        5 * np.array([-math.sin(0.1), 1 - math.cos(0.1)]), -0.1, 0.2, WIDTH_MM, NOTHING
    )
    outgoing = Leg(
        5 * np.array([1 - math.cos(0.1), math.sin(0.1)]),
        math.pi / 2 - 0.1,
        -0.2,
        WIDTH_MM,
        NOTHING,
    )
    met = meet(incoming, outgoing)
    assert met is not None
    assert incoming.at(met[0]) == pytest.approx(
        np.zeros(2), abs=1 * UM
    )  # a parabola for a circle over 0.5 mm
    assert outgoing.at(-met[1]) == pytest.approx(np.zeros(2), abs=1 * UM)


@pytest.mark.parametrize(("away_mm", "do"), [(9.9, True), (10.1, False)])
def test_legs_that_would_meet_more_than_a_centimetre_away_do_not_meet(
    away_mm: float, do: bool
) -> None:
    """Ahead of the incoming leg, behind it, and before the outgoing one."""
    incoming = straight((0, 0), 0)
    assert (meet(incoming, straight((away_mm, 1), 90)) is not None) is do
    assert (meet(incoming, straight((-away_mm, 1), 90)) is not None) is do
    assert (meet(incoming, straight((1, away_mm), 90)) is not None) is do


def test_legs_in_line_do_not_meet() -> None:
    assert meet(straight((0, 0), 0), straight((2, 0), 0.5)) is None
    assert meet(straight((0, 0), 0), straight((2, 0.3), 0)) is None
