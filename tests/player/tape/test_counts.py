"""Counts that tracks tell, against places of known motions: what is right, what is off, and when."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.player.tape.counts import Counts, Due
from morfax.recorder.tape.check_frame import CheckFrame

GRAIN = 1 / 64  # cycle, of version 3
TURN = 2.0**20 / 64  # cycles, after which counts of 20 bits begin again


def counted(
    cycles: float,
    speed: float = 0.0,
    error: float = 0.0,
    *,
    is_timed: bool = True,
    version: int = 3,
) -> tuple[Counts, Due]:
    """Counts of one axis whose zero is known, and what it tells at row 100."""
    counts = Counts(1, 6000.0, is_timed=is_timed)
    counts.zero_cycles[0] = 1000.25
    counts.begin(100.0, 1540.0)
    said = CheckFrame(1, 7, cycles, speed, version=version, middle_cycles=0.75)
    counts.tell(0, said, error / 6000.0)
    due = counts.due(0, 200)
    assert due is not None
    return counts, due


@pytest.mark.parametrize(
    ("beside", "is_right"),
    [(0.0, True), (0.0155, True), (-0.0155, True), (0.016, False), (-0.016, False)],
)
def test_an_axis_at_rest_is_right_within_half_a_count_and_the_least_noise(
    beside: float, is_right: bool
) -> None:
    """1/128 and 0.008 cycle: 0.0158."""
    counts, due = counted(3.5)
    off = counts.off(0, 1003.75 + beside, due)
    assert off.is_right == is_right and off.cycles == pytest.approx(beside)


def test_noise_speed_and_a_reference_without_time_widen_what_is_right() -> None:
    def limit(**said: float) -> float:
        counts, due = counted(0.0, **said)
        return counts.off(0, 1000.25, due).limit_cycles

    assert limit() == pytest.approx(GRAIN / 2 + 0.008)
    assert limit(error=0.002) == pytest.approx(GRAIN / 2 + 0.008 + 3 * 0.002)
    assert limit(error=0.1) == pytest.approx(GRAIN / 2 + 0.02)
    # at 1000 cycles/s (50 mm/s) 15 us are 0.015 cycle
    assert limit(speed=1000.0) == pytest.approx(GRAIN / 2 + 0.008 + 0.015)
    assert limit(version=1) == pytest.approx(1 / 32 + 0.008)
    assert limit(is_timed=False) == 0.25


@pytest.mark.parametrize("turns", [-2, 0, 1])
def test_counts_begin_again_after_so_many_cycles(turns: int) -> None:
    counts, due = counted(3.5)
    assert counts.off(0, 1003.75 + turns * TURN, due).cycles == pytest.approx(0.0)
    assert counts.off(0, 1003.75 + (turns + 0.25) * TURN, due).cycles == pytest.approx(TURN / 4)


def test_the_middle_of_a_frame_is_told_modulo_a_cycle() -> None:
    counts, _ = counted(3.5)
    assert counts.due(200, 1000) is None
    middle = counts.due(1400, 200)
    assert middle is not None and middle.is_middle and middle.row == 1540.0
    assert counts.off(0, 1000.25 + 5.75, middle).cycles == pytest.approx(0.0)
    assert counts.off(0, 1000.25 + 5.85, middle).cycles == pytest.approx(0.1)


def test_a_reference_without_time_tells_no_middle() -> None:
    counts, _ = counted(3.5, is_timed=False)
    middle = counts.due(1400, 200)
    assert middle is not None and not middle.told


def test_what_is_told_is_due_when_its_row_has_come_and_in_order() -> None:
    counts = Counts(1, 6000.0, is_timed=True)
    counts.zero_cycles[0] = 0.0
    counts.begin(99.5, 1540.0)
    assert counts.due(0, 0) is None and counts.due(0, 100) is None
    due = counts.due(0, 101)  # its last row is 100
    assert due is not None and due.row == 99.5
    assert counts.due(0, 101) is None


def test_until_a_zero_is_known_only_a_frame_s_start_that_lies_ahead_gives_one() -> None:
    """A tape that is taken up under way: the frame that has begun before tells nothing."""
    counts = Counts(1, 6000.0, is_timed=True)
    counts.begin(100.0, 1540.0)
    counts.begin(2980.0, 4420.0)
    counts.tell(0, CheckFrame(1, 8, 4.0), 0.0)
    due = counts.due(500, 3000)
    assert due is not None and due.row == 2980.0
    assert math.isnan(counts.zero_cycles[0])
    assert counts.off(0, 250.5, due).cycles == 0.0
    assert counts.zero_cycles[0] == 246.5
    assert np.isfinite(counts.zero_cycles).all()
