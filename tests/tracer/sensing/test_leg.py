"""Legs: one place of a leg is that of many, to the bit, and where two legs meet."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.tracer.sensing.leg import Leg, meet

UM = 1e-3  # mm
NOTHING = np.empty((0, 3))


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
