"""The check sum of a G-code program: a comment that tells a changed character anywhere in the other lines.

    G0 Z2
    (crc32 8f3a09c1)        of all other lines, each stripped and followed by a newline; blank ones left out
    M5
    M2

Signals in: the lines of a program. Signals out: the same lines with that comment before the last few; or a
fault, where there is one that is not right. A program without it is read as it is.

Source: CRC-32 as of zlib, as in recorder/textfile.py. Questions: controls pass over comments; so a program
that was changed by hand runs on the machine, and our reader asks to take the line out.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterable, Sequence

from morfax.motion.faults import ProgramFault
from morfax.recorder.gcode.machine import Machine
from morfax.recorder.gcode.program_text import ENDING

_SUM = re.compile(r"^[ \t]*(?:\(|; )crc32 ([0-9a-f]{8})\)?[ \t\r]*$", re.MULTILINE)


def summed(lines: Sequence[str], machine: Machine) -> list[str]:
    """The lines with their check sum as a comment, before those that end the program."""
    ending = len(machine.end) + (not any(line in ENDING for line in machine.end))
    at = len(lines) - ending
    return [*lines[:at], machine.comment(f"crc32 {_of(lines):08x}"), *lines[at:]]


def demand_right(text: str, name: str) -> None:
    """Raise ProgramFault for a program whose check sum is not that of its lines."""
    found = _SUM.search(text)
    if found is None:
        return
    total = _of((text[: found.start()] + text[found.end() :]).split("\n"))
    if int(found[1], 16) != total:
        line = text.count("\n", 0, found.start()) + 1
        raise ProgramFault(
            f"{name}: a character is wrong somewhere: the check sum in line {line} is {found[1]}, the lines"
            f" give {total:08x}; record it again, or take line {line} out if you have changed the program",
            line=line,
        )


def _of(lines: Iterable[str]) -> int:
    """The check sum of some lines."""
    plain = [line.strip() for line in lines]
    return zlib.crc32("".join(f"{line}\n" for line in plain if line).encode())
