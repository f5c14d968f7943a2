"""The transport: each part by itself against what it states of itself, and worn tapes as files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import soundfile

from morfax.motion.axis import LeadScrew
from morfax.motion.faults import FileFault, TapeFault
from morfax.recorder.wear import transport
from morfax.recorder.wear.settings import SETS, Wear
from morfax.recorder.wear.transport import Deck, age

RATE_HZ = 48000
SECONDS = 4
HZ = 6000.0


def tones(tracks: int = 4) -> np.ndarray:
    """Four seconds of the reference on all tracks."""
    t_s = np.arange(SECONDS * RATE_HZ) / RATE_HZ
    return np.tile(
        (0.5 * np.sin(2 * np.pi * HZ * t_s)).astype(np.float32)[:, None], (1, tracks)
    )


def worn(
    wear: Wear, frames: np.ndarray | None = None, block: int = 30_000, seed: int = 1
) -> tuple[np.ndarray, Deck]:
    """The frames after a deck, and the deck."""
    frames = tones() if frames is None else frames
    deck = Deck(wear, RATE_HZ, frames.shape[1], seed)
    blocks = (frames[i : i + block].copy() for i in range(0, len(frames), block))
    return np.concatenate(list(deck.frames(blocks))), deck


def test_no_wear_is_a_copy() -> None:
    out, _ = worn(Wear())
    assert len(out) == SECONDS * RATE_HZ
    assert np.abs(out - tones())[50:-50].max() < 1e-4  # -80 dB: the interpolating filter


SKEWED = Wear(skew_s=-0.0015, wow=0.01)  # the last track is read 4.5 ms after the first


@pytest.mark.parametrize("wear", [*SETS.values(), SKEWED], ids=[*SETS, "skewed"])
def test_blocks_do_not_show(wear: Wear) -> None:
    wear = replace(wear, dropouts_per_min=60)
    one, other = worn(wear, block=30_000)[0], worn(wear, block=7_001)[0]
    assert len(one) == len(other)
    assert np.abs(one - other).max() < 1e-6  # rounding to float32


def test_the_time_base_is_what_it_says() -> None:
    wear = Wear(speed=0.015, wow=1e-3, flutter=1e-3, scrape=1e-3, skew_s=1e-5, weave_s=1e-6)
    out, deck = worn(wear)
    t_s = np.arange(RATE_HZ, 3 * RATE_HZ) / RATE_HZ
    for track in (0, 3):
        at = deck.timebase.programme_s(t_s) - track * deck.timebase.lag_s(t_s)
        expected = 0.5 * np.sin(2 * np.pi * HZ * at)
        # laid through every eighth frame: scrape of 0.1 % at 2 kHz is 40 ns of bend, 1e-3 of a cycle at the
        # most
        assert np.abs(out[RATE_HZ : 3 * RATE_HZ, track] - expected).max() < 0.01
    speed = np.diff(deck.timebase.programme_s(np.arange(10 * RATE_HZ) / RATE_HZ)) * RATE_HZ
    assert speed.mean() == pytest.approx(
        1.015, abs=3e-4
    )  # ten seconds hold few periods of the slowest tone
    assert speed.std() == pytest.approx(np.sqrt(3) * 1e-3, rel=0.15)


def test_noise_hum_and_direct_current() -> None:
    out, _ = worn(Wear(noise_db=40, dc=0.01))
    rest = (out - tones())[100:-100]
    assert rest.mean() == pytest.approx(0.01, abs=1e-4)
    assert 20 * np.log10(0.5 / np.sqrt(2) / rest.std()) == pytest.approx(40, abs=0.1)
    buzz = (worn(Wear(hum_db=40))[0] - tones())[100:-100]
    assert np.abs(buzz).max() == pytest.approx(0.005, rel=0.5)


def test_crosstalk_and_print_through() -> None:
    frames = np.zeros_like(tones())
    frames[RATE_HZ : 2 * RATE_HZ, 1] = tones()[:RATE_HZ, 1]
    beside, _ = worn(Wear(crosstalk_db=40), frames)
    assert np.abs(beside[:, 0]).max() == pytest.approx(0.005, rel=0.05)
    assert np.abs(beside[:, 3]).max() == pytest.approx(0.00005, rel=0.1)
    echo, _ = worn(Wear(print_db=40, print_s=1.0), frames)
    before, after = echo[100 : RATE_HZ - 100, 1], echo[2 * RATE_HZ + 100 : 3 * RATE_HZ - 100, 1]
    assert np.abs(before).max() == pytest.approx(0.005, rel=0.05)
    assert np.abs(after).max() == pytest.approx(0.005, rel=0.05)


def test_dropouts_are_where_they_say() -> None:
    out, deck = worn(Wear(dropouts_per_min=120, dropout_s=0.01, dropout_db=40))
    assert 2 <= len(deck.dropouts) <= 20
    hole = deck.dropouts[0]
    middle = round((hole.start_s + hole.length_s / 2) * RATE_HZ)
    levels = np.abs(out[middle - 8 : middle + 8]).max(axis=0)
    assert levels[hole.track % 4] == pytest.approx(0.005, rel=0.1)
    assert np.delete(levels, hole.track % 4) == pytest.approx(0.5, rel=0.05)
    everywhere, deck = worn(
        Wear(dropouts_per_min=120, dropout_s=0.01, dropout_db=40, dropout_all=True)
    )
    middle = round((deck.dropouts[0].start_s + deck.dropouts[0].length_s / 2) * RATE_HZ)
    assert np.abs(everywhere[middle - 8 : middle + 8]).max() < 0.006


def test_distortion_bandwidth_level_and_clipping() -> None:
    spectrum = np.abs(np.fft.rfft(worn(Wear(third=0.03))[0][RATE_HZ : 2 * RATE_HZ, 0]))
    assert spectrum[18000] / spectrum[6000] == pytest.approx(0.03, rel=0.1)
    narrow, _ = worn(Wear(bandwidth_hz=6000))
    assert np.abs(narrow[RATE_HZ:-100]).max() == pytest.approx(0.5 / np.sqrt(2), rel=0.02)
    assert np.abs(worn(Wear(level_db=-20))[0][100:-100]).max() == pytest.approx(0.05, rel=0.01)
    assert np.abs(worn(Wear(clip=0.3))[0]).max() == pytest.approx(0.3)


def test_order_and_polarity() -> None:
    frames = tones() * np.array([1, 0.5, 0.25, 0.125], np.float32)
    out, _ = worn(Wear(order=(4, 3, 2, 1), inverted=(2,)), frames)
    levels = np.abs(out[100:-100]).max(axis=0)
    assert levels == pytest.approx(0.5 * np.array([0.125, 0.25, 0.5, 1]), rel=0.01)
    assert np.corrcoef(out[100:-100, 1], frames[100:-100, 2])[0, 1] < -0.99


def test_seeds_are_other_tapes_and_the_same_seed_the_same() -> None:
    one, again, other = (worn(SETS["cassette"], seed=seed)[0] for seed in (1, 1, 2))
    assert np.array_equal(one, again)
    assert not np.array_equal(one[: len(other)], other[: len(one)])


@pytest.mark.parametrize("name", ["w.wav", "w.flac", "w.w64", "w.aiff"])
def test_a_worn_tape_keeps_its_text(tmp_path: Path, name: str) -> None:
    with soundfile.SoundFile(tmp_path / "a.wav", "w", RATE_HZ, 4) as out:
        out.comment = '{"version": 1}'
        out.write(tones())
    aged = age(
        tmp_path / "a.wav",
        tmp_path / name,
        Wear(cut_start_s=0.5, cut_end_s=1.5, stamped_hz=44_100),
    )
    with soundfile.SoundFile(tmp_path / name) as sound:
        assert sound.samplerate == 44_100 == aged.sample_rate_hz
        assert sound.frames == aged.frames == pytest.approx(2 * RATE_HZ, abs=2)
        text = sound.comment or (tmp_path / "w.w64.json").read_text()
    assert text.startswith('{"version": 1}')
    # beside a file that has room for a text lies no other
    beside = ["w.w64.json"] if name == "w.w64" else []
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(["a.wav", name, *beside])


def test_what_cannot_be_worn(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "a.wav", tones(), RATE_HZ)
    (tmp_path / "b.wav").write_text("no sound")
    for wear, said in (
        (Wear(order=(1, 2)), "each of the tracks"),
        (Wear(inverted=(5,)), "tracks are 1 to 4"),
        (Wear(wow=-1), "zero or more"),
        (Wear(speed=float("nan")), "finite"),
        (Wear(cut_end_s=99), "leave nothing"),
    ):
        with pytest.raises(ValueError, match=said):
            age(tmp_path / "a.wav", tmp_path / "w.wav", wear)
    with pytest.raises(FileFault, match="check the name"):
        age(tmp_path / "none.wav", tmp_path / "w.wav", Wear())
    with pytest.raises(TapeFault, match="is no tape"):
        age(tmp_path / "b.wav", tmp_path / "w.wav", Wear())
    assert not (tmp_path / "w.wav").exists()
    assert transport.BLOCK_FRAMES > 0


def test_skew_is_an_error_of_the_axis_as_worked_out(vectors: Callable[[str], Any]) -> None:
    """600 urad of azimuth between tracks 5 mm apart at 7.5 in/s: 15.75 us, 0.0063 cycle, 0.787 um."""
    worked = vectors("mf_tape")
    told, given = worked["skew"], worked["params"]
    skew_s = 600e-6 * told["track_spacing_mm"] / (told["tape_ips"] * 25.4)
    assert skew_s == pytest.approx(told["time_us"] * 1e-6, rel=1e-3)
    out, _ = worn(Wear(skew_s=skew_s))
    t_s = np.arange(RATE_HZ, 2 * RATE_HZ) / RATE_HZ
    turns = np.exp(-2j * np.pi * HZ * t_s) @ out[RATE_HZ : 2 * RATE_HZ, :2]
    late_s = -np.angle(turns[1] / turns[0]) / (2 * np.pi * HZ)
    cycles = late_s * given["f_ref_hz"]
    assert cycles == pytest.approx(told["cycles_at_400Hz"], rel=0.005)
    error_um = 1e3 * cycles * LeadScrew(given["pitch_mm"], given["sectors"]).mm_per_cycle
    assert error_um == pytest.approx(told["axis_error_um"], rel=0.005)
