"""The block recorder: a motion becomes a program of lines, arcs and dwells with feeds, in RS-274.

Signals: a stream of Motion or a Path in, a program file out, in mm, mm/min and s. For LinuxCNC:

    G21 G17 G40 G49 G54 G80 G90 G94      how the machine wants its programs to begin (recorder.gcode.machine)
    G0 Z2                                up to the clearance, Z alone
    G0 X7 Y18.0593                       where the motion starts
    G1 Z-1 F600                          the tool goes down
    G1 X12.4 Y18.0612 F598               lines
    G3 X13.1 Y19.2 I0.2 J1.1             arcs, by the centre from where they begin
    G4 P1                                a dwell
    G0 Z2                                the tool goes up; M5 and M2 end the program

`recorder.gcode.plan` finds the blocks in the motion, `recorder.gcode.tooling` puts a tool that is only up or
down in the place of Z, `recorder.gcode.program_text` writes them in the words of a machine, and
`recorder.gcode.program_head` says at the head what it is.

Source: RS-274-D, as LinuxCNC, Grbl and Marlin take it. Questions: a motion that starts at or below the
surface goes to its place first and then down.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

from morfax.motion.files import written_beside
from morfax.motion.segments import Source
from morfax.recorder.gcode.check_sum import summed
from morfax.recorder.gcode.machine import DEFAULT, TOLERANCE_MM, Machine, machine
from morfax.recorder.gcode.made import Made
from morfax.recorder.gcode.plan import Feeds, Writing, plan
from morfax.recorder.gcode.program_head import head
from morfax.recorder.gcode.program_text import program_text
from morfax.recorder.gcode.running_time import running_time_s
from morfax.recorder.gcode.tooling import without_z
from morfax.recorder.report import Written


@dataclass(frozen=True, slots=True)
class BlockReport(Written):
    """What was recorded: lines (rapids too), arcs, dwells, running time, largest distance from the motion."""

    lines: int
    arcs: int
    dwells: int
    duration_s: float
    deviation_mm: float
    machine: str

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {
            "machine": self.machine,
            "lines": self.lines,
            "arcs": self.arcs,
            "dwells": self.dwells,
            "deviation_mm": self.deviation_mm,
        }


def record_blocks(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float = TOLERANCE_MM,
    arcs: bool = True,
    machine_name: str | Machine = DEFAULT,
    feeds: Feeds | None = None,
    made: Made | None = None,
) -> BlockReport:
    """Record a motion as a program of lines, and arcs if wanted, that stay within the tolerance of it.

    The machine is a built-in one by its name, that of a .toml file, or one at hand. Raises MotionFault,
    FileFault, CardFault for a mistake in a machine's file, ValueError for a name or a tolerance that cannot
    be.
    """
    wanted = machine_name if isinstance(machine_name, Machine) else machine(machine_name)
    if feeds and feeds.cut_mm_s and not wanted.feeds:
        wanted = replace(wanted, panel_feed_mm_s=feeds.cut_mm_s)
    planned = plan(stream, Writing(tolerance_mm, wanted.decimals, arcs and wanted.arcs), feeds)
    start_mm, blocks = planned.start_mm, planned.blocks
    if not wanted.z:
        blocks = without_z(start_mm, blocks, wanted)
    seconds = float(running_time_s(start_mm, blocks, wanted))
    comments = head(planned, blocks, seconds, wanted, made or Made())
    with written_beside(file) as beside:
        text = summed(program_text(start_mm, blocks, wanted, comments), wanted)
        beside.write_text("\n".join([*text, ""]), encoding="ascii")
    turned, dwells = planned.count("G2", "G3"), planned.count("G4")
    return BlockReport(
        FilePath(file),
        len(planned.blocks) - turned - dwells,
        turned,
        dwells,
        seconds,
        planned.deviation_mm,
        wanted.name,
    )
