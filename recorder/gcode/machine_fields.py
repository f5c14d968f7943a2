"""What each field of a machine's file may hold.

Signals in: the fields of a TOML file (`motion.toml_fields`). Signals out: the values of a Machine by name,
or a CardFault with the line of a mistake. Speeds are mm/s, accelerations mm/s2, lengths mm: the unit is in
the name.
"""

from __future__ import annotations

import math
import re
import unicodedata
from typing import Any

from morfax.motion.toml_fields import Field
from morfax.recorder.gcode.takes import read_takes, read_tool

SUFFIXES = (".ngc", ".nc", ".gcode", ".tap", ".cnc", ".plt", ".hpgl")
CONTROL = re.compile(r"[^\x20-\x7e]")  # what is no printable character of ASCII
# as people write without them: umlauts; letters that do not come apart into one of ASCII and an accent; signs
UMLAUTS = {"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss"}
LETTERS = dict(
    zip(
        "øØæÆåÅłŁđĐœ", ["o", "O", "ae", "Ae", "aa", "Aa", "l", "L", "d", "D", "oe"], strict=True
    )
)
SIGNS = dict(zip("µ–—×’“”„", 'u--x\'"""', strict=True))
WRITTEN = str.maketrans(UMLAUTS | LETTERS | SIGNS)
PLACEHOLDER = re.compile(r"\{(\w+)\}")
SHORTEST_LINE = 64  # characters; an arc with its feed has up to 60
NUMBER_LONG = 7  # characters of a line number, such as "N99990 "
LARGEST_STEP = 100  # of line numbers; chosen: tens are usual
LINES = (
    "begin",
    "end",
    "tool_down",
    "tool_up",
    "dot_down",
    "dot_up",
    "hole_begin",
    "hole_overcut",
    "hole_end",
)


def in_ascii(text: str) -> str:
    """A text in printable ASCII: ä is ae, é is e, and ? is what has no such letter."""
    written = unicodedata.normalize("NFC", text).translate(WRITTEN)
    apart = unicodedata.normalize("NFKD", written)
    return CONTROL.sub("?", "".join(c for c in apart if not unicodedata.combining(c)))


def strings(held: Field) -> list[Field]:
    """The elements of a list of lines, which may be empty."""
    return (
        []
        if held.value == []
        else held.elements('a list of lines, such as ["G21 G90", "M3 S1000"]')
    )


def filled(held: Field, values: dict[str, float]) -> str:
    """A line with its placeholders filled from [values]."""
    line = _text(held)
    for name in PLACEHOLDER.findall(line):
        if name not in values:
            held.refuse(f"{{{name}}} stands in no line of [values]; add {name} = 0 there")
    return PLACEHOLDER.sub(lambda found: f"{values[found[1]]:g}", line)


def _text(held: Field) -> str:
    """Text of one line that a control can read."""
    if not isinstance(held.value, str) or CONTROL.search(held.value):
        held.refuse("it may hold one line of plain letters, digits and signs in quotes")
    return held.value


def _suffix(held: Field) -> str:
    """The suffix of the machine's programs."""
    return held.choice(*SUFFIXES)


def _decimals(held: Field) -> int:
    """Decimals of a place: 2 are 10 um, 6 are finer than any machine."""
    if held.number() not in range(2, 7):
        held.refuse("it may hold 2 to 6 decimals of a mm")
    return held.number()


def _longest(held: Field) -> int:
    """The longest line: an arc with its feed has up to 60 characters."""
    if held.number() < SHORTEST_LINE:
        held.refuse(f"it may hold {SHORTEST_LINE} characters or more: an arc needs up to 60")
    return held.number()


def _line_numbers(held: Field) -> int:
    """The step of line numbers; 0: none."""
    if held.number() not in range(LARGEST_STEP + 1):
        held.refuse(f"it may hold the step of line numbers, 1 to {LARGEST_STEP}, or 0 for none")
    return held.number()


def _values(held: Field) -> dict[str, float]:
    """Numbers by name."""
    if not isinstance(held.value, dict):
        held.refuse("it may hold numbers by name, such as speed = 12000")
    fields = held.table(*held.value)
    for each in fields.values():
        if isinstance(each.value, bool) or not isinstance(each.value, int | float):
            each.refuse("it may hold a number")
    return {name: float(each.value) for name, each in fields.items()}


def _three(held: Field, allowed: str) -> tuple[float, float, float]:
    """A number above zero for X, Y and Z: one for all, or a list of three."""
    given = held.value if isinstance(held.value, list) else [held.value] * 3
    if len(given) != 3 or any(
        isinstance(each, bool) or not isinstance(each, int | float) or not 0 < each < math.inf
        for each in given
    ):
        held.refuse(f"it may hold {allowed}, one for all axes or three for X, Y and Z")
    x, y, z = (float(each) for each in given)
    return x, y, z


def _travel(held: Field) -> tuple[float, float, float]:
    """How far the machine travels in X, Y and Z, mm; a machine without Z may say two."""
    two = isinstance(held.value, list) and len(held.value) == 2
    whole = Field([*held.value, 1.0], held.path, held.page) if two else held
    x, y, z = _three(whole, "lengths in mm, such as [300, 180, 60]")
    return x, y, math.inf if two else z


def _above_zero(held: Field, what: str) -> float:
    """A number above zero."""
    number = held.value
    if (
        isinstance(number, bool)
        or not isinstance(number, int | float)
        or not 0 < number < math.inf
    ):
        held.refuse(f"it may hold {what} above zero")
    return float(number)


# field of the file: field of Machine, and how it is read
FIELDS: dict[str, tuple[str, Any]] = {
    "what": ("what", _text),
    "suffix": ("suffix", _suffix),
    "comments": (
        "semicolon",
        lambda held: held.choice("parentheses", "semicolon") == "semicolon",
    ),
    "language": ("is_hpgl", lambda held: held.choice("rs274", "hpgl") == "hpgl"),
    "step_mm": ("step_mm", lambda held: _above_zero(held, "a length in mm")),
    "z": ("z", Field.truth),
    "arcs": ("arcs", Field.truth),
    "decimals": ("decimals", _decimals),
    "dwell": ("dwell_unit_s", lambda held: 1.0 if held.choice("s", "ms") == "s" else 1e-3),
    "longest_line": ("longest_line", _longest),
    "line_numbers": ("line_numbers", _line_numbers),
    "direction": ("milling", lambda held: held.choice("climb", "conventional")),
    "lines": ("lines", lambda held: held.choice("all", "contours")),
    "feed": ("feeds", lambda held: held.choice("program", "machine") == "program"),
    "rapid": ("rapids_have_feed", lambda held: held.choice("program", "machine") == "program"),
    "rapid_mm_s": ("rapid_mm_s", lambda held: _three(held, "speeds in mm/s")),
    "acceleration_mm_s2": (
        "acceleration_mm_s2",
        lambda held: _three(held, "accelerations in mm/s2"),
    ),
    "corner_mm": ("corner_mm", lambda held: _above_zero(held, "a length in mm")),
    "panel_feed_mm_s": ("panel_feed_mm_s", lambda held: _above_zero(held, "a speed in mm/s")),
    "travel_mm": ("travel_mm", _travel),
    **{name: (name, strings) for name in LINES},
    "values": ("values", _values),
    "takes": ("takes", read_takes),
    "tool": ("tool", read_tool),
}
