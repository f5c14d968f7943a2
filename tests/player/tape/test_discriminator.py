"""The discriminator against closed forms: phases of known courses, whatever the tape's level, start phase and
speed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.player.tape import discriminator as organ
from morfax.player.tape.band_filter import translating_taps
from morfax.player.tape.discriminator import (
    Discriminator,
    Phases,
    discriminate,
)
from tests.player.carriers import (
    CYCLES_PER_MM,
    MOTION_RATE_HZ,
    RATE_HZ,
    REFERENCE_HZ,
    Transport,
    swing,
    tracks,
)

SECONDS = 1.5
ENDS = slice(8, -8)  # the rows whose filter would reach past the tape are held


def decode(frames: np.ndarray, block_frames: int = 10_000) -> Phases:
    """All phases of a tape, fed in blocks."""
    blocks = (frames[i : i + block_frames] for i in range(0, len(frames), block_frames))
    parts = list(discriminate(blocks, Discriminator(RATE_HZ, REFERENCE_HZ, 8, frames.shape[1])))
    return Phases(
        0,
        *(
            np.vstack([getattr(p, name) for p in parts])
            for name in ("cycles", "surprise", "levels")
        ),
    )


def truth(transport: Transport, rows: int) -> np.ndarray:
    """Displacement in cycles at each row."""
    return swing(transport.programme_s(np.arange(rows) / MOTION_RATE_HZ)) * CYCLES_PER_MM


def error_cycles(transport: Transport) -> np.ndarray:
    """Decoded less true phase, the zero of each axis taken off."""
    phases = decode(tracks(swing, SECONDS, transport))
    error = phases.cycles - truth(transport, len(phases))
    return (error - error[:300].mean(axis=0))[ENDS]


def test_every_eighth_frame_has_a_row_at_its_own_time() -> None:
    phases = decode(tracks(swing, SECONDS))
    assert len(phases) == SECONDS * MOTION_RATE_HZ
    # At 1000 cycles/s a row that stood one frame off would be 0.02 cycle out.
    assert np.abs(phases.cycles - truth(Transport(), len(phases)))[ENDS].max() < 1e-4


def test_a_clean_tape_is_read_to_a_hundred_thousandth_of_a_cycle() -> None:
    # 0.5 nm: what the curve of the low-pass makes of 0.5 m/s² (1e-5 cycle), rounding to float32 far below it.
    assert np.sqrt(np.mean(error_cycles(Transport()) ** 2)) < 1.2e-5


def test_noise_of_40_db_costs_what_the_filter_lets_through() -> None:
    # Noise in an eighth of the band, of two tracks: sqrt(2 · 1e-4 / 16 · 2) / 2 pi / sqrt(2)… = 7.9e-4 cycle
    # at most.
    rms = np.sqrt(np.mean(error_cycles(Transport(noise_db=40)) ** 2))
    assert 6.5e-4 < rms < 8.0e-4


def test_no_cycle_is_lost_at_20_db() -> None:
    # 7.5e-3 cycle RMS; five sigma of the largest of 27 000 values is far from half a cycle.
    assert np.abs(error_cycles(Transport(noise_db=20))).max() < 0.05


def test_flutter_of_half_a_percent_adds_nothing() -> None:
    assert np.abs(error_cycles(Transport(flutter=0.005))).max() < 5e-5  # as without: 2.5 nm


@settings(max_examples=12, deadline=None)
@given(
    level=st.floats(0.01, 0.99),
    start_cycles=st.floats(0, 1),
    offsets=st.tuples(*[st.floats(-0.5, 0.5)] * 3),
    speed=st.floats(0.95, 1.05),
)
def test_gain_start_phase_and_speed_do_not_change_what_a_tape_means(
    level: float, start_cycles: float, offsets: tuple[float, ...], speed: float
) -> None:
    how = Transport(
        level=level, start_cycles=start_cycles, track_cycles=(0.0, *offsets), speed=speed
    )
    assert np.abs(error_cycles(how)).max() < 5e-5


@settings(max_examples=10, deadline=None)
@given(block_frames=st.integers(7, 30_000))
def test_blocks_of_any_length_give_the_same_rows(block_frames: int) -> None:
    frames = tracks(swing, 0.4)
    whole, pieces = decode(frames, len(frames)), decode(frames, block_frames)
    # The order of the sum may differ at the end of a block: float32 rounding, 1e-7 of a turn.
    assert np.abs(whole.cycles - pieces.cycles).max() < 1e-6
    assert np.abs(whole.levels - pieces.levels).max() < 1e-6


def test_samples_as_stored_mean_the_same() -> None:
    stored = np.round(tracks(swing, 0.4) * 32768).astype(np.int16)
    whole = decode((stored / np.float32(32768)).astype(np.float32))
    assert np.abs(decode(stored).cycles - whole.cycles).max() < 1e-6  # float32 rounding
    assert np.abs(decode(stored).levels - whole.levels).max() < 1e-6


def test_level_is_the_amplitude_of_the_carrier() -> None:
    phases = decode(tracks(swing, 0.2, Transport(level=0.3)))
    assert phases.levels == pytest.approx(
        0.3, abs=1e-4
    )  # the mirror of the carrier, 80 dB down


def test_dc_and_second_harmonic_are_kept_out() -> None:
    frames = tracks(swing, SECONDS)
    spoilt = frames + np.float32(0.05) + 0.05 * (2 * frames**2 - 0.25)
    error = (decode(spoilt).cycles - decode(frames).cycles)[ENDS]
    # DC of a tenth of the carrier at -83 dB: 1e-5 cycle. A harmonic of 2.5 %, that of a track moving at -40
    # mm/s comes within 4.4 kHz, where the filter leaves 1.5 %: 6e-5 cycle.
    assert np.abs(error).max() < 8e-5


@pytest.mark.parametrize(
    ("rate_hz", "reference_hz", "decimation", "speed_mm_s"),
    [
        (48000, 6000.0, 8, 90.0),
        (44100, 5512.5, 8, 80.0),
        (96000, 6000.0, 16, 90.0),
        (48000, 400.0, 8, 2.0),
    ],
)
def test_other_rates_and_references(
    rate_hz: int, reference_hz: float, decimation: int, speed_mm_s: float
) -> None:
    t_s = np.arange(rate_hz) / rate_hz
    # A steady run, entered smoothly enough for the predictor.
    way_mm = speed_mm_s * np.where(t_s < 0.5, t_s**2, t_s - 0.25)
    cycles = reference_hz * t_s[:, None] + np.column_stack([0 * t_s, way_mm * CYCLES_PER_MM])
    organ_ = Discriminator(rate_hz, reference_hz, decimation, 2)
    rows = np.vstack(
        [
            p.cycles
            for p in discriminate([np.sin(2 * np.pi * cycles).astype(np.float32)], organ_)
        ]
    )
    ends = organ_.filter_frames // decimation + 1
    expected = way_mm[::decimation, None] * CYCLES_PER_MM
    assert len(rows) == len(expected)
    assert np.abs(rows - expected)[ends:-ends].max() < 5e-4  # 25 nm


def test_a_jump_is_a_surprise_of_its_size() -> None:
    def splice(t_s: np.ndarray) -> np.ndarray:
        return np.column_stack(
            [np.where(t_s > 0.5, 0.4 / CYCLES_PER_MM, 0.0), 0 * t_s, 0 * t_s]
        )

    surprise = np.abs(decode(tracks(splice, 1.0)).surprise)
    assert surprise[:, 0].max() > 0.25
    assert surprise[:, 1:].max() < 0.01


def test_taps_have_no_denormals_and_pass_the_reference_whole() -> None:
    re, im = translating_taps(RATE_HZ, REFERENCE_HZ, 8)
    taps = np.r_[re, im]
    assert np.abs(taps[taps != 0]).min() >= 1e-12
    n = np.arange(len(re)) - len(re) // 2
    turn = np.exp(2j * np.pi * REFERENCE_HZ / RATE_HZ * n)
    assert np.sum((re + 1j * im) * turn) == pytest.approx(1, abs=1e-6)  # float32 taps


def test_stages_agree_with_themselves_as_plain_python(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = tracks(swing, 0.3)[-600:]
    fast = Discriminator(RATE_HZ, REFERENCE_HZ, 8, 4).feed(frames)
    for name in (
        "_wrap",
        "_unlace",
        "_translate",
        "_group",
        "_amplitude",
        "turn",
        "count_turns",
    ):
        monkeypatch.setattr(organ, name, getattr(organ, name).py_func)
    slow = Discriminator(RATE_HZ, REFERENCE_HZ, 8, 4).feed(frames)
    assert np.abs(fast.cycles - slow.cycles).max() < 1e-6
    assert np.abs(fast.levels - slow.levels).max() < 1e-6


@pytest.mark.parametrize("kernel", [organ.turn, organ.turn.py_func])
def test_the_arc_tangent_goes_all_the_way_round(kernel: Callable[..., None]) -> None:
    cycles = np.r_[np.linspace(-0.499, 0.499, 997), 0.25, -0.25, 0.0]
    axis, ref = (
        0.3 * np.exp(2j * np.pi * (cycles + 0.1)),
        np.full(len(cycles), 0.5 * np.exp(0.2j * np.pi)),
    )
    parts = [part.astype(np.float32) for part in (axis.real, axis.imag, ref.real, ref.imag)]
    phase = np.empty(len(cycles))
    kernel(*parts, phase)
    # cycles: float32 parts, and 1e-8 of the polynomial
    assert np.abs(phase - cycles).max() < 5e-8


def test_the_arc_tangent_of_nothing_is_nothing_and_of_no_number_is_none() -> None:
    phase = np.empty(2)
    organ.turn(*np.array([[0, np.nan], [0, 1], [0, 1], [0, 1]], np.float32), phase)
    assert phase[0] == 0
    assert np.isnan(phase[1])


@pytest.mark.parametrize(("reference_hz", "tracks_"), [(0.0, 4), (24000.0, 4), (6000.0, 1)])
def test_impossible_settings_are_refused(reference_hz: float, tracks_: int) -> None:
    with pytest.raises(ValueError, match="give"):
        Discriminator(RATE_HZ, reference_hz, 8, tracks_)


def test_a_tape_shorter_than_the_filter_has_no_rows() -> None:
    assert not list(
        discriminate(
            [np.zeros((50, 4), np.float32)], Discriminator(RATE_HZ, REFERENCE_HZ, 8, 4)
        )
    )
