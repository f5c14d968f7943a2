"""Reader of plotter files: HP-GL in, moves in mm out.

Signals in: the text of a plotter file, and the Machine with its step. Signals out: moves as those of a
program of lines, the pen down on the paper at Z 0, up at 2 mm above it.

    IN SP VS FS     begin, pen, speed in cm/s, force: VS is the feed, the others are the machine's
    PU PD           pen up, pen down, and on to places if there are some
    PA PR           places, or distances from the place before
    AA AR CI        arcs about a place, by degrees, and circles about the pen: as chords within 1 um
    IP SC           units of the user's own: SC names the places that two plotter places of IP have then

Source: Hewlett-Packard, HP-GL and HP-GL/2 references. Questions: the file says nowhere that it is whole; one
that does not end with the pen up is taken for cut short. Without VS the pen runs at 10 cm/s. SC without IP
hangs on the paper that is loaded, and is refused, as are words (LB) and coded lines (PE); other programs can
turn them into lines.
"""

from __future__ import annotations

import math
import os
import re

import numpy as np

from morfax.motion.arrays import AS_WRITTEN
from morfax.motion.faults import ProgramFault
from morfax.motion.plane import NOTHING_MM
from morfax.motion.usual import INCREMENT_MM, PLOTTER_MM
from morfax.player.gcode.gcode_text import text_of
from morfax.player.gcode.moves import LINE, RAPID, Move, Program
from morfax.recorder.drawings.curve_chords import bulged
from morfax.recorder.gcode.machine import Machine

ABOVE_MM = 2.0  # where the pen stands when it is up
USUAL_CM_S = 10.0

_COMMANDS = re.compile(r"[A-Z]{2}[^A-Z;]*|[^;\s]+")
_COMMAND = re.compile(r"([A-Z]{2})\s*([-+\d.,\s]*)")
# what sets up the port of a plotter, and says nothing to its pen
_ESCAPES = re.compile(r"\x1b(?:\.[@-Z()](?:[-\d;]*:)?|[^A-Za-z@]*[A-Za-z@])")
_PASSED = ("IN", "SP", "FS", "DF", "LT", "PT", "PW", "AS")
_PLACES, _ARCS = ("PU", "PD", "PA", "PR"), ("AA", "AR")
_READ = "IN SP VS FS PU PD PA PR AA AR CI IP SC"


