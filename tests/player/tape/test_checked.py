"""Checked tapes: what a bare tape would play wrongly is right, or a fault that says what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.faults import LockFault, TapeFault
from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play, play_pipe
from morfax.recorder.tape.tape import TapeFormat, record
from tests.player.tape.checked import (
    ALL,
    AT,
    RATE_HZ,
    REFERENCE,
    RIGHT_UM,
    UM,
    Bench,
    Change,
    Frames,
    X,
    Y,
    Z,
    delayed,
    lost,
    repeated,
)
from tests.player.worn import program


def test_the_check_signal_does_not_move_the_screws(bench: Bench, tmp_path: Path) -> None:
    positions = program(10.0, 60.0)
    positions[:, 2] = 2 - 1.5 * positions[:, 1] / 10.0
    record(Motion(positions), tmp_path / "bare.wav", TapeFormat())
    bare = play(tmp_path / "bare.wav")
    apart = (join(bare).positions_mm - bench.clean) * 20
    # 2e-5 cycle is asked; the filter has it 96 dB below the carrier
    assert np.sqrt((apart**2).mean(axis=0)).max() < 1e-5
    assert len(bare.notes) == 1
    checked = play(bench.tape)
    join(checked)
    assert checked.notes == ()


@pytest.mark.parametrize("delay_us", [-200, -20, 3, 30, 100, 200])
def test_a_late_track_is_put_right(bench: Bench, delay_us: float) -> None:
    went, fault = bench.played(delayed(X, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert fault is None
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("delay_us", [-195, 195])
def test_a_late_reference_takes_the_clock_along(bench: Bench, delay_us: float) -> None:
    """Its frames begin as late: at 60 mm/s a count told at another moment is 0.23 cycle off."""
    went, fault = bench.played(delayed(REFERENCE, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert fault is None
    rows = np.arange(len(went))
    late_rows = delay_us * 1e-6 * 6000
    at = np.column_stack([np.interp(rows + late_rows, rows, column) for column in went.T])
    assert bench.error_um(at) < RIGHT_UM


@pytest.mark.parametrize("track", [REFERENCE, Y])
@pytest.mark.parametrize("drift_us", [-45, 45])
def test_a_delay_that_drifts_is_put_right(bench: Bench, track: int, drift_us: float) -> None:
    went, fault = bench.played(delayed(track, lambda t: drift_us * 1e-6 * t))
    assert fault is None
    # a reference that drifts takes the machine's clock along: 3 us at 60 mm/s are 0.2 um
    went = went if track else along(went, bench.clean, drift_us * 1e-6)
    assert bench.error_um(went) < RIGHT_UM


def along(went: np.ndarray, wanted: np.ndarray, drift: float) -> np.ndarray:
    """What was played by a clock that drifts, at the moments of the right one."""
    rows = np.arange(len(went))
    return np.column_stack([np.interp(rows * (1 + drift), rows, column) for column in went.T])


@pytest.mark.parametrize("delay_us", [230, 400, 500, 740, -260])
def test_a_track_later_than_200_us_is_a_fault(bench: Bench, delay_us: float) -> None:
    went, fault = bench.played(delayed(X, lambda t: np.full_like(t, delay_us * 1e-6)))
    assert isinstance(fault, TapeFault)
    assert "us off the reference" in str(fault)
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("count", [1, 2, 3, 8, 480, 960])
@pytest.mark.parametrize("change", [lost, repeated])
@pytest.mark.parametrize("tracks", [(REFERENCE,), (X,), (Z,)])
def test_samples_lost_or_repeated_on_one_track_are_a_fault(
    bench: Bench, tracks: tuple[int, ...], change: Callable[..., Change], count: int
) -> None:
    went, fault = bench.played(change(tracks, count))
    assert fault is not None
    # nothing behind the place is given out, and what was a second before it is
    assert AT / RATE_HZ - 1 < len(went) / 6000 < AT / RATE_HZ
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("count", [8, 48, 192, 480, 960, 23040])
@pytest.mark.parametrize("change", [lost, repeated])
def test_buffers_lost_or_repeated_on_all_tracks_are_a_fault(
    bench: Bench, change: Callable[..., Change], count: int
) -> None:
    went, fault = bench.played(change(ALL, count))
    assert fault is not None
    assert len(went) / 6000 < AT / RATE_HZ
    assert bench.error_um(went) < RIGHT_UM


# four are half a cycle of the reference, which may be counted either way; one of them is a fault
@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_a_few_samples_lost_on_all_tracks_only_move_the_time(bench: Bench, count: int) -> None:
    went, fault = bench.played(lost(ALL, count))
    if fault is not None:
        assert count == 4
        return
    on = bench.clean[: len(went)]
    # the machine jumps 60 mm/s · 21 us · count along the path, and not off it
    off = np.hypot(went[:, 0], went[:, 1] - 10) - np.hypot(on[:, 0], on[:, 1] - 10)
    assert np.abs(off).max() < RIGHT_UM * UM
    assert np.abs(went[-1] - on[-1]).max() < RIGHT_UM * UM


@pytest.mark.parametrize(
    ("tracks", "told"),
    [
        ([0, 0, 2, 3], "track 2 says that it is the reference, and should be the X"),
        ([0, 1, 1, 3], "track 3 says that it is the X, and should be the Y"),
    ],
)
def test_a_copied_track_is_a_fault_before_anything_moves(
    bench: Bench, tracks: list[int], told: str
) -> None:
    went, fault = bench.played(lambda frames: frames[:, tracks])
    assert not len(went)
    assert told in str(fault)


def test_tracks_in_another_order_are_put_in_order_or_told(bench: Bench) -> None:
    went, fault = bench.played(lambda frames: frames[:, [0, 2, 1, 3]])
    assert fault is None
    assert bench.error_um(went) < 1e-6
    pipe = BytesIO(bench.changed.read_bytes())
    with pytest.raises(TapeFault, match=r"track 2 says that it is the Y.*--tracks"):
        join(play_pipe(pipe))


def test_a_tape_that_runs_backwards_is_a_fault_at_once(bench: Bench) -> None:
    with pytest.raises(TapeFault, match="the tape runs backwards: its check signal"):
        play(bench.written(lambda frames: frames[::-1]))


@pytest.mark.parametrize("tracks", [(X,), (REFERENCE,), ALL])
def test_polarity_does_not_matter(bench: Bench, tracks: tuple[int, ...]) -> None:
    signs = np.array([-1.0 if track in tracks else 1.0 for track in ALL], np.float32)
    went, fault = bench.played(lambda frames: frames * signs)
    assert fault is None
    assert bench.error_um(went) < 0.01  # um: the rounding of 16 bit


def test_a_start_that_is_cut_is_right_and_an_end_that_is_cut_is_a_fault(bench: Bench) -> None:
    went, fault = bench.played(lambda frames: frames[RATE_HZ // 2 :])
    assert fault is None
    assert np.abs(went - bench.clean[3000:]).max() < RIGHT_UM * UM
    went, fault = bench.played(lambda frames: frames[: -int(1.5 * RATE_HZ)])
    assert "the tape's end is missing" in str(fault)
    assert bench.error_um(went) < RIGHT_UM


def test_a_count_that_slips_in_a_dropout_is_a_fault(bench: Bench) -> None:
    """A splice of a whole cycle of the carrier of X, at a place where its level hides it."""

    def slipped(frames: Frames) -> Frames:
        carrier = np.exp(2j * np.pi * np.linspace(0, 1, 960))  # a cycle more in 20 ms
        from scipy.signal import butter, hilbert, sosfiltfilt

        # the check signal beneath stays as it is, or it could not be read
        low = sosfiltfilt(butter(6, 2500, fs=RATE_HZ, output="sos"), frames[:, X])
        analytic = hilbert(frames[:, X] - low)
        frames[AT : AT + 960, X] = low[AT : AT + 960] + (analytic[AT : AT + 960] * carrier).real
        return frames

    went, fault = bench.played(slipped)
    assert isinstance(fault, LockFault)
    assert fault.axis == "x"
    assert abs(fault.error_cycles) == pytest.approx(1, abs=0.1)
    assert bench.error_um(went) < RIGHT_UM


@pytest.mark.parametrize("noise_db", [40, 26])
def test_noise_moves_the_screws_no_more_than_without(bench: Bench, noise_db: float) -> None:
    random = np.random.default_rng(3)
    sigma = 0.5 / np.sqrt(2) * 10 ** (-noise_db / 20)
    went, fault = bench.played(
        lambda frames: frames + random.normal(0, sigma, frames.shape).astype(np.float32)
    )
    assert fault is None
    rms = np.sqrt((((went - bench.clean) * 20) ** 2).mean(axis=0))
    assert rms.max() < {40: 1e-3, 26: 5e-3}[noise_db]  # cycles, as asked
