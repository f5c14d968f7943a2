"""The check sum of a program: a changed character anywhere is a fault; without it the program is read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from morfax.motion.faults import ProgramFault
from morfax.motion.motion import Path as MotionPath
from morfax.player.gcode.machine_reader import read_program
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import machine, names

SQUARE = np.array(
    [[0, 0, 2], [0, 0, -1], [5, 0, -1], [5, 5, -1], [0, 5, -1], [0, 0, -1], [0, 0, 2]], float
)


def program(folder: Path, name: str = "linuxcnc") -> Path:
    """The program of a square for a machine."""
    file = folder / f"part{machine(name).suffix}"
    record_blocks(MotionPath(np.arange(7.0), SQUARE), file, machine_name=name)
    return file


@pytest.mark.parametrize("name", [name for name in names() if name != "hpgl"])
def test_every_machine_has_one_before_its_end(tmp_path: Path, name: str) -> None:
    file = program(tmp_path, name)
    lines = file.read_text().splitlines()
    at = [k for k, line in enumerate(lines) if "crc32" in line]
    assert len(at) == 1
    assert len(lines) - 4 <= at[0] < len(lines) - 1
    assert read_program(file).moves


def test_a_changed_character_anywhere_is_a_fault(tmp_path: Path) -> None:
    file = program(tmp_path)
    text = file.read_text()
    name = text.index("crc32")
    for at, old in enumerate(text):
        if name <= at < name + 5:
            continue  # a comment of another name: all that the machine obeys is as it was
        new = "7" if old.isdigit() and old != "7" else "8" if old == "7" else None
        if new is None:
            continue
        file.write_text(text[:at] + new + text[at + 1 :])
        with pytest.raises(ProgramFault):
            read_program(file)


def test_it_says_which_line_to_take_out(tmp_path: Path) -> None:
    file = program(tmp_path)
    text = file.read_text().replace("X5 ", "X6 ").replace("X5\n", "X6\n")
    file.write_text(text)
    number = next(k for k, line in enumerate(text.splitlines(), 1) if "crc32" in line)
    with pytest.raises(ProgramFault, match=f"or take line {number} out"):
        read_program(file)
    lines = text.splitlines()
    file.write_text("\n".join([*lines[: number - 1], *lines[number:], ""]))
    assert read_program(file).moves


def test_other_ends_of_lines_change_nothing(tmp_path: Path) -> None:
    file = program(tmp_path)
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    assert read_program(file).moves
