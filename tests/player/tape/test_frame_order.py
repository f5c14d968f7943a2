"""Frame order: swings of the delays, and those of a clock that was lost."""

from __future__ import annotations

import math

import pytest

from morfax.player.tape.frame_order import FrameOrder
from morfax.player.tape.frame_report import FrameReport
from morfax.recorder.tape.check_frame import CheckFrame
from morfax.recorder.tape.format import TapeFormat

US = 1e-6


def report(swings_us: tuple[float, ...], *, reference_lost: bool) -> FrameReport:
    """A frame of four tracks whose delays swing by so much, RMS."""
    said = tuple(
        None if reference_lost and not track else CheckFrame(track, 47, 0.0)
        for track in range(4)
    )
    nothing = [[math.nan] * 4] * 4
    return FrameReport(
        47,
        135_360.0,
        136_800.0,
        [0.0] * 4,
        said,
        [0.0] * 4,
        nothing if reference_lost else [[0.0] * 4] * 4,
        [0.0] * 4,
        [swing * US for swing in swings_us],
        (),
        [[1.0], [], [], []] if reference_lost else [[]] * 4,
    )


@pytest.mark.parametrize(
    ("swings_us", "reference_lost", "is_fault"),
    [
        ((0.0, 1.0, 1.0, 1.0), False, False),
        ((0.0, 9.4, 9.5, 9.4), False, True),
        ((0.0, 9.4, 9.5, 9.4), True, False),  # behind a dropout of the reference of 0.5 s
        ((0.0, 9.4, 15.0, 9.4), True, True),
    ],
)
def test_what_all_tracks_swing_alike_while_the_clock_is_lost_is_the_clocks(
    swings_us: tuple[float, ...], reference_lost: bool, is_fault: bool
) -> None:
    fault = FrameOrder(TapeFormat()).fault(report(swings_us, reference_lost=reference_lost))
    assert (fault is not None) == is_fault
    assert fault is None or "swings by" in str(fault)
