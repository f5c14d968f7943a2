"""Machines and drawings on the command line: what is written for whom, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.gcode.machine import as_toml, machine, names
from tests.console.conftest import SAMPLES, Morfax

CAM = SAMPLES / "cam.csv"


def test_machines_are_listed_and_printed_as_a_file_to_change(
    morfax: Morfax, here: Path
) -> None:
    assert list(morfax("machines", "--json").figures) == names()
    (here / "mine.toml").write_text(
        morfax("machines", "grbl-pen").out.replace("down = 90", "down = 45")
    )
    assert morfax("record", CAM, "-o", "a.nc", "--machine", "mine.toml").exit_code == 0
    assert "M3 S45" in (here / "a.nc").read_text().split("\n")
    assert as_toml("grbl-pen") == morfax("machines", "grbl-pen").out


def test_a_machine_that_is_not_there_is_wrong_use(morfax: Morfax, here: Path) -> None:
    for words in (("machines", "mach3"), ("record", CAM, "-o", "a.nc", "--machine", "mach3")):
        answer = morfax(*words)
        assert (
            answer.exit_code == 2 and "there is no machine 'mach3'; there are" in answer.fault
        )
    assert morfax("record", CAM, "-o", "a.nc", "--machine", "none.toml").exit_code == 8
    assert not list(here.iterdir())


def test_a_mistake_in_a_machine_is_told_with_its_line(morfax: Morfax, here: Path) -> None:
    (here / "mine.toml").write_text('what = "mine"\narcs = 3\n')
    answer = morfax("record", CAM, "-o", "a.nc", "--machine", "mine.toml")
    assert (
        answer.exit_code == 9
        and "mine.toml, line 2: arcs holds 3; it may hold true" in answer.fault
    )
    assert not (here / "a.nc").exists()


@pytest.mark.parametrize("option", [("--machine", "marlin"), ("--plunge", "2mm/s")])
def test_what_g_code_alone_has_is_refused_for_a_tape(
    option: tuple[str, str], morfax: Morfax, here: Path
) -> None:
    answer = morfax("record", CAM, "-o", "a.wav", *option)
    assert answer.exit_code == 2 and f"{option[0]} is for G-code, .ngc" in answer.fault
    assert not list(here.iterdir())


def test_the_feed_that_is_asked_for_is_the_program_s(morfax: Morfax, here: Path) -> None:
    words = ("trace", SAMPLES / "bracket.png", "-o", "a.nc", "--machine", "grbl-router")
    assert morfax(*words, "--feed", "2400mm/min", "--plunge", "120mm/min").exit_code == 0
    feeds = {move.feed_mm_s for move in read_program(here / "a.nc").moves if move.feed_mm_s}
    assert feeds == {40.0, 2.0}


@pytest.mark.parametrize(
    ("suffix", "holds"), [(".dxf", "LWPOLYLINE"), (".svg", "<path"), (".plt", "PD")]
)
def test_a_drawing_of_what_is_cut_for_other_programs(
    suffix: str, holds: str, morfax: Morfax, here: Path
) -> None:
    figures = morfax("trace", SAMPLES / "bracket.png", "-o", f"a{suffix}", "--json").figures
    assert figures["drawn"] == f"a{suffix}" and holds in (here / f"a{suffix}").read_text()


def test_a_pen_needs_no_depth(morfax: Morfax, here: Path) -> None:
    words = (
        "trace",
        SAMPLES / "bracket.png",
        "-o",
        "a.nc",
        "--machine",
        "grbl-pen",
        "--depth",
        "0mm",
    )
    assert morfax(*words).exit_code == 0
    assert "M3 S90" in (here / "a.nc").read_text().split("\n")


def test_a_program_is_read_back_as_its_machine_reads_it(morfax: Morfax, here: Path) -> None:
    words = ("record", CAM, "-o", "a.ngc", "--machine", "qtplasmac")
    assert morfax(*words).exit_code == 0
    for given in ((), ("--machine", "qtplasmac")):
        figures = morfax("compare", "a.ngc", CAM, *given, "--json").figures
        assert figures["largest_mm"] <= 0.010  # um of what was written
    assert morfax("play", "a.ngc", "--machine", "mach3").exit_code == 2


@pytest.mark.parametrize("name", names())
def test_what_was_written_for_a_machine_is_read_back_within_10_um(
    name: str, morfax: Morfax, here: Path
) -> None:
    program = f"a{machine(name).suffix}"
    assert morfax("record", CAM, "-o", program, "--machine", name).exit_code == 0
    compared = morfax("compare", program, CAM, "--machine", name, "--json")
    # um: of G-code; whole steps of a plotter, 25, put a place off by up to 18
    assert compared.figures["largest_mm"] <= (0.025 if name == "hpgl" else 0.010)


def test_a_fast_program_is_compared_as_well_as_a_slow_one(morfax: Morfax, here: Path) -> None:
    words = ("record", CAM, "-o", "a.nc", "--machine", "grbl-laser", "--feed", "3000mm/min")
    assert morfax(*words).exit_code == 0
    assert morfax("compare", "a.nc", CAM, "--json").figures["largest_mm"] <= 0.010


def test_run_goes_the_whole_way_in_a_machine_s_words(morfax: Morfax, here: Path) -> None:
    words = ("run", SAMPLES / "curve.png", "-o", "out", "--machine", "grbl-pen", "--json")
    figures = morfax(*words).figures
    assert figures["program"] == "out/curve.nc" and "tape" not in figures
    assert "M3 S90" in (here / "out" / "curve.nc").read_text().split("\n")
    assert figures["played_to_ink"]["rms_mm"] < 0.01
    tabs = ("--machine", "grbl-pen", "--tabs", "2")
    assert (
        "tabs need a Z axis" in morfax("run", SAMPLES / "cam.png", "-o", "other", *tabs).fault
    )
    refused = morfax("run", SAMPLES / "curve.png", "-o", "other", "--feed", "1200mm/min")
    assert refused.exit_code == 2 and "--feed is for G-code" in refused.fault


def test_a_machine_is_for_g_code_alone(morfax: Morfax, here: Path) -> None:
    answer = morfax("compare", CAM, CAM, "--machine", "marlin")
    assert answer.exit_code == 2 and "--machine is for G-code, .ngc" in answer.fault
    answer = morfax("play", SAMPLES / "cam.wav", "--machine", "marlin")
    assert answer.exit_code == 2 and "--machine is for G-code, .ngc" in answer.fault


def test_values_of_the_machine_and_rapids_are_set_by_name(morfax: Morfax, here: Path) -> None:
    words = ("record", CAM, "-o", "a.gcode", "--machine", "marlin", "--rapid", "1800mm/min")
    assert morfax(*words, "--machine-value", "speed=18000").exit_code == 0
    lines = (here / "a.gcode").read_text().split("\n")
    assert "M3 S18000" in lines
    assert all(" F1800" in line for line in lines if line.startswith("G0 X"))


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--machine-value", "rpm=3"), "no value 'rpm'; its values are: speed, spin_up"),
        (("--machine-value", "speed"), "'speed' is no NAME=NUMBER; give one such as"),
        (("--machine", "hpgl"), "--machine hpgl takes .plt, .hpgl; give -o such a name"),
    ],
)
def test_what_a_machine_does_not_have_is_wrong_use(
    words: tuple[str, ...], says: str, morfax: Morfax, here: Path
) -> None:
    answer = morfax("record", CAM, "-o", "a.ngc", *words)
    assert answer.exit_code == 2 and says in answer.fault
    assert not list(here.iterdir())


def test_a_plotter_file_has_its_speed_and_force_and_is_played(
    morfax: Morfax, here: Path
) -> None:
    words = (
        "record",
        CAM,
        "-o",
        "a.plt",
        "--feed",
        "1200mm/min",
        "--machine-value",
        "force=20",
    )
    assert morfax(*words).exit_code == 0
    assert (here / "a.plt").read_text().startswith("IN;SP1;\nVS2;\nFS20;\nPU")
    figures = morfax("compare", "a.plt", CAM, "--json").figures
    assert figures["largest_mm"] <= 0.025  # half a step each way, chords, and the fit


@pytest.mark.parametrize(
    ("output", "machine", "says"),
    [
        (
            "a.nc",
            ("--machine", "grbl-laser"),
            "grbl-laser has no Z, so a.nc cannot hold depth, pecks",
        ),
        (
            "a.dxf",
            (),
            "a.dxf holds only what is cut, without depth, pecks, dwells: set them in the program",
        ),
        ("a.ngc", (), ""),
    ],
)
def test_what_a_medium_cannot_hold_of_a_card_is_told(
    output: str, machine: tuple[str, ...], says: str, morfax: Morfax, here: Path
) -> None:
    words = ("trace", SAMPLES / "program.png", "--card", SAMPLES / "program.toml", "-o", output)
    answer = morfax(*words, *machine, "--json")
    assert answer.exit_code == 0
    assert says in answer.err if says else "holds no" not in answer.err
    # of a program the machine's time is stated, of a drawing the head's
    seconds = float(str(answer.figures["duration_s"]))
    assert (seconds > 29) == output.endswith(".dxf")


def test_a_machine_that_is_given_reads_the_program_that_is_played(
    morfax: Morfax, here: Path
) -> None:
    """A program of one's own machine, and one of Marlin that ends with its file, need --machine."""
    mine = as_toml("grbl-pen").replace('"M3 S{down}"', '"M4 S{down}"')
    (here / "mine.toml").write_text(mine)
    assert morfax("record", CAM, "-o", "a.nc", "--machine", "mine.toml").exit_code == 0
    assert "give its file with --machine" in morfax("compare", "a.nc", CAM).fault
    compared = morfax("compare", "a.nc", CAM, "--machine", "mine.toml", "--json")
    assert compared.figures["largest_mm"] <= 0.010  # um of what was written
    moves = ["G0 Z2 F600", "G0 X5 Y5 F3000", "G1 Z-1 F200", "G1 X20 F600", "G0 Z2", "M5"]
    (here / "b.gcode").write_text("\n".join(["G21", "G90", "M3 S1000", *moves, ""]))
    assert "with --machine grbl-router or marlin" in morfax("play", "b.gcode").fault
    played = morfax("play", "b.gcode", "--machine", "marlin", "-o", "b.csv", "--json")
    assert played.exit_code == 0
    assert played.figures["end_place_mm"] == pytest.approx([20, 5, 2], abs=0.01)
    assert "see that it is whole" not in played.err
    # Grbl takes a program without an end, and programs for it end as a rule
    played = morfax("play", "b.gcode", "--machine", "grbl-router", "-o", "b.csv", "--force")
    assert played.exit_code == 0 and "no M2 or M30; see that it is whole" in played.err
    (here / "b.gcode").write_text("\n".join(["G21", "G90", "M3 S1000", *moves, "M2", ""]))
    assert "whole" not in morfax("play", "b.gcode", "--machine", "grbl-router").err


