"""Values of the command line: text with a unit becomes mm, mm/s, Hz; places, lines, stops become tuples."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import click

from morfax.motion.units import (
    parse_angle_rad,
    parse_frequency_hz,
    parse_length_mm,
    parse_memory_bytes,
    parse_place_mm,
    parse_share,
    parse_speed_mm_s,
    parse_time_s,
)
from morfax.motion.usual import COUNT_MM

ZEROS = ("sheet", "reference", "lower-left", "centre")
# a shorter lead is none; a longer one is a slip of the pen
LEAST_LEAD_MM, MOST_LEAD_MM = 0.1, 100.0


class Quantity(click.ParamType):
    """A parameter with a unit; what cannot be read is wrong use of the command line."""

    def __init__(
        self,
        name: str,
        parse: Callable[[str], Any],
        *,
        above_zero: bool = False,
        within: str | None = None,
        bare: str = "",
    ) -> None:
        self.name, self._parse, self._above_zero = name, parse, above_zero
        self._within = within  # such as "0.05mm to 500mm"
        self._bare = bare  # what a bare number is, where that may surprise

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Read the text; a value that is a number already stays as it is."""
        try:
            quantity = self._parse(value) if isinstance(value, str) else value
        except ValueError as refused:
            self.fail(str(refused), param, ctx)
        if self._above_zero and not quantity > 0:
            self.fail(f"{value!r} is no {self.name} here; it must be above zero", param, ctx)
        if self._within is not None:
            least, most = (self._parse(end) for end in self._within.split(" to "))
            if not least <= quantity <= most:
                allowed = f"it may be {self._within}{self._bare}"
                self.fail(f"{value!r} is no {self.name} here; {allowed}", param, ctx)
        return quantity


