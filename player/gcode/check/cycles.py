"""Canned cycles: G81 to G89 and G73 drill at a place, from R down to Z, and come up again.

Signals in: the words of a line; R and Z hold from line to line. Signals out: rapids and a line, which the
reader runs.

    Z   ──┐  ┌── above (G98)      XY first, then down to R as a rapid, down to Z at the feed, up
     R    └┐┌┘── or R (G99)
     Z     └┘

Source: NIST RS274/NGC interpreter, version 3, section 3.5.16. Questions: pecks, dwells and back-boring (G87)
are one way down and one up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from morfax.player.gcode.check.findings import Findings
from morfax.player.gcode.moves import LINE, RAPID


class Runner(Protocol):
    """Whoever runs the moves of a cycle: its modes, and where it stands, mm."""

    findings: Findings
    place: list[float]
    offset: list[float]
    scale: float
    relative: bool

    def run(self, kind: str, places_mm: dict[str, float]) -> None:
        """Go to places in mm."""


MOST_REPEATS = 1000  # of L; more are a mistake, and only take time here


@dataclass(slots=True)
class CannedCycle:
    """R and Z as they hold, mm; whether the tool comes up to where it was (G98), or to R (G99)."""

    r_mm: float | None = None
    z_mm: float | None = None
    returns_to_start: bool = True

    def run(self, runner: Runner, values: dict[str, float]) -> None:
        """Drill at each place of a line."""
        self._set(runner, values)
        if self.r_mm is None or self.z_mm is None:
            runner.findings.here("word", "a canned cycle has no R or no Z", "both", "give both")
            return
        start_mm = runner.place[2]
        clear_mm = max(start_mm, self.r_mm) if self.returns_to_start else self.r_mm
        if start_mm < self.r_mm:
            runner.run(RAPID, {"Z": self.r_mm})
        repeats = min(max(values.get("L", 1.0), 0.0), MOST_REPEATS) if runner.relative else 1
        for _ in range(round(repeats)):
            across = {
                letter: values[letter] * runner.scale
                + (runner.place if runner.relative else runner.offset)[axis]
                for axis, letter in enumerate("XY")
                if letter in values
            }
            if across:
                runner.run(RAPID, across)
            runner.run(RAPID, {"Z": self.r_mm})
            runner.run(LINE, {"Z": self.z_mm})
            runner.run(RAPID, {"Z": clear_mm})

    def _set(self, runner: Runner, values: dict[str, float]) -> None:
        """Take R and Z of a line, from the zero or, with G91, from where the tool stands."""
        if "R" in values:
            base_mm = runner.place[2] if runner.relative else runner.offset[2]
            self.r_mm = values["R"] * runner.scale + base_mm
        if "Z" in values and self.r_mm is not None:
            base_mm = self.r_mm if runner.relative else runner.offset[2]
            self.z_mm = values["Z"] * runner.scale + base_mm
