"""Blocks as a machine without Z runs them: passes, dots, dwells; holes with their words and an overcut."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.recorder.gcode.arc_places import length_mm, place_at, turned_rad
from morfax.recorder.gcode.closing import loop
from morfax.recorder.gcode.machine import Machine, machine
from morfax.recorder.gcode.program_text import Block, program_text
from morfax.recorder.gcode.tooling import without_z

PEN = Machine("pen", "a pen", z=False, tool_down=("DOWN",), tool_up=("UP",), end=("M2",))
START = np.array([0.0, 0.0, 2.0])


def line(x: float, y: float, z: float, code: str = "G1") -> Block:
    """A line to a place."""
    return Block(code, (x, y, z), feed_mm_s=10.0)


def written(blocks: list[Block], wanted: Machine = PEN) -> list[str]:
    """The lines of a program without its way to the start."""
    return program_text(START, without_z(START, blocks, wanted), wanted, [])[
        len(wanted.begin) + 1 :
    ]


def ring(x: float, y: float, radius: float, z: float) -> list[Block]:
    """A circle in two arcs from its left end, counter-clockwise, with the tool put down and up."""
    return [
        line(x - radius, y, 2, "G0"),
        line(x - radius, y, z),
        Block("G3", (x + radius, y, z), (radius, 0.0), 10.0),
        Block("G3", (x - radius, y, z), (-radius, 0.0), 10.0),
        line(x - radius, y, 2, "G0"),
    ]


def test_a_line_at_two_depths_is_run_twice_with_the_tool_down_once() -> None:
    blocks = [line(0, 0, -1), line(5, 0, -1), line(0, 0, -1), line(0, 0, -2)]
    blocks += [line(5, 0, -2), line(0, 0, -2), line(0, 0, 2, "G0")]
    assert written(blocks) == ["DOWN", "G1 X5 F600", "G1 X0", "G1 X5", "G1 X0", "UP", "M2"]


def test_pecks_are_one_dot_and_a_dwell_above_the_work_is_made_with_the_tool_up() -> None:
    pecks = [line(0, 0, z) for z in (-1, 2, -2, 2)]
    stand = Block("G4", (0, 0, 2), dwell_s=1.0)
    assert written([*pecks, stand]) == ["DOWN", "UP", "G4 P1", "M2"]
    below = Block("G4", (0, 0, -1), dwell_s=1.0)
    assert written([pecks[0], below, pecks[1]]) == ["DOWN", "G4 P1", "UP", "M2"]


def test_a_dot_may_have_words_of_its_own() -> None:
    laser = machine("grbl-laser")
    lines = written([line(0, 0, -1), line(0, 0, 2, "G0")], laser)
    assert lines[:-2] == ["S1000", "G1 F600", "M3", "G4 P0.1", "S0", "M4"]
    # the feed of a dot is not that of the next line
    more = written(
        [line(0, 0, -1), line(0, 0, 2), line(5, 0, 2, "G0"), line(5, 0, 0), line(9, 0, 0)],
        laser,
    )
    assert "G1 X9 F600" in more


def test_a_torch_cuts_a_hole_slower_and_runs_on_with_the_torch_off() -> None:
    torch = machine("qtplasmac")
    lines = written([*ring(50, 50, 5, -1), *ring(50, 50, 40, -1)], torch)
    at = lines.index("M62 P3")
    assert lines[lines.index("M3 $0 S1") + 1] == "M67 E3 Q60"
    assert lines[at + 2 : at + 5] == ["M5 $0", "M65 P3", "M68 E3 Q0"]
    # 4 mm further on a circle of 5 mm: from its left end, turned by 0.8 rad
    x, y = 50 - 5 * math.cos(0.8), 50 - 5 * math.sin(0.8)
    assert lines[at + 1] == f"G3 X{x:.4f} Y{y:.4f} I5 J0"
    assert lines.count("M67 E3 Q60") == 1  # the outside is no hole


@pytest.mark.parametrize(
    ("values", "holds"),
    [({"hole_mm": 0}, "M67"), ({"hole_mm": 9}, "M67"), ({"overcut_mm": 0}, "M62")],
)
def test_a_hole_s_words_are_data(values: dict[str, float], holds: str) -> None:
    torch = machine("qtplasmac", values)
    lines = written([*ring(50, 50, 5, -1), *ring(50, 50, 40, -1)], torch)
    assert not any(each.startswith(holds) for each in lines)


def test_a_hole_with_a_lead_in_is_overcut_along_its_own_line() -> None:
    torch = machine("qtplasmac")
    hole = ring(50, 50, 5, -1)
    lead_in = [line(48, 50, 2, "G0"), line(48, 50, -1), line(45, 50, -1)]
    lines = written([*lead_in, *hole[2:], *ring(50, 50, 40, -1)], torch)
    overcut = lines[lines.index("M62 P3") + 1]
    assert overcut.startswith("G3 ") and overcut.endswith("I5 J0")


def test_places_along_an_arc() -> None:
    arc = Block("G2", (0.0, -10.0, 0.0), (0.0, -5.0), 1.0)
    assert turned_rad((0.0, 0.0, 0.0), arc) == pytest.approx(-math.pi)
    assert length_mm((0.0, 0.0, 0.0), arc) == pytest.approx(5 * math.pi)
    assert place_at((0.0, 0.0, 0.0), arc, 0.5) == pytest.approx((5.0, -5.0))
    whole = Block("G3", (0.0, 0.0, 0.0), (3.0, 0.0), 1.0)
    assert turned_rad((0.0, 0.0, 0.0), whole) == pytest.approx(2 * math.pi)


def test_a_line_closes_between_its_leads() -> None:
    begin, *rest = [
        line(48, 50, -1),
        line(45, 50, -1),
        *ring(50, 50, 5, -1)[2:4],
        line(44, 48, -1),
    ]
    assert loop([begin, *rest]) == (1, 3)
    assert loop([begin, *rest[:2]]) is None
    assert loop([begin, line(48.1, 50, -1)]) is None  # a tick is no ring