def _number(text: str) -> float:
    """Read a bare number."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is no number; give one such as 0.5 or 20")
    return number


def _parse_places_mm(text: str) -> tuple[float, ...]:
    """Place in mm of "X,Y", "X,Y,Z" or more axes, each a length."""
    parts = text.split(",")
    return (
        *parse_place_mm(",".join(parts[:2])),
        *(parse_length_mm(part) for part in parts[2:]),
    )


def _parse_pixels(text: str) -> tuple[float, float]:
    """Place in pixels of "X,Y", two bare numbers."""
    parts = text.split(",")
    try:
        x, y = (float(part) for part in parts)
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(
            f"{text!r} is no place in pixels; give column and row, two numbers without a unit, "
            "such as 210,305"
        )
    return x, y


def _parse_lines(text: str) -> str | tuple[int, ...]:
    """Which lines of a drawing: "all", "contours", "outer", or their numbers."""
    word = text.strip().lower()
    if word in ("all", "contours", "outer"):
        return word
    try:
        return tuple(int(number) for number in word.split(","))
    except ValueError:
        raise ValueError(
            f"{text!r} names no lines; give all, contours, outer, or numbers such as 1,3"
        ) from None


def _parse_order(text: str) -> tuple[int, ...]:
    """Numbers of lines in their order."""
    parts = [part.strip() for part in text.split(",")]
    if not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise ValueError(f"{text[:40]!r} is no order of lines; give their numbers, such as 3,1")
    return tuple(map(int, parts))


def _parse_lettering(text: str) -> float:
    """From which height on letters are followed, mm: 0 for "all", infinite for "none"."""
    word = text.strip().lower()
    if word in ("all", "none"):
        return 0.0 if word == "all" else math.inf
    try:
        high_mm = parse_length_mm(word)
    except ValueError:
        high_mm = 0.0
    if not high_mm > 0:
        raise ValueError(
            f"{text!r} names no letters; give all, none, or the height of the least, such as 2mm"
        )
    return high_mm


def _parse_stops(text: str) -> str | tuple[int, ...]:
    """Which stop marks do not stop the head: "none", "all", or their numbers."""
    word = text.strip().lower()
    if word in ("none", "all"):
        return word
    parts = [part.strip() for part in word.split(",")]
    if not all(part.isdecimal() and int(part) > 0 for part in parts):
        raise ValueError(
            f"{text!r} names no stops; give none, all, or numbers from 1 on, such as 1,3"
        )
    return tuple(map(int, parts))


def _tracks(text: str) -> tuple[int, ...]:
    """Tracks of "2,1,3,4"."""
    try:
        return tuple(int(part) for part in text.split(","))
    except ValueError:
        raise ValueError(f"{text[:40]!r} names no tracks; give 2,1,3,4") from None


def _axes(text: str) -> tuple[str, ...]:
    """Axes of "x,y"."""
    names = tuple(part.strip().lower() for part in text.split(","))
    if not all(name.isidentifier() for name in names):
        raise ValueError(f"{text[:40]!r} names no axes; give such as y or x,y")
    return names


def _parse_zero(text: str) -> Any:
    """Where the zero of a program is: "sheet", "reference", "lower-left", "centre", or a place."""
    word = text.strip().lower()
    if word in ZEROS:
        return word
    try:
        return parse_place_mm(text)
    except ValueError:
        raise ValueError(
            f"{text!r} is no zero; give {', '.join(ZEROS)}, or a place X,Y on the sheet such as 40,62"
        ) from None


def _parse_stock(text: str) -> tuple[float, float, float | None]:
    """Width, height and thickness in mm of "200x100x18mm", or "200x100mm" without a thickness."""
    allowed = "200x100x18mm (width, height, thickness), or 200x100mm"
    parts = text.lower().replace("×", "x").split("x")
    unit = parts[-1].strip().lstrip("0123456789.")
    try:
        sizes = [parse_length_mm(p if p.strip()[-1:].isalpha() else p + unit) for p in parts]
    except ValueError:
        sizes = []
    if len(sizes) not in (2, 3) or min(sizes) <= 0:
        raise ValueError(f"{text!r} is no stock; give {allowed}, above zero")
    return sizes[0], sizes[1], sizes[2] if len(sizes) == 3 else None


def _parse_lead(text: str) -> tuple[float, str]:
    """A lead of "3mm", "3mm,arc" or "3mm,line": its size in mm, and its kind."""
    size, _, kind = text.strip().lower().partition(",")
    kind = kind.strip() or "arc"
    if kind not in ("arc", "line"):
        raise ValueError(
            f"{text!r} is no lead; give its size, such as 3mm for an arc, or 3mm,line"
        )
    size_mm = parse_length_mm(size)
    if not LEAST_LEAD_MM <= size_mm <= MOST_LEAD_MM:
        raise ValueError(
            f"{text!r} is no lead; its size may be {LEAST_LEAD_MM:g}mm to {MOST_LEAD_MM:g}mm"
        )
    return size_mm, kind


def _decades(least_counts: int) -> Callable[[str], float]:
    """How to read a length of Z, which is set on five decades."""

    def parse(text: str) -> float:
        from morfax.tracer.operator.zunit import (
            COUNTS_PER_MM,
            LARGEST_COUNT,
            counts_of,
        )

        length_mm, most_mm = parse_length_mm(text), LARGEST_COUNT * COUNT_MM
        least_mm = least_counts * COUNT_MM
        allowed = f"give {least_mm:.2f} to {most_mm:.2f} mm in steps of {COUNT_MM:g} mm, such as 2.5mm"
        if not least_mm <= length_mm <= most_mm:
            raise ValueError(f"{text!r} cannot be set here on the five decades of Z; {allowed}")
        try:
            return counts_of(length_mm) / COUNTS_PER_MM
        except ValueError:
            raise ValueError(
                f"{text!r} cannot be set on the five decades of Z; {allowed}"
            ) from None

    return parse


def _flatten(text: str) -> Any:
    """What is wanted of a photograph."""
    from morfax.tracer.flatten.wanted import parsed

    return parsed(text)


def _correction_place(text: str) -> Any:
    """One place of a correction."""
    from morfax.tracer.corrections.corrections import Place

    return Place.parse(text)


def _correction_places(text: str) -> Any:
    """Places of a correction, with blanks between: "812px,1004px 850px,1010px"."""
    parts = text.split()
    if not parts:
        raise ValueError("no place is given; give X,Y, or several in quotes")
    return tuple(map(_correction_place, parts))


def _correction_width(text: str) -> Any:
    """A width of a correction."""
    from morfax.tracer.corrections.corrections import Span

    return Span.parse(text)


STOCK = Quantity("stock", _parse_stock)
LENGTH = Quantity("length", parse_length_mm, above_zero=True)
REACH = Quantity("length", parse_length_mm)  # of the head; may be 0
DEPTH = Quantity("length", _decades(0))
COUNTED = Quantity("length", _decades(1))  # of Z, above zero
# flatter, Z changes too little for its noise to show a slope
RAMP = Quantity("angle", parse_angle_rad, within="1.5deg to 45deg")
# up to 0.05 mm above the work the tool counts as in it
CLEARANCE = Quantity("length", _decades(6))
BAR = Quantity("length", parse_length_mm, within="90mm to 110mm")  # further off is a slip
FLATTEN = Quantity("marks|paper=FORMAT|places=WxH|auto", _flatten)
CUTTER = Quantity("length", parse_length_mm, within="0.05mm to 500mm")
SPEED = Quantity("speed", parse_speed_mm_s)
FEED = Quantity(
    "speed",
    parse_speed_mm_s,
    within="0.01mm/s to 1000mm/s",
    bare="; a bare number is in mm/s: give 1200mm/min",
)
FREQUENCY = Quantity("frequency", parse_frequency_hz)
ANGLE = Quantity("angle", parse_angle_rad)
SHARE = Quantity("share", parse_share)
NUMBER = Quantity("number", _number, above_zero=True)
PLACE = Quantity("x,y", parse_place_mm)
PIXELS = Quantity("x,y", _parse_pixels)
PLACES = Quantity("x,y,z", _parse_places_mm)
TIME = Quantity("time", parse_time_s)
LIMIT = Quantity("time", parse_time_s, above_zero=True)
# with its libraries a worker takes 0.8 GB of addresses before it has a drawing
MEMORY = Quantity("memory", parse_memory_bytes, within="1GB to 1000TB")
LINES = Quantity("lines", _parse_lines)
ORDER = Quantity("lines", _parse_order)
LETTERS = Quantity("all|none|length", _parse_lettering)
STOPS = Quantity("stops", _parse_stops)
TRACKS = Quantity("tracks", _tracks)
AXES = Quantity("axes", _axes)
ZERO = Quantity("zero", _parse_zero)
LEAD = Quantity("size[,line]", _parse_lead)
CORRECTED = Quantity("x,y", _correction_place)
CORRECTED_ALONG = Quantity("x,y x,y …", _correction_places)
CORRECTION_WIDTH = Quantity("length", _correction_width)
