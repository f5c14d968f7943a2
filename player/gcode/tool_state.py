"""The tool as the words of a program leave it: running, and, where there is no Z, in the work.

Signals in: the G and M words of each line, and its values by their letters. Signals out: whether the tool
runs, and whether it is in the work.

Source: Grbl 1.1, spindle_control.c, and laser mode: S0 is off, whatever M3 says; QtPlasmaC's user manual: M62
and M64 P3 put the torch off on the way, M63 and M65 P3 on again. Questions: M3 with no S in the whole program
is on where `least_s` is 0: a router that is switched by a relay has no speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass

from morfax.recorder.gcode.takes import Code, ToolWords, codes

_DWELL, _ENDS = codes("G4"), codes("M2 M30")
_TORCH_OFF, _TORCH_ON = codes("M62 M64"), codes("M63 M65")
TORCH = _TORCH_OFF | _TORCH_ON
_TORCH_OUTPUT = 3.0  # P of the torch among a control's outputs


@dataclass(slots=True)
class ToolState:
    """Whether the tool is switched on, its last S, and whether its torch is put off on the way."""

    words: ToolWords
    is_switched_on: bool = False
    s: float | None = None
    torch: bool = True

    @property
    def runs(self) -> bool:
        """Whether the tool runs: switched on, and with S enough."""
        if self.s is None:
            return self.is_switched_on and self.words.least_s == 0
        return self.is_switched_on and self.s > 0 and self.s >= self.words.least_s

    @property
    def in_work(self) -> bool:
        """Whether the tool of a machine without Z is in the work."""
        return self.runs and self.torch

    def obey(self, values: Mapping[str, float], present: Set[Code]) -> None:
        """Obey the words of a line, before its motion."""
        if "S" in values and not present & _DWELL:  # S of a dwell is a time for some
            self.s = values["S"]
        if present & self.words.on:
            self.is_switched_on = True
        if present & self.words.off:
            self.is_switched_on = False
        if present & TORCH and values.get("P") == _TORCH_OUTPUT:
            self.torch = bool(present & _TORCH_ON)

    def end(self, present: Set[Code]) -> None:
        """Obey the end of the program: M2 and M30 stop the tool."""
        if present & _ENDS:
            self.is_switched_on = False
