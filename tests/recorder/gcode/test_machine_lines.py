"""Line numbers and percent signs as a machine wants them, and built-in machines."""

from __future__ import annotations

from pathlib import Path

import pytest

from morfax.motion.faults import CardFault
from morfax.player.gcode.check.checked import check_lines
from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import as_toml, machine
from tests.recorder.gcode.parts import part


def test_lines_have_numbers_and_percent_stands_first_where_the_machine_wants_it(
    tmp_path: Path,
) -> None:
    """As a Fanuc control has it: %, numbers, home at the end, %."""
    text = as_toml("linuxcnc").replace(
        "longest_line = 252", "longest_line = 80\nline_numbers = 10"
    )
    text = text.replace('begin = ["G21', 'begin = ["%", "G21').replace(
        'end = ["M5", "M2"]', 'end = ["M5", "G0 X0 Y0", "M30", "%"]'
    )
    (tmp_path / "fanuc.toml").write_text(text)
    record_blocks(part(), tmp_path / "a.nc", machine_name=str(tmp_path / "fanuc.toml"))
    lines = (tmp_path / "a.nc").read_text().splitlines()
    assert lines[0] == lines[-1] == "%" and lines[1].startswith("(for fanuc")
    words = [line for line in lines if not line.startswith(("(", "%"))]
    assert words[0] == "N10 G21 G17 G40 G49 G54 G80 G90 G94"
    assert [line.split()[0] for line in words] == [
        f"N{10 * k}" for k in range(1, len(words) + 1)
    ]
    read = read_program(tmp_path / "a.nc", machine_name=str(tmp_path / "fanuc.toml"))
    assert read.moves[-1].end_mm[:2] == (0, 0) and read.moves[-1].end_mm[2] > 0
    assert check_lines(lines, machine(str(tmp_path / "fanuc.toml"))).may_start


def test_a_step_of_line_numbers_that_cannot_be_is_refused(tmp_path: Path) -> None:
    for said, mistake in (
        ("line_numbers = 500", "the step of line numbers, 1 to 100, or 0 for none"),
        ("longest_line = 64\nline_numbers = 5", "longest_line must be 71 or more"),
    ):
        (tmp_path / "mine.toml").write_text(f'what = "mine"\n{said}\n')
        with pytest.raises(CardFault, match=mistake):
            machine(str(tmp_path / "mine.toml"))


def test_a_built_in_machine_is_read_once_and_its_values_are_its_own() -> None:
    usual = machine("grbl-router")
    assert machine("grbl-router") is usual
    other = machine("grbl-router", {"speed": 8000.0})
    assert other.values["speed"] == 8000.0 != usual.values["speed"]
    assert machine("grbl-router").values == usual.values
