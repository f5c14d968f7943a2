"""A machine, as data: which words its control takes, and how a program begins and ends there.

Signals in: the name of a built-in machine (`machines/*.toml`) or a file like these. Signals out: a Machine,
or a CardFault that points at the line of a mistake, as for the operator's card.

Source: LinuxCNC's and Grbl 1.1's lists of G-codes, Marlin's, and QtPlasmaC's manual. Questions: the spindle's
speed and the times are the workshop's own; what stands here is a beginning, and is one file to change.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path as FilePath
from typing import Any

from morfax.motion.toml_fields import Field, opened, parsed

DEFAULT = "linuxcnc"
SUFFIXES = (".ngc", ".nc", ".gcode", ".tap", ".cnc")
CALLED = "the machine"
_PLACEHOLDER = re.compile(r"\{(\w+)\}")
_CONTROL = re.compile(r"[^\x20-\x7e]")  # what is no printable character of ASCII


@dataclass(frozen=True, slots=True)
class Machine:
    """How a control wants its programs; the lines hold no {placeholder} any more."""

    name: str
    what: str
    suffix: str = ".ngc"
    semicolon: bool = False  # comments after ; and not in ( )
    z: bool = True
    arcs: bool = True
    decimals: int = 4
    dwell_unit_s: float = 1.0
    longest_line: int = 255
    feeds: bool = True  # whether the program says F
    begin: tuple[str, ...] = ()
    end: tuple[str, ...] = ("M2",)
    tool_down: tuple[str, ...] = ()
    tool_up: tuple[str, ...] = ()
    values: dict[str, float] = field(default_factory=dict, compare=False)

    def comment(self, text: str) -> str:
        """A line that the control passes over, cut to its longest."""
        plain = _CONTROL.sub("?", text).replace("(", "[").replace(")", "]")
        kept = plain[: self.longest_line - 3]
        return f"; {kept}" if self.semicolon else f"({kept})"


def names() -> list[str]:
    """Names of the built-in machines."""
    folder = resources.files("morfax.recorder.gcode") / "machines"
    return sorted(file.name[:-5] for file in folder.iterdir() if file.name.endswith(".toml"))


def as_toml(name: str) -> str:
    """The file of a built-in machine, to copy and change; raises ValueError if there is none of that name."""
    if name not in names():
        raise ValueError(
            f"there is no machine {name!r}; there are {', '.join(names())}, or give a .toml file"
        )
    folder = resources.files("morfax.recorder.gcode") / "machines"
    return (folder / f"{name}.toml").read_text(encoding="utf-8")


def machine(name: str = DEFAULT) -> Machine:
    """A built-in machine, or the one that a .toml file describes.

    Raises ValueError for a name that is neither, CardFault for a mistake in a file, FileFault if a file
    cannot be read.
    """
    if name.lower().endswith(".toml"):
        file = FilePath(name)
        return _machine(file.stem, opened(file, CALLED, "--machine"))
    return _machine(name, parsed(as_toml(name), f"{name}.toml", CALLED))


def _machine(name: str, whole: Field) -> Machine:
    """The machine in a file."""
    fields = whole.table(*_FIELDS)
    said: dict[str, Any] = {
        field_of: read(fields[key])
        for key, (field_of, read) in _FIELDS.items()
        if key in fields
    }
    values = said.setdefault("values", {})
    for key in ("begin", "end", "tool_down", "tool_up"):
        if key in fields:
            said[key] = tuple(_filled(element, values) for element in _strings(fields[key]))
    made = Machine(name, **{"what": name, **said})
    for key in ("begin", "end", "tool_down", "tool_up"):
        for number, line in enumerate(getattr(made, key), 1):
            if len(line) > made.longest_line:
                fields[key].refuse(
                    f"its line {number} may hold {made.longest_line} characters, as longest_line says"
                )
    return made


def _strings(held: Field) -> list[Field]:
    """The elements of a list of lines, which may be empty."""
    return (
        []
        if held.value == []
        else held.elements('a list of lines, such as ["G21 G90", "M3 S1000"]')
    )


def _filled(held: Field, values: dict[str, float]) -> str:
    """A line with its placeholders filled from [values]."""
    line = _text(held)
    for name in _PLACEHOLDER.findall(line):
        if name not in values:
            held.refuse(f"{{{name}}} stands in no line of [values]; add {name} = 0 there")
    return _PLACEHOLDER.sub(lambda found: f"{values[found[1]]:g}", line)


def _text(held: Field) -> str:
    """Text of one line that a control can read."""
    if not isinstance(held.value, str) or _CONTROL.search(held.value):
        held.refuse("it may hold one line of plain letters, digits and signs in quotes")
    return held.value


def _truth(held: Field) -> bool:
    """Whether something is so."""
    if not isinstance(held.value, bool):
        held.refuse("it may hold true or false")
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
    if held.number() < 64:
        held.refuse("it may hold 64 characters or more: an arc needs up to 60")
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


# field of the file: field of Machine, and how it is read
_FIELDS: dict[str, tuple[str, Any]] = {
    "what": ("what", _text),
    "suffix": ("suffix", _suffix),
    "comments": (
        "semicolon",
        lambda held: held.choice("parentheses", "semicolon") == "semicolon",
    ),
    "z": ("z", _truth),
    "arcs": ("arcs", _truth),
    "decimals": ("decimals", _decimals),
    "dwell": ("dwell_unit_s", lambda held: 1.0 if held.choice("s", "ms") == "s" else 1e-3),
    "longest_line": ("longest_line", _longest),
    "feed": ("feeds", lambda held: held.choice("program", "machine") == "program"),
    "begin": ("begin", _strings),
    "end": ("end", _strings),
    "tool_down": ("tool_down", _strings),
    "tool_up": ("tool_up", _strings),
    "values": ("values", _values),
}
