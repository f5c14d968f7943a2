"""Bare tapes: copied tracks and a tape that runs backwards are refused, what is meant so is allowed."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.bare import NOT_PLACED, NOT_VOUCHED
from morfax.player.tape.mend import mend
from morfax.player.tape.playback import play, play_pipe
from morfax.recorder.tape.own_motion import OWN_CYCLES, STATED_CYCLES, OwnMotion
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.worn import program

RATE_HZ = 48000
REFERENCE, X, Y, Z = range(4)


@pytest.fixture(scope="module")
def tape(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A circle of 3 mm, the tool 2 mm above the work at both ends and 1 mm in it on the far side."""
    positions = program(3.0)
    positions[:, 2] = 2 - 1.5 * positions[:, 1] / 3.0
    file = tmp_path_factory.mktemp("bare") / "circle.wav"
    record(Motion(positions), file, TapeFormat())
    return file


def rewritten(tape: Path, file: Path, change: object) -> Path:
    """The tape with its frames changed, its text as it was."""
    with soundfile.SoundFile(tape) as sound:
        frames, text = sound.read(dtype="float32"), sound.comment
    with soundfile.SoundFile(file, "w", RATE_HZ, frames.shape[1], "PCM_16") as out:
        out.comment = text
        out.write(change(frames))  # type: ignore[operator]
    return file


def copied(source: int, target: int) -> object:
    """Lay one track's signal on another track too."""

    def change(frames: np.ndarray) -> np.ndarray:
        frames[:, target] = frames[:, source]
        return frames

    return change


def test_a_sound_tape_plays_and_says_what_it_cannot_vouch_for(tape: Path) -> None:
    playback = play(tape)
    join(playback)
    assert playback.notes == (NOT_VOUCHED,)
    assert "\n" not in NOT_VOUCHED


def test_a_bare_tape_without_text_says_that_its_start_is_not_known(
    tape: Path, tmp_path: Path
) -> None:
    file = tmp_path / "no-text.wav"
    soundfile.write(file, soundfile.read(tape, dtype="int16")[0], RATE_HZ, "PCM_16")
    figures = {"reference_hz": 6000.0, "cycles_per_mm": 20.0}
    for start_mm, notes in (
        (None, (NOT_VOUCHED, NOT_PLACED)),
        ((1.0, 2.0, 2.0), (NOT_VOUCHED,)),
    ):
        playback = play(file, start_mm=start_mm, **figures)
        join(playback)
        assert playback.notes == notes


@pytest.mark.parametrize("wear", [Wear(), replace(Wear(), noise_db=30.0, skew_s=3e-6)])
@pytest.mark.parametrize(
    ("source", "target", "told"),
    [
        (REFERENCE, X, r"X stands from start to end.*track 2 may be a copy.*--still x"),
        (REFERENCE, Y, r"Y stands from start to end.*--still y"),
        (X, Y, r"X and Y run alike.*track 3 may be a copy of track 2.*--alike x,y"),
        (X, Z, r"X and Z run alike"),
    ],
)
def test_a_copied_track_is_refused(
    tape: Path, tmp_path: Path, source: int, target: int, told: str, wear: Wear
) -> None:
    attacked = rewritten(tape, tmp_path / "a.wav", copied(source, target))
    age(attacked, tmp_path / "b.wav", wear)
    with pytest.raises(TapeFault, match=told):
        join(play(tmp_path / "b.wav"))


def test_what_is_meant_so_is_allowed_by_hand(tape: Path, tmp_path: Path) -> None:
    still = rewritten(tape, tmp_path / "a.wav", copied(REFERENCE, Y))
    positions = join(play(still, still=("y",))).positions_mm
    assert np.ptp(positions[:, 1]) < 1e-4  # mm: the rounding of 16 bit
    alike = rewritten(tape, tmp_path / "b.wav", copied(X, Y))
    join(play(alike, alike=("x", "y")))
    with pytest.raises(TapeFault, match=r"still is .*'q'.*axes of the tape: x, y, z"):
        play(still, still=("q",))


