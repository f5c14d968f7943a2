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

`recorder.gcode.plan` finds the blocks in the motion, `recorder.gcode.program_text` writes them in the words
of a machine.

Source: RS-274-D, as LinuxCNC, Grbl and Marlin take it. Questions: a motion that starts at or below the
surface goes to its place first and then down.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from morfax.motion.files import written_beside
from morfax.motion.segments import Source
from morfax.recorder.gcode.machine import DEFAULT, machine
from morfax.recorder.gcode.plan import BlockPlan, Feeds, Writing, plan
from morfax.recorder.gcode.program_text import program_text
from morfax.recorder.report import Written

TOLERANCE_MM = 0.01


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
    machine_name: str = DEFAULT,
    feeds: Feeds | None = None,
) -> BlockReport:
    """Record a motion as a program of lines, and arcs if wanted, that stay within the tolerance of it.

    The machine is a built-in one by its name, or that of a .toml file. Raises MotionFault, FileFault,
    CardFault for a mistake in a machine's file, ValueError for a name or a tolerance that cannot be.
    """
    wanted = machine(machine_name)
    planned = plan(stream, Writing(tolerance_mm, wanted.decimals, arcs and wanted.arcs), feeds)
    comments = [f"for {wanted.what}", *_comments(planned, depth=wanted.z)]
    with written_beside(file) as beside:
        text = program_text(planned.start_mm, planned.blocks, wanted, comments)
        beside.write_text("\n".join([*text, ""]), encoding="ascii")
    turned, dwells = planned.count("G2", "G3"), planned.count("G4")
    return BlockReport(
        FilePath(file),
        len(planned.blocks) - turned - dwells,
        turned,
        dwells,
        planned.duration_s,
        planned.deviation_mm,
        wanted.name,
    )


def _comments(planned: BlockPlan, *, depth: bool) -> list[str]:
    """What a person at the machine wants to know before pressing start."""
    cut = [part.points_mm for part in planned.parts if not part.rapid]
    if not cut:
        return [f"about {planned.duration_s:.0f} s, nothing is cut"]
    points = np.vstack(cut)
    x_mm, y_mm, _ = np.ptp(points, axis=0)
    length_mm = sum(float(np.hypot(*np.diff(piece[:, :2], axis=0).T).sum()) for piece in cut)
    down = f", Z down to {points[:, 2].min():.2f} mm" if depth else ""
    return [
        f"cut {x_mm:.2f} x {y_mm:.2f} mm{down}",
        f"length {length_mm:.1f} mm, about {planned.duration_s:.0f} s",
        f"within {planned.deviation_mm:.4f} mm of the traced path",
    ]
