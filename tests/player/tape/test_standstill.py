"""What the standstill tells, and what the watch over the tracks finds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.faults import LockFault, TapeFault
from morfax.player.tape.discriminator import Discriminator
from morfax.player.tape.phases import Phases
from morfax.player.tape.standstill import Bearings, decibels, strongest_hz, take_bearings
from morfax.recorder.tape.format import TapeFormat
from tests.player.carriers import (
    MOTION_RATE_HZ,
    RATE_HZ,
    REFERENCE_HZ,
    Transport,
    swing,
    tracks,
)

FORMAT = TapeFormat()


def bearings(frames: np.ndarray, fmt: TapeFormat = FORMAT) -> Bearings:
    """Bearings taken from a tape."""
    phases = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    ).feed(frames)
    return take_bearings(frames, phases, fmt)


def test_level_zero_and_reference_are_found() -> None:
    found = bearings(
        tracks(swing, 0.3, Transport(level=0.4, track_cycles=(0.0, 0.1, -0.2, 0.3), speed=1.02))
    )
    assert found.levels == pytest.approx(0.4, abs=1e-3)
    zero = swing(np.zeros(1))[0] * FORMAT.cycles_per_mm + [0.1, -0.2, 0.3]
    turns = found.zero_cycles - zero
    assert turns - np.round(turns) == pytest.approx(
        0, abs=1e-5
    )  # clean tape: see the discriminator
    assert found.reference_hz == pytest.approx(1.02 * REFERENCE_HZ, abs=0.5)


def test_noise_of_the_zero_is_averaged_away() -> None:
    found = bearings(tracks(swing, 0.3, Transport(noise_db=40)))
    turns = found.zero_cycles - swing(np.zeros(1))[0] * FORMAT.cycles_per_mm
    # 7.9e-4 cycle over 300 rows, of which the filter leaves about two thirds independent: 6e-5; five sigma.
    assert turns - np.round(turns) == pytest.approx(0, abs=3e-4)


@settings(max_examples=30, deadline=None)
@given(hz=st.floats(300, 20_000), phase=st.floats(0, 6.28), level=st.floats(0.001, 1))
def test_the_strongest_tone_is_found(hz: float, phase: float, level: float) -> None:
    t_s = np.arange(16384) / RATE_HZ
    samples = (level * np.sin(2 * np.pi * hz * t_s + phase)).astype(np.float32)
    assert strongest_hz(samples, RATE_HZ) == pytest.approx(
        hz, abs=0.3
    )  # a tenth of a line, 2.9 Hz


@pytest.mark.parametrize(("track", "name"), [(0, "reference"), (2, "Y"), (3, "Z")])
def test_a_silent_track_is_named(track: int, name: str) -> None:
    frames = tracks(swing, 0.3)
    frames[:, track] = 0
    with pytest.raises(
        TapeFault, match=rf"track {track + 1} \({name}\) is silent: level none, at least -60 dB"
    ):
        bearings(frames)


def test_a_whisper_is_silence_but_forty_db_down_is_not() -> None:
    assert bearings(tracks(swing, 0.3, Transport(level=0.005))).levels[1] == pytest.approx(
        0.005, rel=0.01
    )
    with pytest.raises(TapeFault, match="silent: level -66 dB"):
        bearings(tracks(swing, 0.3, Transport(level=0.0005)))


@pytest.mark.parametrize("left", [0.0, 0.2, 0.4])
def test_a_dropout_in_the_first_50_ms_is_told_from_a_missing_carrier(left: float) -> None:
    """20 ms at less than half of the level; the rows that are left are steady and full of carrier."""
    frames = tracks(swing, 0.3)
    frames[round(0.02 * RATE_HZ) : round(0.04 * RATE_HZ), 1] *= left
    with pytest.raises(TapeFault, match=r"track 2 \(X\) has a dropout at 0\.02\d s"):
        bearings(frames)


def test_another_reference_is_told() -> None:
    with pytest.raises(TapeFault, match="carries 6000 Hz where the reference of 4000 Hz"):
        bearings(tracks(swing, 0.3), TapeFormat(reference_hz=4000.0))


def test_hiss_before_the_tape_is_no_reference_of_its_own() -> None:
    """A reference of 19.5 kHz was advised, and refused when it was given."""
    frames = tracks(swing, 0.3)
    t_s = np.arange(len(frames)) / RATE_HZ
    frames[:, 0] = 0.1 * np.sin(2 * np.pi * 19_547 * t_s)
    with pytest.raises(TapeFault, match="give the tape without the hiss before it"):
        bearings(frames)


@pytest.mark.parametrize("reference_hz", [6000.0, 9000.0])
def test_a_recorder_whose_band_ends_below_the_carrier_is_told(reference_hz: float) -> None:
    """What is left of track 1 then is the check signal, a sixth of the reference."""
    frames = tracks(swing, 0.3)
    t_s = np.arange(len(frames)) / RATE_HZ
    frames[:, 0] = 0.1 * np.sin(2 * np.pi * reference_hz / 6 * t_s)
    band = f"one that passes {reference_hz * 2 / 3:.0f} to {reference_hz * 4 / 3:.0f} Hz"
    said = rf"carries the check signal of {reference_hz / 6:.0f} Hz and not the carrier.*{band}"
    with pytest.raises(TapeFault, match=said):
        bearings(frames, TapeFormat(reference_hz=reference_hz))
    for hz in (reference_hz / 6 * 0.88, reference_hz / 6 * 1.12):
        frames[:, 0] = 0.1 * np.sin(2 * np.pi * hz * t_s)
        with pytest.raises(TapeFault, match=f"carries {hz:.0f} Hz where the reference"):
            bearings(frames, TapeFormat(reference_hz=reference_hz))


@pytest.mark.parametrize(
    ("off", "is_let_pass"), [(-0.09, True), (0.09, True), (-0.11, False), (0.11, False)]
)
def test_a_reference_that_is_a_little_off_is_the_tape_s_speed(
    off: float, is_let_pass: bool
) -> None:
    frames = tracks(lambda t_s: np.zeros((len(t_s), 3)), 0.3, Transport(speed=1 + off))
    if is_let_pass:
        assert bearings(frames).reference_hz == pytest.approx((1 + off) * REFERENCE_HZ, abs=1)
    else:
        with pytest.raises(TapeFault, match="where the reference of 6000 Hz should be"):
            bearings(frames)


def test_a_track_of_noise_is_told() -> None:
    frames = tracks(swing, 0.3)
    frames[:, 1] = np.random.default_rng(5).normal(0, 0.3, len(frames))
    with pytest.raises(TapeFault, match=r"track 2 \(X\) has no carrier"):
        bearings(frames)


def test_a_tape_without_a_standstill_starts_at_its_first_row() -> None:
    frames = tracks(lambda t_s: swing(t_s + 1.0), 0.3)
    first = Discriminator(RATE_HZ, REFERENCE_HZ, 8, 4).feed(frames).cycles[0]
    by_hand = TapeFormat(dwell_s=0.0)
    assert np.array_equal(bearings(frames, by_hand).zero_cycles[:2], first[:2])
    with pytest.raises(TapeFault, match=r"the tape starts while . moves, and should stand"):
        bearings(frames)


def block(rows: int = 100) -> Phases:
    """Rows without anything wrong, from row 6000 of the tape."""
    return Phases(
        6000,
        np.zeros((rows, 3)),
        np.zeros((rows, 3), np.float32),
        np.full((rows, 4), 0.5, np.float32),
    )


WATCH = Bearings(np.full(4, 0.5), np.zeros(3), REFERENCE_HZ, ("x", "y", "z"))


def test_nothing_wrong_is_nothing_found() -> None:
    assert WATCH.first_fault(block(), MOTION_RATE_HZ, [0, 0, 0]) is None


@pytest.mark.parametrize(("surprise", "bad"), [(0.24, False), (-0.26, True), (np.nan, True)])
def test_a_jump_is_a_fault_with_axis_and_position(surprise: float, bad: bool) -> None:
    phases = block()
    phases.surprise[12, 1] = surprise
    found = WATCH.first_fault(phases, MOTION_RATE_HZ, [1.0, 2.5, 3.0])
    assert (found is not None) == bad
    if found:
        row, fault = found
        assert row == 12
        assert isinstance(fault, LockFault)
        assert (fault.axis, fault.position_mm) == ("y", 2.5)


def test_decibels() -> None:
    assert (decibels(1.0), decibels(0.001), decibels(0.0)) == ("0 dB", "-60 dB", "none")


@pytest.mark.parametrize("moves_at_s", [0.6, 0.853, 0.856, 0.89])
def test_an_axis_that_starts_before_the_stated_standstill_ends(moves_at_s: float) -> None:
    """Nine tenths of a second count as standstill at most; what moves in the last of it is left out."""

    def ramp(t_s: np.ndarray) -> np.ndarray:
        return np.column_stack([0 * t_s, 0 * t_s, 8.0 * np.maximum(t_s - moves_at_s, 0)])

    found = bearings(tracks(ramp, 1.2, Transport()))
    assert found.zero_cycles == pytest.approx(0, abs=1e-3)
