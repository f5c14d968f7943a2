"""What a control takes of a program: words, lines, the ends of arcs, and what puts the tool in the work.

Signals in: the tables [takes] and [tool] of a machine's file. Signals out: Takes and ToolWords, or a
CardFault that points at the line of a mistake. `morfax check` reads programs by them; writing does without.

Source: Grbl 1.1, gcode.c (gc_execute_line), protocol.c (protocol_main_loop), serial.c (the interrupt that
reads a character); LinuxCNC 2.9, interp_array.cc, interp_check.cc, interp_arc.cc (arc_data_ijk, arc_data_r),
interp_internal.hh; Marlin 2's list of G-codes. Questions: Marlin does not look at the ends of an arc: it
turns by the angle and then jumps to the end. Its limits here are Grbl's.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

from morfax.motion.toml_fields import Field

# four digits are the most that a control has; more would make a range of them last
_CODE = re.compile(r"([GM])(\d{1,4}(?:\.\d)?)(?:-([GM])(\d{1,4}))?")

ARC_MM, ARC_SHARE = 0.005, 0.001  # Grbl 1.1, gcode.c, gc_execute_line
Code = tuple[str, float]  # such as ("G", 38.2)


@cache
def codes(text: str) -> frozenset[Code]:
    """The words that a text such as "G0 G1 G38.2 M100-M199" names; raises ValueError for what is none."""
    named: set[Code] = set()
    for part in text.split():
        found = _CODE.fullmatch(part)
        if not found or found[3] not in (None, found[1]):
            raise ValueError(f"{part!r} is no word such as G38.2 or M100-M199")
        first = float(found[2])
        last = float(found[4] or found[2])
        whole = range(int(first), int(last) + 1) if found[4] else ()
        named |= {(found[1], first)} | {(found[1], float(number)) for number in whole}
    return frozenset(named)


@dataclass(frozen=True, slots=True)
class Takes:
    """What a control takes; the beginning is what our own reader takes."""

    codes: frozenset[Code] = codes(
        "G0-G4 G17 G20 G21 G40 G49 G54 G61 G64 G80 G90 G91 G94 M0 M2-M5 M30"
    )
    letters: str = "FIJNPRSTXYZ"  # of words beside G and M
    alone: frozenset[Code] = frozenset()  # words that a motion may not stand beside
    percent: bool = True  # whether a line may be %
    end: str = "needed"  # M2, M30 or %: "needed", "usual", "none"
    expressions: bool = False  # parameters # and expressions [ ]
    parentheses: bool = True  # comments in ( ); after ; they are taken everywhere
    nested: bool = True  # whether a ( may stand in a comment
    length_of: str = "line"  # what may be longest_line long: the "line", or its "words" alone
    not_sent: str = ""  # characters that the control obeys wherever they stand
    one_code: bool = False  # one G or M in a line, and none that still holds from before
    small_letters: bool = True
    lone_motion: bool = True  # a whole turn may be told by its centre alone, G2 I5
    turns: bool = False  # P of an arc counts turns
    largest_line_number: float = math.inf
    largest_tool: float = math.inf  # T
    digits: int = 15  # that the control keeps of a number
    arc_mm: float = ARC_MM  # an arc's ends lie on one circle within this,
    arc_share: float = ARC_SHARE  # or within this share of the radius,
    arc_most_mm: float = 0.5  # but never further
    reach_mm: float = 0.0  # half the chord may exceed R by this


@dataclass(frozen=True, slots=True)
class ToolWords:
    """Which words start the tool, or put it in the work where there is no Z, and which stop it."""

    on: frozenset[Code] = codes("M3 M4")
    off: frozenset[Code] = codes("M5")
    least_s: float = 0.0  # S from here on counts as on; 0: M3 without an S is enough
    travels_at_feed: bool = False  # whether G1 with the tool off is no mistake there


def read_takes(held: Field) -> Takes:
    """What the table [takes] says; raises CardFault."""
    return Takes(**_values(held, _TAKES))


def read_tool(held: Field) -> ToolWords:
    """What the table [tool] says; raises CardFault."""
    return ToolWords(**_values(held, _TOOL))


def _values(held: Field, readers: dict[str, Callable[[Field], Any]]) -> dict[str, Any]:
    """The values of a table by their names."""
    return {name: readers[name](each) for name, each in held.table(*readers).items()}


def _codes(held: Field) -> frozenset[Code]:
    """Words in one text."""
    try:
        return codes(_text(held))
    except ValueError:
        return held.refuse('it may hold G and M words, such as "G0 G1 G38.2 M100-M199"')


def _text(held: Field) -> str:
    """Text, which may be empty."""
    if not isinstance(held.value, str):
        held.refuse("it may hold text in quotes")
    return held.value


def _number(held: Field) -> float:
    """A number from 0."""
    number = held.value
    if isinstance(number, bool) or not isinstance(number, int | float) or not number >= 0:
        held.refuse("it may hold a number from 0")
    return float(number)


_TAKES: dict[str, Callable[[Field], Any]] = {
    "codes": _codes,
    "letters": _text,
    "alone": _codes,
    "percent": Field.truth,
    "end": lambda held: held.choice("needed", "usual", "none"),
    "expressions": Field.truth,
    "parentheses": Field.truth,
    "nested": Field.truth,
    "length_of": lambda held: held.choice("line", "words"),
    "not_sent": _text,
    "one_code": Field.truth,
    "small_letters": Field.truth,
    "lone_motion": Field.truth,
    "turns": Field.truth,
    "largest_line_number": _number,
    "largest_tool": _number,
    "digits": Field.number,
    "arc_mm": _number,
    "arc_share": _number,
    "arc_most_mm": _number,
    "reach_mm": _number,
}
_TOOL: dict[str, Callable[[Field], Any]] = {
    "on": _codes,
    "off": _codes,
    "least_s": _number,
    "travels_at_feed": Field.truth,
}
