"""Frame order: whether each track's frames of the check signal are its own, follow one another, and are not
late.

Signals in: the reports of the check reader, frame by frame. Signals out: nothing, or a fault.

    identity    each track says which it is                      another order: a fault
    number      frames follow one another, at their time         a lost or repeated stretch: a fault
    late        symbols lie within 0.25 ms of the clock          the same, where it is less than a frame
    delay       of a track against the reference                 above 200 us, or a step: a fault
    swing       of a delay within a quarter of a frame           above 4 us, RMS: a fault
    damaged     a frame whose level is right cannot be read      the track is not what was recorded: a fault
    missing     four frames in a row of one track                one more: a fault

Source: our own. Questions: a delay that drifts by 50 us/s moves 12 us in two parts of a frame; one lost
sample moves 21. A sample that is lost on all tracks alike moves nothing but the time.
"""

from __future__ import annotations

import math

from morfax.motion.faults import Fault
from morfax.player.tape import check_faults as faults
from morfax.player.tape.calm_frames import CalmFrames
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.symbols import PARTS
from morfax.recorder.tape.check_frame import LAST_AT, NUMBERS, CheckFrame
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME
from morfax.recorder.tape.format import TapeFormat

LARGEST_DELAY_S = 200e-6  # what is asked; half a cycle of the subcarrier is 500
TOLD_WITHIN_S = 1e-6  # a delay of exactly that much is told so true, at 26 dB of noise too
LARGEST_LATE_S = 250e-6  # of the symbols: the delay, and 50 us for the gates
LARGEST_STEP_S = 16e-6  # of a delay in two parts of a frame, 0.24 s: 50 us/s of drift are 12
MOST_MISSING = 4  # frames in a row of one track: 1 s of dropout reaches into four
# RMS, 7 us at most: 0.04 cycle; 26 dB of noise tell up to 1
LARGEST_SWING_S = 4e-6


class FrameOrder:
    """Keeps watch over the frames of one tape."""

    def __init__(self, fmt: TapeFormat) -> None:
        self._names, self._rate_hz = fmt.axes, fmt.motion_rate_hz
        self._frame_s = CYCLES_PER_FRAME / fmt.reference_hz
        self._told: list[list[float]] = [[] for _ in range(fmt.tracks)]  # delays of a frame, s
        self._missing, self._is_last = [0] * fmt.tracks, [False] * fmt.tracks
        self._number: int | None = None  # of the next frame
        self._is_calm = (
            True  # whether the frames so far leave nothing to hold the next one against
        )

    @property
    def ended(self) -> bool:
        """Whether the last frame of every track said that the tape ends."""
        return all(self._is_last)

    def takes(self, frames: CalmFrames) -> bool:
        """Whether calm frames come behind one that was calm; then they are taken, and need no look."""
        if not self._is_calm or self._number not in (None, frames.number):
            return False
        self._number = frames.number + frames.frames
        self._missing = [0] * len(self._told)
        self._told = frames.figures[-1, :, 1:-2].tolist()
        self._is_last = [bool(told >> LAST_AT & 1) for told in frames.told[-1].tolist()]
        return True

    def fault(self, report: FrameReport) -> Fault | None:
        """Take the next frame; the fault of the first track in which it is not as it should be."""
        expected = report.number if self._number is None else self._number
        self._number, self._is_calm = report.number + 1, report.is_calm
        found: Fault | None = None
        for track, said in enumerate(report.said):
            if said is None:
                found = found or self._unreadable(track, report)
                continue
            if report.swing_s[track] > LARGEST_SWING_S:
                found = found or self._swinging(track, report)
            self._missing[track], self._is_last[track] = 0, said.last
            if said.track != track or (said.number - expected) % NUMBERS:
                found = found or self._misplaced(track, said, expected, report)
            found = found or self._too_late(track, report)
            told = report.delay_s[track]
            if math.isfinite(sum(told)):
                self._told[track] = told[-PARTS:]
        return found

    def _unreadable(self, track: int, report: FrameReport) -> Fault | None:
        """The fault of a track that says nothing for too long."""
        self._missing[track] += 1
        damaged = track in report.damaged and 0 not in _weak(report)
        if self._missing[track] <= MOST_MISSING and not damaged:
            return None
        gone = 0 if damaged else MOST_MISSING
        time_s = report.row / self._rate_hz - gone * self._frame_s
        return faults.unreadable(track, self._names, time_s)

    def _swinging(self, track: int, report: FrameReport) -> Fault | None:
        """The fault of a track whose delay swings faster than can be followed.

        While the reference is lost, in a dropout, its clock is counted on, and put right behind: what all
        axes then swing alike is the clock's.
        """
        swing_s = report.swing_s[track]
        if report.said[0] is None or report.weak_rows[0]:
            axes = zip(report.swing_s[1:], report.said[1:], strict=True)
            swing_s -= min((swing for swing, said in axes if said is not None), default=0.0)
        if not swing_s > LARGEST_SWING_S:
            return None
        return faults.swings(track, self._names, swing_s, report.row / self._rate_hz)

    def _misplaced(
        self, track: int, said: CheckFrame, expected: int, report: FrameReport
    ) -> Fault | None:
        """The fault of a track that says to be another, or whose frame is not the next."""
        time_s = report.row / self._rate_hz
        if said.track != track:
            return faults.wrong_track(track, said.track, self._names, time_s)
        off = (said.number - expected + NUMBERS // 2) % NUMBERS - NUMBERS // 2
        if not off:
            return None
        return faults.disordered(track, self._names, off * self._frame_s, time_s)

    def _too_late(self, track: int, report: FrameReport) -> Fault | None:
        """The fault of a track whose delay is too long, or makes a step: samples were lost or repeated."""
        late_s, delays_s = report.late_s[track], report.delay_s[track]
        if not math.isfinite(sum(delays_s)):
            delays_s = [delay for delay in delays_s if math.isfinite(delay)]
        told = self._told[track] + delays_s
        longest_s = max(max(told), -min(told)) if told else 0.0
        time_s = report.row / self._rate_hz
        if abs(late_s) > LARGEST_LATE_S or longest_s > LARGEST_DELAY_S + TOLD_WITHIN_S:
            late_s = late_s if abs(late_s) > LARGEST_LATE_S else longest_s
            return faults.too_late(track, self._names, late_s, LARGEST_DELAY_S, time_s)
        if 2 * longest_s <= LARGEST_STEP_S:
            return None
        step_s = max((abs(b - a) for a, b in zip(told, told[2:], strict=False)), default=0.0)
        if step_s <= LARGEST_STEP_S:
            return None
        return faults.stepped(track, self._names, step_s, time_s)


def _weak(report: FrameReport) -> list[int]:
    """The tracks that say nothing because a dropout took it."""
    silent = [track for track, said in enumerate(report.said) if said is None]
    return [track for track in silent if track not in report.damaged]
