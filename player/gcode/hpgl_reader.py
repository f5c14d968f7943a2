"""Reader of plotter files: HP-GL in, moves in mm out.

Signals in: the text of a plotter file, and the Machine with its step. Signals out: moves as those of a
program of lines, the pen down on the paper at Z 0, up at 2 mm above it.

    IN SP VS FS     begin, pen, speed in cm/s, force: VS is the feed, the others are the machine's
    PU PD           pen up, pen down, and on to places if there are some
    PA              places, not distances: the only way that is read

Source: Hewlett-Packard, HP-GL reference. Questions: the file says nowhere that it is whole; one that does not
end with the pen up is taken for cut short. Without VS the pen runs at 10 cm/s.
"""

from __future__ import annotations

import os
import re

from morfax.motion.faults import ProgramFault
from morfax.player.gcode.rs274 import LINE, RAPID, Move, Program, text_of
from morfax.recorder.gcode.machine import Machine

ABOVE_MM = 2.0  # where the pen stands when it is up
USUAL_CM_S = 10.0

_COMMAND = re.compile(r"([A-Z]{2})\s*([-\d.,\s]*)")
_PASSED = ("IN", "SP", "FS", "PA", "DF")


def read_hpgl(file: str | os.PathLike[str], machine: Machine) -> Program:
    """Read a plotter file; raises ProgramFault with the command, FileFault for an unreadable file."""
    reader = _Pen(str(file), machine)
    for number, line in enumerate(text_of(file).upper().split("\n"), 1):
        for command in filter(None, (part.strip() for part in line.split(";"))):
            reader.obey(number, command)
    if reader.is_down or not reader.moves:
        raise ProgramFault(
            f"{file} ends with the pen {'down' if reader.is_down else 'where it stood'}; a plotter file ends "
            "with PU: get the whole of it"
        )
    x_mm, y_mm, _ = reader.moves[0].end_mm
    return Program((x_mm, y_mm, ABOVE_MM), reader.moves, machine.name)


class _Pen:
    """Where the pen is, and its moves so far."""

    def __init__(self, name: str, machine: Machine) -> None:
        self.name, self.step_mm = name, machine.step_mm
        self.moves: list[Move] = []
        self.is_down, self.feed_mm_s = False, 10 * USUAL_CM_S
        self.place = (0.0, 0.0)

    def obey(self, number: int, command: str) -> None:
        """Carry out a command; raises ProgramFault for one that is not read."""
        found = _COMMAND.fullmatch(command)
        if not found or found[1] not in ("PU", "PD", "VS", *_PASSED):
            raise ProgramFault(
                f"{self.name}, line {number}: {command[:20]!r} is not played; this control reads IN SP VS FS "
                "PU PD PA",
                line=number,
            )
        values = self._values(number, found[2])
        if found[1] == "VS" and values:
            self.feed_mm_s = 10 * values[0]
        if found[1] in ("PU", "PD"):
            self._pen(number, down=found[1] == "PD")
        if found[1] in ("PU", "PD", "PA"):
            for x, y in zip(values[::2], values[1::2], strict=True):
                self.place = x * self.step_mm, y * self.step_mm
                self._go(number, LINE if self.is_down else RAPID)

    def _values(self, number: int, text: str) -> list[float]:
        """The numbers of a command; raises ProgramFault for half a place."""
        try:
            values = [float(part) for part in re.split(r"[,\s]+", text.strip()) if part]
        except ValueError:
            values = [0.0, 0.0, 0.0]
        if len(values) > 1 and len(values) % 2:
            raise ProgramFault(
                f"{self.name}, line {number}: {text[:20]!r} is no row of places X,Y; get the whole of it",
                line=number,
            )
        return values

    def _pen(self, number: int, *, down: bool) -> None:
        """Put the pen down or up, where it is not there yet."""
        if down != self.is_down:
            self.is_down = down
            self._go(number, RAPID)

    def _go(self, number: int, kind: str) -> None:
        """To where the pen is to be."""
        place = *self.place, 0.0 if self.is_down else ABOVE_MM
        feed_mm_s = self.feed_mm_s if kind == LINE else 0.0
        if not self.moves or self.moves[-1].end_mm != place:
            self.moves.append(Move(number, kind, place, feed_mm_s))
