"""Corrections: what the operator puts right on a drawing before the head follows it, or after it went wrong.

Signals: places on the picture, in pixels or mm, with what is to be done there, in; a record of plain values
out, which `correction_file` reads and writes and `on_sheet` lays on a drawing.

    rub          ink is rubbed out along a stroke of the rubber, or under it at one place
    rub-area     all ink inside a polygon is rubbed out
    bridge       ink is drawn from place to place, as wide and as dark as the line where it begins
    straight     the head goes straight on at the junction there
    left, right  the head turns off to that side at the junction there
    stop, drill  the head stops there; at a drill point as at a dot
    not-stop     no stop is there, whatever the ink looks like
    reference    the reference point is there
    start        the head is put down there

Source: our own. The patent's operator (ES 361967) stands beside the head, has rubber and pen at hand, and
leads the head through the junctions. Questions: see `on_sheet` for the frame of the places.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal, cast, get_args

from morfax.motion.units import parse_length_mm

Unit = Literal["px", "mm"]
Kind = Literal[
    "rub",
    "rub-area",
    "bridge",
    "straight",
    "left",
    "right",
    "stop",
    "drill",
    "not-stop",
    "reference",
    "start",
]
Direction = Literal["cw", "ccw"]

KINDS: tuple[Kind, ...] = get_args(Kind)
RUBBED: tuple[Kind, ...] = ("rub", "rub-area")
INKED: tuple[Kind, ...] = (*RUBBED, "bridge")  # they change what the cells see
TURNS: tuple[Kind, ...] = ("straight", "left", "right")
STOPS: tuple[Kind, ...] = ("stop", "drill", "not-stop")
ONCE: tuple[Kind, ...] = ("reference", "start")  # of several the last one counts
# how many places each kind may have; all others have one
FEWEST = {"rub-area": 3, "bridge": 1, "rub": 1}
MOST_PLACES = 2000  # of one correction: a stroke of the mouse has a few hundred
MOST_PX = 1e6  # further out is no place on a picture
LONGEST_WHY = 500  # characters
PX_DIGITS = 2  # of a place in pixels: a hundredth of a pixel is finer than any mouse


@dataclass(frozen=True, slots=True)
class Place:
    """A place: "px" are columns from the left and rows from the top of the picture, "mm" are X and Y from
    the sheet's lower-left corner.
    """

    x: float
    y: float
    unit: Unit = "px"

    @classmethod
    def parse(cls, text: str) -> Place:
        """The place of "345px,210px" or "40mm,62mm"; a bare number is in mm. Raises ValueError."""
        parts = [part.strip() for part in text.split(",")]
        allowed = 'give X,Y with a unit each, such as "345px,210px" or "40mm,62mm"'
        if len(parts) != 2:
            raise ValueError(f"{text.strip()[:40]!r} is no place; {allowed}")
        first, second = (Span.parse(part) for part in parts)
        if first.unit != second.unit:
            raise ValueError(f"{text.strip()[:40]!r} mixes pixels and mm; {allowed}")
        return cls(first.amount, second.amount, first.unit)

    def __str__(self) -> str:
        """The place as it is read."""
        return f"{Span(self.x, self.unit)},{Span(self.y, self.unit)}"


@dataclass(frozen=True, slots=True)
class Span:
    """A length on the picture: pixels or mm."""

    amount: float
    unit: Unit = "px"

    @classmethod
    def parse(cls, text: str) -> Span:
        """The length of "12px", "0.4mm", "0.02in" or a bare number of mm; raises ValueError."""
        plain = text.strip().lower()
        if not plain.endswith("px"):
            return cls(parse_length_mm(text), "mm")
        try:
            amount = float(plain[:-2])
        except ValueError:
            amount = math.nan
        if not abs(amount) <= MOST_PX:
            raise ValueError(f"{text.strip()[:40]!r} is no length in pixels; give such as 12px")
        return cls(amount)

    def __str__(self) -> str:
        """The length as it is read."""
        digits = PX_DIGITS if self.unit == "px" else PX_DIGITS + 1
        rounded = round(self.amount, digits) + 0.0  # no minus before a zero
        return f"{rounded:.{digits}f}".rstrip("0").rstrip(".") + self.unit


@dataclass(frozen=True, slots=True)
class Correction:
    """One correction: its kind, its places, and a word on why.

    `width` is the rubber's or the pen's; None: `on_sheet` says how wide. `coming_from`: a turn counts only
    for a head that comes from that side. `direction`: which way round the head takes the line from a start.
    """

    do: Kind
    at: tuple[Place, ...]
    width: Span | None = None
    coming_from: Place | None = None
    direction: Direction | None = None
    why: str = ""

    @property
    def has_mm(self) -> bool:
        """Whether any place or width is in mm, for which a scale must be known."""
        lengths = (*self.at, self.width, self.coming_from)
        return any(each is not None and each.unit == "mm" for each in lengths)

    def check(self) -> None:
        """Raise ValueError if the places or what is beside them cannot be served."""
        fewest = FEWEST.get(self.do, 1)
        most = MOST_PLACES if self.do in INKED else 1
        if not fewest <= len(self.at) <= most:
            allowed = "one place" if most == 1 else f"{fewest} to {most} places"
            raise ValueError(f"{self.do} has {len(self.at)} places; it takes {allowed}")
        self._check_what_is_beside()
        if self.width is not None and not self.width.amount > 0:
            raise ValueError(f"the width is {self.width}; it must be above zero, such as 3mm")
        if len(self.why) > LONGEST_WHY or not self.why.isprintable():
            raise ValueError(f"why may be one line of at most {LONGEST_WHY} characters")

    def _check_what_is_beside(self) -> None:
        """Raise ValueError for a width, a way or a direction that is for other corrections."""
        beside = {
            "width": (self.width, ("rub", "bridge")),
            "from": (self.coming_from, TURNS),
            "direction": (self.direction, ("start",)),
        }
        for name, (held, kinds) in beside.items():
            if held is not None and self.do not in kinds:
                raise ValueError(f"{self.do} takes no {name}; that is for {', '.join(kinds)}")


@dataclass(frozen=True, slots=True)
class PictureFile:
    """The picture that corrections belong to: its file's name, size in pixels, page, and the file's sum."""

    name: str
    columns: int
    rows: int
    sha256: str = ""
    page: int = 1


@dataclass(frozen=True, slots=True)
class Corrections:
    """All corrections of a drawing, in the order in which they were made."""

    each: tuple[Correction, ...] = ()
    picture: PictureFile | None = None  # None: nobody has said which
    file: str = field(default="", compare=False)  # its name, for messages

    def of(self, *kinds: Kind) -> list[tuple[int, Correction]]:
        """Those of some kinds, each with its number from 1."""
        return [(n, one) for n, one in enumerate(self.each, 1) if one.do in kinds]

    def counts(self) -> dict[str, int]:
        """How many there are of each kind that there is."""
        every = [one.do for one in self.each]
        return {kind: every.count(kind) for kind in KINDS if kind in every}


def kind_of(text: str) -> Kind:
    """A kind by its name; raises ValueError for a name that none has."""
    if text not in KINDS:
        raise ValueError(f"{text[:40]!r} is no correction; give {', '.join(KINDS)}")
    return cast(Kind, text)
