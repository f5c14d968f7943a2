"""The pick-ups against the closed form of their phase, and against the patent's figures as worked out."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.axis import LeadScrew
from morfax.recorder.tape import carrier
from morfax.recorder.tape.carrier import Carrier, PickUp
from morfax.recorder.tape.lacing import BARE, CHUNK_PERIODS, LacingRoom, words_of

FULL = PickUp(level=1.0)
SINE = 1.1e-7 + 6e-8  # of full scale: the polynomial's error, and half a step of float32 near 1
TABLE_S = 1 / 6000


def all_frames(
    pick_up: PickUp, positions: np.ndarray, sizes: list[int] | None = None
) -> np.ndarray:
    made = Carrier(pick_up, positions[0])
    cuts = np.clip(np.cumsum([0, *(sizes or [])]), 0, len(positions)).tolist()
    blocks = np.split(positions, cuts[1:])
    return np.vstack([*(made.frames(block) for block in blocks), made.rest()]).astype(float)


def write(
    cycles: np.ndarray, first: int, reference_cycles: float, level: float, frames: np.ndarray
) -> None:
    """Fill bare frames from displacements by the kernel."""
    wave = carrier._Wave(reference_cycles, np.array([level]), False)
    room = LacingRoom.of(frames.shape[1], len(frames) // (len(cycles) - 3))
    bits, words = np.empty((0, 0)), words_of(frames)
    carrier._write(cycles, first, wave, BARE, bits, room, frames, words)


def swing(samples: int, axes: int = 3) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]:
    """A smooth motion of up to 40 mm/s and 50 mm/s², sampled and as a function of time."""

    def at(t_s: np.ndarray) -> np.ndarray:
        return np.column_stack([30 * np.sin((1.0 + 0.3 * j) * t_s) for j in range(axes)])

    return at(np.arange(samples) * TABLE_S), at


def test_samples_are_the_sine_of_reference_plus_displacement() -> None:
    positions, at = swing(12_000)
    frames = all_frames(FULL, positions)
    assert frames.shape == (8 * 12_000, 4)
    t_s = np.arange(len(frames)) / 48_000
    phase = (6000 * t_s)[:, None] + np.column_stack([0 * t_s, 20 * at(t_s)])
    error = np.abs(frames - np.sin(2 * np.pi * phase))
    # not the first and last periods: before and after them the screws stand, so that they start and stop
    # there
    assert error[8:-16].max() <= SINE + 5e-8


@given(st.lists(st.integers(0, 40), max_size=12))
def test_blocks_do_not_show(sizes: list[int]) -> None:
    positions, _ = swing(100)
    assert np.array_equal(all_frames(FULL, positions, sizes), all_frames(FULL, positions))


def test_the_plain_kernel_is_the_compiled_one(monkeypatch: pytest.MonkeyPatch) -> None:
    positions, _ = swing(50)
    compiled = all_frames(FULL, positions)
    for name in ("_write", "_are_alike", "_cubics", "_sines", "_turned", "finish", "lace"):
        monkeypatch.setattr(carrier, name, getattr(carrier, name).py_func)
    # the compiler may fuse multiply and add
    assert np.abs(all_frames(FULL, positions) - compiled).max() <= SINE


def test_the_chunks_of_the_kernel_do_not_show() -> None:
    # each period by itself is what it is within many; a chunk's last periods are no whole chunk
    periods = 2 * CHUNK_PERIODS + 5
    cycles = np.cumsum(np.random.default_rng(19).normal(0, 0.05, (periods + 3, 3)), axis=0)
    whole, reference_cycles = np.empty((8 * periods, 4), np.float32), 6001.37 / 6000
    write(cycles, 7, reference_cycles, 0.5, whole)
    one = np.empty((8, 4), np.float32)
    for i in range(periods):
        write(cycles[i : i + 4], 7 + i, reference_cycles, 0.5, one)
        assert np.array_equal(one, whole[8 * i : 8 * i + 8])


def test_the_sine_is_a_sine() -> None:
    cycles = np.linspace(-3, 3, 60_001)
    assert np.abs(carrier.sine.py_func(cycles) - np.sin(2 * np.pi * cycles)).max() <= 1.1e-7


def test_an_axis_that_stands_is_made_as_one_that_moves() -> None:
    # it stands, moves, stands elsewhere and stands on; the others never stand
    positions, _ = swing(9 * CHUNK_PERIODS)
    positions[: 2 * CHUNK_PERIODS + 9, 1] = 3.3
    positions[4 * CHUNK_PERIODS :, 1] = positions[4 * CHUNK_PERIODS, 1]
    by_itself = all_frames(FULL, positions[:, 1:2])
    one_by_one = all_frames(FULL, positions[:, 1:2], [1] * len(positions))
    assert np.array_equal(all_frames(FULL, positions)[:, 2], one_by_one[:, 1])
    assert np.array_equal(by_itself, one_by_one)


def test_standstill_is_the_reference_frequency() -> None:
    frames = all_frames(FULL, np.full((1000, 3), 123.456))
    assert np.abs(frames[:, 1:] - frames[:, :1]).max() <= SINE


def test_nothing_drifts_in_ten_hours() -> None:
    # one period after ten hours of a reference that is no whole fraction of the motion rate: float64 keeps
    # 2e-8 cycle
    first_period, reference_cycles = 10 * 3600 * 6000, 6001.37 / 6000
    frames = np.empty((8, 2), np.float32)
    write(np.zeros((4, 1)), first_period, reference_cycles, 1.0, frames)
    exact = (first_period * 600137 % 600000) / 600000 + np.arange(8) / 8 * reference_cycles
    assert np.abs(frames[:, 0] - np.sin(2 * np.pi * exact)).max() <= SINE + 2 * np.pi * 6e-8


def test_a_vibration_leaves_no_images_of_the_motion_rate() -> None:
    # 100 Hz at 0.0127 mm is the drives' 5 m/s²; images would stand at 6 kHz ± 6 kHz ± n 100 Hz
    t_s = np.arange(6000) * TABLE_S
    frames = all_frames(FULL, 0.0127 * np.sin(2 * np.pi * 100 * t_s)[:, None])[:, 1]
    spectrum = np.abs(np.fft.rfft(frames * np.blackman(len(frames)))) / (0.21 * len(frames))
    hz = np.fft.rfftfreq(len(frames), 1 / 48_000)
    outside = np.abs(hz - 6000) > 2500
    # dB below the carrier; 16 bit noise is at -98 in all
    assert 20 * np.log10(spectrum[outside].max()) < -100


def test_the_historic_tracks_have_the_frequencies_worked_out(
    vectors: Callable[[str], Any],
) -> None:
    worked = vectors("mf_tape")
    screw = LeadScrew(worked["params"]["pitch_mm"], worked["params"]["sectors"])
    pick_up = PickUp(worked["params"]["f_ref_hz"], screw.cycles_per_mm, level=1.0)
    for row in worked["rows"]:
        positions = row["axis_speed_mm_s"] * np.arange(6001)[:, None] * TABLE_S
        track = all_frames(pick_up, positions)[:48_001, 1]
        crossings = np.count_nonzero((track[:-1] < 0) & (track[1:] >= 0))  # in one second
        assert crossings == pytest.approx(row["tape_hz"], abs=1.0)


def test_positions_that_do_not_fit_are_misuse() -> None:
    with pytest.raises(ValueError, match=r"give \(n, 3\) mm"):
        Carrier(FULL, np.zeros(3)).frames(np.zeros((5, 2)))


def test_a_tape_of_nothing() -> None:
    assert Carrier(FULL, np.zeros(3)).rest().shape == (0, 4)
    assert all_frames(FULL, np.zeros((1, 3))).shape == (8, 4)
