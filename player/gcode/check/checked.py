"""The check of a program: what its control would not take, what the work would not, and where it goes.

Signals in: a file, the machine, the stock if one is given. Signals out: the steps of the program in mm, and
findings.

    file ──► lines ──► words ──► follower (the reader) ──► steps ──► motion_rules
               └─────────┴───────────┴──────── findings ────────────────┘

Questions: a program is held to be sure only as far as it is read: a line whose values are computed, or whose
curve is not followed, keeps it from being started, and is found as "not read".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath

from morfax.motion.faults import FileFault, ProgramFault
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.player.gcode.check import motion_rules
from morfax.player.gcode.check.findings import Finding, Findings
from morfax.player.gcode.check.follower import CheckingReader
from morfax.player.gcode.check.lines import ControlInput
from morfax.player.gcode.check.motion_rules import Stock
from morfax.player.gcode.check.steps import Step
from morfax.player.gcode.check.words import WordRules
from morfax.player.gcode.machine_reader import FOR
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.program_text import END

TOLD_EVERY = 2000  # lines: some ms


@dataclass(frozen=True, slots=True)
class Checked:
    """A program as its control reads it."""

    lines: int
    steps: list[Step]
    findings: list[Finding]
    said: list[tuple[int, str]]  # words for the tool, and before which step

    @property
    def may_start(self) -> bool:
        """Whether nothing was found that keeps one from starting the program."""
        return not any(finding.stops for finding in self.findings)


def check_program(
    file: FilePath,
    machine: Machine,
    stock: Stock | None = None,
    tell: Callable[[float], object] = lambda share: None,
) -> Checked:
    """Check a file; raises FileFault if it cannot be read, ProgramFault if it is no text.

    `tell` is told what share of the lines is read.
    """
    try:
        raw = file.read_bytes()
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error
    if b"\0" in raw:
        raise ProgramFault(f"{file} is no text; a program is lines such as G1 X10 Y5 F600")
    # each byte is a character: what a control reads
    lines = raw.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return check_lines(_told(lines, tell), machine, stock)


def _told(lines: list[str], tell: Callable[[float], object]) -> Iterator[str]:
    """The lines, and how far they are."""
    for number, line in enumerate(lines):
        if number % TOLD_EVERY == 0:
            tell(number / len(lines))
        yield line


def check_lines(lines: Iterable[str], machine: Machine, stock: Stock | None = None) -> Checked:
    """Check some lines of text."""
    findings = Findings()
    taken, rules = ControlInput(machine, findings), WordRules(machine, findings)
    follower = CheckingReader("program", machine, findings)
    count, is_ours, is_whole = 0, False, False
    for count, raw in enumerate(lines, 1):
        findings.line = count
        is_ours = is_ours or bool(FOR.match(raw))
        is_whole = is_whole or raw == machine.comment(END)
        words = taken.words(raw)
        if words is not None:
            follower.follow(words, rules.check(words, follower.motion))
        if taken.ended or follower.ended:
            break
    _check_last_line(taken, follower, findings)
    if is_ours and machine.takes.end == "none" and not is_whole:
        allowed = f"{machine.comment(END)!r} in its last line"
        findings.here("end", "the program breaks off", allowed, "get the whole of it")
    steps = _checked_steps(follower, stock, findings)
    return Checked(count, steps, findings.in_order(), follower.said)


def _checked_steps(
    follower: CheckingReader, stock: Stock | None, findings: Findings
) -> list[Step]:
    """The steps of the program, held to the rules of motion."""
    machine, surface_mm = follower.machine, stock.surface_mm if stock else 0.0
    steps = _steps(follower, surface_mm)
    motion_rules.check_rapids(steps, surface_mm, findings)
    motion_rules.check_tool(steps, machine, findings)
    before_z = len(steps) if follower.start[2] is None else follower.unsent[2]
    motion_rules.check_start(steps, machine, before_z, findings)
    motion_rules.check_end(steps, machine, findings)
    motion_rules.check_travel(steps, machine, findings)
    if stock is not None:
        motion_rules.check_stock(steps, stock, findings)
    return steps


def _check_last_line(taken: ControlInput, follower: CheckingReader, findings: Findings) -> None:
    """Find a program without an end, and a tool that it leaves on."""
    ended = taken.ended or follower.ended
    if not taken.begun:
        findings.here(
            "end", "the program holds no line", "lines such as G1 X5", "get the whole of it"
        )
    elif not ended and taken.takes.end == "needed":
        findings.here("end", "the program has no end", "M2, M30 or %", "get the whole of it")
    elif not ended and taken.takes.end == "usual":
        findings.remark("end", "the program has no M2 or M30", "see that it is whole")
    if follower.tool.runs:
        off = "M5" if ("M", 5.0) in follower.machine.tool.off else "its word for off"
        findings.here(
            "end", "the program ends with the tool on", "the tool off", f"put {off} last"
        )


def _steps(follower: CheckingReader, surface_mm: float) -> list[Step]:
    """The moves with where each begins, and whether the tool is in the work."""
    x, y, z = (0.0 if place is None else place for place in follower.start)
    begin, steps = (x, y, z), list[Step]()
    tool = zip(follower.on, follower.working, strict=True)
    for move, (on, in_work) in zip(follower.moves_from(begin), tool, strict=True):
        if follower.machine.z:
            low = min(begin[2], move.end_mm[2])
            in_work = low <= surface_mm + IN_WORK_BELOW_MM
        steps.append(Step(move, begin, on, in_work))
        begin = move.end_mm
    return steps
