"""Programs read back for every machine: the tool without Z, dwells, feeds, ends, and whose program it is."""

from __future__ import annotations

import math
import re
from itertools import pairwise
from pathlib import Path

import pytest

from morfax.motion.contour import distance
from morfax.motion.faults import ProgramFault
from morfax.motion.motion import IN_WORK_BELOW_MM, thin
from morfax.player.gcode.machine_reader import ABOVE_MM, MachineReader, machine_of, read_program
from morfax.player.gcode.moves import DWELL, Move
from morfax.player.gcode.pulses import play_pulses
from morfax.player.gcode.rs274 import parse_rs274
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import as_toml, machine, names
from morfax.recorder.gcode.plan import Feeds
from morfax.recorder.media import record
from tests.recorder.gcode.parts import part

UM = 1e-3
READ_BACK_MM = 10 * UM  # the fit's own tolerance; a servo of the simulated machine adds some um


def moves_of(machine_name: str, *lines: str) -> list[Move]:
    """The moves of a few lines for a machine."""
    reader = MachineReader("program", None, machine(machine_name))
    return parse_rs274(lines, "program", None, reader).moves


def z_across(moves: list[Move]) -> list[float]:
    """Z of each move in X and Y."""
    pairs = pairwise(moves)
    return [move.end_mm[2] for before, move in pairs if before.end_mm[:2] != move.end_mm[:2]]


@pytest.mark.parametrize("name", [name for name in names() if not machine(name).is_hpgl])
def test_what_was_written_is_played_within_10_um(name: str, tmp_path: Path) -> None:
    file = tmp_path / f"part{machine(name).suffix}"
    record_blocks(part(), file, machine_name=name)
    playback = play_pulses(file)
    assert playback.program.machine == name
    apart = distance(thin(playback), part())
    assert apart.hausdorff_mm <= READ_BACK_MM


@pytest.mark.parametrize(
    ("name", "down", "up"),
    [
        ("grbl-laser", ["M4 S0", "S800"], ["S0"]),
        ("grbl-pen", ["M3 S90"], ["M5"]),
        ("grbl-pen", ["M3 S90"], ["M3 S0"]),  # a servo that is up at S0
        ("marlin-fan", ["M106 S255"], ["M107"]),
        ("qtplasmac", ["M3 $0 S1"], ["M5 $0"]),
    ],
)
def test_words_put_the_tool_in_the_work(name: str, down: list[str], up: list[str]) -> None:
    lines = ["G0 X1 Y1", *down, "G1 X5 F600", *up, "G0 X9", "M2"]
    assert z_across(moves_of(name, *lines)) == [0.0, ABOVE_MM]
    assert IN_WORK_BELOW_MM < ABOVE_MM


def test_a_laser_s_power_may_stand_beside_the_move() -> None:
    lines = ["M3", "G0 X1 Y1 S0", "G1 X5 F600 S500", "G1 X9 S0", "M2"]
    assert z_across(moves_of("grbl-laser", *lines)) == [0.0, ABOVE_MM]


def test_a_torch_is_off_in_the_overcut_and_slow_in_a_hole() -> None:
    lines = [
        "#<holes> = 4",
        "F#<_hal[plasmac.cut-feed-rate]>",
        "G0 X1 Y1",
        *["M3 $0 S1", "M67 E3 Q60", "G1 X5", "M62 P3", "G1 X9", "M5 $0", "M65 P3", "M68 E3 Q0"],
        *["G0 X1", "M3 $0 S1", "G1 X5", "M5 $0", "M2"],
    ]
    moves = moves_of("qtplasmac", *lines)
    assert z_across(moves) == [0.0, ABOVE_MM, ABOVE_MM, 0.0]
    panel = machine("qtplasmac").panel_feed_mm_s
    cuts = [move.feed_mm_s for move in moves if move.feed_mm_s]
    assert cuts == pytest.approx([0.6 * panel, 0.6 * panel, panel])


def test_dwells_are_in_the_machine_s_own_unit() -> None:
    of_marlin = moves_of("marlin", "G4 P200", "G4 S2", "G0 X1")
    assert [m.dwell_s for m in of_marlin if m.kind == DWELL] == pytest.approx([0.2, 2.0])
    of_grbl = moves_of("grbl-router", "G4 P0.2", "G0 X1", "M2")
    assert of_grbl[0].dwell_s == pytest.approx(0.2)


