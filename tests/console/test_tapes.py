"""record, play and inspect by their behaviour, and what they say of tapes that are none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import soundfile

from morfax.motion.contour import distance
from morfax.motion.pathfile import read_path
from tests.console.conftest import Morfax

UM = 1e-3
PLAYED_WITHIN_MM = 3 * UM  # what the issue allows at any place
RATE_HZ = 48000
BY_HAND = ("--reference-frequency", "6kHz", "--cycles-per-mm", "20")


def test_a_path_written_as_it_comes_is_the_path_written_whole(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    """With a picture the path is held whole; without one it goes to the file piece by piece: byte for byte
    the same, and so are the figures.
    """
    piece_by_piece = morfax("play", tape_file, "-o", "pieces.csv", "--json").figures
    whole = morfax("play", tape_file, "-o", "whole.csv", "-o", "whole.svg", "--json").figures
    assert Path("pieces.csv").read_bytes() == Path("whole.csv").read_bytes()
    for key in ("duration_s", "length_mm", "start_place_mm", "end_place_mm"):
        assert piece_by_piece[key] == whole[key]


def rewritten(tape: Path, frames: np.ndarray, file: str) -> Path:
    """A tape with other frames and without the text chunk, in the current folder."""
    soundfile.write(file, frames, RATE_HZ, subtype="PCM_16")
    return Path(file)


@pytest.fixture
def frames(tape_file: Path) -> np.ndarray:
    """All frames of the tape."""
    return np.asarray(soundfile.read(tape_file)[0])


def test_a_path_recorded_and_played_is_the_same_path(
    morfax: Morfax, here: Path, path_file: Path, tape_file: Path
) -> None:
    answer = morfax("play", tape_file, "-o", "played.csv", "--json")
    assert answer.exit_code == 0
    found = distance(read_path("played.csv"), read_path(path_file))
    assert found.hausdorff_mm < PLAYED_WITHIN_MM
    assert answer.figures["length_mm"] == pytest.approx(20 * np.pi, abs=PLAYED_WITHIN_MM)
    assert answer.figures["start_place_mm"] == pytest.approx([40, 30, 2], abs=PLAYED_WITHIN_MM)
    assert answer.figures["paths"] == ["played.csv"]


def test_play_writes_all_that_is_asked_for(morfax: Morfax, here: Path, tape_file: Path) -> None:
    answer = morfax("play", tape_file, "-o", "a.csv", "-o", "a.svg", "-o", "a.png", "--quiet")
    assert answer.exit_code == 0 and answer.err == ""
    assert (here / "a.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (here / "a.svg").read_text()
    assert sorted(file.name for file in here.iterdir()) == ["a.csv", "a.png", "a.svg"]


def test_path_names_the_machine_s_path_as_trace_names_the_head_s(
    morfax: Morfax, here: Path, tape_file: Path
) -> None:
    answer = morfax("play", tape_file, "-o", "a.csv", "--path", "b.csv", "--json")
    assert answer.exit_code == 0 and answer.figures["paths"] == ["a.csv", "b.csv"]
    assert (here / "a.csv").read_bytes() == (here / "b.csv").read_bytes()
    refused = morfax("play", tape_file, "--path", "b.svg")
    assert refused.exit_code == 2 and "'--path': 'b.svg' must end in .csv" in refused.fault


def test_raw_keeps_every_sample(morfax: Morfax, here: Path, tape_file: Path) -> None:
    assert morfax("play", tape_file, "-o", "raw.csv", "--raw").exit_code == 0
    seconds = soundfile.info(tape_file).duration
    assert len((here / "raw.csv").read_text().splitlines()) - 1 == pytest.approx(
        seconds * 6000, abs=2
    )


def test_a_tape_without_text_plays_with_what_is_given_by_hand(
    morfax: Morfax, here: Path, path_file: Path, tape_file: Path, frames: np.ndarray
) -> None:
    bare = rewritten(tape_file, frames, "bare.wav")
    told = morfax("play", bare, "-o", "bare.csv")
    assert told.exit_code == 5
    assert "--reference" in told.fault and "--cycles-per-mm" in told.fault
    given = ("--reference-frequency", "6kHz", "--cycles-per-mm", "20", "--from", "40,30")
    assert morfax("play", bare, *given, "-o", "bare.csv").exit_code == 0
    played, truth = read_path("bare.csv"), read_path(path_file)
    assert played.xy_mm[-1] == pytest.approx(truth.xy_mm[-1], abs=PLAYED_WITHIN_MM)
    assert np.ptp(played.xy_mm, axis=0) == pytest.approx([20, 20], abs=PLAYED_WITHIN_MM)


def test_inspect_tells_tracks_carriers_levels_and_travel(
    morfax: Morfax, path_file: Path, tape_file: Path
) -> None:
    figures = morfax("inspect", tape_file, "--json").figures
    assert figures["tracks"] == 4 and figures["sample_rate_hz"] == RATE_HZ
    assert figures["reference_hz"] == 6000 and figures["cycles_per_mm"] == 20
    reference, x, y, z = (
        figures[f"track_{name}"] for name in ("1_reference", "2_x", "3_y", "4_z")
    )
    assert [reference["from_hz"], reference["to_hz"]] == pytest.approx(
        [6000, 6000], abs=1
    )  # a tenth of a bin
    truth = read_path(path_file)
    y_mm_s = np.gradient(truth.xy_mm[:, 1], truth.t_s)
    asked_hz = [6000 + 20 * y_mm_s.min(), 6000 + 20 * y_mm_s.max()]
    assert [y["from_hz"], y["to_hz"]] == pytest.approx(asked_hz, abs=12)  # a bin
    # half of full scale, and the power of the check signal 14 dB below: it changes over three parts in four
    assert reference["level_db"] == pytest.approx(-6.02 + 0.13, abs=0.05)
    assert x["lowest_travel_mm"] == pytest.approx(-20, abs=PLAYED_WITHIN_MM)
    assert z["lowest_travel_mm"] == pytest.approx(-7, abs=PLAYED_WITHIN_MM)
    assert '"version": 1' in figures["text"]


def test_inspect_tells_what_it_can_of_a_tape_that_cannot_be_played(
    morfax: Morfax, here: Path, tape_file: Path, frames: np.ndarray
) -> None:
    answer = morfax("inspect", rewritten(tape_file, frames, "bare.wav"), "--json")
    assert answer.exit_code == 5 and "--reference" in answer.fault
    assert answer.figures["tracks"] == 4
    assert answer.figures["track_1_reference"]["from_hz"] == pytest.approx(6000, abs=1)


def test_a_file_that_is_no_sound_is_no_tape(morfax: Morfax, here: Path) -> None:
    (here / "words.wav").write_text("this is no sound")
    for words in (["play", "words.wav"], ["inspect", "words.wav"]):
        answer = morfax(*words)
        assert answer.exit_code == 5 and "words.wav" in answer.fault and answer.out == ""


@pytest.mark.parametrize("tracks", [1, 2])
def test_too_few_tracks_are_no_tape(
    morfax: Morfax, here: Path, tape_file: Path, frames: np.ndarray, tracks: int
) -> None:
    few = rewritten(tape_file, frames[:, :tracks], "few.wav")
    answer = morfax("play", few, "--reference-frequency", "6kHz", "--cycles-per-mm", "20")
    assert answer.exit_code == 5 and "few.wav" in answer.fault
    assert ("one track", "2 tracks")[tracks - 1] in answer.fault


def test_a_tape_cut_short_is_told(morfax: Morfax, here: Path, tape_file: Path) -> None:
    whole = tape_file.read_bytes()
    (here / "cut.wav").write_bytes(whole[: len(whole) * 2 // 3])
    answer = morfax("play", "cut.wav", "-o", "cut.csv")
    assert answer.exit_code == 5 and "cut.wav" in answer.fault


# with a check signal, up to the last moment at which the tracks have said where they are: 3 · 0.48 s
@pytest.mark.parametrize(("plain", "kept_s"), [(["--plain"], 2.0), ([], 1.44)])
def test_a_silent_track_is_told_and_what_was_played_before_is_kept(
    morfax: Morfax, here: Path, path_file: Path, plain: list[str], kept_s: float
) -> None:
    assert morfax("record", path_file, "-o", "whole.wav", *plain).exit_code == 0
    frames = np.asarray(soundfile.read("whole.wav")[0])
    frames[2 * RATE_HZ :, 1] = 0
    broken = rewritten(Path("whole.wav"), frames, "broken.wav")
    answer = morfax(
        "play",
        broken,
        "--reference-frequency",
        "6kHz",
        "--cycles-per-mm",
        "20",
        "-o",
        "broken.csv",
        "--json",
    )
    assert answer.exit_code == 5 and "X" in answer.fault
    assert answer.figures["incomplete"] is True
    assert not (here / "broken.csv").exists()
    assert read_path("broken.incomplete.csv").t_s[-1] == pytest.approx(kept_s, abs=0.1)


def test_a_recording_with_hiss_before_and_behind_the_tape_plays(
    morfax: Morfax, here: Path, tape_file: Path, frames: np.ndarray
) -> None:
    """As a sound program records it: the recorder runs before the tape does, and after it."""
    noise = np.random.default_rng(3)
    before, behind = (noise.normal(0, 2e-3, (n * RATE_HZ, frames.shape[1])) for n in (2, 3))
    heard = rewritten(tape_file, np.concatenate([before, frames / 3, behind]), "heard.wav")
    assert morfax("play", tape_file, "-o", "tape.csv").exit_code == 0
    answer = morfax("play", heard, "--label", tape_file, "-o", "heard.csv")
    assert answer.exit_code == 0
    assert "2.20 s before it and 3.02 s behind it are left out" in answer.err
    apart = distance(read_path("heard.csv"), read_path("tape.csv"))
    assert apart.hausdorff_mm < PLAYED_WITHIN_MM
    carrier = morfax("inspect", heard, *BY_HAND, "--json").figures["track_1_reference"]
    assert carrier["from_hz"] == pytest.approx(6000, abs=1)  # and not a peak of the hiss
    assert carrier["lowest_level_db"] == pytest.approx(carrier["level_db"], abs=1)


def test_a_motion_too_fast_for_the_tape_is_refused(morfax: Morfax, here: Path) -> None:
    (here / "fast.csv").write_text("t_s,x_mm,y_mm\n0,0,0\n0.1,100,0\n")
    answer = morfax("record", "fast.csv", "-o", "fast.wav")
    assert answer.exit_code == 7 and "1000 mm/s" in answer.fault
    assert [file.name for file in here.iterdir()] == ["fast.csv"]


def test_a_jump_that_no_tape_is_read_across_is_refused_with_its_place(
    morfax: Morfax, here: Path
) -> None:
    (here / "jump.csv").write_text("t_s,x_mm,y_mm\n0,0,0\n1,10,0\n1.1,20,0\n2.1,30,0\n")
    answer = morfax("record", "jump.csv", "-o", "jump.wav")
    assert (
        answer.exit_code == 7
        and "X, at 10.0" in answer.fault
        and "100 mm/s at once" in answer.fault
    )
    assert "up to 33.9 mm/s" in answer.fault and [file.name for file in here.iterdir()] == [
        "jump.csv"
    ]


def test_a_start_that_the_drives_do_not_follow_is_recorded_and_told(
    morfax: Morfax, hasty_file: Path
) -> None:
    answer = morfax("record", hasty_file, "-o", "hasty.wav")
    assert answer.exit_code == 0 and "the drive of X would lose its lock at" in answer.err
    assert morfax("play", "hasty.wav").exit_code == 6
    assert morfax("play", "hasty.wav", "--feed-override", "50%").exit_code == 0


def test_record_takes_a_path_without_times_at_the_feed(morfax: Morfax, here: Path) -> None:
    (here / "line.csv").write_text("x,y\n0,0\n30,40\n")
    answer = morfax("record", "line.csv", "--feed", "25mm/s", "--json")
    assert answer.exit_code == 0
    assert answer.figures["duration_s"] == pytest.approx(
        2 + 2, abs=0.01
    )  # a second of standstill at both ends
    assert (here / "line.wav").exists()


def test_a_tape_that_cannot_be_is_wrong_use(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    """A carrier of 30 kHz has no place on a tape of 48 kHz."""
    answer = morfax("record", path_file, "-o", "high.wav", "--reference-frequency", "30kHz")
    assert answer.exit_code == 2 and "sample rate" in answer.fault
    assert list(here.iterdir()) == []