def test_what_was_played_is_recorded_in_another_medium(morfax: Morfax, here: Path) -> None:
    assert morfax("record", CAM, "-o", "a.ngc").exit_code == 0
    words = [
        word for name in ("b.dxf", "b.plt", "b.nc", "b.csv", "b.png") for word in ("-o", name)
    ]
    answer = morfax("play", "a.ngc", *words, "--json")
    assert answer.exit_code == 0, answer.err
    assert answer.figures["paths"] == words[1::2]
    assert "from a.ngc, played" in (here / "b.nc").read_text()
    # um: 10 of what is written, 10 of the servos
    for name, most_mm in (("b.dxf", 0.020), ("b.nc", 0.020), ("b.plt", 0.040)):
        assert morfax("compare", name, CAM, "--json").figures["largest_mm"] <= most_mm, name
    assert "must end in" in morfax("play", "a.ngc", "-o", "b.txt").fault


PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "machines.md").read_text("utf-8")


@pytest.mark.parametrize(
    ("what", "name", "most_mm"),
    [
        # um: what is written is within 10 of the path, in steps of 5 too
        ("my router", "a.nc", 0.010),
        ("Grbl with a plasma torch", "a.nc", 0.010),
        ("HP-GL/2 in steps of 5 um", "a.plt", 0.010),
    ],
)
def test_the_machine_files_of_the_page_write_programs_that_are_read_back(
    morfax: Morfax, here: Path, what: str, name: str, most_mm: float
) -> None:
    blocks = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (text,) = (block for block in blocks if f'what = "{what}"' in block)
    (here / "mine.toml").write_text(text)
    assert morfax("record", CAM, "-o", name, "--machine", "mine.toml").exit_code == 0
    compared = morfax("compare", name, CAM, "--machine", "mine.toml", "--json")
    assert compared.figures["largest_mm"] <= most_mm
    if name == "a.plt":  # which says its units itself
        assert morfax("compare", name, CAM, "--json").figures == compared.figures
        return
    assert morfax("check", name, "--machine", "mine.toml").exit_code == 0


def test_a_feed_in_mm_a_minute_without_its_unit_is_doubted(
    morfax: Morfax, path_file: Path, here: Path
) -> None:
    """A bare number is in mm/s; rapids of grbl-router are 50 mm/s, and 15 mm/s in Z."""
    words = ("record", path_file, "-o", "a.nc", "--machine", "grbl-router")
    doubted = morfax(*words, "--feed", "800", "--plunge", "16")
    assert doubted.exit_code == 0
    assert "--feed is 800 mm/s, F48000; grbl-router has rapids of 50 mm/s" in doubted.err
    assert "--plunge is 16 mm/s" in doubted.err
    assert morfax(*words, "--feed", "800mm/min", "--plunge", "15").err == ""
    assert morfax(*words, "--feed", "800", "--rapid", "900").err == ""
    assert "a bare number is in mm/s: give 1200mm/min" in morfax(*words, "--feed", "1200").fault
