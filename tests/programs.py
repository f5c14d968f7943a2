"""Every program of G-code that a test writes, read by our rules of its machine and by LinuxCNC's own reader.

The writers put each program together in one place (`recorder.gcode.blocks`), which is watched here; a program
counts once, however many tests write it. After the last test each is read twice:

    player.gcode.check     as the control of its own machine reads it: Grbl, Marlin, LinuxCNC
    rs274 of LinuxCNC      where it is installed, all that have comments in ( ) and M2 at their end: in one
                           file, the reader's state put back between them. From a fault on they are read again

A program that is not taken fails the session, with the test's name and the reader's words. What a test spoils
on purpose bears the mark `no_control`.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from morfax.player.gcode.check.checked import check_lines
from morfax.recorder.gcode import blocks
from morfax.recorder.gcode.machine import Machine

NO_CONTROL = "no_control"
PANEL_FEED = "#<_hal[plasmac.cut-feed-rate]>"  # rs274 by itself has no panel to ask for it
# what a program leaves behind, put back as rs274 has it at its start
AS_AT_THE_START = ("M5", "F0", "S0", "M65 P3", "M68 E3 Q0", "G90", "G0 X0 Y0 Z0")
ENDS = ("M2", "M30")
READER_S = 300.0  # for all programs together, which take a second or two
_NUMBER = re.compile(r"^N\d+ ")
_READING = re.compile(r'COMMENT\("program (\d+)"\)')


class Written(NamedTuple):
    """A program: the test that wrote it first, its machine, and its lines."""

    test: str
    machine: Machine
    lines: list[str]


class Programs:
    """The programs of a session, and what is wrong with them; a plugin of pytest."""

    def __init__(self) -> None:
        self.written = dict[str, Written]()
        self.is_kept = True  # of the present test
        self.faults = list[str]()
        self.told = ""

    def add(self, lines: list[str], machine: Machine) -> None:
        """Keep a program, if it is new."""
        told = "\n".join([machine.name, *lines]).encode()
        test = os.environ.get("PYTEST_CURRENT_TEST", "no test").split(" ")[0]
        self.written.setdefault(
            hashlib.sha256(told).hexdigest(), Written(test, machine, list(lines))
        )

    @pytest.hookimpl(trylast=True)
    def pytest_sessionstart(self) -> None:
        """Watch the place where programs are put together."""
        write = blocks.program_text

        def watched(*given: Any) -> list[str]:
            lines = write(*given)
            if self.is_kept:
                self.add(lines, given[2])
            return lines

        blocks.program_text = watched

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        """Leave out the programs of a test that spoils them."""
        self.is_kept = item.get_closest_marker(NO_CONTROL) is None

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Take the programs of a worker of pytest-xdist that is done."""
        output = getattr(node, "workeroutput", None) or {}  # none of one that crashed
        self.written = pickle.loads(output.get("programs", pickle.dumps({}))) | self.written

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Read them all, or hand them to the session whose worker this is."""
        if hasattr(session.config, "workeroutput"):
            session.config.workeroutput["programs"] = pickle.dumps(self.written)
            return
        programs = list(self.written.values())
        self.faults = [*misread(programs), *refused(programs)]
        if self.faults:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Say what was read, and which programs a control would not take."""
        if not self.written:
            return
        reader = "" if shutil.which("rs274") else " (rs274 of LinuxCNC is not installed)"
        terminalreporter.write_line(f"{len(self.written)} programs read{reader}")
        for fault in self.faults:
            terminalreporter.write_line(f"FAILED {fault}", red=True)


def misread(programs: Sequence[Written]) -> list[str]:
    """What our rules of each program's own machine find in it."""
    found = list[str]()
    for program in programs:
        stops = [
            each.text
            for each in check_lines(program.lines, program.machine).findings
            if each.stops
        ]
        if stops:
            found.append(
                f"{program.test}: check, as {program.machine.name} reads it: {stops[0]}"
            )
    return found


def refused(programs: Sequence[Written]) -> list[str]:
    """What rs274 says of the programs that are in its language; nothing where it is not installed."""
    if shutil.which("rs274") is None:
        return []
    left = [
        each for each in programs if not each.machine.semicolon and _words(each)[-1] in ENDS
    ]
    found = list[str]()
    while left:
        read, words = _rs274(left)
        if read == len(left):
            break
        found.append(f"{left[read].test}: rs274: {words}")
        left = left[read + 1 :]
    return found


def _words(program: Written) -> list[str]:
    """The lines of a program without % and without their numbers."""
    lines = (_NUMBER.sub("", line) for line in program.lines)
    return [line.replace(PANEL_FEED, "3000") for line in lines if line != "%"]


def _rs274(programs: Sequence[Written]) -> tuple[int, str]:
    """How many programs rs274 takes before the first that it does not, and what it says of that one."""
    lines = list[str]()
    for number, program in enumerate(programs):
        lines.append(f"(program {number})")
        lines += _words(program)[:-1]
        lines += AS_AT_THE_START
    with tempfile.TemporaryDirectory() as folder:
        Path(
            folder, "tool.tbl"
        ).touch()  # else it looks for the example's of a whole installation
        Path(folder, "all.ngc").write_text("\n".join([*lines, "M2", ""]), encoding="ascii")
        done = subprocess.run(
            ["rs274", "-t", "tool.tbl", "-g", "all.ngc"],
            cwd=folder, capture_output=True, text=True, timeout=READER_S, check=False,
        )  # fmt: skip
    if done.returncode == 0 and "PROGRAM_END" in done.stdout:
        return len(programs), ""
    words = [line for line in done.stderr.splitlines() if line != "executing"]
    return int(_READING.findall(done.stdout)[-1]), ": ".join(words)
