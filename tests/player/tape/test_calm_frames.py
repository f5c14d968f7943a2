"""Calm frames: read and compared many at once, they tell what they tell one by one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Motion
from morfax.player.tape.calm_frames import CalmFrames, Heard, unfolded
from morfax.player.tape.check_reader import CheckReader, read_check
from morfax.player.tape.counts import Counts
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.held_rows import HeldRows
from morfax.player.tape.phases import Phases
from morfax.player.tape.told_axes import ToldAxes
from morfax.recorder.tape.tape import Tape, record

SECONDS, RATE_HZ = 6.0, 6000.0
BLOCK_ROWS = 8192


class Played:
    """A tape on which three axes swing: what its check signal says, and where they are, row by row."""

    def __init__(self, folder: Path) -> None:
        t = np.arange(round(SECONDS * RATE_HZ)) / RATE_HZ
        places = np.column_stack([np.sin(t), 1 - np.cos(t), 0.5 - 0.5 * np.cos(2 * t)])
        record(Motion(places), folder / "tape.wav")
        with Tape.open(folder / "tape.wav") as tape:
            self.format = tape.format
            self.frames = np.concatenate(list(tape.stored_blocks()))
        dwell = round(self.format.dwell_s * RATE_HZ)
        way = np.pad(places, ((dwell, dwell), (0, 0)), mode="edge")
        self.cycles = way * self.format.cycles_per_mm

    def heard(self) -> list[Heard]:
        """What the check signal says."""
        check = read_check([self.frames], self.format)
        assert check is not None
        return check.heard()

    def held(self) -> HeldRows:
        """All rows, in the reader's blocks."""
        held = HeldRows()
        for first in range(0, len(self.cycles), BLOCK_ROWS):
            rows = self.cycles[first : first + BLOCK_ROWS]
            nothing = np.zeros((len(rows), 0), np.float32)
            held.add(Phases(first, rows, nothing, nothing))
        return held

    def counts(self) -> Counts:
        """Counts whose zeros are known."""
        counts = Counts(3, self.format.reference_hz, is_timed=True)
        counts.zero_cycles = [0.0, 0.0, 0.0]
        return counts


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Played:
    return Played(tmp_path_factory.mktemp("calm"))


def test_a_block_of_calm_frames_is_read_at_once_and_each_as_by_itself(
    played: Played, monkeypatch: pytest.MonkeyPatch
) -> None:
    (whole,) = played.heard()
    assert isinstance(whole, CalmFrames) and whole.frames > 10
    are_whole = CheckReader._whole
    monkeypatch.setattr(CheckReader, "_whole", lambda check: min(are_whole(check), 1))
    single = played.heard()
    assert all(isinstance(one, CalmFrames) and one.frames == 1 for one in single)
    for one, other in zip(whole.reports(), unfolded(single), strict=True):
        assert (one.number, one.said, one.is_calm) == (other.number, other.said, True)
        for name in ("row", "part_rows", "late_s", "delay_s", "error_s", "swing_s"):
            assert np.allclose(getattr(one, name), getattr(other, name), rtol=0, atol=1e-9), (
                name
            )


def test_calm_frames_tell_of_the_axes_what_their_reports_tell(played: Played) -> None:
    (frames, *_), quick, slow = (
        played.heard(),
        ToldAxes(played.format),
        ToldAxes(played.format),
    )
    assert isinstance(frames, CalmFrames)
    quick.take(frames)
    for report in frames.reports():
        for axis in range(3):
            assert slow.add(axis, report) == 0.0
        told = [
            [said.cycles, said.middle_cycles, said.speed] for said in report.said[1:] if said
        ]
        assert np.array_equal(frames.said[report.number, :, :3], told)
    assert quick.settled_row == slow.settled_row > 0 and not quick.moves
    for one, other in zip(quick.delays + quick.bounds, slow.delays + slow.bounds, strict=True):
        assert vars(one) == vars(other)


def due_rows(counts: Counts, rows: int) -> list[float]:
    """The rows of all that is due."""
    found = []
    while (due := counts.due(0, rows)) is not None:
        found.append(due.row)
    return found


def test_all_counts_that_are_right_are_passed_but_those_between_two_blocks(
    played: Played,
) -> None:
    (frames, *_), counts, held = played.heard(), played.counts(), played.held()
    assert isinstance(frames, CalmFrames)
    counts.take(frames)
    passed, left = counts.pass_right(held), due_rows(counts, len(held))
    assert passed == pytest.approx(frames.rows[-1, 0]) and not left


@pytest.mark.parametrize("off_cycles", [0.4, -1.0])
def test_the_first_count_that_is_off_is_left_to_be_told(
    played: Played, off_cycles: float
) -> None:
    """A whole cycle shows at the start of a frame, not in its middle."""
    (frames, *_), counts, at = played.heard(), played.counts(), 8000
    assert isinstance(frames, CalmFrames)
    held = HeldRows()
    cycles = played.cycles.copy()
    cycles[at:, 1] += off_cycles
    nothing = np.zeros((len(cycles), 0), np.float32)
    held.add(Phases(0, cycles, nothing, nothing))
    counts.take(frames)
    passed = counts.pass_right(held)
    due = counts.due(0, len(cycles))
    moments = frames.rows[:, :2].ravel()
    first = (
        moments[moments > at][0]
        if off_cycles == 0.4
        else frames.rows[:, 0][frames.rows[:, 0] > at][0]
    )
    assert (
        due is not None
        and due.row == first
        and not counts.off(1, cycles[round(due.row), 1], due).is_right
    )
    assert passed is not None and passed < at and passed in frames.rows[:, 0]


def test_a_frame_behind_calm_ones_waits_for_them(played: Played) -> None:
    (frames, *_), counts = played.heard(), played.counts()
    assert isinstance(frames, CalmFrames)
    counts.take(frames)
    counts.begin(1e5, 1.1e5)
    reports: list[FrameReport] = frames.reports()
    rows = [row for report in reports for row in (report.row, report.middle_row)]
    assert due_rows(counts, 1 << 20) == [*rows, 1e5, 1.1e5]
