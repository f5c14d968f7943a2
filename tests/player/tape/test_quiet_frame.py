"""Quiet frames: what one kernel reads of a whole frame is what the kernels for damaged frames read of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Motion
from morfax.player.tape.check_reader import read_ahead, read_check
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.quiet_frame import QuietFrames
from morfax.player.tape.subcarrier import Subcarrier
from morfax.player.tape.symbols import WORD, read_gates
from morfax.recorder.tape.tape import Stored, Tape, record

SECONDS, RATE_HZ = 4.0, 6000.0
LATE_FRAMES = 3  # of track 3: 62 us


def frames(folder: Path) -> tuple[list[Stored], Tape]:
    """The blocks of a tape on which two axes swing, and one track is late."""
    t = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
    places = np.column_stack([np.sin(t), 1 - np.cos(t), 0 * t])
    record(Motion(places), folder / "tape.wav")
    with Tape.open(folder / "tape.wav") as tape:
        whole = np.concatenate(list(tape.stored_blocks(4096)))
    whole[:, 2] = np.roll(whole[:, 2], LATE_FRAMES)
    return [part.copy() for part in np.array_split(whole, 7)], tape


def reports(blocks: list[Stored], tape: Tape) -> list[FrameReport]:
    """The reports of all frames."""
    left = iter(blocks)
    check = read_check(read_ahead(left, tape.format), tape.format)
    assert check is not None
    told = check.reports()
    for block in left:
        check.feed(block)
        told += check.reports()
    check.finish()
    return told + check.reports()


def test_a_quiet_frame_is_read_as_a_damaged_one_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocks, tape = frames(tmp_path)
    quiet = reports(blocks, tape)
    read = [0]

    def none(self: QuietFrames, points: Subcarrier, begins: float) -> None:
        """Read the gates, and say that the frame is not quiet."""
        read_gates(points.points, points.theta, begins, WORD, self.gates)
        read[0] += 1

    monkeypatch.setattr(QuietFrames, "read", none)
    slow = reports(blocks, tape)
    assert read[0] == len(slow) == len(quiet) > 10
    for one, other in zip(quiet, slow, strict=True):
        assert one.said == other.said and None not in one.said
        assert (one.number, one.row, one.part_rows) == (
            other.number,
            other.row,
            other.part_rows,
        )
        for name in ("late_s", "delay_s", "error_s", "swing_s"):
            assert np.array_equal(getattr(one, name), getattr(other, name)), name
