"""Reader of programs for one machine: what its data says, beside the reader of RS-274.

Signals in: the text of a program, and the Machine that it is for. Signals out: moves in mm, mm/s and s, as
`player.gcode.rs274` gives them.

    machine without Z        the words that put its tool in the work are moves of Z: 0 in it, 2 mm above
    M62 M63 M64 M65 P3       torch off, torch on (QtPlasmaC)      M67 M68 E3 Q60   60 % of the feed
    M106 S, M107             the fan output of Marlin             G4 P in ms, G4 S in s
    F#<_hal[...]>            the feed on the machine's own panel  #<name>=1        passed over

Without a machine's name the program says itself which it is for: our own in a comment, "for grbl-laser: ...",
others by their words. A program without Z whose tool goes on and off between moves is one for a machine
without Z; everything else is read as before, as LinuxCNC would.

Source: LinuxCNC's G-codes (M62 to M68) and QtPlasmaC's user manual; Grbl 1.1, laser mode; Marlin 2's list of
G-codes. Questions: Marlin has no word for the end of a program; in ours a comment says that it is whole, and
in others' the end of the file is taken for it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path as FilePath

from morfax.motion.faults import ProgramFault
from morfax.player.gcode.arc_words import ArcLimits
from morfax.player.gcode.gcode_text import COMMENT, text_of
from morfax.player.gcode.hpgl_reader import ABOVE_MM, read_hpgl
from morfax.player.gcode.moves import RAPID, Move, Program
from morfax.player.gcode.rs274 import GcodeReader, parse_rs274
from morfax.player.gcode.tool_state import TORCH, ToolState
from morfax.recorder.gcode.machine import HPGL, Machine, machine, names
from morfax.recorder.gcode.program_head import HEAD_LINES
from morfax.recorder.gcode.program_text import END
from morfax.recorder.gcode.takes import Code, codes

PLOTS = (".plt", ".hpgl")

FOR = re.compile(r"^[(;]\s*for ([\w.-]+): ")
_PARAMETER = re.compile(r"^\s*#<[^>]*>\s*=.*$")
_PANEL = re.compile(r"F#<[^>]*>", re.IGNORECASE)
_SPINDLE = re.compile(r"\$\d+")
_SLOWER, _BY_FAN = codes("M67 M68"), codes("M106 M107")


def read_program(
    file: str | os.PathLike[str],
    start_mm: Sequence[float] | None = None,
    machine_name: str | None = None,
) -> Program:
    """Read a program for a machine, or for the one that the program itself names.

    Raises ProgramFault with line and word, FileFault for an unreadable file, ValueError and CardFault for a
    machine that is none.
    """
    if FilePath(file).suffix.lower() in PLOTS:
        return read_hpgl(file, machine(machine_name or HPGL))
    lines = text_of(file).split("\n")
    wanted = machine(machine_name) if machine_name else machine_of(lines, str(file))
    if wanted is None:
        return parse_rs274(lines, str(file), start_mm)
    reader = MachineReader(str(file), start_mm, wanted)
    return replace(parse_rs274(lines, str(file), start_mm, reader), machine=wanted.name)


def machine_of(lines: Sequence[str], name: str = "program") -> Machine | None:
    """The machine that a program names, or that its words are of; None: read as RS-274.

    Raises ProgramFault for a program of ours for a machine that is not built in.
    """
    for line in lines[:HEAD_LINES]:
        if said := FOR.match(line):
            if said[1] in names():
                return machine(said[1])
            raise ProgramFault(
                f"{name} is for the machine {said[1]!r}, which is not built in; give its file with "
                f"--machine, such as --machine {said[1]}.toml"
            )
    return _machine_of_words(COMMENT.sub("", "\n".join(lines)).upper().replace(" ", ""))


def _machine_of_words(text: str) -> Machine | None:
    """The machine whose words a program has, comments and spaces left out; None: read as RS-274."""
    if "$0" in text or "#<_HAL[PLASMAC" in text:
        return machine("qtplasmac")
    if re.search(r"[XYF\d]Z|\bZ|Z[-\d.]", text):
        return machine("marlin") if re.search(r"^M10[67]", text, re.MULTILINE) else None
    if re.search(r"^M10[67]", text, re.MULTILINE):
        return machine("marlin-fan")
    if not re.search(r"^(M5|S0)\b[^Z]*?^(G[0-3])?X?[XY]", text, re.MULTILINE | re.DOTALL):
        return None
    return machine("grbl-laser" if re.search(r"^M4", text, re.MULTILINE) else "grbl-pen")


class MachineReader(GcodeReader):
    """The modal state of a program and of the machine's tool, and the moves so far."""

    def __init__(self, name: str, start_mm: Sequence[float] | None, wanted: Machine) -> None:
        super().__init__(name, start_mm)
        takes = wanted.takes
        self.machine = wanted
        self.arc_limits = ArcLimits(
            takes.arc_mm, takes.arc_share, takes.arc_most_mm, takes.reach_mm
        )
        self.tool, self.share = ToolState(wanted.tool), 1.0
        self.takes_number = takes.expressions
        self.is_whole = takes.end != "needed"
        if takes.end == "none":
            self.ending = f"the comment {wanted.comment(END)!r}"
        elif takes.end == "usual":
            self.unended = f"{name} has no M2 or M30; see that it is whole"
        if not wanted.z and start_mm is None:
            self.start[2] = self.place[2] = ABOVE_MM

    def read(self, text: str) -> None:
        """Read a line."""
        if FOR.match(text):
            self.is_whole = False  # one of ours says in a comment that it is whole
        if text.strip() in (self.machine.comment(END), f"; {END}"):
            self.ended = True
            return
        plain = COMMENT.sub("", text)
        if _PARAMETER.match(plain):
            return
        if _PANEL.search(plain):
            self.feed_mm_s = self.machine.panel_feed_mm_s
        super().read(_SPINDLE.sub("", _PANEL.sub("", plain)))

    def note(self, letters: Sequence[str], numbers: Sequence[str]) -> None:
        """Note a line that has words for the tool; what M67 says is in the feeds of the moves."""
        if ("M", "67") not in zip(letters, numbers, strict=True):
            super().note(letters, numbers)

    def obey(self, letters: list[str], numbers: list[str]) -> None:
        """Carry out the words of a line: those of the tool first, then the reader's own."""
        words = list(zip(letters, map(float, numbers), strict=True))
        present = {(letter, number) for letter, number in words if letter in "GM"}
        self._hear_the_tool(dict(words), present)
        if present & (TORCH | _SLOWER | _BY_FAN):
            return
        kept = [k for k, (letter, _) in enumerate(words) if letter != "Z" or self.machine.z]
        texts = [numbers[k] for k in kept]
        letters = [letters[k] for k in kept]
        if ("G", 4.0) in words:
            letters, texts = self._in_seconds(letters, texts)
        first = len(self.moves)
        super().obey(letters, texts)
        for k in range(first, len(self.moves)):
            if self.share != 1.0:
                slower = self.moves[k].feed_mm_s * self.share
                self.moves[k] = self.moves[k]._replace(feed_mm_s=slower)

    def _hear_the_tool(self, values: dict[str, float], present: set[Code]) -> None:
        """Follow the words that put the tool in the work, or slow it down; move Z where there is none."""
        self.tool.obey(values, present)
        if present & _SLOWER:
            self.share = (values.get("Q", 0.0) or 100.0) / 100
        z_mm = 0.0 if self.tool.in_work else ABOVE_MM
        if not self.machine.z and z_mm != self.place[2]:
            self.place[2] = z_mm
            place = self.place[0], self.place[1], z_mm
            self.moves.append(Move(self.number, RAPID, place))

    def _in_seconds(
        self, letters: list[str], numbers: list[str]
    ) -> tuple[list[str], list[str]]:
        """The words of a dwell with its time in s."""
        words = dict(zip(letters, numbers, strict=True))
        if "P" in words:
            seconds = float(words["P"]) * self.machine.dwell_unit_s
        elif "S" in words and self.machine.takes.one_code:
            seconds = float(words["S"])
        else:
            return letters, numbers
        return ["G", "P"], ["4", f"{seconds:.9f}"]
