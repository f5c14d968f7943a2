"""Calm frames: frames of the check signal, one behind the other, of which nothing is to be said.

Signals in: what one kernel read of them (quiet_frame.py). Signals out: the same as arrays, for who takes all
at once; or the report of each.

Nearly all frames of a tape are calm: each track is itself, in time, and late by no more than noise is.

Source: our own. Questions: none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.player.tape.frame_report import FrameReport, frame_report
from morfax.recorder.tape.check_frame import said_by


class CalmFrames(NamedTuple):
    """So many frames, `number` is that of the first; of an axis' track as CheckFrame has it.

    `rows` (n, moments): of the tape, at the start, the middle, and the middle of each part; `told` (n,
    tracks): bits; `figures` (n, tracks, times): as `count_on` fills them; `said` (n, axes, 4): cycles, those
    of the middle, speed, acceleration; `spans` (n, axes, 4): as `told_span` has them.
    """

    number: int
    rows: Array
    told: NDArray[np.int64]
    figures: Array
    said: Array
    spans: Array

    @property
    def frames(self) -> int:
        """How many they are."""
        return len(self.told)

    def upto(self, frames: int) -> CalmFrames:
        """The first so many of them."""
        return CalmFrames(
            self.number,
            self.rows[:frames],
            self.told[:frames],
            self.figures[:frames],
            self.said[:frames],
            self.spans[:frames],
        )

    @property
    def part_rows(self) -> list[float]:
        """The rows in the middle of each part, frame by frame."""
        return self.rows[:, 2:].ravel().tolist()

    def delays_s(self, track: int) -> list[float]:
        """The delays of a track in each part, frame by frame, s."""
        return self.figures[:, track, 1:-2].ravel().tolist()

    def report(self, at: int) -> FrameReport:
        """The report of one of them."""
        said = tuple([said_by(told) for told in self.told[at].tolist()])
        rows, figures = self.rows[at].tolist(), self.figures[at].tolist()
        return frame_report(self.number + at, rows, said, figures, is_calm=True)

    def reports(self) -> list[FrameReport]:
        """The reports of all."""
        return [self.report(at) for at in range(self.frames)]


Heard = FrameReport | CalmFrames


def unfolded(heard: list[Heard]) -> list[FrameReport]:
    """The reports of all frames that were heard, one by one."""
    told: list[FrameReport] = []
    for one in heard:
        told += one.reports() if isinstance(one, CalmFrames) else [one]
    return told
