"""Bridges: which sides of a gap are those of one motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound, Bridge, GapEdge, bridge, filled, turned
from morfax.player.tape.gap import Gap

MOST = 1e-4  # cycles/row², 0.18 m/s²
NOISE = 0.005  # six standard deviations of a row of a quiet tape, cycles


def gap_of(places: np.ndarray, speeds: np.ndarray, beside: float = 0.0) -> Gap:
    """The gap between the first and the last of some rows, its second side so far beside its place."""
    rows = len(places) - 1
    before = GapEdge(float(places[0]), float(speeds[0]), 0.0, 0.0)
    after = GapEdge(float(places[-1]) + beside, float(speeds[-1]), 0.0, 0.0)
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


def motion_of(times: np.ndarray, accelerations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Speeds and places of a motion by its accelerations at many even times, from rest at 0."""
    step = times[1] - times[0]
    speeds = np.r_[0.0, np.cumsum((accelerations[1:] + accelerations[:-1]) / 2) * step]
    return speeds, np.r_[0.0, np.cumsum((speeds[1:] + speeds[:-1]) / 2) * step]


@pytest.mark.parametrize("lost", [0, 2, -3])
@pytest.mark.parametrize("rows", [1, 12, 40])
def test_a_motion_of_even_jerk_is_bridged_exactly_whatever_cycles_were_lost(
    rows: int, lost: int
) -> None:
    """p = 3 + 0.05 t - 2e-4 t² + 6e-6 t³: its acceleration changes evenly."""
    place = np.polynomial.Polynomial([3.0, 0.05, -2e-4, 6e-6])
    speed, acceleration = place.deriv(), place.deriv(2)
    before = GapEdge(float(place(0)), float(speed(0)), float(acceleration(0)) / 2, 0.001)
    after = GapEdge(
        float(place(rows)) + lost, float(speed(rows)), float(acceleration(rows)) / 2, 0.002
    )
    found = bridge(before, after, rows, 0.0)
    assert found.travel == pytest.approx(place(rows) - place(0), abs=1e-12)
    assert found.off == pytest.approx(0.0, abs=1e-12) and found.misfit == 0.002
    assert max(found.reach, found.between) < 1e-12


def test_how_far_a_motion_may_lie_off_is_what_its_acceleration_and_a_jump_of_speed_allow() -> (
    None
):
    """A T² / 4 and dv T / 2; in the way between half of what is off and dv T / 8."""
    before, after = GapEdge(0.0, 0.01, 0.0, 0.0), GapEdge(0.32, 0.014, 0.0, 0.0)
    found = bridge(before, after, 20, 1e-3)
    # 0.24 of travel, 0.08 off
    assert found.travel == pytest.approx(0.32) and found.off == pytest.approx(0.08)
    assert found.reach == pytest.approx(1e-3 * 400 / 4 + 0.004 * 20 / 2)
    assert found.between == pytest.approx(0.08 / 2 + 0.004 * 20 / 8)


@pytest.mark.parametrize(("reach", "counted"), [(0.69, True), (0.71, False)])
def test_a_count_is_certain_where_no_other_whole_number_is_possible(
    reach: float, counted: bool
) -> None:
    """Off by 0.2 and a tenth of a cycle for noise, 0.7 is left."""
    for off in (0.2, -0.2):
        assert Bridge(0.0, off, reach, 0.0, 0.0).counted == counted


@pytest.mark.parametrize("turn", [3, 10, 17])
def test_a_motion_that_changes_its_acceleration_once_is_laid_where_it_changes(
    turn: int,
) -> None:
    """From 4e-4 to -2e-4 cycles/row² at a row of a gap of 20."""
    first, last, rows = 4e-4, -2e-4, 20
    times = np.linspace(0, rows, 20_001)
    speeds, places = motion_of(times, np.where(times < turn, first, last))
    before = GapEdge(5.0, 0.02, first / 2, 0.0)
    end = 5.0 + 0.02 * rows + places[-1]
    after = GapEdge(end + 1, 0.02 + speeds[-1], last / 2, 0.003)
    found = turned(before, after, rows, 1e-3)
    assert found is not None and found.turn == pytest.approx(turn, abs=1e-2)
    assert found.travel == pytest.approx(end - 5.0, abs=1e-5)
    assert found.reach == pytest.approx(1e-3 * rows**2 / 4) and found.misfit == 0.003
    gap = Gap(
        0, 100, 100 + rows - 1, before, replace(after, place=end), found, Bound(MOST, 1.0)
    )
    true = 5.0 + 0.02 * times + places
    assert gap.laid() == pytest.approx(true[1000:-1000:1000], abs=1e-4)


