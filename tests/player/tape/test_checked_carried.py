"""Checked tapes on what carries them: recorders, pick-ups, mending, filters, echoes, earlier versions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
import soundfile
from scipy.signal import lfilter

from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.mend import mend
from morfax.player.tape.playback import play
from morfax.recorder.tape import check_signal
from morfax.recorder.tape.tape import Tape, TapeFormat, record
from morfax.recorder.wear.settings import Wear
from morfax.recorder.wear.transport import age
from tests.player.tape.checked import (
    AT,
    RATE_HZ,
    REFERENCE,
    RIGHT_UM,
    UM,
    Bench,
    Frames,
    X,
    delayed,
    run,
)
from tests.player.worn import program


@pytest.mark.parametrize("kind", ["speed", "flutter", "level", "hum", "rate", "cassette"])
def test_what_a_recorder_does_leaves_it_readable(
    bench: Bench, tmp_path: Path, kind: str
) -> None:
    wear = {
        "speed": Wear(speed=0.05),
        "flutter": Wear(wow=2e-3, flutter=2e-3, scrape=1e-3),
        "level": Wear(level_db=-20, uneven_db=0.7),
        "hum": Wear(hum_db=20, dc=0.02, third=0.03),
        "rate": Wear(stamped_hz=44100),
        "cassette": Wear(noise_db=46, crosstalk_db=40, bandwidth_hz=12_500, skew_s=1.2e-5),
    }[kind]
    age(bench.tape, tmp_path / "worn.wav", wear, seed=1)
    playback = play(tmp_path / "worn.wav")
    went, fault = run(playback)
    assert fault is None
    assert playback.reader.is_checked
    assert np.abs(went[-1] - bench.clean[-1]).max() < RIGHT_UM * UM


@pytest.mark.parametrize("pickup", ["photocell", "coil", "hall", "scale"])
def test_every_pick_up_carries_it(bench: Bench, tmp_path: Path, pickup: str) -> None:
    from morfax.recorder.tape.pickups import PICK_UPS

    own = PICK_UPS[pickup].cycles_per_mm
    positions = program(5.0, 20.0)
    record(
        Motion(positions),
        tmp_path / "a.wav",
        TapeFormat(pickup=pickup, cycles_per_mm=own, checked=True),
    )
    playback = play(tmp_path / "a.wav")
    went, fault = run(playback)
    assert fault is None
    assert playback.reader.is_checked
    assert (
        np.abs(went[6000:-6000] - positions[: len(went) - 12000]).max() < 0.01
    )  # mm: following


def test_further_axes_and_other_rates_carry_it(tmp_path: Path) -> None:
    for axes, rate_hz in ((("x", "y"), 44100), (("x", "y", "z", "u", "v"), 96000)):
        fmt = TapeFormat(
            axes=axes, sample_rate_hz=rate_hz, samples_per_motion=rate_hz // 6000, checked=True
        )
        smooth = (1 - np.cos(np.linspace(0, np.pi, 9000))) / 2
        way = 5.0 * (1 + np.arange(len(axes)))
        stream = Motion(np.outer(smooth, way), fmt.motion_rate_hz, 0.0, axes)
        record(stream, tmp_path / "a.wav", fmt)
        playback = play(tmp_path / "a.wav")
        ended = join(playback).positions_mm[-1]
        assert playback.reader.is_checked
        assert ended[: len(axes) if len(axes) > 2 else 2] == pytest.approx(way, abs=1e-3)


def test_a_mended_tape_is_checked_again(bench: Bench, tmp_path: Path) -> None:
    def holed(frames: Frames) -> Frames:
        frames[AT : AT + 9600, X] *= 0.01  # 0.2 s, which no bound makes known
        return frames

    mended = mend(bench.written(holed), tmp_path / "mended.wav")
    assert [one.axis for one in mended.mends] == ["x"]
    playback = play(tmp_path / "mended.wav")
    ended = join(playback).positions_mm[-1]
    assert playback.reader.is_checked
    assert np.abs(ended - bench.clean[-1]).max() < RIGHT_UM * UM


def test_it_goes_on_from_a_place(bench: Bench) -> None:
    row = 7980  # 30 ms after the start, at 15 mm/s
    resumed = join(play(bench.tape, resume_at_s=row / 6000, start_mm=tuple(bench.clean[row])))
    assert np.abs(resumed.positions_mm[600:] - bench.clean[row + 600 :]).max() < 2 * UM


def test_a_reference_too_low_has_no_check_signal(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"at least 5000 Hz for a check signal.*--plain"):
        TapeFormat(reference_hz=3000.0, checked=True)
    record(Motion(program(3.0)), tmp_path / "a.wav", TapeFormat(reference_hz=3000.0))
    playback = play(tmp_path / "a.wav")
    join(playback)
    assert len(playback.notes) == 1


@pytest.mark.parametrize("track", [REFERENCE, X])
def test_a_delay_that_begins_to_drift_under_way_is_put_right(bench: Bench, track: int) -> None:
    """50 us/s from 2.2 s on; a mean over seven delays alone rounded the bend off: 2.2 um."""

    bend = delayed(track, lambda t: 50e-6 * np.clip(t - 2.2, 0, None))
    went, fault = bench.played(bend)
    assert fault is None
    if track == REFERENCE:  # it takes the machine's clock along
        rows = np.arange(len(went))
        by = rows + 50e-6 * np.clip(rows - 2.2 * 6000, 0, None)
        went = np.column_stack([np.interp(by, rows, column) for column in went.T])
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("corner", [-0.8, -0.6])
def test_a_carrier_that_a_filter_turns_on_is_a_fault(bench: Bench, corner: float) -> None:
    """An all-pass on X turns its carrier by up to 9 um, at any level; its check signal is late by less."""

    def turned(frames: Frames) -> Frames:
        frames[:, X] = lfilter([corner, 1], [1, corner], frames[:, X])
        return frames

    went, fault = bench.played(turned)
    assert isinstance(fault, LockFault)
    assert fault.axis == "x" and fault.error_cycles is not None
    assert 0.048 < abs(fault.error_cycles) < 0.25
    assert "as a filter or an echo does" in str(fault)
    assert bench.error_um(went) < 2.5  # 0.05 cycle


def test_an_echo_that_shows_between_the_starts_of_frames_is_a_fault(bench: Bench) -> None:
    """Once round takes two frames: at each start Y is nearly right, and 0.17 cycle off between two."""

    def echoed(frames: Frames) -> Frames:
        late, tracks = 14, [2, 3]  # Y and Z
        frames[late:, tracks] += 0.37 * frames[:-late, tracks].copy()
        return frames * 0.6

    went, fault = bench.played(echoed)
    assert isinstance(fault, LockFault)
    assert fault.axis == "y"
    assert bench.error_um(went) < 2.5  # 0.05 cycle


def test_counts_that_begin_again_lead_no_axis_astray(tmp_path: Path) -> None:
    """X goes 0.45 m at up to 84 mm/s; its count begins again at 0.41 m."""
    time_s = np.arange(round(9.2 * 6000)) / 6000
    way = np.clip((time_s - 0.4) / 8, 0, 1)
    positions = np.zeros((len(time_s), 3))
    positions[:, 0] = 450 * way**2 * (3 - 2 * way)
    record(Motion(positions), tmp_path / "long.wav")
    went, fault = run(play(tmp_path / "long.wav"))
    assert fault is None
    assert went[-1] == pytest.approx([450, 0, 0], abs=0.1 * UM)


def test_a_tape_of_version_1_plays(tmp_path: Path, bench: Bench) -> None:
    """Its counts are sixteenths of a cycle."""
    with mock.patch.object(check_signal, "VERSION", 1):
        earlier = Bench(tmp_path)
    assert not np.array_equal(earlier.frames, bench.frames)
    assert np.abs(earlier.clean - bench.clean).max() < 0.01 * UM
    playback = play(earlier.tape)
    join(playback)
    assert playback.notes == ()  # a tape whose frames are not read is a bare one, and told so


def test_the_text_says_nothing_of_it(bench: Bench) -> None:
    with Tape.open(bench.tape) as opened:
        assert "check" not in opened.text
        assert opened.format.version == 1
        assert replace(opened.format, checked=True) == opened.format


@pytest.mark.parametrize("frames", [1, 2, 3, 50])
@pytest.mark.parametrize("value", [0.0, np.nan, np.inf])
def test_a_tape_of_a_moment_is_a_fault(
    bench: Bench, tmp_path: Path, frames: int, value: float
) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", RATE_HZ, 4, "FLOAT") as out:
        out.comment = bench.text
        out.write(np.where(np.arange(frames)[:, None] == 0, value, bench.frames[:frames]))
    with pytest.raises(TapeFault):
        join(play(tmp_path / "a.wav"))


@pytest.mark.parametrize("track", [REFERENCE, X])
@pytest.mark.parametrize("at", [100, AT])
def test_a_sample_that_is_no_number_is_ridden_over_or_a_fault(
    bench: Bench, tmp_path: Path, track: int, at: int
) -> None:
    frames = bench.frames.copy()
    frames[at, track] = np.nan
    with soundfile.SoundFile(tmp_path / "a.wav", "w", RATE_HZ, 4, "FLOAT") as out:
        out.comment = bench.text
        out.write(frames)
    went, _ = run(play(tmp_path / "a.wav"))
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("length_s", [0.05, 0.3, 0.6])
def test_a_carrier_without_its_check_signal_is_a_fault(bench: Bench, length_s: float) -> None:
    """However long: a dropout takes the carrier too, another signal does not."""

    def replaced(frames: Frames) -> Frames:
        from scipy.signal import butter, sosfiltfilt

        low = sosfiltfilt(butter(6, 2500, fs=RATE_HZ, output="sos"), frames[:, X])
        end = AT + round(length_s * RATE_HZ)
        frames[AT:end, X] -= low[AT:end]
        return frames

    _, fault = bench.played(replaced)
    assert isinstance(fault, TapeFault)
    assert "check signal" in str(fault)
    assert fault.time_s == pytest.approx(AT / RATE_HZ, abs=0.01)