@pytest.mark.parametrize(
    ("way", "still", "alike"),
    [
        ((1, 0, 0), ("y",), ()),
        ((0, 1, -1), ("x",), ()),
        ((1, 1, 0), (), ("x", "y")),
        ((1, -1, 0), (), ()),
    ],
)
def test_the_recorder_states_what_is_meant_so(
    tmp_path: Path, way: tuple[int, ...], still: tuple[str, ...], alike: tuple[str, ...]
) -> None:
    smooth = (1 - np.cos(np.linspace(0, np.pi, 3000))) / 2
    record(Motion(smooth[:, None] * np.array(way, float)), tmp_path / "line.wav")
    with Tape.open(tmp_path / "line.wav") as opened:
        assert (opened.format.still, opened.format.alike) == (still, alike)
        assert opened.format.version == (3 if still or alike else 1)
        assert opened.format.end_mm == pytest.approx(way, abs=1e-6)
    ended = join(play(tmp_path / "line.wav")).positions_mm[-1]
    assert ended == pytest.approx(way, abs=1e-4)  # mm


def test_a_drilled_hole_and_a_standstill_play(tmp_path: Path) -> None:
    smooth = (1 - np.cos(np.linspace(0, 2 * np.pi, 3000))) / 2
    record(Motion(np.outer(smooth, [0.0, 0.0, -3.0])), tmp_path / "hole.wav")
    join(play(tmp_path / "hole.wav"))
    record(Motion(np.zeros((100, 3))), tmp_path / "still.wav")
    join(play(tmp_path / "still.wav"))


def test_a_tape_that_ends_before_it_begins_is_refused(tape: Path, tmp_path: Path) -> None:
    turned = rewritten(tape, tmp_path / "a.wav", lambda frames: frames[::-1])
    with pytest.raises(
        TapeFault, match=r"goes up by 3\.000 mm from its start at 2\.000 mm.*backwards"
    ):
        join(play(turned))


def test_a_tool_that_starts_in_the_work_may_go_up_only(tape: Path, tmp_path: Path) -> None:
    turned = rewritten(tape, tmp_path / "a.wav", lambda frames: frames[::-1])
    highest = join(play(turned, start_mm=(0.0, 0.0, -1.0))).positions_mm[:, 2].max()
    assert highest == pytest.approx(2, abs=1e-3)


def test_a_pipe_is_asked_the_same(tape: Path, tmp_path: Path) -> None:
    attacked = rewritten(tape, tmp_path / "a.wav", copied(REFERENCE, X))
    with pytest.raises(TapeFault, match="X stands"):
        join(play_pipe(BytesIO(attacked.read_bytes())))
    join(play_pipe(BytesIO(attacked.read_bytes()), still=("x",)))


def test_a_copied_track_is_not_mended_into_a_tape_that_allows_it(
    tape: Path, tmp_path: Path
) -> None:
    attacked = rewritten(tape, tmp_path / "a.wav", copied(REFERENCE, X))
    with pytest.raises(TapeFault, match="X stands"):
        mend(attacked, tmp_path / "b.wav")
    assert not (tmp_path / "b.wav").exists()


@pytest.mark.parametrize("track", [REFERENCE, X, Z])
@pytest.mark.parametrize("first_ms", [0, 5, 20, 38])
def test_a_drop_to_two_fifths_in_the_first_50_ms_is_a_fault(
    tape: Path, tmp_path: Path, track: int, first_ms: int
) -> None:
    def weakened(frames: np.ndarray) -> np.ndarray:
        frames[first_ms * 48 : (first_ms + 10) * 48, track] *= 0.4
        return frames

    with pytest.raises(TapeFault, match=rf"track {track + 1} .*has a dropout at 0\.0"):
        next(iter(play(rewritten(tape, tmp_path / "a.wav", weakened))))


def test_ranges_do_not_depend_on_the_blocks() -> None:
    random = np.random.default_rng(3)
    cycles = np.cumsum(random.normal(0, 0.1, (1000, 3)), axis=0)
    cycles[:, 1] = 7 + 0.1 * OWN_CYCLES * np.sin(np.arange(1000))  # stands, away from zero
    cycles[:, 2] = cycles[:, 0] + 0.1 * OWN_CYCLES * np.sin(np.arange(1000))
    one, parts = OwnMotion(3), OwnMotion(3)
    one.feed(cycles)
    for part in np.array_split(cycles, 37):
        parts.feed(part)
    assert one.range_cycles == pytest.approx(np.ptp(cycles, axis=0))
    for own in (one, parts):
        assert own.standing(("x", "y", "z"), OWN_CYCLES) == ("y",)
        assert own.pairs(STATED_CYCLES) == [(0, 2)]
