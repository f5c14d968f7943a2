"""What the tracks tell of the axes: how late each is, and the most that the program asks of it.

Signals in: the reports of the check reader, frame by frame, or calm frames all at once. Signals out: the
delay of each axis and its bounds; where an axis is at a row that is held, without its delay.

Source: our own. Questions: none.
"""

from __future__ import annotations

from morfax.motion.arrays import between
from morfax.player.tape.calm_frames import CalmFrames
from morfax.player.tape.delays import Delay
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.held_rows import HeldRows
from morfax.player.tape.told_bounds import ToldBounds
from morfax.recorder.tape.check_signal import CYCLES_PER_FRAME
from morfax.recorder.tape.format import TapeFormat


class ToldAxes:
    """Delays and bounds of the axes of one tape."""

    def __init__(self, fmt: TapeFormat) -> None:
        frame_s = CYCLES_PER_FRAME / fmt.reference_hz
        self.delays = [Delay(fmt.reference_hz, fmt.motion_rate_hz) for _ in fmt.axes]
        self.bounds = [ToldBounds(fmt.motion_rate_hz, frame_s) for _ in fmt.axes]

    @property
    def moves(self) -> bool:
        """Whether any axis has a delay that is taken out."""
        return any([delay.moves for delay in self.delays])

    @property
    def settled_row(self) -> float:
        """The row up to which all delays are known."""
        return min(delay.settled_row for delay in self.delays)

    def add(self, axis: int, report: FrameReport) -> float:
        """Take what the track of an axis tells in a frame; how far its delays swing, s, as `Delay.off_s`."""
        self.bounds[axis].add(report, axis + 1)
        delay, delays_s = self.delays[axis], report.delay_s[axis + 1]
        errors_s = [report.error_s[axis + 1]]
        delay.add(report.part_rows, delays_s, errors_s, is_calm=report.is_calm)
        return delay.off_s()

    def take(self, frames: CalmFrames) -> None:
        """Take what the tracks tell in calm frames."""
        rows, errors_s = frames.part_rows, frames.figures[:, 1:, -2].T.tolist()
        for axis, delay in enumerate(self.delays):
            self.bounds[axis].take(frames.spans[:, axis].tolist())
            delay.add(rows, frames.delays_s(axis + 1), errors_s[axis], is_calm=True)

    def places(self, held: HeldRows, row: float) -> list[float]:
        """Where the axes are at a row that is held, cycles, without the delays of their tracks."""
        places = held.places(row - held.first_row)
        for axis, delay in enumerate(self.delays):
            if delay.moves:
                at = max(int(row) - held.first_row, 0)
                first, last = max(at - 2 * delay.span, 0), at + 2 * delay.span + 1
                near = delay.corrected(held.axis(axis, first, last), held.first_row + first)
                places[axis] = between(near, row - held.first_row - first)
        return places
