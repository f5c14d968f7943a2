"""Programs of our own pass the check of their machine, and every mistake that is put into one is found."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.pathfile import read_path
from morfax.player.gcode.check.checked import check_lines, check_program
from morfax.player.gcode.check.motion_rules import Stock
from morfax.recorder.gcode.blocks import record_blocks
from morfax.recorder.gcode.machine import machine, names

SAMPLES = Path(__file__).parents[4] / "samples"
DEEP_MM = 3.0
OF_G_CODE = [name for name in names() if machine(name).suffix not in (".plt", ".hpgl")]
WHOLE_TURN = r"^G[23] .*I"

Programs = Callable[[str, str], Path]


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, str], Path]:
    """A sample's program for a machine, written once."""
    return cache(lambda name, sample: written(name, sample, tmp_path_factory.mktemp(name)))


def written(name: str, sample: str, folder: Path) -> Path:
    """A sample's program for a machine, 3 mm deep."""
    path = read_path(SAMPLES / f"{sample}.csv")
    places = np.array(path.positions_mm)
    places[path.tool, 2] -= DEEP_MM
    file = folder / f"{sample}{machine(name).suffix}"
    record_blocks(replace(path, positions_mm=places), file, machine_name=name)
    return file


@pytest.mark.parametrize("name", OF_G_CODE)
@pytest.mark.parametrize("sample", ["bracket", "program"])
def test_every_program_that_we_write_may_be_started(
    name: str, sample: str, program: Programs
) -> None:
    checked = check_program(program(name, sample), machine(name))
    assert [each.text for each in checked.findings if each.stops] == []
    assert sum(step.in_work and not step.is_rapid for step in checked.steps) > 5


def first(lines: list[str], pattern: str) -> int:
    """Index of the first line like a pattern."""
    return next(k for k, line in enumerate(lines) if re.search(pattern, line))


def in_work(lines: list[str]) -> int:
    """Index of the first line that cuts across: after the tool is down."""
    down = first(lines, r"^(G1.* Z-|M3 S|M3 \$|S1000|M106)")
    return down + 1 + first(lines[down + 1 :], r"^G[123] [XY]")


def without(lines: list[str], pattern: str) -> tuple[list[str], int]:
    """Some lines less, and the place of the first of them."""
    return [line for line in lines if not re.search(pattern, line)], first(lines, pattern)


def changed(lines: list[str], at: int, line: str) -> tuple[list[str], int]:
    """Another line at a place."""
    return [*lines[:at], line, *lines[at + 1 :]], at


def added(lines: list[str], at: int, line: str) -> tuple[list[str], int]:
    """One line more at a place."""
    return [*lines[:at], line, *lines[at:]], at


Mistake = Callable[[list[str]], tuple[list[str], int]]
MISTAKES: dict[str, tuple[str, Mistake]] = {
    "a word that no control takes": ("word", lambda lines: added(lines, 9, "G12 X1")),
    "a garbled number": (
        "word",
        lambda lines: changed(lines, in_work(lines), "G1 X1.2.3 Y5 F9"),
    ),
    "a word that nothing uses": ("word", lambda lines: added(lines, in_work(lines), "G0 R5")),
    "two words of a group": ("group", lambda lines: added(lines, 9, "G90 G91")),
    "the same letter twice": (
        "group",
        lambda lines: added(lines, in_work(lines), "G1 X1 X2 F9"),
    ),
    "a line too long": ("length", lambda lines: added(lines, 9, "G1 X1." + "0" * 300 + " F9")),
    "an arc that misses its end": (
        "arc",
        lambda lines: changed(
            lines,
            first(lines, WHOLE_TURN),
            re.sub(r"I(-?)(\d)", r"I\g<1>3\2", lines[first(lines, WHOLE_TURN)]),
        ),
    ),
    "a rapid through the work": (
        "rapid",
        lambda lines: added(lines, in_work(lines) + 1, "G0 X1 Y1"),
    ),
    "no feed": (
        "feed",
        lambda lines: ([re.sub(r" ?F[\d.#<].*$", "", line) for line in lines], -1),
    ),
    "the tool off": ("tool", lambda lines: without(lines, r"\b(M3|M4|M106)\b")),
    "a bracket left open": ("comment", lambda lines: added(lines, 9, "(a comment")),
    "a part that breaks off": ("end", lambda lines: (lines[: in_work(lines) + 2], -1)),
}


@pytest.mark.parametrize("name", OF_G_CODE)
@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_that_is_put_in_is_found_at_its_line(
    name: str, mistake: str, program: Programs
) -> None:
    rule, made = MISTAKES[mistake]
    lines, at = made(program(name, "bracket").read_text().split("\n")[:-1])
    found = [each for each in check_lines(lines, machine(name)).findings if each.rule == rule]
    if mistake == "a word that nothing uses" and machine(name).takes.one_code:
        assert not found  # Marlin passes over it
        return
    assert found
    if at >= 0 and rule != "tool":
        assert at + 1 in [each.line for each in found]


@pytest.mark.parametrize("name", OF_G_CODE)
def test_a_stock_or_a_travel_too_small_is_found(name: str, program: Programs) -> None:
    file, wanted = program(name, "bracket"), machine(name)
    for stock, rule in ((Stock(5, 5, 18), "stock"), (Stock(900, 900, 1), "depth")):
        found = [each.rule for each in check_program(file, wanted, stock).findings]
        assert (rule in found) == (wanted.z or rule == "stock")
    small = replace(wanted, travel_mm=(10.0, 10.0, 10.0))
    found = [each.rule for each in check_program(file, small).findings if each.stops]
    assert found == ["travel", "travel"]  # X and Y


@pytest.mark.skipif(
    shutil.which("rs274") is None, reason="rs274 of linuxcnc-uspace is not installed"
)
@pytest.mark.parametrize("name", OF_G_CODE)
def test_linuxcnc_s_reader_takes_every_program_whose_words_it_knows(
    name: str, tmp_path: Path, program: Programs
) -> None:
    """QtPlasmaC's panel and Marlin's fan are not there for it: their words are put in its own."""
    text = program(name, "program").read_text()
    text = re.sub(r"F#<_hal[^>]*>", "F3000", text)
    text = re.sub(r"^M106", "M3", re.sub(r"^M107$", "M5", text, flags=re.M), flags=re.M)
    (tmp_path / "tool.tbl").touch()
    (tmp_path / "part.ngc").write_text(text if "\nM2" in text else text + "M2\n")
    words = ["rs274", "-t", "tool.tbl", "-g", "part.ngc"]
    read = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert read.returncode == 0, read.stdout[-400:] + read.stderr[-400:]
    assert read.stdout.count("ARC_FEED") + read.stdout.count("STRAIGHT_FEED") > 20
