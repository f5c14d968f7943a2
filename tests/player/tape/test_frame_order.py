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


def calm_report(number: int, delay_us: float, *, is_last: bool = False) -> FrameReport:
    """A frame of four tracks of which axis X is late by so much."""
    said = tuple(CheckFrame(track, number, 0.0, last=is_last) for track in range(4))
    delays = [[0.0] * 4, [delay_us * US] * 4, [0.0] * 4, [0.0] * 4]
    whole = (number, 2880.0 * number, 2880.0 * number + 1440, [0.0] * 4, said, [0.0] * 4)
    return FrameReport(*whole, delays, [0.0] * 4, [0.0] * 4, (), [[]] * 4, abs(delay_us) <= 0.5)


@pytest.mark.parametrize("first_us", [0.3, 9.0, 20.0])
def test_a_calm_frame_is_taken_as_any_other(first_us: float) -> None:
    """Behind a frame that is late by 20 us it is a step; a lost frame, and the end, show as well."""
    for told in (
        [calm_report(3, first_us), calm_report(4, 0.2), calm_report(5, 0.1, is_last=True)],
        [calm_report(3, first_us), calm_report(5, 0.2)],
        [calm_report(3, 0.2), calm_report(4, first_us), calm_report(5, 0.1)],
        [calm_report(3, 0.2), calm_report(5, 0.2)],
    ):
        quick, slow = FrameOrder(TapeFormat()), FrameOrder(TapeFormat())
        for report in told:
            fault, other = quick.fault(report), slow.fault(report._replace(is_calm=False))
            assert str(fault) == str(other)
            assert quick.ended == slow.ended == report.said[0].last
            if fault is not None:
                break
        assert (fault is not None) == (first_us == 20.0 or len(told) == 2)