def test_a_program_of_ours_that_breaks_off_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "part.gcode"
    record_blocks(part(), file, machine_name="marlin")
    whole = file.read_text()
    without = re.sub("; crc32 .*\n", "", whole.replace("; end of the program\n", ""))
    file.write_text(without)
    with pytest.raises(ProgramFault, match="ends with the comment '; end of the program'"):
        read_program(file)
    # one of another origin, of which nothing says where it ends
    file.write_text("G21\nG90\nG0 X1 Y2 Z3\nG1 X5 F600\n")
    with pytest.raises(ProgramFault, match="M2, M30 or %"):
        read_program(file)
    assert len(read_program(file, None, "marlin").moves) == 2


@pytest.mark.parametrize(
    ("lines", "name"),
    [
        (["(for grbl-router: mine)", "G0 X1", "M2"], "grbl-router"),
        (["G0 X1 Y1", "M3 $0 S1", "G1 X5", "M5 $0", "M2"], "qtplasmac"),
        (["G0 X1", "M106 S99", "G1 X5 F9", "M107"], "marlin-fan"),
        (["M4 S0", "G0 X1", "S9", "G1 X5 F9", "S0", "G0 X9", "M2"], "grbl-laser"),
        (["M5", "G0 X1", "M3 S90", "G1 X5 F9", "M5", "M2"], "grbl-pen"),
        (["G0 Z2", "G0 X1", "M3", "G1 X5 F9", "M5", "G0 X9", "M2"], None),
        (["M3 S1000", "G1 X5 F9", "X9", "M5", "M2"], None),  # all of it is cut
    ],
)
def test_a_program_says_which_machine_it_is_for(lines: list[str], name: str | None) -> None:
    found = machine_of(lines)
    assert (found.name if found else None) == name


def test_a_machine_of_one_s_own_is_asked_for_by_its_file(tmp_path: Path) -> None:
    mine, file = tmp_path / "mine.toml", tmp_path / "part.nc"
    mine.write_text(as_toml("grbl-pen"))
    record_blocks(part(), file, machine_name=str(mine))
    with pytest.raises(ProgramFault, match=r"for the machine 'mine'.*--machine mine.toml"):
        read_program(file)
    assert read_program(file, None, str(mine)).moves


def test_feeds_of_a_faster_machine_are_held_and_told(tmp_path: Path) -> None:
    file = tmp_path / "a.nc"
    file.write_text("(for grbl-laser: mine)\nM4 S0\nG0 X1 Y1\nS9\nG1 X5 F6000\nS0\nM2\n")
    playback = play_pulses(file)
    fastest_mm_s = max(move.feed_mm_s for move in playback.program.moves)
    assert fastest_mm_s == 20.0 and "above 48 mm/s" in playback.notes[0]


def test_a_plotter_file_is_played_within_its_steps(tmp_path: Path) -> None:
    file = tmp_path / "part.plt"
    record(part(), file, feeds=Feeds(cut_mm_s=10))
    playback = play_pulses(file)
    step_mm = machine("hpgl").step_mm
    # half a step for the chords, half a step across each axis for the rounding
    allowed_mm = READ_BACK_MM + step_mm / 2 + math.hypot(step_mm, step_mm) / 2
    assert distance(thin(playback), part()).hausdorff_mm <= allowed_mm


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("IN;SP1;\nPU0,0;\nPD400,0;\n", "ends with the pen down; a plotter file ends with PU"),
        (
            "IN;\nSC0,100,0,100;\nPU;",
            "line 2: SC without IP: its units hang on the paper in the plotter",
        ),
        ("IN;PU0,0;PD400,0,400;PU;", "line 1: '400,0,400' is no row of places X,Y"),
        ("", "ends with the pen where it stood"),
    ],
)
def test_a_plotter_file_that_is_not_whole_is_refused(
    text: str, says: str, tmp_path: Path
) -> None:
    file = tmp_path / "part.plt"
    file.write_text(text)
    with pytest.raises(ProgramFault, match=says):
        read_program(file)
