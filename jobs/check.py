"""The job `check`: whether a machine may be started with a program, and what the program does.

The program is read as the machine's control reads it (`player.gcode.check`). The time is the machine's own,
by its speeds and accelerations.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.figures import Figures
from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.running import duration_s, machine_for
from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.player.gcode.check.checked import Checked
    from morfax.player.gcode.check.findings import Finding
    from morfax.player.gcode.check.motion_rules import Stock
    from morfax.recorder.gcode.machine import Machine
    from morfax.tracer.operator.operator import Panel

OTHER_MEDIA = (".steps", ".cubic", ".plt", ".hpgl", ".dxf", ".svg")


@dataclass(frozen=True, slots=True)
class CheckResult:
    """What a check found: figures, and the program as it was read, for pictures."""

    figures: Figures
    checked: Checked
    machine: Machine
    stock: Stock | None

    @property
    def may_start(self) -> bool:
        """Whether nothing keeps one from starting the machine."""
        return self.checked.may_start


@dataclass(frozen=True, slots=True)
class CheckJob:
    """Check a program for a machine, and on a stock if one is given."""

    program: FilePath
    # name of a built-in one, or a .toml file; None: the one that the program names, or linuxcnc
    machine: str | None = None
    stock: Stock | None = None
    picture: FilePath | None = None

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> CheckResult:
        """Check; raises WrongUse, CardFault, FileFault, ProgramFault for what is no text."""
        from morfax.player.gcode.check.checked import check_program

        if medium.kind_of(self.program) in ("tape", "drawing") or (
            self.program.suffix.lower() in (*OTHER_MEDIA, *medium.PATHS)
        ):
            raise WrongUse(
                f"{self.program} is no G-code; check reads {', '.join(medium.BLOCKS)} "
                "(inspect says what is on a tape)"
            )
        if self.picture is not None:
            medium.outgoing(self.picture, self.program)
        made = machine_for(self.program, self.machine)
        with listener.progress("checking the program", 1.0) as advance:
            checked = check_program(self.program, made, self.stock, advance)
        surface_mm = self.stock.surface_mm if self.stock else 0.0
        figures = {
            "program": str(self.program),
            "machine": made.name,
            "may_be_started": checked.may_start,
            **_figures(checked, made, surface_mm),
            "findings": [_told(finding) for finding in checked.findings],
        }
        return CheckResult(figures, checked, made, self.stock)


def _told(finding: Finding) -> dict[str, Any]:
    """The figures of a finding."""
    return {
        "line": finding.line,
        "kind": finding.rule,
        "stops": finding.stops,
        "what": finding.what,
        "allowed": finding.allowed or None,
        "do": finding.do,
        "lines": finding.lines,
        "last_line": finding.last_line,
        "at_mm": finding.place_mm,
    }


def _figures(checked: Checked, machine: Machine, surface_mm: float) -> dict[str, Any]:
    """Size, travel, depth, lengths, feeds and time of a program; straight plunges are no cut length."""
    from morfax.player.gcode.check.steps import bounds_mm

    steps = checked.steps
    cuts = [step for step in steps if step.in_work and not step.is_rapid and step.moves]
    figures: dict[str, Any] = {"lines": checked.lines}
    if size := bounds_mm(cuts):
        (x, y, z), (to_x, to_y, _) = size
        figures |= {"width_mm": to_x - x, "height_mm": to_y - y}
        if machine.z:
            figures["depth_mm"] = max(surface_mm - z, 0.0)
    feeds = [step.move.feed_mm_s for step in cuts if step.move.feed_mm_s]
    figures |= {
        "cuts": sum(1 for is_cut, _ in groupby(steps, lambda step: step.in_work) if is_cut),
        "cut_length_mm": sum(step.length_mm for step in cuts if step.across),
        "rapid_length_mm": sum(step.length_mm for step in steps if step.is_rapid),
        "slowest_feed_mm_s": min(feeds, default=None),
        "fastest_feed_mm_s": max(feeds, default=None),
        "duration_s": duration_s(checked, machine),
    }
    if travel := bounds_mm(steps):
        for axis, low, high in zip("xyz", *travel, strict=True):
            if axis != "z" or machine.z:
                figures[f"{axis}_axis"] = {
                    "from_mm": low,
                    "to_mm": high,
                    "travel_mm": high - low,
                }
    return figures
