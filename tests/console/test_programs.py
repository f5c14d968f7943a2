"""Programs in other media by the command line: recorded, played, compared, looked at."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from morfax.motion.contour import distance
from morfax.motion.faults import FileFault
from morfax.motion.pathfile import read_path
from morfax.player.controls import CONTROLS
from morfax.recorder.media import MEDIA, record
from morfax.recorder.steps.file import StepFormat, StepProgram, read_program
from morfax.reports import punched
from tests.console.conftest import SAMPLES, Morfax

UM = 1e-3
WITHIN_MM = {".steps": 12.5 * UM, ".cubic": 4 * UM}


@pytest.mark.parametrize("suffix", WITHIN_MM)
def test_a_path_recorded_and_played_is_the_same_path(
    morfax: Morfax, here: Path, path_file: Path, suffix: str
) -> None:
    recorded = morfax("record", path_file, "-o", f"a{suffix}", "--json")
    assert recorded.exit_code == 0 and recorded.figures["program"] == f"a{suffix}"
    assert recorded.figures["bits_per_mm"] == pytest.approx(
        8 * (here / f"a{suffix}").stat().st_size / (20 * np.pi), rel=1e-3
    )
    played = morfax("play", f"a{suffix}", "-o", "a.csv", "--json")
    assert played.exit_code == 0 and played.figures["duration_s"] == pytest.approx(
        recorded.figures["duration_s"], abs=0.1
    )
    assert distance(read_path("a.csv"), read_path(path_file)).hausdorff_mm < WITHIN_MM[suffix]
    compared = morfax("compare", path_file, f"a{suffix}", "--tolerance", WITHIN_MM[suffix])
    assert compared.exit_code == 0


def test_any_program_becomes_any_other(
    morfax: Morfax, here: Path, path_file: Path, tape_file: Path
) -> None:
    for source, program in (
        (tape_file, "a.steps"),
        ("a.steps", "b.cubic"),
        ("b.cubic", "c.wav"),
    ):
        assert morfax(
            "record", source, "-o", program, "--fit-tolerance", "12.5um", "--quiet"
        ).exit_code == (2 if program.endswith(".wav") else 0)
    assert morfax("record", "b.cubic", "-o", "c.wav").exit_code == 0
    assert morfax("compare", "c.wav", path_file, "--tolerance", "50um").exit_code == 0


def test_the_stairs_of_stepping_motors_are_no_tape(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.steps").exit_code == 0
    answer = morfax("record", "a.steps", "-o", "a.wav")
    assert (
        answer.exit_code == 7
        and "the stairs of stepping motors" in answer.fault
        and not (here / "a.wav").exists()
    )


@pytest.mark.parametrize("suffix", WITHIN_MM)
def test_a_drawing_is_traced_into_any_medium(morfax: Morfax, here: Path, suffix: str) -> None:
    traced = morfax(
        "trace", SAMPLES / "curve.png", "-o", f"part{suffix}", "--path", "part.csv", "--json"
    )
    assert traced.exit_code == 0 and traced.figures["program"] == f"part{suffix}"
    assert (
        morfax(
            "compare", f"part{suffix}", "part.csv", "--tolerance", WITHIN_MM[suffix]
        ).exit_code
        == 0
    )


def test_what_is_for_tapes_only_is_wrong_use(
    morfax: Morfax, here: Path, path_file: Path, tape_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.steps").exit_code == 0
    for words in (
        ["play", "a.steps", "--reference-frequency", "6kHz"],
        ["inspect", "a.steps", "--reference-frequency", "6kHz"],
        ["record", path_file, "-o", "a.wav", "--fit-tolerance", "1um"],
        ["record", path_file, "-o", "a.steps", "--lines-only"],
        ["trace", SAMPLES / "curve.png", "-o", "b.wav", "--fit-tolerance", "1um"],
        ["trace", SAMPLES / "curve.png", "-o", "b.csv", "--lines-only"],
        ["run", SAMPLES / "curve.png", "-o", "b", "--lines-only"],
        ["inspect", tape_file, "--picture", "tape.png"],
        ["record", path_file, "-o", "a.tape"],
        ["inspect", "a.steps", "--picture", "tape.jpg"],
    ):
        answer = morfax(*words)
        assert answer.exit_code == 2 and answer.fault


def test_trace_and_record_take_a_tolerance_and_lines_only(morfax: Morfax, here: Path) -> None:
    """A wider tolerance makes fewer lines, none of them an arc, within it of the traced path."""
    sources = {"trace": SAMPLES / "curve.png", "record": SAMPLES / "curve.csv"}
    for verb, source in sources.items():
        for name, words in (
            ("as-usual.ngc", []),
            ("lines.ngc", ["--lines-only"]),
            ("coarse.ngc", ["--lines-only", "--fit-tolerance", "50um"]),
            ("lines.svg", ["--lines-only"]),
        ):
            assert morfax(verb, source, "-o", name, *words).exit_code == 0
        usual, lines, coarse = (
            Path(name).read_text() for name in ("as-usual.ngc", "lines.ngc", "coarse.ngc")
        )
        assert "\nG3 " in usual and "\nG3 " not in lines and "\nG2 " not in lines
        assert 2 * coarse.count("\nG1 ") < lines.count("\nG1 ")  # as the root of the tolerance
        assert " A " not in Path("lines.svg").read_text()
        answer = morfax("compare", "coarse.ngc", "lines.ngc", "--tolerance", "62um")
        assert answer.exit_code == 0, answer.err  # 50 and 10 um, and 2 of its pulses


def test_a_tolerance_finer_than_the_last_decimal_is_one_line(
    morfax: Morfax, here: Path
) -> None:
    for verb, source in (("trace", "curve.png"), ("record", "curve.csv")):
        answer = morfax(verb, SAMPLES / source, "-o", "a.ngc", "--fit-tolerance", "0.1um")
        assert answer.exit_code == 2 and "give 0.0002 mm or more" in answer.fault
    assert not list(here.iterdir())


def test_a_garbled_program_is_one_line_and_leaves_nothing(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.steps").exit_code == 0
    text = (here / "a.steps").read_text()
    (here / "a.steps").write_text(text[: len(text) // 2])
    for words in (
        ["play", "a.steps", "-o", "b.csv"],
        ["record", "a.steps", "-o", "b.wav"],
        ["inspect", "a.steps"],
    ):
        answer = morfax(*words)
        assert answer.exit_code == 5 and "a.steps" in answer.fault and answer.out == ""
    assert [file.name for file in here.iterdir()] == ["a.steps"]


def test_inspect_tells_what_is_on_a_punched_tape_and_draws_it(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.steps").exit_code == 0
    figures = morfax("inspect", "a.steps", "--picture", "tape.png", "--json").figures
    assert (
        figures["oscillator_hz"] == 10240
        and figures["tool_changes"] == 2
        and figures["channels"] == 8
    )
    assert figures["x_axis"]["from_mm"] == pytest.approx(20, abs=0.01)
    with Image.open(here / "tape.png") as image:
        assert image.info["dpi"][0] == pytest.approx(6 * 25.4, rel=1e-3)
    assert morfax("inspect", "a.steps", "--picture", "tape.svg").exit_code == 0
    assert (here / "tape.svg").read_text().count("<circle") == sum(
        1 for _ in punched.holes(read_program("a.steps"))
    )


def test_inspect_tells_what_is_in_a_cubic_program(
    morfax: Morfax, here: Path, path_file: Path
) -> None:
    assert morfax("record", path_file, "-o", "a.cubic").exit_code == 0
    figures = morfax("inspect", "a.cubic", "--json").figures
    assert figures["counts_per_mm"] == 2000 and figures["start_place_mm"][:2] == pytest.approx(
        [40, 30], abs=1 * UM
    )
    assert morfax("inspect", "a.cubic", "-o", "tape.png").exit_code == 2


def test_holes_stand_where_their_bits_are() -> None:
    found = list(
        punched.holes(StepProgram(StepFormat(), np.array([0b1000_0001, 0b100], np.uint8)))
    )
    assert [hole.diameter_mm for hole in found] == [1.17, 1.83, 1.83, 1.17, 1.83]
    feed, first, eighth = found[:3]
    assert first.x_mm - feed.x_mm == pytest.approx(
        3 * 2.54
    ) and feed.x_mm - eighth.x_mm == pytest.approx(5 * 2.54)
    assert found[4].x_mm - found[3].x_mm == pytest.approx(2.54) and found[
        3
    ].y_mm - feed.y_mm == pytest.approx(2.54)
    (strip,) = punched.strips(StepProgram(StepFormat(channels=5), np.zeros(3, np.uint8)))
    assert strip.width_mm == 17.46 and strip.length_mm == pytest.approx(4 * 2.54)


def test_every_medium_has_a_control_and_both_can_be_loaded() -> None:
    assert set(MEDIA) <= set(CONTROLS)
    for suffix in (".wav", *WITHIN_MM):
        assert callable(MEDIA[suffix].recorder()) and callable(CONTROLS[suffix].player())


def test_a_suffix_without_a_medium_is_told(tmp_path: Path, path_file: Path) -> None:
    with pytest.raises(FileFault, match=r"must end in \.wav"):
        record(read_path(path_file), tmp_path / "a.bin")
