"""Dropouts of checked tapes: ridden by the told acceleration, picked up at the next frame, laid by
mending.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.faults import DropoutFault, Fault
from morfax.motion.motion import Motion, join
from morfax.player.tape.mend import mend
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import record
from tests.player.worn import program

RATE_HZ = 48000
UM = 1e-3  # mm
RIGHT_CYCLES = 0.05  # of a cycle, 2.5 um
AT_S = 3.31  # X and Y both move, and the check signal's seventh frame (2.88 to 3.36 s) is hit
REFERENCE, X, Y, Z = range(4)
ALL = (REFERENCE, X, Y, Z)
Frames = np.ndarray


class Bench:
    """A circle of 5 mm at 10 mm/s on a checked tape, its frames, and what is played of it."""

    def __init__(self, folder: Path) -> None:
        self.tape, self.holed = folder / "whole.wav", folder / "holed.wav"
        record(Motion(program(5.0, 10.0)), self.tape)
        self.clean = join(play(self.tape)).positions_mm
        with soundfile.SoundFile(self.tape) as sound:
            self.frames, self.text = sound.read(dtype="float32"), sound.comment

    def written(self, frames: Frames) -> Path:
        """A tape of these frames."""
        with soundfile.SoundFile(self.holed, "w", RATE_HZ, frames.shape[1], "PCM_16") as out:
            out.comment = self.text
            out.write(frames)
        return self.holed

    def with_hole(
        self, length_s: float, tracks: tuple[int, ...], at_s: float = AT_S, left: float = 0.003
    ) -> Path:
        """The tape with a dropout, in which a share of the level is left."""
        frames = self.frames.copy()
        first = round(at_s * RATE_HZ)
        frames[first : first + round(length_s * RATE_HZ), list(tracks)] *= left
        return self.written(frames)

    def played(self, tape: Path) -> tuple[np.ndarray, Fault | None]:
        """What was played, and the fault that ended it; it is right as far as it goes."""
        blocks, fault = [], None
        try:
            for block in play(tape):
                blocks.append(block)
        except Fault as met:
            fault = met
        went = join(blocks).positions_mm if blocks else np.zeros((0, 3))
        assert np.abs(went - self.clean[: len(went)]).max(initial=0.0) * 20 < RIGHT_CYCLES
        return went, fault


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench(tmp_path_factory.mktemp("dropouts"))


@pytest.mark.parametrize("tracks", [(X,), (REFERENCE,), ALL])
@pytest.mark.parametrize("length_s", [0.005, 0.010, 0.020])
def test_short_ones_are_ridden_as_the_frames_tell(
    bench: Bench, tracks: tuple[int, ...], length_s: float
) -> None:
    went, fault = bench.played(bench.with_hole(length_s, tracks))
    assert fault is None
    assert len(went) == len(bench.clean)


def test_one_across_the_start_of_a_frame_is_ridden_too(bench: Bench) -> None:
    """Then both frames are hit, and only what their lost symbols may be tells the bound."""
    went, fault = bench.played(bench.with_hole(0.010, (X,), at_s=7 * 0.48 - 0.005))
    assert fault is None
    assert len(went) == len(bench.clean)


def test_an_axis_that_rests_is_ridden_for_as_long_as_its_frames_say(tmp_path: Path) -> None:
    way = np.zeros((24000, 3))
    way[:6000, 0] = np.linspace(0, np.pi, 6000)
    way[:, 0] = 1 - np.cos(way[:, 0])
    way[6000:, 0] = 2.0
    record(Motion(way), tmp_path / "a.wav")
    with soundfile.SoundFile(tmp_path / "a.wav") as sound:
        frames, text = sound.read(dtype="float32"), sound.comment
    frames[round(2.9 * RATE_HZ) : round(3.2 * RATE_HZ), Z] *= 0.003
    with soundfile.SoundFile(tmp_path / "b.wav", "w", RATE_HZ, 4, "PCM_16") as out:
        out.comment = text
        out.write(frames)
    playback = play(tmp_path / "b.wav")
    assert join(playback).positions_mm[-1] == pytest.approx([2.0, 0.0, 0.0], abs=UM)
    assert [round(length_s, 2) for length_s in playback.bridged.values()] == [0.3]


@pytest.mark.parametrize("tracks", [(X,), (REFERENCE,), ALL])
def test_one_that_reaches_the_end_at_standstill_moves_nothing(
    bench: Bench, tracks: tuple[int, ...]
) -> None:
    """As behind MP3, which fades the last samples out."""
    ends_s = len(bench.frames) / RATE_HZ
    went, fault = bench.played(bench.with_hole(0.004, tracks, at_s=ends_s - 0.004))
    assert fault is None
    assert np.abs(went - bench.clean).max() < 0.1 * UM


@pytest.mark.parametrize("tracks", [(X,), (REFERENCE,), ALL])
@pytest.mark.parametrize("length_s", [0.3, 0.5, 1.0])
def test_long_ones_hold_the_machine_and_tell_where_to_go_on(
    bench: Bench, tracks: tuple[int, ...], length_s: float
) -> None:
    went, fault = bench.played(bench.with_hole(length_s, tracks))
    assert isinstance(fault, DropoutFault)
    assert (fault.exit_code, fault.axis) == (6, "x")
    assert fault.time_s == pytest.approx(AT_S, abs=0.001)
    # up to the dropout; or, where the count behind it shows a cycle more, up to the last count before it
    counted = round(2.4 * 6000)  # a row lies where the frame begins, which is known to some us
    assert len(went) == round(fault.time_s * 6000) or counted - 1 <= len(went) <= counted
    assert fault.length_s == pytest.approx(length_s, abs=0.003)  # the filter adds 1.7 ms
    assert fault.resume_at_s is not None
    assert AT_S + length_s < fault.resume_at_s < AT_S + length_s + 0.5
    row = round(fault.resume_at_s * 6000)
    assert np.abs(np.array(fault.resume_mm) - bench.clean[row]).max() < 0.1 * UM
    assert f"--resume-at {fault.resume_at_s:.6f}s --from=" in str(fault)
    on = play(bench.holed, resume_at_s=fault.resume_at_s, start_mm=fault.resume_mm)
    rest = join(on).positions_mm
    assert np.abs(rest[600:] - bench.clean[row + 600 :]).max() < UM


@pytest.mark.parametrize("tracks", [(Y,), ALL])
def test_mending_lays_the_way_within_the_error_that_it_states(
    bench: Bench, tmp_path: Path, tracks: tuple[int, ...]
) -> None:
    mended = mend(bench.with_hole(0.5, tracks, at_s=3.0), tmp_path / "m.wav")
    assert [one.axis for one in mended.mends] == (["y"] if tracks == (Y,) else ["x", "y", "z"])
    went = join(play(tmp_path / "m.wav")).positions_mm[600 : 600 + len(bench.clean)]
    error = np.abs(went - bench.clean)
    first, last = 3 * 6000 - 20, round(3.5 * 6000) + 20
    for one in mended.mends:
        column = error[first:last, "xyz".index(one.axis)]
        # no frame tells what is asked for in the seventh frame; those around it tell of a circle and its end
        assert column.max() < one.likely_mm < 3 < one.unknown_mm
    error[first:last] = 0.0
    assert error.max() < 0.1 * UM


def test_what_the_tape_was_given_by_hand_bounds_what_no_frame_tells(
    bench: Bench, tmp_path: Path
) -> None:
    # the dropout spoils the sixth frame, so that nothing tells what the program does in the seventh
    holed = bench.with_hole(0.3, (X,))
    wide = mend(holed, tmp_path / "m.wav").mends[0].unknown_mm
    near = mend(holed, tmp_path / "n.wav", acceleration_mm_s2=50.0).mends[0].unknown_mm
    assert near == pytest.approx(50 * 0.3018**2 / 16, rel=0.2)
    assert wide > 10 * near


def test_a_reference_that_is_lost_while_the_tape_changes_its_speed(bench: Bench) -> None:
    """The tape runs 0.4 % faster behind the dropout than before it: five cycles in half a second."""
    numbers = np.arange(len(bench.frames), dtype=np.float64)
    at = (AT_S + 0.02) * RATE_HZ
    places = numbers + 0.004 * np.clip(numbers - at, 0, None)
    places = places[places < len(numbers) - 1]
    faster = np.column_stack(
        [_moved(column, places) for column in bench.frames.T.astype(np.float64)]
    )
    first = round(AT_S * RATE_HZ)
    faster[first : first + RATE_HZ // 2] *= 0.003
    playback = play(bench.written(faster.astype(np.float32)))
    with pytest.raises(DropoutFault) as caught:
        join(playback)
    assert caught.value.resume_at_s is not None
    row = places[round(caught.value.resume_at_s * RATE_HZ)] / 8
    wanted = [np.interp(row, np.arange(len(bench.clean)), way) for way in bench.clean.T]
    assert caught.value.resume_mm == pytest.approx(wanted, abs=UM)


def _moved(column: np.ndarray, places: np.ndarray) -> np.ndarray:
    """A track at other places of it: 32 samples of a sinc."""
    whole = np.floor(places).astype(int)
    out = np.zeros(len(places))
    for k in range(-15, 17):
        apart = places - whole - k
        window = np.cos(np.pi * np.clip(apart / 16, -1, 1) / 2) ** 2
        out += column[np.clip(whole + k, 0, len(column) - 1)] * np.sinc(apart) * window
    return out


def test_a_dropout_that_no_frame_follows_is_a_fault(bench: Bench) -> None:
    """The tape is cut in the standstill behind a dropout, before the next frame is whole."""
    holed = bench.with_hole(0.06, (X,), at_s=3.8)
    with soundfile.SoundFile(holed) as sound:
        frames = sound.read(dtype="float32")[: round(4.1 * RATE_HZ)]
    went, fault = bench.played(bench.written(frames))
    assert fault is not None
    assert len(went) < 3.8 * 6000
