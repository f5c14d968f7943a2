"""Machines as data: every built-in one, files of one's own, mistakes with their line, programs in their
words.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from morfax.motion.faults import CardFault, FileFault
from morfax.player.gcode.hpgl_reader import ABOVE_MM
from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import as_toml, machine, names
from morfax.recorder.gcode.machine_fields import FIELDS
from morfax.recorder.gcode.plan import Feeds
from tests.recorder.gcode.parts import CORNERS_MM, part

BUILT_IN = [
    "grbl-laser",
    "grbl-pen",
    "grbl-router",
    "linuxcnc",
    "marlin",
    "marlin-fan",
    "qtplasmac",
]
# words of Grbl 1.1 (its wiki, "G-code quick reference"); one letter may stand once in a line
GRBL_WORDS = r"G(0|1|2|3|4|17|21|40|49|54|80|90|94)|M(2|3|4|5)|[XYZIJFSP]-?\d+(\.\d+)?"


def program(name: str, folder: Path, feeds: Feeds | None = None) -> list[str]:
    """The lines of the part's program for a machine."""
    file = folder / f"part{machine(name).suffix}"
    record_blocks(part(), file, machine_name=name, feeds=feeds)
    return file.read_text().split("\n")[:-1]


def test_the_built_in_machines_are_these() -> None:
    assert names() == sorted([*BUILT_IN, "hpgl"])
    assert machine().name == "linuxcnc"


@pytest.mark.parametrize("name", BUILT_IN)
def test_every_line_is_as_the_machine_wants_it(name: str, tmp_path: Path) -> None:
    wanted, lines = machine(name), program(name, tmp_path)
    assert max(map(len, lines)) <= wanted.longest_line
    ends = lines if lines[-1] == wanted.end[-1] else lines[:-1]
    assert ends[-len(wanted.end) :] == list(wanted.end)
    assert lines[-1] in ("M2", "; end of the program")
    moves = [line for line in lines if re.match(r"G[0123] ", line)]
    decimals = [len(digits) for line in moves for digits in re.findall(r"\.(\d+)", line)]
    assert max(decimals, default=0) <= wanted.decimals
    assert any(" Z" in line for line in moves) == wanted.z
    assert any(" F" in line for line in moves) == wanted.feeds


@pytest.mark.parametrize("name", [name for name in BUILT_IN if name.startswith("grbl")])
def test_grbl_s_own_rules_hold(name: str, tmp_path: Path) -> None:
    for line in program(name, tmp_path):
        if line.startswith("("):
            continue
        words = line.split(" ")
        assert all(re.fullmatch(GRBL_WORDS, word) for word in words), line
        letters = [word[0] for word in words if word[0] != "G"]
        assert len(letters) == len(set(letters)), line


@pytest.mark.parametrize("name", ["grbl-router", "linuxcnc"])
def test_a_program_reads_back_to_the_part(name: str, tmp_path: Path) -> None:
    program(name, tmp_path)
    read = read_program(tmp_path / f"part{machine(name).suffix}")
    depths_mm = [move.end_mm[2] for move in read.moves]
    assert min(depths_mm) == -4.0 and read.start_mm == (10, 10, 2)
    places = {move.end_mm for move in read.moves}
    last_digit_mm = 10.0 ** -machine(name).decimals
    for x, y in CORNERS_MM[:3]:
        nearest_mm = min(math.dist(place[:2], (x, y)) for place in places)
        assert nearest_mm <= 2 * last_digit_mm


def test_a_laser_is_off_on_every_rapid_and_on_on_every_cut(tmp_path: Path) -> None:
    power = 0
    for line in program("grbl-laser", tmp_path):
        if line.startswith("S"):
            power = int(line[1:])
        if line.startswith("G0"):
            assert power == 0
        if re.match(r"G[123] ", line):
            assert power == 1000
    assert power == 0


def test_a_pen_makes_one_dot_of_a_hole_in_pecks(tmp_path: Path) -> None:
    lines = program("grbl-pen", tmp_path)
    assert lines.count("M3 S90") == 2  # round the part, and the hole
    assert lines.count("M5") == lines.count("M3 S90") + 2  # at the beginning and at the end


def test_a_torch_takes_its_feed_from_its_panel(tmp_path: Path) -> None:
    lines = program("qtplasmac", tmp_path)
    assert "F#<_hal[plasmac.cut-feed-rate]>" in lines
    assert lines.count("M3 $0 S1") == lines.count("M5 $0") == 2
    assert "#<holes> = 0" in lines
    assert "#<holes> = 4" in machine("qtplasmac", {"holes": 4}).begin


def test_feeds_are_the_motion_s_or_those_that_are_asked_for(tmp_path: Path) -> None:
    assert {
        word for line in program("linuxcnc", tmp_path) for word in re.findall(r"F\S+", line)
    } == {
        "F240",
        "F600",
    }
    asked = program("linuxcnc", tmp_path, Feeds(cut_mm_s=40, plunge_mm_s=5))
    assert {word for line in asked for word in re.findall(r"F\S+", line)} == {"F300", "F2400"}


