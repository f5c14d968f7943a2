"""How far any motion within a bound may lie off what was laid over a gap, with ends that need no parabola."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound, GapEdge, bridge, side
from morfax.player.tape.gap import Gap
from morfax.player.tape.motion_edges import END_ROWS, furthest

MOST = 10_000 / 6000**2  # cycles/row²: 0.5 m/s² at 20 cycles per mm
SIDE, GAP = 36, 42  # rows: 6 ms, and 7 ms that a dropout of 5 ms costs
SURE = 1e-9  # cycle: rounding


def way(random: np.random.Generator, rows: int) -> np.ndarray:
    """A motion that keeps to MOST and changes its acceleration up to six times."""
    turns = np.sort(random.integers(1, rows, random.integers(1, 7)))
    each = MOST * random.choice([-1.0, -1.0, 0.0, 1.0, 1.0], len(turns) + 1)
    bends = each[np.searchsorted(turns, np.arange(rows))]
    return np.asarray(np.cumsum(random.uniform(-0.03, 0.03) + np.cumsum(bends)))


def across(cycles: np.ndarray) -> tuple[Gap, float]:
    """The gap in the middle of a way, laid from sides of 6 ms, and the furthest that it may be off."""
    a, b = SIDE, SIDE + GAP
    before, after = side(cycles[:a], a - 1), side(cycles[b:], 0)
    found = bridge(before, after, GAP + 1, MOST)
    gap = Gap(0, a, b, before, after, found, Bound(MOST, 1.0))
    sides = (cycles[a - END_ROWS : a], cycles[b : b + END_ROWS])
    return gap, furthest(sides, gap.laid(), (MOST, 1.0), 0.0)


@pytest.mark.parametrize("seed", range(200))
def test_no_motion_within_the_bound_lies_further_off(seed: int) -> None:
    cycles = way(np.random.default_rng(seed), 2 * SIDE + GAP)
    gap, most = across(cycles)
    assert np.abs(gap.laid() - cycles[SIDE : SIDE + GAP]).max() <= most + SURE


def test_it_is_a_swing_of_the_whole_acceleration_and_little_more() -> None:
    """At rest on both sides: A T² / 16 of the gap with its ends, and what these may be off themselves."""
    span = GAP + END_ROWS
    swing = MOST * span**2 / 16
    ends = MOST * END_ROWS**2 / 24 + MOST * END_ROWS * 3 / 16 * span / 4
    most = across(np.zeros(2 * SIDE + GAP))[1]
    assert swing + ends / 2 < most < swing + 2 * ends


def test_a_gap_is_known_by_it_only_where_its_sides_are_as_smooth_as_the_tape() -> None:
    still = GapEdge(0.0, 0.0, 0.0, 0.004)
    found = replace(bridge(still, still, GAP + 1, MOST), between=0.06, misfit=0.004)
    gap = Gap(0, SIDE, SIDE + GAP, still, still, found, Bound(MOST, 1.0), noise=0.005)
    assert not gap.certain
    near = replace(gap, furthest=0.04)
    assert near.certain
    assert near.moved(3.0).certain  # the whole tape counted on
    assert not near.ending(1.0).certain  # another count behind it: another way
    assert not replace(near, noise=0.003).certain
    assert not replace(near, furthest=0.06).certain