def test_sides_of_one_acceleration_or_of_a_change_outside_of_the_gap_say_nothing_of_a_turn() -> (
    None
):
    before = GapEdge(0.0, 0.02, 2e-4, 0.0)
    assert turned(before, GapEdge(0.5, 0.028, 2e-4, 0.0), 20, 1e-3) is None
    # from 4e-4 to -2e-4: 0.008 more speed after 20 rows is a change at the last; 4 rows further on it is none
    for gained, is_told in (
        (0.008, True),
        (0.008 + 6e-4 * 2.9, True),
        (0.008 + 6e-4 * 3.1, False),
    ):
        after = GapEdge(0.02 * 20 + 0.08, 0.02 + gained, -1e-4, 0.0)
        assert (turned(before, after, 20, 1e-3) is not None) == is_told
    for gained, is_told in ((-0.004 - 6e-4 * 2.9, True), (-0.004 - 6e-4 * 3.1, False)):
        after = GapEdge(0.02 * 20 - 0.04, 0.02 + gained, -1e-4, 0.0)
        assert (turned(before, after, 20, 1e-3) is not None) == is_told


@pytest.mark.parametrize(
    ("beside", "agrees"), [(0.045, True), (0.055, False), (-0.045, True), (-0.055, False)]
)
def test_a_turn_counts_only_where_what_was_measured_agrees_with_it(
    beside: float, agrees: bool
) -> None:
    """By half of what is off against a fortieth of a cycle; whole cycles apart."""
    before, after = GapEdge(0.0, 0.02, 2e-4, 0.0), GapEdge(0.0, 0.023, -1e-4, 0.0)
    first, last, rows = 4e-4, -2e-4, 20
    turn = (0.003 - last * rows) / (first - last)
    travel = 0.4 + first * turn * (rows - turn / 2) + last * (rows - turn) ** 2 / 2
    after = replace(after, place=travel + 2 + beside)
    assert (turned(before, after, rows, 1e-3) is not None) == agrees


def test_the_rows_within_have_the_place_and_the_speed_of_both_sides() -> None:
    before, after = GapEdge(1.0, 0.05, 0.0, 0.0), GapEdge(2.0, -0.02, 0.0, 0.0)
    whole = np.r_[1.0, filled(before, after, 1.0, 1000), 2.0]
    steps = np.diff(whole)
    assert steps[0] == pytest.approx(0.05, rel=0.01) and steps[-1] == pytest.approx(
        -0.02, rel=0.05
    )
    assert len(whole) == 1001
    # of the least acceleration, root mean square: its third difference is even
    assert np.ptp(np.diff(whole, 3)) < 1e-12


@pytest.mark.parametrize(("step", "is_foreign"), [(0.079, False), (0.081, True)])
def test_a_side_of_another_level_is_foreign(step: float, is_foreign: bool) -> None:
    speeds = np.full(13, 0.01)
    gap = gap_of(np.cumsum(speeds), speeds)
    assert replace(gap, level_step=step).is_foreign == is_foreign


@pytest.mark.parametrize(("share", "is_foreign"), [(0.98, False), (1.02, True)])
def test_a_speed_that_the_program_cannot_have_gained_is_foreign(
    share: float, is_foreign: bool
) -> None:
    """A tenth more than the bound is let pass, and what noise of a row makes of a speed: 0.26 of it."""
    gained = share * (1.1 * MOST * 20 + 0.26 * NOISE)
    speeds = np.linspace(0.01, 0.01 + gained, 21)
    places = np.r_[0.0, np.cumsum((speeds[1:] + speeds[:-1]) / 2)]
    assert gap_of(places, speeds).is_foreign == is_foreign


def test_gaps_moved_ended_and_joined_keep_what_they_know() -> None:
    speeds = np.full(13, 0.01)
    gap = replace(gap_of(np.cumsum(speeds), speeds), furthest=0.01)
    moved = gap.moved(2.0)
    assert moved.laid() == pytest.approx(gap.laid() + 2.0) and moved.furthest == 0.01
    ended = gap.ending(1.0)
    assert ended.after.place == gap.after.place + 1 and ended.before == gap.before
    assert ended.furthest == np.inf and gap.ending(0.0).furthest == 0.01
    later = replace(gap, first=200, last=230, bound=Bound(3 * MOST, 0.5))
    joined = gap.upto(later)
    assert (joined.first, joined.last, joined.rows) == (gap.first, 230, 131 + gap.first - 100)
    assert joined.bound == Bound(3 * MOST, 1.0) and joined.furthest == np.inf
    assert later.upto(gap).bound == Bound(3 * MOST, 1.0)
