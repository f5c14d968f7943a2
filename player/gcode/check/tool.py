"""The tool as the words of a program leave it: running, or in the work where there is no Z.

Signals in: the M and S words of each line. Signals out: whether the tool is on.

Source: Grbl 1.1, spindle_control.c, and laser mode: S0 is off, whatever M3 says. Questions: M3 with no S in
the whole program is on where `least_s` is 0: a router that is switched by a relay has no speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from morfax.player.gcode.check.lines import Words
from morfax.recorder.gcode.takes import Code, ToolWords, codes

_DWELL = codes("G4")
_ENDS = codes("M2 M30")


@dataclass(slots=True)
class ToolState:
    """Whether the tool is switched on, and its last S."""

    words: ToolWords
    switched_on: bool = False
    s: float | None = None

    @property
    def on(self) -> bool:
        """Whether the tool runs, or is in the work where there is no Z."""
        if not self.switched_on:
            return False
        if self.s is None:
            return self.words.least_s == 0
        return self.s > 0 and self.s >= self.words.least_s

    def obey(self, words: Words, named: list[Code]) -> None:
        """Obey the words of a line, before its motion."""
        present = set(named)
        if not present & _DWELL:  # where S is a time for some
            if "S" in words.letters:
                self.s = float(words.numbers[words.letters.index("S")])
            elif "S" in words.computed:
                self.s = math.inf
        if present & self.words.on:
            self.switched_on = True
        if present & self.words.off:
            self.switched_on = False

    def end(self, named: list[Code]) -> None:
        """Obey the end of the program: M2 and M30 stop the tool."""
        if set(named) & _ENDS:
            self.switched_on = False
