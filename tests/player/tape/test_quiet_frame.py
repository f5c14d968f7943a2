"""Quiet frames: what one kernel reads of a whole frame is what the kernels for damaged frames read of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Motion
from morfax.player.tape.calm_frames import CalmFrames
from morfax.player.tape.check_reader import read_ahead, read_check
from morfax.player.tape.delays import DEAD_ZONE_S
from morfax.player.tape.frame_order import LARGEST_LATE_S, LARGEST_SWING_S
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.quiet_frame import QuietFrames, _is_calm
from morfax.player.tape.subcarrier import Subcarrier
from morfax.player.tape.symbols import WORD, read_gates
from morfax.recorder.tape.check_frame import TABLES, VERSION, CheckFrame, tell, to_bits
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

    read_calm = QuietFrames.read

    def none(
        self: QuietFrames, points: Subcarrier, begins: float, number: int, most: int
    ) -> tuple[CalmFrames, bool]:
        """Read the gates, and say that the frame is not quiet."""
        read_gates(points.points, points.theta, begins, WORD, self.gates)
        read[0] += 1
        return read_calm(self, points, begins, number, 0)[0], False

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


def words(number: int, tracks: tuple[int, ...], version: int = VERSION) -> np.ndarray:
    """What frames of some tracks tell, as 64 bits each."""
    told = np.empty(len(tracks), np.int64)
    bits = np.array([to_bits(CheckFrame(track, number, 0.25)) for track in tracks])
    tell(bits, *TABLES, told, np.empty(len(tracks), bool))
    rest = told.view(np.uint64) & np.uint64((1 << 61) - 1)
    return np.asarray((rest | np.uint64(version << 61)).view(np.int64))


@pytest.mark.parametrize("plain", [False, True])
def test_a_calm_frame_is_one_of_which_nothing_is_to_be_said(plain: bool) -> None:
    is_calm = _is_calm.py_func if plain else _is_calm
    # late; delays of four parts; error, which tells nothing of the track itself; swing
    most = np.array([LARGEST_LATE_S, *[DEAD_ZONE_S] * 4, 1.0, LARGEST_SWING_S])
    figures = np.array([most, -most, most])
    figures[:, -1] = LARGEST_SWING_S
    told = words(65_535, (0, 1, 2))
    assert is_calm(told, 65_535, figures) and is_calm(told, 65_535 + 65_536, figures)
    assert not is_calm(told, 0, figures)
    assert not is_calm(words(65_535, (0, 2, 1)), 65_535, figures)
    for version in (0, 4, 7):
        assert not is_calm(words(65_535, (0, 1, 2), version), 65_535, figures)
    for column in (0, 1, 2, 3, 4, 6):
        for value in (1.001 * most[column], np.nan):
            worse = figures.copy()
            worse[1, column] = value
            assert not is_calm(told, 65_535, worse), (column, value)


def test_the_frames_of_a_sound_tape_are_calm_and_those_of_a_late_track_are_not(
    tmp_path: Path,
) -> None:
    blocks, tape = frames(tmp_path)
    assert not any(report.is_calm for report in reports(blocks, tape))
    with Tape.open(tmp_path / "tape.wav") as again:
        sound = list(again.stored_blocks(4096))
    assert all(report.is_calm for report in reports(sound, tape))
