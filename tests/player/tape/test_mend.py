"""Mending: what a closed end tells of the dropouts, and where it tells nothing."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
import soundfile
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.end_count import _sets
from morfax.player.tape.mend import mend
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.worn import program

RATE_HZ = 48000
UM = 1e-3


@pytest.fixture
def tape(tmp_path: Path) -> Path:
    """A bare tape: a circle of 3 mm at 40 mm/s, entered and left with 0.5 m/s²."""
    record(Motion(program(3.0, 40.0)), tmp_path / "a.wav", TapeFormat())
    return tmp_path / "a.wav"


def holed(
    tape: Path,
    places_s: tuple[float, ...],
    length_ms: float,
    track: int = 1,
    text: str | None = None,
) -> Path:
    """The tape with dropouts."""
    with soundfile.SoundFile(tape) as sound:
        frames, said = sound.read(dtype="float32"), sound.comment
    for at_s in places_s:
        frames[round(at_s * RATE_HZ) :][: round(length_ms * 48), track] *= 0.003
    file = tape.with_name("holed.wav")
    with soundfile.SoundFile(file, "w", RATE_HZ, frames.shape[1], "PCM_16") as out:
        if text != "":
            out.comment = text or said
        out.write(frames)
    return file


@pytest.mark.parametrize("length_ms", [8.0, 30.0, 60.0])
def test_a_dropout_that_is_too_long_for_the_player_is_mended(
    tape: Path, tmp_path: Path, length_ms: float
) -> None:
    whole, broken = join(play(tape)).positions_mm, holed(tape, (1.6,), length_ms)
    with pytest.raises(LockFault, match="morfax mend"):
        join(play(broken))
    mended = mend(broken, tmp_path / "m.wav")
    assert [(one.axis, round(one.time_s, 2)) for one in mended.mends] == [("x", 1.6)]
    went = join(play(tmp_path / "m.wav")).positions_mm
    assert len(went) == pytest.approx(
        len(whole) + 2 * 600, abs=2
    )  # a tenth of the old standstills is kept
    error = np.abs(went[600 : 600 + len(whole)] - whole)
    outside = np.ones(len(whole), bool)
    outside[9600 - 20 : 9600 + round(6 * length_ms) + 20] = False
    # read, recorded anew and read again: two following errors and 16 bit
    assert error[outside].max() < 1.5 * UM
    assert error.max() < mended.mends[0].unknown_mm


def test_the_end_tells_how_many_cycles_were_lost(tmp_path: Path) -> None:
    # X stands, and within the dropout goes on by 0.15 mm, three cycles, which no side of it shows.
    def course(t_s: np.ndarray) -> np.ndarray:
        jump = (
            0.15
            * np.clip((t_s - 0.5) / 0.02, 0, 1) ** 2
            * (3 - 2 * np.clip((t_s - 0.5) / 0.02, 0, 1))
        )
        return np.column_stack([jump, 0 * t_s, 0 * t_s])

    told = course(np.arange(6000) / 6000)
    record(Motion(told), tmp_path / "a.wav", TapeFormat())
    broken = holed(tmp_path / "a.wav", (1.498,), 24.0)
    mended = mend(broken, tmp_path / "m.wav")
    assert [(one.axis, one.cycles) for one in mended.mends] == [("x", 3)]
    assert join(play(tmp_path / "m.wav")).positions_mm[-1] == pytest.approx(
        [0.15, 0, 0], abs=0.1 * UM
    )


def test_what_cannot_be_known_is_told_and_nothing_is_written(
    tape: Path, tmp_path: Path
) -> None:
    with pytest.raises(
        TapeFault,
        match=r"what one of the 2 dropouts at 1\.599 s, 1\.799 s lost another may have put back",
    ):
        mend(holed(tape, (1.6, 1.8), 40.0), tmp_path / "m.wav")
    off = TapeFormat(start_mm=(0.0, 0.0, 0.0), end_mm=(0.0, 0.1, 0.0))
    with pytest.raises(
        TapeFault,
        match=r"Y ends \+2 cycles off, and there is no dropout that could have lost them",
    ):
        mend(holed(tape, (1.6,), 40.0, text=off.to_json()), tmp_path / "m.wav")
    far = TapeFormat(start_mm=(0.0, 0.0, 0.0), end_mm=(5.0, 0.0, 0.0))
    with pytest.raises(
        TapeFault,
        match=r"X ends \+100 cycles off, and the dropouts at 1.599 s are too short for it",
    ):
        mend(holed(tape, (1.6,), 8.0, text=far.to_json()), tmp_path / "m.wav")
    assert not (tmp_path / "m.wav").exists()


def test_a_lost_reference_is_mended_by_the_end_of_every_axis(
    tape: Path, tmp_path: Path
) -> None:
    assert [
        one.axis for one in mend(holed(tape, (1.6,), 40.0, 0), tmp_path / "m.wav").mends
    ] == [
        "x",
        "y",
        "z",
    ]


def test_two_long_dropouts_on_two_axes_are_mended_each_by_its_own_end(
    tape: Path, tmp_path: Path
) -> None:
    first = holed(tape, (1.6,), 30.0, 1)
    first.rename(tmp_path / "b.wav")
    mended = mend(holed(tmp_path / "b.wav", (1.8,), 30.0, 2), tmp_path / "m.wav")
    assert [one.axis for one in mended.mends] == ["x", "y"]


def test_a_tape_that_does_not_say_where_it_ends_must_be_closed(
    tape: Path, tmp_path: Path
) -> None:
    broken = holed(tape, (1.6,), 30.0, text="")
    by_hand = {"reference_hz": 6000.0, "cycles_per_mm": 20.0}
    with pytest.raises(TapeFault, match="--closed"):
        mend(broken, tmp_path / "m.wav", **by_hand)
    assert len(mend(broken, tmp_path / "m.wav", **by_hand, closed=True).mends) == 1


def test_an_end_that_is_off_by_less_than_a_cycle_is_not_mended(
    tape: Path, tmp_path: Path
) -> None:
    fmt = TapeFormat(start_mm=(0.0, 0.0, 0.0), end_mm=(0.02, 0.0, 0.0))
    with pytest.raises(LockFault, match="no whole number"):
        mend(holed(tape, (1.6,), 30.0, text=fmt.to_json()), tmp_path / "m.wav")


@given(
    st.lists(st.tuples(st.integers(-3, 3), st.integers(0, 4)), max_size=4), st.integers(-6, 6)
)
def test_sets_of_numbers_are_all_found_up_to_two(
    ranges: list[tuple[int, int]], total: int
) -> None:
    candidates = [range(low, low + count) for low, count in ranges]
    every = [numbers for numbers in product(*candidates) if sum(numbers) == total]
    assert _sets(candidates, total) == every[:2]
