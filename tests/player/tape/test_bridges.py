"""Bridges: which sides of a gap are those of one motion."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound, Gap, Side, bridge

MOST = 1e-4  # cycles/row², 0.18 m/s²
NOISE = 0.005  # six standard deviations of a row of a quiet tape, cycles


def gap_of(places: np.ndarray, speeds: np.ndarray, beside: float = 0.0) -> Gap:
    """The gap between the first and the last of some rows, its second side so far beside its place."""
    rows = len(places) - 1
    before = Side(float(places[0]), float(speeds[0]), 0.0, 0.0)
    after = Side(float(places[-1]) + beside, float(speeds[-1]), 0.0, 0.0)
    found = bridge(before, after, rows, MOST)
    return Gap(0, 100, 100 + rows - 1, before, after, found, Bound(MOST, 1.0), noise=NOISE)


def motion(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and speeds of a motion that turns its whole acceleration over at random rows."""
    random = np.random.default_rng(seed)
    rows, hold = int(random.integers(8, 200)), int(random.integers(1, 60))
    turns = random.choice([-MOST, MOST], -(-rows // hold))
    acceleration = np.repeat(turns, hold)[:rows]
    speeds = np.concatenate([[0.0], np.cumsum(acceleration)]) + random.normal(0, 0.05)
    places = np.concatenate([[0.0], np.cumsum((speeds[1:] + speeds[:-1]) / 2)])
    return places, speeds


@pytest.mark.parametrize("seed", range(40))
def test_no_side_of_a_motion_within_the_bound_is_foreign(seed: int) -> None:
    assert not gap_of(*motion(seed)).is_foreign


@pytest.mark.parametrize("beside", [-0.3, -0.06, 0.06, 0.3])
def test_a_side_at_a_place_not_reached_from_the_other_is_foreign(beside: float) -> None:
    """As fast on both sides, over 2 ms: that was known, however far beside the second was.

    (Fails without `far` in `Gap.is_foreign`.)
    """
    speeds = np.full(13, 0.01)
    gap = gap_of(np.cumsum(speeds), speeds, beside)
    assert gap.is_foreign and not gap.certain
