"""Each rule for one line, as Grbl's own parser and LinuxCNC's own reader have it.

The table was made with both: gvalidate of grbl-sim, built with Grbl 1.1h (gcode.c, gc_execute_line;
protocol.c, protocol_main_loop), and rs274 of LinuxCNC 2.9 (interp_read.cc, interp_check.cc, interp_array.cc,
interp_arc.cc). Each line stood between "G21 G90 G94", "G0 X0 Y0 Z5" and "M2". Where rs274 is installed, its
column is held against it here.

Not in the table, as we refuse what both take: F0, X--5; a computed place, which is not read.
Refused by LinuxCNC alone, and not by us: a tool that is not in its table, M100 to M199 without their files,
K in an XY arc.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from morfax.player.gcode.check.checked import check_lines
from morfax.recorder.gcode.machine import machine

BEFORE = ["G21 G90 G94", "G0 X0 Y0 Z5"]
OF_THE_WORK = ("rapid", "tool", "start")  # kinds of findings that no control has
# Grbl, LinuxCNC: + takes the line, - refuses it
TABLE = """
++  G0 X1
--  G1 X5
++  G1 X5 F100
--  G1
--  G2 X1 Y1 I1
++  G2 X10 Y0 I5 F100
++  G2 X10 Y0 I5.002 F100
-+  G2 X10 Y0 I5.003 F100
++  G2 X10 Y0 I5 J0.01 F100
-+  G2 I5 F100
++  G2 X0 Y0 I5 F100
++  G2 X10 Y0 R5 F100
-+  G2 X10 Y0 R4.9999 F100
--  G2 X10 Y0 R4.99 F100
--  G2 X0 Y0 R5 F100
--  G2 X10 Y0 F100
-+  G2 Z-1 I5 F100
++  G2 X10 Z-1 I5 F100
--  G18 G2 X10 Z0 I5 F100
--  G19 G2 Y10 Z0 J5 F100
--  G2 X10 Y0 I5 R5 F100
-+  G2 X10 I5 P2 F100
++  G3 X200 Y0 I100.05 F100
--  G3 X200 Y0 I100.06 F100
--  G0 G1 X1 F10
--  G0 X1 X2
--  M3 M5
--  M3 S-1
++  M3 S1000
-+  M7
++  M8
--  M8 M9
-+  M6
--  T-1
--  F-1
--  G1 X1 F0
++  N1 G0 X1
--  N-1 G0 X1
++  N10000000 G0 X1
-+  N10000001 G0 X1
--  %
-+  G64
-+  G64 P0.01
++  G61
-+  G61.1
++  G43.1 Z1
++  G49
-+  G49 G0 X1
++  G40
++  G80
-+  G80 G0 X1
--  G80 X1
-+  G81 X1 Y1 Z-1 R1 F10
-+  G90.1
++  G91.1
--  G91 G90
--  G17 G18
--  G20 G21
++  G20
--  G93 G1 X1
++  G93 G1 X1 F2
-+  G95
++  G94
++  G53 G0 X1
--  G53 G2 X10 I5 F100
++  G54
++  G59
-+  G59.1
--  G54 G55
++  G28
++  G28 X1
--  G28 G0 X1
++  G30
++  G10 L2 P1 X0
--  G10 P1 X0
-+  G10 L2 P1
--  G92
++  G92 X0
--  G92 G0 X1
++  G92.1
++  G4 P1
++  G4 P1 G0 X1
--  G4
--  G4 P-1
--  G4 X1
--  P1
--  I5
--  G0 X1 I5
--  G0 X1 R5
--  G0 X1 L5
--  G0 X1 K5
-+  G0 X1 A5
--  G0 X1 H5
--  G0 X1 D5
--  G0 X1 Q5
--  G0 X1 E5
--  G0 X1 U5
++  X5
++  g0 x5
++  G00 X05.000
++  G0 X.5
++  G0 X5.
--  G0 X
--  G0 X1.2.3
++  G0 X+5
--  G0 X1e3
--  G0.1 X5
--  G1.5 X5 F10
--  M3.1
++  M30
++  M2
++  M1
-+  M60
-+  M62 P1
-+  #1=5
++  /G0 X1
++  (comment) G0 X1
++  G0 (c) X1
--  G0 X1 (a (b) X2
++  G0 X1 ; c
++  ;
--  !
--  G38.6 Z-1 F10
--  G38.2 F10
--  G5 X1 Y1
--  G33 Z1 K1
++  S1000
--  S1000 S2000
-+  M3 $0 S1
--  $H
--  G12
-+  G99
-+  G98
-+  G7
--  M98 P1
++  G0 X12345678901
++  G0 X0.123456789012
--  G1 X0000000000000000000000000000000000000000000000000000000000000000000000000000
--  G1X00000000000000000000000000000000000000000000000000000000000000000000000000000
"""
ROWS = [(row[0], row[1], row[4:]) for row in TABLE.strip().split("\n")]


def takes(name: str, line: str) -> bool:
    """Whether nothing is found that the machine's control would refuse."""
    findings = check_lines([*BEFORE, line, "M2"], machine(name)).findings
    return not any(each.stops and each.rule not in OF_THE_WORK for each in findings)


def test_the_table_has_both_kinds() -> None:
    for column in (0, 1):
        kinds = [row[column] for row in ROWS]
        assert kinds.count("+") > 40 and kinds.count("-") > 40


@pytest.mark.parametrize(("grbl", "linuxcnc", "line"), ROWS, ids=[row[2] for row in ROWS])
def test_a_line_is_taken_or_refused_as_the_control_does(
    grbl: str, linuxcnc: str, line: str
) -> None:
    assert takes("grbl-router", line) == (grbl == "+")
    assert takes("linuxcnc", line) == (linuxcnc == "+")


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
def test_linuxcnc_takes_what_the_table_says_in_one_program(tmp_path: Path) -> None:
    """The lines that end a program, or leave a mode that the next one minds, are left out."""
    ending = {"M30", "M2", "M60", "%", "M0", "M1"}
    lines = [line for _, its, line in ROWS if its == "+" and line not in ending]
    reset = ["G21 G90 G94 G17 G54 G40 G49 G80", "G0 X0 Y0 Z5"]
    program = [text for line in lines for text in (*reset, line)]
    assert rs274(program, tmp_path) == 0


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
@pytest.mark.parametrize("line", [line for _, its, line in ROWS if its == "-"][::6])
def test_linuxcnc_refuses_what_the_table_says(line: str, tmp_path: Path) -> None:
    """Every sixth line: each takes a tenth of a second."""
    assert rs274([*BEFORE, line], tmp_path) != 0


def rs274(lines: list[str], folder: Path) -> int:
    """What LinuxCNC's reader ends with, 0 if it takes all lines."""
    (folder / "tool.tbl").touch()
    (folder / "part.ngc").write_text("\n".join([*lines, "M2", ""]))
    words = ["rs274", "-t", "tool.tbl", "-g", "part.ngc"]
    return subprocess.run(words, cwd=folder, capture_output=True, timeout=300).returncode


@pytest.mark.parametrize("number", ["O0000(PART 7)", "o1234"])
def test_the_number_of_a_program_is_a_line_of_linuxcnc_before_its_words(number: str) -> None:
    """rs274 takes both; Grbl has no letter O. (Told as a subroutine without `PROGRAM_NUMBER`.)"""
    for name, is_told in (("linuxcnc", False), ("grbl-router", True)):
        for lines, is_found in (
            ([number, *BEFORE, "M2"], is_told),
            ([*BEFORE, number, "M2"], True),
        ):
            rules = {found.rule for found in check_lines(lines, machine(name)).findings}
            assert bool(rules & {"not read", "word"}) == is_found, (name, lines)
