"""Tapes that are none, or not as they should be: one line that says what was wrong and what to do, an exit
code, no file.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.console.cli import main
from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from tests.console.conftest import Morfax

RATE_HZ = 48000
BY_HAND = ("--reference-frequency", "6kHz", "--cycles-per-mm", "20")


@pytest.fixture
def frames(tape_file: Path) -> np.ndarray:
    """The frames of the tape."""
    return np.asarray(soundfile.read(tape_file, dtype="float32")[0])


@pytest.fixture
def bare_frames(path_file: Path, tmp_path_factory: pytest.TempPathFactory) -> np.ndarray:
    """The frames of the same tape without a check signal."""
    file = tmp_path_factory.mktemp("bare") / "bare.wav"
    assert main(["record", str(path_file), "-o", str(file), "--plain", "--quiet"]) == 0
    return np.asarray(soundfile.read(file, dtype="float32")[0])


def written(frames: np.ndarray, text: str = "", rate_hz: int = RATE_HZ) -> str:
    """A tape with other frames, and its name."""
    with soundfile.SoundFile("bad.wav", "w", rate_hz, frames.shape[1], "PCM_16") as sound:
        if text:
            sound.comment = text
        sound.write(frames)
    return "bad.wav"


def music(seconds: float = 4.0, tracks: int = 4) -> np.ndarray:
    """Chords of a few notes with overtones, another for each track, struck twice a second."""
    random, t_s = np.random.default_rng(440), np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    heard = np.zeros((len(t_s), tracks))
    for track in range(tracks):
        for beat in np.arange(0, seconds, 0.5):
            since = t_s - beat
            for note_hz in 110 * 2 ** (random.integers(0, 30, 3) / 12):
                waves = sum(np.sin(2 * np.pi * n * note_hz * since) / n for n in range(1, 8))
                heard[:, track] += (
                    np.where(since >= 0, np.exp(-4 * np.clip(since, 0, None)), 0) * waves
                )
    return np.asarray(0.5 * heard / np.abs(heard).max(), np.float32)


def refused(morfax: Morfax, name: str, *words: str, exit_code: int = 5) -> str:
    """The one line that play says of it."""
    answer = morfax("play", name, *words, "-o", "bad.csv")
    assert answer.exit_code == exit_code
    assert not Path("bad.csv").exists()
    return answer.fault


def test_music_is_no_tape(morfax: Morfax, here: Path) -> None:
    said = refused(morfax, written(music()))
    assert (
        "does not say its format" in said
        and "--reference-frequency 6kHz --cycles-per-mm 20" in said
    )
    said = refused(morfax, written(music()), *BY_HAND)
    assert "where the reference of 6000 Hz should be" in said


def test_a_mono_tape_has_no_reference(morfax: Morfax, here: Path, frames: np.ndarray) -> None:
    said = refused(morfax, written(frames[:, 1:2]), *BY_HAND)
    assert "has one track; a tape has at least 3: reference, X, Y" in said


def test_a_tape_without_its_reference_cannot_be_known(
    morfax: Morfax, here: Path, bare_frames: np.ndarray
) -> None:
    frames = bare_frames
    said = refused(
        morfax, written(frames[:, 1:]), *BY_HAND
    )  # X, Y, Z: the first of them is taken for the reference
    assert (
        "the reference is on track 3" in said and "--tracks" in said
    )  # Z, which stands longest
    stated = tape_text(here, frames)
    said = refused(morfax, written(frames[:, 1:], stated))
    assert "has 3 tracks, but its text chunk speaks of 4" in said
    silent = frames.copy()
    silent[:, 0] = 0
    said = refused(morfax, written(silent, stated))
    assert "track 1 (reference) is silent" in said and "--tracks" in said


def tape_text(here: Path, frames: np.ndarray) -> str:
    """The text of a tape as it is recorded."""
    fmt = {
        "version": 1,
        "sample_rate_hz": RATE_HZ,
        "reference_hz": 6000.0,
        "cycles_per_mm": 20.0,
        "axes": ["x", "y", "z"],
    }
    places = {"start_mm": [40.0, 30.0, 2.0], "end_mm": [40.0, 30.0, 2.0]}
    return json.dumps({**fmt, **places, "dwell_s": 1.0, "level": 0.5, "samples_per_motion": 8})


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_a_tape_at_another_speed_says_which_reference_it_has(
    morfax: Morfax, here: Path, frames: np.ndarray, share: float
) -> None:
    at_s = np.arange(0, len(frames), share)
    slow = np.column_stack(
        [np.interp(at_s, np.arange(len(frames)), track) for track in frames.T]
    )
    said = refused(morfax, written(slow.astype(np.float32), tape_text(here, frames)))
    assert f"carries {6000 * share:.0f} Hz where the reference of 6000 Hz should be" in said
    assert f"--reference-frequency {6000 * share:.0f}Hz" in said


def test_a_tape_backwards_is_no_other_tape_but_the_tool_goes_up(
    morfax: Morfax, here: Path, bare_frames: np.ndarray
) -> None:
    """Backwards every track turns the other way, so it ends where it should: only Z, which rises, is to be
    seen.
    """
    frames = bare_frames
    answer = morfax(
        "play", written(frames[::-1].copy(), tape_text(here, frames)), "-o", "bad.csv"
    )
    assert answer.exit_code == 5 and "the tape runs backwards" in answer.err
    assert "bad.incomplete.csv" in answer.out
    assert (
        "the tape runs backwards"
        not in morfax("play", written(frames, tape_text(here, frames)), "-o", "good.csv").err
    )


def refused_after_motion(morfax: Morfax, name: str) -> str:
    """The one line of a fault that comes under way: what was played before it is kept under another name."""
    answer = morfax("play", name, "-o", "bad.csv")
    assert answer.exit_code in (5, 6)
    assert not Path("bad.csv").exists()
    return answer.fault


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{ nonsense", "is no JSON object"),
        ("{}", "lacks"),
        ('{"version": 99}', "version 99; this program reads"),
        ("[" * 500, "does not say its format"),
        ("recorded by aunt Ada", "does not say its format"),
    ],
)
def test_a_text_chunk_that_is_none(
    morfax: Morfax, here: Path, frames: np.ndarray, text: str, said: str
) -> None:
    assert said in refused(morfax, written(frames, text))


def test_a_text_chunk_of_ten_megabytes(morfax: Morfax, here: Path, frames: np.ndarray) -> None:
    written(frames, tape_text(here, frames))
    data = Path("bad.wav").read_bytes()
    at = data.index(b"LIST")
    comment = b'{"a": "' + b"x" * 10_000_000 + b'"}'
    info = (
        b"INFOICMT" + len(comment).to_bytes(4, "little") + comment + b"\0" * (len(comment) % 2)
    )
    size = int.from_bytes(data[at + 4 : at + 8], "little")
    data = data[:at] + b"LIST" + len(info).to_bytes(4, "little") + info + data[at + 8 + size :]
    Path("bad.wav").write_bytes(data[:4] + (len(data) - 8).to_bytes(4, "little") + data[8:])
    assert "--reference" in refused(morfax, "bad.wav")  # libsndfile leaves such a chunk out


def test_two_tracks_with_one_signal_are_told(
    morfax: Morfax, here: Path, bare_frames: np.ndarray
) -> None:
    frames = bare_frames
    noisy = frames + np.random.default_rng(1).normal(0, 1e-3, frames.shape).astype(np.float32)
    noisy[:, 2] = noisy[:, 1]
    said = refused(morfax, written(noisy, tape_text(here, frames)))
    assert "tracks 2 (X) and 3 (Y) carry the same signal, noise and all" in said


def test_the_rounding_of_a_tape_of_8_bit_is_no_signal_that_two_tracks_share(
    morfax: Morfax, here: Path, path_file: Path, bare_frames: np.ndarray
) -> None:
    """At standstill all tracks are rounded alike; the phase is off by a thousandth of a cycle, 0.1 um."""
    coarse = (np.round(bare_frames * 128) / 128).astype(np.float32)
    file = written(coarse, tape_text(here, bare_frames))
    assert morfax("play", file, "-o", "coarse.csv").exit_code == 0
    apart = distance(read_path(here / "coarse.csv"), read_path(path_file))
    assert apart.hausdorff_mm < 0.005  # one bit in 64 of the carrier's height is 0.0025 cycle


def test_a_track_that_becomes_noise_stops_the_machine(
    morfax: Morfax, here: Path, frames: np.ndarray
) -> None:
    from_s = round(2.0 * RATE_HZ)
    frames[from_s:, 3] = np.random.default_rng(2).normal(0, 0.35, len(frames) - from_s)
    said = refused_after_motion(morfax, written(frames, tape_text(here, frames)))
    assert "track 4 (Z)" in said or "Z" in said
    assert "2.0" in said or "1.99" in said  # s


def test_a_dropout_before_anything_is_known_says_so(
    morfax: Morfax, here: Path, frames: np.ndarray
) -> None:
    frames[500:1500, 1] = 0  # from 10 ms on, for 21 ms, within the 50 ms that tell the levels
    said = refused(morfax, written(frames, tape_text(here, frames)))
    assert "track 2 (X)" in said and "dropout" in said


@pytest.mark.parametrize(
    ("rate_hz", "reference_hz"),
    [(22050, 2756.25), (44100, 5512.5), (96000, 6000.0), (192000, 6000.0)],
)
@pytest.mark.parametrize("sample", ["16", "24", "32", "float"])
def test_every_rate_and_kind_of_sample_is_played(
    here: Path, rate_hz: int, reference_hz: float, sample: str
) -> None:
    from morfax.motion.motion import Motion, join
    from morfax.player.tape.playback import play
    from morfax.recorder.tape.tape import TapeFormat, record
    from tests.player.carriers import circle

    fmt = TapeFormat(
        sample_rate_hz=rate_hz,
        reference_hz=reference_hz,
        samples_per_motion=max(8, rate_hz // 6000),
    )
    told = circle(3, 10)(np.arange(round(2.6 * fmt.motion_rate_hz)) / fmt.motion_rate_hz)
    record(Motion(told, fmt.motion_rate_hz), "a.wav", fmt, sample=sample)
    rows = round(fmt.dwell_s * fmt.motion_rate_hz)
    played = join(play("a.wav")).positions_mm[rows : rows + len(told)]
    # mm: the following error of 0.5 m/s², four times as large where the loop is half as fast
    assert np.abs(played - told).max() < (2.5e-3 if rate_hz == 22050 else 0.7e-3)


@pytest.mark.parametrize(
    ("tracks", "told"),
    [
        ([1, 2, 3], "track 1 says that it is the X, and should be the reference"),
        ([0, 1, 1, 3], "track 3 says that it is the X, and should be the Y"),
    ],
)
def test_tracks_with_a_check_signal_say_which_they_are(
    morfax: Morfax, here: Path, frames: np.ndarray, tracks: list[int], told: str
) -> None:
    said = refused(morfax, written(frames[:, tracks]), *BY_HAND)
    assert told in said and "--tracks" in said


def test_a_tape_with_a_check_signal_does_not_run_backwards(
    morfax: Morfax, here: Path, frames: np.ndarray
) -> None:
    said = refused(morfax, written(frames[::-1].copy(), tape_text(here, frames)))
    assert "the tape runs backwards" in said