def test_a_machine_of_one_s_own_is_a_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    text = as_toml("grbl-router").replace("speed = 10000", "speed = 8000")
    file.write_text(text.replace("arcs = true", "arcs = false"))
    lines = program(str(file), tmp_path)
    assert "M3 S8000" in lines and not any(line.startswith(("G2 ", "G3 ")) for line in lines)
    assert machine(str(file)).name == "mine"


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("z = 1", r"mine.toml, line 1: z holds 1; it may hold true or false"),
        ("decimals = 9", r"decimals holds 9; it may hold 2 to 6 decimals of a mm"),
        (
            'begin = ["G21", "S{rpm} M3"]',
            r"begin\[2\] holds .*\{rpm\} stands in no line of \[values\]; add rpm = 0",
        ),
        ('suffix = ".txt"', r'suffix holds ".txt"; it may hold ".ngc" or'),
        ("longest_line = 20", r"longest_line holds 20; it may hold 64 characters or more"),
        ('end = ["M5\\nM2"]', r"end\[1\] holds .*one line of plain letters"),
        (
            "spindle = 3",
            r"spindle holds 3; there is no such field; the machine may hold what, suffix",
        ),
        ("[values]\nspeed = true", r"line 2: values.speed holds true; it may hold a number"),
        ("z = ", r"line 1: .* holds"),
        ("travel_mm = [300, 0, 60]", r"it may hold lengths in mm, such as \[300, 180, 60\]"),
        ("rapid_mm_s = true", r"it may hold speeds in mm/s, one for all axes or three"),
        ("corner_mm = -1", r"corner_mm holds -1; it may hold a length in mm above zero"),
    ],
)
def test_a_mistake_is_told_with_its_line(line: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(line + "\n")
    with pytest.raises(CardFault, match=says):
        machine(str(file))


def test_travel_speeds_and_accelerations_are_data(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("z = false\ntravel_mm = [300, 180]\nrapid_mm_s = 80\n")
    mine = machine(str(file))
    assert mine.travel_mm == (300.0, 180.0, math.inf) and mine.rapid_mm_s == (80.0,) * 3
    assert all(machine(name).travel_mm is None for name in names())  # nobody knows it


DOCS = Path(__file__).parents[3] / "docs" / "reference" / "machines.md"


def test_the_reference_names_every_field() -> None:
    text = DOCS.read_text(encoding="utf-8")
    assert [key for key in FIELDS if f"`{key}`" not in text and f"[{key}]" not in text] == []


def test_the_files_of_the_reference_are_machines(tmp_path: Path) -> None:
    files = re.findall(r"```toml\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    router, torch, plotter = (
        tmp_path / name for name in ("router.toml", "torch.toml", "plotter.toml")
    )
    for file, text in zip((router, torch, plotter), files, strict=True):
        file.write_text(text)
    assert machine(str(plotter)).is_hpgl and machine(str(plotter)).step_mm == 0.005
    assert "M3 S18000" in program(str(router), tmp_path)
    lines = program(str(torch), tmp_path)
    at = lines.index("G0 Z3.8")
    assert lines[at : at + 5] == [
        "G0 Z3.8",
        "M3 S1000",
        "G4 P0.5",
        "G1 Z1.5 F1000",
        "G1 X40 F600",
    ]
    read = read_program(tmp_path / "part.nc", None, str(torch))
    assert {move.end_mm[2] for move in read.moves} == {0.0, ABOVE_MM}


def test_values_are_changed_by_name() -> None:
    assert "M3 S18000" in machine("grbl-router", {"speed": 18000}).begin
    with pytest.raises(ValueError, match="no value 'rpm'; its values are: speed, spin_up"):
        machine("grbl-router", {"rpm": 18000})


def test_a_name_that_is_none_names_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(
        ValueError,
        match=r"no machine 'mach3'; there are grbl-laser, grbl-pen, .*or give a .toml",
    ):
        machine("mach3")
    with pytest.raises(FileFault, match="--machine"):
        machine(str(tmp_path / "none.toml"))


def test_a_comment_cannot_end_itself_nor_hide_a_line() -> None:
    assert machine("linuxcnc").comment("a) G0 X9\n(b") == "(a] G0 X9?[b)"
    assert len(machine("grbl-pen").comment("x" * 500)) <= 79


def test_a_comment_writes_letters_of_other_languages_as_people_write_them_in_ascii() -> None:
    """(Fails without `WRITTEN`, or without the accents taken off: "B?gel", "pi?ce".)"""
    named = "Bügel Größe 2–3 µm, pièce łańcuch, Ⅳ, 部.png"
    assert (
        machine("linuxcnc").comment(named)
        == "(Buegel Groesse 2-3 um, piece lancuch, IV, ?.png)"
    )
    decomposed = "Bu\u0308gel"  # as file names of macOS are
    assert machine("linuxcnc").comment(decomposed) == "(Buegel)"


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
@pytest.mark.parametrize(
    "name", ["linuxcnc", "grbl-router", "grbl-laser", "grbl-pen", "qtplasmac"]
)
def test_linuxcnc_reads_every_program_to_its_end(name: str, tmp_path: Path) -> None:
    lines = program(name, tmp_path)
    file = tmp_path / f"part{machine(name).suffix}"
    if name == "qtplasmac":  # rs274 by itself has no panel to ask for the feed
        file.write_text(file.read_text().replace("#<_hal[plasmac.cut-feed-rate]>", "3000"))
    (tmp_path / "tool.tbl").touch()  # else it looks for the example's of a whole installation
    told = subprocess.run(
        ["rs274", "-t", "tool.tbl", "-g", f"part{machine(name).suffix}"],
        cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert told.returncode == 0, told.stderr
    assert "PROGRAM_END" in told.stdout
    cuts = [line for line in lines if re.match(r"G[123] ", line)]
    assert told.stdout.count("STRAIGHT_FEED") + told.stdout.count("ARC_FEED") == len(cuts)
