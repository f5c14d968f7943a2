"""The kinds of pick-up: their waves against closed forms, no aliases, the coil's amplitude, and the way to
the machine.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.motion import Motion, join
from morfax.player.tape.playback import play
from morfax.recorder.tape import carrier
from morfax.recorder.tape.carrier import Carrier, PickUp
from morfax.recorder.tape.pickups import DECAY, DEFAULT_PICK_UP, PICK_UPS
from morfax.recorder.tape.tape import Tape, TapeFormat, record

RATE_HZ = 6000
OTHERS = [name for name in PICK_UPS if name != DEFAULT_PICK_UP]
ROUNDING = 1.5e-7  # of full scale: the sine's polynomial, and half a step of float32

CLOSED: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "resolver": np.sin,
    "photocell": lambda phi: np.pi / 4 * np.sign(np.sin(phi)),
    "scale": lambda phi: np.pi / 4 * np.arcsin(np.sin(phi)),
    "hall": lambda phi: np.arctan(2 * DECAY * np.sin(phi) / (1 - DECAY**2)) / (2 * DECAY),
    "coil": lambda phi: (
        (1 - DECAY**2) * np.sin(phi) / (1 + 2 * DECAY**2 * np.cos(2 * phi) + DECAY**4)
    ),
}


def track(
    name: str, speed_mm_s: float, seconds: float = 1.0, reference_hz: float = 6000.0
) -> np.ndarray:
    """Frames of a track at an even speed, level 1 (of the fundamental), from the second period on."""
    pick_up = PickUp(reference_hz, 20.0, level=1.0, sensor=PICK_UPS[name])
    positions = speed_mm_s * np.arange(int(seconds * RATE_HZ) + 3)[:, None] / RATE_HZ
    frames = Carrier(pick_up, positions[0]).frames(positions)
    return frames[8 : 8 + int(seconds * 48_000), 1].astype(float)


@pytest.mark.parametrize("name", PICK_UPS)
def test_harmonics_are_those_of_the_closed_form(name: str) -> None:
    count = 10
    phi = 2 * np.pi * (np.arange(1 << 16) + 0.5) / (1 << 16)  # off the photocell's steps
    wave = CLOSED[name](phi)
    for n in range(1, 2 * count, 2):
        amplitude = 2 * np.mean(wave * np.sin(n * phi))
        # 65 536 points round a square's steps: 1e-8 of the wave
        assert PICK_UPS[name].amplitudes(count)[n // 2] == pytest.approx(amplitude, abs=1e-8)
        assert abs(np.mean(wave * np.cos(n * phi))) < 1e-8
    # teeth as wide as gaps
    assert max(abs(np.mean(wave * np.sin(n * phi))) for n in range(2, 2 * count, 2)) < 1e-8


@pytest.mark.parametrize("name", ["resolver", "hall", "coil", "scale"])
def test_a_slow_carrier_holds_the_whole_wave(name: str) -> None:
    # reference 100 Hz: 227 harmonics, of which those left out are below the last one's share
    frames = track(name, 0.0, reference_hz=100.0)
    phi = 2 * np.pi * 100 * np.arange(8, 8 + len(frames)) / 48_000
    # sum of 1/n² from n = 200 on, every second
    left_out = 1 / (2 * 200) if name == "scale" else 0.0
    # the harmonics of a coil are so steep in the fundamental that they make 1.4 of its polynomial's error
    assert np.abs(frames - CLOSED[name](phi)).max() <= left_out + 1.5 * ROUNDING


@pytest.mark.parametrize("name", OTHERS)
@pytest.mark.parametrize("speed_mm_s", [-90.0, -37.0, 0.0, 55.0, 95.0])
def test_nothing_aliases(name: str, speed_mm_s: float) -> None:
    frames = track(name, speed_mm_s)
    # a whole number: every harmonic falls upon one line of the spectrum
    hz = 6000 + 20 * speed_mm_s
    lines = 2 * np.abs(np.fft.rfft(frames)) / len(frames)
    own = [int(n * hz) for n in range(1, 9, 2) if n * hz < 24_000]
    assert lines[own[0]] == pytest.approx(hz / 6000 if name == "coil" else 1.0, abs=ROUNDING)
    lines[own] = 0
    # -120 dB; a square sampled as it is has its fifth harmonic at 30 kHz back at 18, -14 dB
    assert lines.max() < 1e-6


def test_a_square_that_is_not_band_limited_would_fail_that() -> None:
    frames = np.sign(np.sin(2 * np.pi * (4900 * np.arange(48_000) / 48_000 + 0.01)))
    lines = 2 * np.abs(np.fft.rfft(frames)) / len(frames)
    lines[[4900, 14_700]] = 0
    assert lines.max() > 0.1


@pytest.mark.parametrize("speed_mm_s", [-100.0, -20.0, 0.0, 20.0, 100.0])
def test_only_the_coil_grows_with_the_speed_of_the_beat(speed_mm_s: float) -> None:
    for name in PICK_UPS:
        lines = 2 * np.abs(np.fft.rfft(track(name, speed_mm_s))) / 48_000
        expected = (6000 + 20 * speed_mm_s) / 6000 if name == "coil" else 1.0
        assert lines[int(6000 + 20 * speed_mm_s)] == pytest.approx(expected, abs=ROUNDING)


@pytest.mark.parametrize("name", PICK_UPS)
def test_no_sample_is_larger_than_said(name: str) -> None:
    largest = max(np.abs(track(name, speed, 0.2)).max() for speed in np.linspace(-100, 100, 41))
    assert largest <= PICK_UPS[name].largest + ROUNDING


@pytest.mark.parametrize("name", OTHERS)
def test_the_plain_kernel_is_the_compiled_one(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    compiled = track(name, 30.0, 0.01)
    for kernel in ("_write", "_waves", "_wave"):
        monkeypatch.setattr(carrier, kernel, getattr(carrier, kernel).py_func)
    assert np.abs(track(name, 30.0, 0.01) - compiled).max() <= ROUNDING


def reversals(largest_mm_s: float, acceleration_mm_s2: float = 4500.0) -> np.ndarray:
    """Two seconds at an even speed, then two to and fro as hard as the motors can; gently from rest and to
    rest.
    """
    t_s = np.arange(4 * RATE_HZ) / RATE_HZ
    period_s = 4 * largest_mm_s / acceleration_mm_s2
    to_and_fro = 2 * np.abs(2 * ((t_s / period_s) % 1) - 1) - 1
    speed = (
        largest_mm_s
        * np.where(t_s < 2, 1, to_and_fro)
        * np.clip(8 * t_s, 0, 1)
        * np.clip(8 * (4 - t_s), 0, 1)
    )
    x = np.cumsum(speed) / RATE_HZ
    return np.column_stack([x, 0.3 * x, 0 * x])


@pytest.mark.parametrize("name", PICK_UPS)
def test_the_machine_plays_back_what_was_recorded(name: str, tmp_path: Path) -> None:
    positions = reversals(90.0)
    sensor = PICK_UPS[name]
    fmt = TapeFormat(pickup=name, cycles_per_mm=sensor.cycles_per_mm)
    record(Motion(positions), tmp_path / "a.wav", fmt)
    playback = play(tmp_path / "a.wav")
    played = join(playback).positions_mm[RATE_HZ : RATE_HZ + len(positions)]
    steady = slice(2000, 2 * RATE_HZ)  # 90 mm/s, where a coil gives 1.3 of its level
    assert not playback.bridged
    # the third harmonic lies 80 dB down in the discriminator, 1e-4 · 1/3 / 2 pi of a cycle: 5e-6 of 0.1 mm
    assert np.abs(played - positions)[steady].max() < 2e-5
    # at a reversal the motors are at their limit, 0.03 mm behind, and there every pick-up is as good as
    # another
    record(Motion(positions), tmp_path / "b.wav")
    as_sine = join(play(tmp_path / "b.wav")).positions_mm[RATE_HZ : RATE_HZ + len(positions)]
    # (0.5 um of it: the phase of a scale, of twice the pitch, is bent half as much, and rounded less by the
    # low-pass)
    assert np.abs(played - as_sine).max() < 6e-4


def test_the_tape_says_its_pick_up(tmp_path: Path) -> None:
    for name in PICK_UPS:
        record(Motion(np.zeros((600, 3))), tmp_path / "a.wav", TapeFormat(pickup=name))
        with Tape.open(tmp_path / "a.wav") as tape:
            assert tape.format.pickup == name
            assert ('"pickup"' in tape.text, tape.format.version) == (
                (False, 1) if name == DEFAULT_PICK_UP else (True, 2)
            )


def test_a_level_beyond_full_scale_is_refused() -> None:
    for name, sensor in PICK_UPS.items():
        TapeFormat(pickup=name, level=1 / sensor.largest)
        with pytest.raises(ValueError, match="level is"):
            TapeFormat(pickup=name, level=1.001 / sensor.largest)


def test_an_unknown_pick_up_is_refused() -> None:
    with pytest.raises(ValueError, match="one of resolver, photocell"):
        TapeFormat(pickup="gramophone")


@pytest.mark.parametrize("name", PICK_UPS)
def test_the_reference_is_a_sine_of_the_stated_level_whatever_the_pick_ups_are(
    name: str,
) -> None:
    """It is the track of the source itself: eight samples a cycle of the reference, from phase 0 on."""
    carrier = Carrier(PickUp(level=0.4, sensor=PICK_UPS[name]), [0.0])
    travel_mm = np.linspace(0.0, 3.0, 600)[:, None]
    reference = carrier.frames(travel_mm)[:, 0]
    wanted = 0.4 * np.sin(2 * np.pi * np.arange(len(reference)) / 8)
    assert np.abs(reference - wanted).max() < ROUNDING
