"""A field of a TOML file: what it holds, what it may hold, and the fault that says so with its line.

Signals in: the text of a TOML file: the operator's card, the head's settings, a machine. Signals out:
quantities in mm/s and s, choices, whole numbers; or a CardFault:

    part.toml, line 7: speeds.feed holds "5kg"; it may hold a speed of 0.01 to 100 mm/s, such as "5mm/s"

Fields are named as in the file, elements of arrays by their number from 1: `stop[2].moves[1].down`.

Questions: the feeds end at 100 mm/s, what a tape of 6 kHz and 20 cycles per mm carries (see `motion.axis`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, NoReturn, TypeVar

from morfax.motion.faults import SHOWN, CardFault, FileFault
from morfax.motion.files import check_regular
from morfax.motion.toml_lines import Path, lines_of, too_deep
from morfax.motion.units import parse_speed_mm_s, parse_time_s
from morfax.motion.usual import SLOWEST_MM_S

FASTEST_MM_S = 100.0  # of the feeds, see Questions
LONGEST_DWELL_S = 600.0  # our own figure
LARGEST_BYTES = 1_000_000  # of a file; a card of a hundred stops has 10 000
DEEPEST = 8  # parts of a key, and brackets in one another; the deepest field of ours has 5
_AT = re.compile(r"\(at line (\d+), column (\d+)\)")

T = TypeVar("T")
D = TypeVar("D")


@dataclass(frozen=True, slots=True)
class Page:
    """The page: the name of the file, the line of each field, and what the file is called in a fault."""

    name: str
    lines: Mapping[Path, int]
    called: str = "the card"


@dataclass(frozen=True, slots=True)
class Field:
    """One field of a file: its value, its path, and the page it is on."""

    value: Any
    path: Path
    page: Page

    @property
    def name(self) -> str:
        """The field as one would name it: stop[2].moves[1].down."""
        return "".join(
            f"[{key + 1}]" if isinstance(key, int) else f".{key}" for key in self.path
        ).lstrip(".")

    def refuse(self, allowed: str, held: str | None = None) -> NoReturn:
        """Raise the CardFault of this field."""
        line = self.page.lines.get(self.path, 1)
        holds = held or _shown(self.value)
        where = self.name or self.page.called
        raise CardFault(
            f"{self.page.name}, line {line}: {where} holds {holds}; {allowed}",
            line=line,
            field=where,
            holds=holds,
        )

    def speed_mm_s(self) -> float:
        """A speed, mm/s."""
        allowed = (
            f"it may hold a speed of {SLOWEST_MM_S:g} to {FASTEST_MM_S:g} mm/s,"
            ' such as "5mm/s" or "300mm/min"'
        )
        return self._within(parse_speed_mm_s, SLOWEST_MM_S, FASTEST_MM_S, allowed)

    def time_s(self) -> float:
        """A time, s."""
        allowed = f'it may hold a time of 0 to {LONGEST_DWELL_S:g} s, such as "500ms" or "2s"'
        return self._within(parse_time_s, 0.0, LONGEST_DWELL_S, allowed)

    def number(self) -> int:
        """A number that counts something, from 1."""
        if isinstance(self.value, bool) or not isinstance(self.value, int) or self.value < 1:
            self.refuse("it may hold a whole number from 1")
        return self.value

    def truth(self) -> bool:
        """Whether something is so."""
        if not isinstance(self.value, bool):
            self.refuse("it may hold true or false")
        return self.value

    def choice(self, *choices: str) -> str:
        """One of some words."""
        if self.value not in choices or not isinstance(self.value, str):
            self.refuse("it may hold " + " or ".join(f'"{choice}"' for choice in choices))
        return self.value

    def elements(self, allowed: str) -> list[Field]:
        """The elements of an array of one or more."""
        if not isinstance(self.value, list) or not self.value:
            self.refuse(f"it may hold {allowed}")
        return [Field(value, (*self.path, k), self.page) for k, value in enumerate(self.value)]

    def table(self, *keys: str) -> dict[str, Field]:
        """The fields of a table; a key that is none of these is refused."""
        if not isinstance(self.value, dict):
            self.refuse(f"it may hold a table with {', '.join(keys)}")
        fields = {
            key: Field(value, (*self.path, key), self.page) for key, value in self.value.items()
        }
        for key, field in fields.items():
            if key not in keys:
                field.refuse(
                    f"there is no such field; {self.name or self.page.called} may hold {', '.join(keys)}"
                )
        return fields

    def quantity(self, allowed: str) -> str:
        """A quantity as text: a string, or a bare number."""
        if isinstance(self.value, bool) or not isinstance(self.value, str | int | float):
            self.refuse(allowed)
        return str(self.value)

    def _within(
        self, parse: Callable[[str], float], least: float, most: float, allowed: str
    ) -> float:
        """A quantity that lies between two."""
        try:
            value = parse(self.quantity(allowed))
        except ValueError:
            self.refuse(allowed)
        if not least <= value <= most:
            self.refuse(allowed)
        return value


def opened(file: FilePath, called: str = "the card", option: str = "--card") -> Field:
    """The whole card in a file; raises FileFault if it cannot be read, CardFault if it is no TOML."""
    check_regular(file)
    try:
        with file.open("rb") as stream:
            raw = stream.read(LARGEST_BYTES + 1)
    except OSError as error:
        raise FileFault(
            f"cannot read {called} {file}: {error.strerror}; give another one with {option}"
        ) from error
    if len(raw) > LARGEST_BYTES:
        whole = Field(None, (), Page(file.name, {(): 1}, called))
        whole.refuse(f"it may hold {LARGEST_BYTES} bytes at most", "more than that")
    try:
        return parsed(raw.decode("utf-8-sig"), file.name, called)
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        allowed = "it may hold text in UTF-8"
        return Field(None, (), Page(file.name, {(): line}, called)).refuse(
            allowed, "bytes that are no UTF-8"
        )


def parsed(text: str, name: str = "card", called: str = "the card") -> Field:
    """The whole card in a text; raises CardFault if it is no TOML, or too deep."""
    deep = too_deep(text, DEEPEST)
    if deep is not None:
        line, what = deep
        Field(None, (), Page(name, {(): line}, called)).refuse(f"it may hold {DEEPEST}", what)
    import tomllib

    try:
        return Field(tomllib.loads(text), (), Page(name, lines_of(text), called))
    except ValueError as error:
        refused = str(error)
    at = _AT.search(refused)
    line = int(at[1]) if at else text.count("\n") + 1
    held = (text.splitlines() or [""])[min(line, len(text.splitlines())) - 1].strip()
    why = " ".join(_AT.sub("", refused).split())
    allowed = f'a line may hold key = "value", a quantity with its unit in quotes ({why})'
    return Field(held, (), Page(name, {(): line}, called)).refuse(allowed)


def read(
    fields: Mapping[str, Field], key: str, how: Callable[[Field], T], otherwise: D
) -> T | D:
    """What a field holds, or something else where there is no such field."""
    return how(fields[key]) if key in fields else otherwise


def _shown(value: object) -> str:
    """What a field holds, as text of one line cut short."""
    try:
        shown = json.dumps(value, ensure_ascii=False, default=str)
    except ValueError:  # a number of thousands of digits
        shown = "a number too long"
    return shown if len(shown) <= SHOWN else f"{shown[:SHOWN]}…"