def read_hpgl(file: str | os.PathLike[str], machine: Machine) -> Program:
    """Read a plotter file; raises ProgramFault with the command, FileFault for an unreadable file."""
    reader = _Pen(str(file), machine)
    text = _ESCAPES.sub("", text_of(file))
    for number, line in enumerate(text.upper().split("\n"), 1):
        for command in _COMMANDS.findall(line):
            reader.obey(number, command.strip())
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
        self.name, self.machine_step_mm = name, machine.step_mm
        self.step_mm, self.zero_mm = machine.step_mm, (0.0, 0.0)
        self.corners: list[float] | None = None  # of IP, in plotter units
        self.moves: list[Move] = []
        self.is_down, self.feed_mm_s = False, 10 * USUAL_CM_S
        self.place, self.by_steps = (0.0, 0.0), False

    def obey(self, number: int, command: str) -> None:
        """Carry out a command; raises ProgramFault for one that is not read."""
        found = _COMMAND.fullmatch(command)
        if not found or found[1] not in ("VS", "CI", "IP", "SC", *_PLACES, *_ARCS, *_PASSED):
            raise ProgramFault(
                f"{self.name}, line {number}: {command[:20]!r} is not played; this control reads {_READ}",
                line=number,
            )
        code = found[1]
        values = self._values(number, found[1], found[2])
        if code == "VS" and values:
            self.feed_mm_s = 10 * values[0]
        self._set_scale(number, code, values)
        if code in _PLACES:
            self._row(number, code, values)
        if code in _ARCS:
            self._arc(number, values, about_pen=code == "AR")
        if code == "CI":
            self._circle(number, values[0] * self.step_mm)

    def _set_scale(self, number: int, code: str, values: list[float]) -> None:
        """Set what a unit is, for the commands that do so."""
        if code in ("IN", "DF"):
            self.by_steps, self.corners = False, None
            self._scale(number, [])
        if code == "IP":
            self.corners = values
        if code == "SC":
            self._scale(number, values)

    def _values(self, number: int, code: str, text: str) -> list[float]:
        """The numbers of a command; raises ProgramFault for half a place, or half an arc."""
        wanted = {"CI": (1, 2), "AA": (3, 4), "AR": (3, 4), "IP": (4,), "SC": (4, 0, 5)}.get(
            code
        )
        try:
            values = [float(part) for part in re.split(r"[,\s]+", text.strip()) if part]
        except ValueError:
            values = [0.0] * 5
        is_half = code in _PLACES and len(values) % 2 == 1
        if is_half or (wanted is not None and len(values) not in wanted):
            what = f"no {code} of {wanted[0]} numbers" if wanted else "no row of places X,Y"
            raise ProgramFault(
                f"{self.name}, line {number}: {text[:20]!r} is {what}; get the whole of it",
                line=number,
            )
        return values

    def _scale(self, number: int, values: list[float]) -> None:
        """Take units of the user's own, or the machine's again without values."""
        if not values:
            self.step_mm, self.zero_mm = self.machine_step_mm, (0.0, 0.0)
            return
        if self.corners is None:
            raise ProgramFault(
                f"{self.name}, line {number}: SC without IP: its units hang on the paper in the plotter;"
                " have the program written in plotter units",
                line=number,
            )
        left, low, right, high = (PLOTTER_MM * unit for unit in self.corners)
        from_x, to_x, from_y, to_y = values[:4]
        steps_mm = [
            wide_mm / count if count else 0.0
            for wide_mm, count in ((right - left, to_x - from_x), (high - low, to_y - from_y))
        ]
        if (
            steps_mm[0] <= 0
            or abs(steps_mm[1] / steps_mm[0] - 1) > AS_WRITTEN
            or values[4:] not in ([], [0.0], [1.0])
        ):
            raise ProgramFault(
                f"{self.name}, line {number}: SC has no one unit in X and Y; have it written in square units",
                line=number,
            )
        self.step_mm = steps_mm[0]
        self.zero_mm = left - from_x * self.step_mm, low - from_y * self.step_mm

    def _row(self, number: int, code: str, values: list[float]) -> None:
        """To places, by the pen that is up or down."""
        if code in ("PU", "PD"):
            self._pen(number, down=code == "PD")
        else:
            self.by_steps = code == "PR"
        for x, y in zip(values[::2], values[1::2], strict=True):
            from_x, from_y = self.place if self.by_steps else self.zero_mm
            self._to(number, (from_x + x * self.step_mm, from_y + y * self.step_mm))

    def _arc(self, number: int, values: list[float], *, about_pen: bool) -> None:
        """Along an arc about a centre, by degrees, in two halves: a whole turn has no chord."""
        x_mm, y_mm = (value * self.step_mm for value in values[:2])
        centre = complex(x_mm, y_mm) + complex(*(self.place if about_pen else self.zero_mm))
        self._turn(number, centre, math.radians(values[2]) / 2)

    def _turn(self, number: int, centre: complex, half_rad: float) -> None:
        """Along an arc about a centre, mm, by twice an angle."""
        for _ in range(2):
            begin = complex(*self.place)
            end = centre + (begin - centre) * complex(math.cos(half_rad), math.sin(half_rad))
            if abs(end - begin) < NOTHING_MM:
                continue
            ends = np.array(self.place), np.array([end.real, end.imag])
            for x, y in bulged(*ends, half_rad, INCREMENT_MM).tolist():
                self._to(number, (x, y))

    def _circle(self, number: int, radius_mm: float) -> None:
        """A circle about the pen, which comes back, and is down or up again as it was."""
        centre, was_down = self.place, self.is_down
        self._pen(number, down=False)
        self._to(number, (centre[0] + radius_mm, centre[1]))
        self._pen(number, down=True)
        self._turn(number, complex(*centre), math.pi)
        self._pen(number, down=False)
        self._to(number, centre)
        self._pen(number, down=was_down)

    def _to(self, number: int, place_mm: tuple[float, float]) -> None:
        """To a place, by the pen as it is."""
        self.place = place_mm
        self._go(number, LINE if self.is_down else RAPID)

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
