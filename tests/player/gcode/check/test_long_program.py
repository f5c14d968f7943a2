"""Long programs and lines: how far the check is is told, and a line that no control reads is not read."""

from __future__ import annotations

from pathlib import Path

from morfax.player.gcode.check.checked import TOLD_EVERY, check_lines, check_program
from morfax.player.gcode.check.lines import LONGEST_READ
from morfax.recorder.gcode.machine import machine


def test_the_share_that_is_read_is_told_as_it_grows(tmp_path: Path) -> None:
    program, told = tmp_path / "part.ngc", list[float]()
    moves = [f"G1 X{k % 7}" for k in range(3 * TOLD_EVERY)]
    program.write_text("\n".join(["G21 G90 F600", "G0 X0 Y0", *moves, "M2"]))
    checked = check_program(program, machine(), tell=told.append)
    assert checked.lines == len(moves) + 3
    assert len(told) == 4 and told[0] == 0.0 and told == sorted(told) and told[-1] < 1.0


def test_a_line_that_no_control_reads_is_found_and_not_read() -> None:
    lines = ["G21 G90 F600", "G0 X0 Y0", "G1 " + "X1" * LONGEST_READ, "M2"]
    found = check_lines(lines, machine()).findings
    assert [(one.line, one.rule) for one in found if one.stops] == [(3, "length")]
