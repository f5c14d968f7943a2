"""A machine, as data: which words its control takes, and how a program begins and ends there.

Signals in: the name of a built-in machine (`machines/*.toml`) or a file like these. Signals out: a Machine,
or a CardFault that points at the line of a mistake, as for the operator's card.

Source: LinuxCNC's and Grbl 1.1's lists of G-codes, Marlin's, and QtPlasmaC's manual. Questions: the spindle's
speed and the times are the workshop's own; what stands here is a beginning, and is one file to change.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from importlib import resources
from pathlib import Path as FilePath
from typing import Any, Literal

from morfax.motion.toml_fields import Field, opened, parsed
from morfax.motion.usual import FEED_MM_S, PLOTTER_MM
from morfax.recorder.gcode.machine_fields import (
    FIELDS,
    LINES,
    NUMBER_LONG,
    SHORTEST_LINE,
    filled,
    in_ascii,
    strings,
)
from morfax.recorder.gcode.takes import Takes, ToolWords

DEFAULT = "linuxcnc"
HPGL = "hpgl"  # the default of .plt and .hpgl
CALLED = "the machine"


Axes = tuple[float, float, float]  # X, Y, Z
UsualLines = Literal["all", "contours"]

TOLERANCE_MM = 0.01  # of a program from the motion, and of a control at a corner
DECIMALS = 4  # of a mm: a tenth of a micrometre


@dataclass(frozen=True, slots=True)
class Machine:
    """How a control wants its programs; the lines hold no {placeholder} any more."""

    name: str
    what: str
    suffix: str = ".ngc"
    is_hpgl: bool = False  # whether its programs are HP-GL; all others are RS-274
    step_mm: float = PLOTTER_MM
    semicolon: bool = False  # comments after ; and not in ( )
    z: bool = True
    arcs: bool = True
    decimals: int = DECIMALS
    dwell_unit_s: float = 1.0
    longest_line: int = 252
    line_numbers: int = 0  # step from one to the next; 0: none are written
    milling: Literal["climb", "conventional"] | None = None  # direction of closed lines
    # of a drawing, where nobody asks for some: of a pen all the ink, of a torch what it cuts; None: one line
    lines: UsualLines | None = None
    feeds: bool = True  # whether the program says F
    rapids_have_feed: bool = False  # whether a rapid bears F
    rapid_mm_s: Axes = (50.0, 50.0, 20.0)
    acceleration_mm_s2: Axes = (500.0, 500.0, 200.0)
    corner_mm: float = TOLERANCE_MM  # how far the control rounds corners off
    panel_feed_mm_s: float = FEED_MM_S  # where the feed is not in the program
    travel_mm: Axes | None = None  # None: not known
    begin: tuple[str, ...] = ()
    end: tuple[str, ...] = ("M2",)
    tool_down: tuple[str, ...] = ()
    tool_up: tuple[str, ...] = ()
    dot_down: tuple[str, ...] = ()  # where X and Y stand meanwhile; (): as anywhere
    dot_up: tuple[str, ...] = ()
    hole_begin: tuple[str, ...] = ()  # before a hole of the part is cut
    hole_overcut: tuple[str, ...] = ()  # where it closes, before the way on
    hole_end: tuple[str, ...] = ()
    takes: Takes = field(default_factory=Takes)
    tool: ToolWords = field(default_factory=ToolWords)
    values: dict[str, float] = field(default_factory=dict, compare=False)

    def comment(self, text: str) -> str:
        """A line that the control passes over, cut to its longest."""
        plain = in_ascii(text).replace("(", "[").replace(")", "]")
        for obeyed in self.takes.not_sent:  # even in a comment
            plain = plain.replace(obeyed, ".")
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


def machine(name: str = DEFAULT, changed: Mapping[str, float] | None = None) -> Machine:
    """A built-in machine, or the one that a .toml file describes, with some of its [values] changed.

    Raises ValueError for a name that is neither or a value that it does not have, CardFault for a mistake in
    a file, FileFault if a file cannot be read.
    """
    if name.lower().endswith(".toml"):
        file = FilePath(name)
        return _machine(file.stem, opened(file, CALLED, "--machine"), changed or {})
    return _built_in(name, tuple((changed or {}).items()))


@lru_cache(maxsize=32)
def _built_in(name: str, changed: tuple[tuple[str, float], ...]) -> Machine:
    """A built-in machine, with some of its [values] changed; read once for all programs of a batch."""
    return _machine(name, parsed(as_toml(name), f"{name}.toml", CALLED), dict(changed))


def _machine(name: str, whole: Field, changed: Mapping[str, float]) -> Machine:
    """The machine in a file."""
    fields = whole.table(*FIELDS)
    said: dict[str, Any] = {
        field_of: read(fields[key]) for key, (field_of, read) in FIELDS.items() if key in fields
    }
    values = said.setdefault("values", {})
    for each, value in changed.items():
        if each not in values:
            there = ", ".join(values) or "none"
            raise ValueError(f"{name} has no value {each!r}; its values are: {there}")
        values[each] = value
    for key in LINES:
        if key in fields:
            said[key] = tuple(filled(element, values) for element in strings(fields[key]))
    made = Machine(name, **{"what": name, **said})
    room = made.longest_line - NUMBER_LONG * bool(made.line_numbers)
    if room < SHORTEST_LINE:
        fields["line_numbers"].refuse(
            f"with line numbers longest_line must be {SHORTEST_LINE + NUMBER_LONG} or more"
        )
    for key in LINES:
        for number, line in enumerate(getattr(made, key), 1):
            if len(line) > room:
                fields[key].refuse(
                    f"its line {number} may hold {room} characters, as longest_line says"
                )
    return made
