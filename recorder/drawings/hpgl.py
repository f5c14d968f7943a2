"""The plotter recorder: what a motion cuts, in HP-GL, for pen plotters and vinyl cutters.

    IN;SP1; VS10; FS3;     as the machine's data has it: pen, speed in cm/s, force
    PU400,400;             pen up, to the beginning of a line
    PD1600,400,1600,1200;  pen down, along its places
    PU;SP0;                pen up, and away

Signals: a stream of Motion or a Path in, a file and a report out. Places are whole steps of the machine,
0.025 mm, arcs are chords within a quarter of a step.

Source: Hewlett-Packard, HP-GL reference (plotter units of 0.025 mm; VS in cm/s, FS from 1 to 8); HP-GL/2,
units of the user's own by IP and SC, with which a machine's file may begin. Questions: whole steps of 0.025
mm put a place off by up to 0.018 mm, which no tolerance of 0.010 mm holds; with finer steps the lines are
fitted closer by as much. Places left of or below zero are refused by many plotters, and so are told here. A
dwell of the card has no word in HP-GL, and is left out.
"""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path as FilePath

from morfax.motion.faults import MotionFault
from morfax.motion.files import written_beside
from morfax.motion.segments import Source
from morfax.motion.usual import PLOTTER_MM
from morfax.recorder.drawings.chords import box, chords
from morfax.recorder.drawings.cut_lines import CutLine, cut_lines_of
from morfax.recorder.drawings.drawings import TOLERANCE_MM, DrawingReport
from morfax.recorder.gcode.machine import HPGL, Machine, machine
from morfax.recorder.gcode.made import Made
from morfax.recorder.gcode.plan import Feeds, Writing
from morfax.recorder.gcode.running_time import running_time_s
from morfax.recorder.gcode.tooling import without_z

# HP-GL's plotter units are numbers of 16 bit; those of HP-GL/2 are longer
LARGEST_MM = 32767 * PLOTTER_MM


def record_hpgl(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float = TOLERANCE_MM,
    machine_name: str | Machine = HPGL,
    feeds: Feeds | None = None,
    made: Made | None = None,
) -> DrawingReport:
    """Write what a motion cuts for a pen or cutting plotter; raises MotionFault, FileFault.

    The machine is a built-in one by its name, that of a .toml file, or one at hand. HP-GL has no comments,
    and what the program is made from stands nowhere.
    """
    wanted = machine_name if isinstance(machine_name, Machine) else machine(machine_name)
    feed_mm_s = (feeds.cut_mm_s if feeds else None) or 10 * wanted.values.get("speed", 1.0)
    wanted = replace(wanted, feeds=False, panel_feed_mm_s=feed_mm_s)
    off_steps_mm = wanted.step_mm * (
        0.25 + math.sqrt(0.5)
    )  # chords, and whole steps in X and Y
    is_fine = off_steps_mm <= tolerance_mm / 2
    fit_mm = tolerance_mm - off_steps_mm if is_fine else tolerance_mm
    lines, planned = cut_lines_of(stream, Writing(fit_mm))
    text = _hpgl(lines, wanted)
    with written_beside(file) as beside:
        beside.write_text(text, encoding="ascii")
    blocks = without_z(planned.start_mm, planned.blocks, wanted)
    seconds = float(running_time_s(planned.start_mm, blocks, wanted))
    off_mm = planned.deviation_mm + off_steps_mm
    closed = sum(line.closed for line in lines)
    return DrawingReport(FilePath(file), len(lines), closed, seconds, off_mm)


def _hpgl(lines: list[CutLine], wanted: Machine) -> str:
    """The text of a plotter file."""
    step_mm, (left, low), (right, high) = wanted.step_mm, *box(lines)
    if min(left, low) < -step_mm / 2:
        raise MotionFault(
            f"what is cut reaches to X {left:.2f}, Y {low:.2f} mm, and a plotter begins at 0, 0; "
            "give --zero lower-left, or, where a cutter's path and leads reach beyond the part, a place X,Y "
            "left of and below all of it; without --zero it is the sheet's corner"
        )
    if max(right, high) > LARGEST_MM:
        raise MotionFault(
            f"what is cut reaches to X {right:.1f}, Y {high:.1f} mm, and a plotter file to "
            f"{LARGEST_MM:.0f} mm; cut it in parts"
        )
    text = list(wanted.begin)
    for line in lines:
        places = [line.begin_mm, *chords(line, step_mm / 4)]
        steps = [f"{round(x / step_mm)},{round(y / step_mm)}" for x, y in places]
        text += [f"PU{steps[0]};", f"PD{','.join(steps[1:])};"]
    return "\n".join([*text, *wanted.end, ""])
