"""Figures as text for people and as JSON for programs.

Signals in: figures (see `jobs.figures`); values of None are left out. Out: JSON with the same keys, or text
with the figures in the unit that reads best. Dictionaries inside that share a figure become the rows of one
table; a list of them becomes a table of its own, whose rows are named after their first figure:

    duration  26.4 s
                         RMS    95 %  largest
    played to traced  0.1 um  0.2 um   0.4 um
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from morfax.jobs.figures import Figures
from morfax.motion import units
from morfax.motion.files import printable

Row = tuple[str, Figures]  # of a table: its name, and its figures

_LABELS = {"rms": "RMS", "p95": "95 %", "max": "largest"}
_LENGTH_DECIMALS = 5  # of a mm; a smaller part is the rounding of the files
_WIDEST = 1000  # columns; a table is never wrapped, so that a program can read it line by line

_UNITS: dict[str, Callable[[Any], str]] = {
    "_mm_s": units.format_speed_mm_s,
    "_per_mm": lambda value: f"{value:g} per mm",
    "_place_mm": lambda value: units.format_place_mm(*value[:2]),
    "_mm": lambda value: units.format_length_mm(round(value, _LENGTH_DECIMALS)),
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
    from rich.console import Console

    out = io.StringIO()
    console = Console(file=out, width=_WIDEST, highlight=False, emoji=False, markup=False)
    told = {key: value for key, value in figures.items() if value is not None}
    rows = [(key, value) for key, value in told.items() if isinstance(value, Mapping)]
    tables = _tables(rows)
    lists = [_named(value) for value in told.values() if _is_listing(value)]
    alone = {
        key: value
        for key, value in told.items()
        if not (isinstance(value, Mapping) or _is_listing(value))
    }
    if alone:
        console.print(_lines(alone))
    for listing in (*lists, *tables):
        console.print(_grid(listing))
    return printable("\n".join(line.rstrip() for line in out.getvalue().splitlines()))


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
        (f"{first} {row[first]}", {key: row[key] for key in row if key != first})
        for row in listing
    ]


def _lines(figures: Figures) -> Any:
    """One line for each figure: its label and its value."""
    from rich.table import Table

    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column()
    table.add_column()
    for key, value in figures.items():
        table.add_row(*_told(key, value))
    return table


def _grid(rows: Sequence[Row]) -> Any:
    """One row for each dictionary, one column for each figure that any of them has."""
    from rich.table import Table

    header, *lines = as_cells(rows)
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for number, label in enumerate(header):
        table.add_column(label, justify="right" if number else "left")
    for line in lines:
        table.add_row(*line)
    return table


def as_cells(rows: Sequence[Row]) -> list[list[str]]:
    """A head of labels, then a line for each row: its name, and each figure that any of them has."""
    keys = list(
        dict.fromkeys(key for _, row in rows for key, value in row.items() if value is not None)
    )
    header = ["", *(_told(key, None)[0] for key in keys)]
    return [header] + [
        [name.replace("_", " "), *(_told(key, row.get(key))[1] for key in keys)]
        for name, row in rows
    ]


def _told(key: str, value: Any) -> tuple[str, str]:
    """Label and value of a figure, as people read it."""
    suffix = next((suffix for suffix in _UNITS if f"_{key}".endswith(suffix)), "")
    name = key if suffix == "_share" else key.removesuffix(suffix).removesuffix("_mm")
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
