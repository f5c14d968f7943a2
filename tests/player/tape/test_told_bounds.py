"""Told bounds: which frames tell the most that an axis is asked for between two rows."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.symbols import PARTS
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.check_frame import CheckFrame

RATE_HZ, FRAME_S = 6000.0, 0.48
ROWS = RATE_HZ * FRAME_S  # of a frame: 2880


def report(row: float, said: CheckFrame | None, rows: float = ROWS) -> FrameReport:
    """A frame that begins at a row and takes so many, by the middles of its parts."""
    parts = [row + rows * (k + 0.5) / PARTS for k in range(PARTS)]
    return FrameReport(0, row, row + rows / 2, parts, (None, said), [], [], [], [], (), [])


def told(*frames: tuple[float, float] | None, fast: float = 1.0) -> ToldBounds:
    """An axis whose frames, one behind the other, tell speeds and accelerations, cycles/s and /s²."""
    bounds = ToldBounds(RATE_HZ, FRAME_S)
    for k, says in enumerate(frames):
        said = None if says is None else CheckFrame(1, k, 0.0, says[0], says[1])
        bounds.add(report(k * ROWS / fast, said, ROWS / fast), 1)
    return bounds


def test_a_frame_tells_of_itself_and_of_the_next() -> None:
    bound = told((600.0, 36_000.0)).between(0, 5760)
    assert bound is not None and bound.speed == pytest.approx(0.1)
    # flutter of 0.5 % at 10 Hz changes 600 cycles/s by 180 in a second
    assert bound.acceleration == pytest.approx((36_000 + 180) / RATE_HZ**2)
    assert told((600.0, 36_000.0)).between(0, 5761) is None
    assert told((600.0, 36_000.0)).between(-1, 100) is None


@pytest.mark.parametrize("fast", [0.98, 1.02])
def test_a_tape_that_runs_fast_makes_speeds_greater_and_accelerations_twice(
    fast: float,
) -> None:
    bound = told((600.0, 36_000.0), fast=fast).between(0, 100)
    assert bound is not None and bound.speed == pytest.approx(0.1 * fast)
    assert bound.acceleration == pytest.approx((36_000 * fast**2 + 180) / RATE_HZ**2)


def test_of_several_frames_the_largest_counts_and_a_missing_one_parts_them() -> None:
    slow, quick = (60.0, 3600.0), (600.0, 360.0)
    both = told(slow, quick).between(1000, 8000)
    assert both is not None and both.speed == pytest.approx(0.1)
    assert both.acceleration == pytest.approx((3600 + 18) / RATE_HZ**2)
    first = told(slow, quick).between(0, 2880)
    assert first is not None and first.speed == pytest.approx(0.01)
    # each frame tells of two: one that is missing parts nothing, two in a row do
    assert told(slow, None, slow).between(0, 11_000) is not None
    assert told(slow, None, None, slow).between(0, 11_000) is None
    # an infinite speed is more than a frame can tell
    assert told((float("inf"), 1.0)).between(0, 100) is None


def test_it_keeps_the_last_eight_frames() -> None:
    bounds = told(*[(60.0 * k, 0.0) for k in range(1, 11)])
    assert bounds.between(0, 100) is None and bounds.between(round(2 * ROWS), 8000) is not None
    assert bounds.largest == pytest.approx(0.3 * 600 / RATE_HZ**2)
    assert ToldBounds(RATE_HZ, FRAME_S).largest == 0.0


def test_an_axis_rests_where_frames_say_so_and_only_there() -> None:
    bounds = told((0.0, 0.0), (60.0, 0.0))
    assert (
        bounds.rests(0, 5000) and not bounds.rests(5000, 7000) and not bounds.rests(0, 20_000)
    )


def test_around_a_gap_the_frames_before_and_behind_tell_what_is_likely() -> None:
    """None has reached over it: the frames of rows 2880 to 8640 are lost."""
    bounds = told((60.0, 0.0), None, None, (600.0, 0.0))
    likely = bounds.around(6000, 8000)
    assert likely is not None and likely.speed == pytest.approx(0.1)
    assert likely.acceleration == pytest.approx(0.3 * 600 / RATE_HZ**2)
    assert bounds.around(-5, 0) is None and bounds.around(9000, 9100) is None


@pytest.mark.parametrize("first", [0, 1000, 5000])
def test_row_by_row_it_tells_the_same_as_between_two_rows(first: int) -> None:
    bounds = told((60.0, 720.0), (600.0, 36.0), None, None, (30.0, 36_000.0))
    filled = np.empty((2, 9000))
    bounds.tell(first, filled)
    for row in range(0, 9000, 617):
        bound: Bound | None = bounds.between(first + row, first + row + 1)
        if bound is None:
            assert np.isnan(filled[:, row]).all()
        else:
            assert filled[0, row] >= bound.acceleration > 0
            assert filled[1, row] >= bound.speed > 0
    nothing = np.empty((2, 10))
    ToldBounds(RATE_HZ, FRAME_S).tell(0, nothing)
    assert np.isnan(nothing).all()
