"""Figures as text for people and as JSON for programs.

Signals in: figures (see `jobs.figures`); values of None are left out. Out: JSON with the same keys, or text
with the figures in the unit that reads best. Dictionaries inside that share a figure become the rows of one
table; a list of them becomes a table of its own, whose rows are named after their first figure. Of very many
places it has the first, which are the worst:

    duration  26.4 s
                         RMS    95 %  largest
    played to traced  0.1 um  0.2 um   0.4 um
"""

from __future__ import annotations

import json
import math
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from morfax.jobs.figures import MOST_PLACES, Figures
from morfax.motion import units
from morfax.motion.files import printable

Row = tuple[str, Figures]  # of a table: its name, and its figures

_LABELS = {"rms": "RMS", "p95": "95 %", "max": "largest"}
_LENGTH_DECIMALS = 5  # of a mm; a smaller part is the rounding of the files
_APART = "  "  # between columns; a table is never wrapped, so that a program can read it line by line

_UNITS: dict[str, Callable[[Any], str]] = {
    "_feed_mm_s": units.format_feed_mm_s,
    "_mm_s": units.format_speed_mm_s,
    "_per_mm": lambda value: f"{value:g} per mm",
    "_place_mm": lambda value: units.format_place_mm(*value[:2]),
    "_mm": lambda value: units.format_length_mm(round(value, _LENGTH_DECIMALS)),
    "_mm2": lambda value: f"{value:.1f} mm2",
    "_deg": lambda value: f"{value:.1f} degrees",
    "_hz": units.format_frequency_hz,
    "_s": units.format_time_s,
    "_db": lambda value: f"{value:.1f} dB",
    "_share": lambda value: f"{100 * value:.2f} %",
}


def as_json(figures: Figures) -> str:
    """The figures as one JSON object; numbers to seven significant figures, no None."""
    return printable(json.dumps(_plain(figures), indent=2, ensure_ascii=False))


def as_text(figures: Figures) -> str:
    """The figures as text: one line each, then those inside as a table."""
    told = {key: value for key, value in figures.items() if value is not None}
    rows = [
        (key.replace("_", " "), value)
        for key, value in told.items()
        if isinstance(value, Mapping)
    ]
    tables = _tables(rows)
    alone = {
        key: value
        for key, value in told.items()
        if not (isinstance(value, Mapping) or _is_listing(value))
    }
    said = _in_columns([_told(key, value) for key, value in alone.items()], 2)
    for listing in filter(_is_listing, told.values()):
        is_of_places = next(iter(listing[0])).endswith("_place_mm")
        shown = listing[:MOST_PLACES] if is_of_places else listing
        said += _in_columns(as_cells(_named(shown)), 1)
        if len(shown) < len(listing):
            said.append(f"and {len(listing) - len(shown)} more, which --json lists")
    for table in tables:
        said += _in_columns(as_cells(table), 1)
    return printable("\n".join(said))


def _tables(rows: list[Row]) -> list[list[Row]]:
    """The rows as tables: those that share a column are one."""
    tables: list[list[Row]] = []
    for row in rows:
        like = (
            table for table in tables if any(row[1].keys() & other.keys() for _, other in table)
        )
        table = next(like, None)
        if table is None:
            tables.append([row])
        else:
            table.append(row)
    return tables


def _is_listing(value: Any) -> bool:
    """Whether a figure is a list of dictionaries."""
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(row, Mapping) for row in value)
    )


def _named(listing: list[Figures]) -> list[Row]:
    """The rows of a list of dictionaries, named after the first figure of each, such as "line 3"."""
    first = next(iter(listing[0]))
    return [
        (" ".join(_told(first, row[first])), {key: row[key] for key in row if key != first})
        for row in listing
    ]


def _in_columns(rows: Sequence[Sequence[str]], left: int) -> list[str]:
    """Rows of cells as lines of text; so many of the columns begin at their left edge, the rest end right."""
    rows = [[" ".join(cell.split("\n")) for cell in row] for row in rows]
    widths = [max(_width(cell) for cell in column) for column in zip(*rows, strict=True)]
    lines = list[str]()
    for row in rows:
        fill = [" " * (width - _width(cell)) for cell, width in zip(row, widths, strict=True)]
        cells = [cell + space for cell, space in zip(row[:left], fill[:left], strict=True)]
        cells += [space + cell for cell, space in zip(row[left:], fill[left:], strict=True)]
        lines.append(_APART.join(cells).rstrip())
    return lines


def _width(text: str) -> int:
    """How many columns of a terminal a text takes."""
    return sum(
        0
        if unicodedata.combining(letter)
        else 1 + (unicodedata.east_asian_width(letter) in "WF")
        for letter in text
    )


def as_cells(rows: Sequence[Row]) -> list[list[str]]:
    """A head of labels, then a line for each row: its name, and each figure that any of them has."""
    keys = list(
        dict.fromkeys(key for _, row in rows for key, value in row.items() if value is not None)
    )
    header = ["", *(_told(key, None)[0] for key in keys)]
    return [header] + [
        [name, *(_told(key, row.get(key))[1] for key in keys)] for name, row in rows
    ]


def _told(key: str, value: Any) -> tuple[str, str]:
    """Label and value of a figure, as people read it."""
    suffix = next((suffix for suffix in _UNITS if f"_{key}".endswith(suffix)), "")
    unit = suffix.removeprefix("_feed").removeprefix(
        "_share"
    )  # these are words of the name too
    name = key.removesuffix(unit).removesuffix("_mm")
    label = _LABELS.get(name, name.replace("_", " "))
    if value is None:
        return label, "–"
    if isinstance(value, bool):
        return label, "yes" if value else "no"
    if isinstance(value, list):
        return label, ", ".join(_UNITS[suffix](one) if suffix else str(one) for one in value)
    return label, _UNITS[suffix](value) if suffix else str(value)


def _plain(value: Any) -> Any:
    """The value in types that JSON has."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if hasattr(value, "tolist"):  # of numpy
        return _plain(value.tolist())
    if not isinstance(value, float):
        return value
    return float(f"{value:.7g}") if math.isfinite(value) else None
