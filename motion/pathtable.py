"""The table of a path file: its columns as numbers, and what is wrong with a file that is no path.

Signals in: the text of a CSV file. Signals out: the columns that a path needs, in s and mm, or a MotionFault
with the line.

Columns stand in any order; only x_mm and y_mm (or x and y, in mm) are required. Comma, semicolon or tab
separates them; lines that begin with # are comments.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import FileFault, MotionFault
from morfax.motion.files import check_regular
from morfax.motion.motion import AXES, FURTHER_AXES
from morfax.motion.units import LONGEST_MM

# short names of the columns
_NAMES = {"t": "t_s", "time_s": "t_s", "x": "x_mm", "y": "y_mm", "z": "z_mm"}
_FURTHER = tuple(f"{axis}_mm" for axis in FURTHER_AXES)
_COLUMNS = ("t_s", "x_mm", "y_mm", "z_mm", "tool", "loop", *_FURTHER)
_OTHER_UNITS = {"", "in", "inch", "cm", "m", "um", "deg", "rad", "ms", "us", "min"}
_TOOL = dict.fromkeys(("0", "0.0", "false", "up"), 0.0)
_TOOL |= dict.fromkeys(("1", "1.0", "true", "down"), 1.0)
_EXPECTED = "a line of names such as t_s,x_mm,y_mm,z_mm,tool"

LARGEST_MM = LONGEST_MM  # of a place; as long as a length may be that is given by hand
LONGEST_S = 86_400.0  # a day; a tape of it would have 33 GB
LONGEST_LINE = 10_000  # characters; a row of ten axes has 150

File = str | os.PathLike[str]
Lines = list[tuple[int, str]]  # the number of each line in the file, and the line


@dataclass(frozen=True, slots=True)
class PathTable:
    """The columns that a file has, as read; `lines` holds each row's line in the file."""

    columns: dict[str, Array]
    lines: NDArray[np.int64]

    @property
    def xy_mm(self) -> Array:
        """Places of X and Y, (n, 2)."""
        return np.column_stack([self.columns["x_mm"], self.columns["y_mm"]])

    @property
    def further(self) -> tuple[str, ...]:
        """The axes beyond X, Y and Z, in the order of their columns."""
        axes = (name.removesuffix("_mm") for name in self.columns)
        return tuple(axis for axis in axes if axis in FURTHER_AXES)

    @property
    def further_mm(self) -> Array:
        """Places of the axes beyond Z, (n, axes beyond Z)."""
        columns = [self.columns[f"{axis}_mm"] for axis in self.further]
        return np.column_stack([np.empty((len(self.lines), 0)), *columns])


def read_table(file: File) -> PathTable:
    """Read the columns that a path needs; raises MotionFault with the line if they are not a path's."""
    written = enumerate(_read_text(file).splitlines(), 1)
    lines = [(n, line) for n, line in written if (bare := line.strip()) and bare[0] != "#"]
    if len(lines) < 3:
        raise MotionFault(
            f"{file}: {max(0, len(lines) - 1)} points in it; a path needs {_EXPECTED}, then two or more"
        )
    (number, header), rows = lines[0], lines[1:]
    long = next((n for n, line in lines if len(line) > LONGEST_LINE), None)
    if long is not None:
        raise MotionFault(
            f"{file}, line {long}: longer than {LONGEST_LINE} characters; a path file is CSV and starts with "
            f"{_EXPECTED}"
        )
    separator = max(",;\t", key=header.count)
    where = _find_columns(header, separator, f"{file}, line {number}")
    # all rows at once; the culprit is looked for only when that fails
    values = _convert([line for _, line in rows], where, separator)
    if values is None:
        raise MotionFault(f"{file}{_culprit(rows, where, separator)}")
    columns = {name: values[:, i] for i, name in enumerate(where)}
    table = PathTable(columns, np.array([number for number, _ in rows]))
    _check_places(table, file)
    _check_times(table, file)
    return table


def _read_text(file: File) -> str:
    """The file's text; a byte-order mark is dropped."""
    check_regular(file)
    try:
        return FilePath(file).read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise MotionFault(
            f"{file}: this is not a text file; a path file is CSV and starts with {_EXPECTED}"
        ) from None
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error


def _find_columns(header: str, separator: str, place: str) -> dict[str, int]:
    """Which column holds what; raises MotionFault for one that is missing, doubled or in another unit."""
    names = [name.strip().strip('"').strip().lower() for name in header.split(separator)]
    names = [_NAMES.get(name, name) for name in names]
    for required in ("x_mm", "y_mm"):
        if required not in names:
            raise MotionFault(
                f"{place}: no column {required} in {header.strip()[:60]!r}; give {_EXPECTED}"
            )
    for name in _COLUMNS:
        if names.count(name) > 1:
            raise MotionFault(
                f"{place}: column {name} stands there {names.count(name)} times; leave one"
            )
    for name in names:
        _refuse_other_unit(name, place)
    return {name: names.index(name) for name in names if name in _COLUMNS}


def _refuse_other_unit(name: str, place: str) -> None:
    """Raise MotionFault for a column of a time or an axis in a unit that is not read."""
    axis, _, unit = name.partition("_")
    is_known = axis in ("t", *AXES, *FURTHER_AXES)
    if name in _COLUMNS or unit not in _OTHER_UNITS or not is_known:
        return
    wanted = "t_s, in seconds" if axis == "t" else f"{axis}_mm, in mm"
    raise MotionFault(
        f"{place}: column {name} cannot be read; give {wanted}, or take the column out"
    )


def _convert(lines: list[str], where: dict[str, int], separator: str) -> Array | None:
    """All rows as numbers, one column per entry of `where`; None if a row is bad."""
    tool = dict[int | str, Callable[[str], float]]()
    if "tool" in where:
        tool[where["tool"]] = _tool
    wanted = tuple(where.values())
    try:
        values = np.loadtxt(
            lines, delimiter=separator, usecols=wanted, converters=tool, quotechar='"', ndmin=2
        )
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def _tool(text: str) -> float:
    """1.0 in the work, 0.0 up."""
    value = _TOOL.get(text)  # as nearly all are written
    if value is None:
        value = _TOOL.get(text.strip().lower())
    if value is None:
        raise ValueError(text)
    return value


def _culprit(lines: Lines, where: dict[str, int], separator: str) -> str:
    """The first bad row and what is wrong with it."""
    for number, line in lines:
        fields = next(csv.reader(io.StringIO(line), delimiter=separator))
        for name, column in where.items():
            if column >= len(fields):
                return f", line {number}: no value for {name} in {line.strip()[:60]!r}; every line needs one"
            if not _is_good(name, fields[column]):
                allowed = "1 (in the work) or 0 (up)" if name == "tool" else "a finite number"
                return f", line {number}: {name} is {fields[column].strip()[:30]!r}; it must be {allowed}"
    return (
        f": the rows cannot be read as numbers; a path file is CSV and starts with {_EXPECTED}"
    )


def _is_good(name: str, field: str) -> bool:
    """Whether a field can be read."""
    try:
        return bool(np.isfinite(_tool(field) if name == "tool" else float(field)))
    except ValueError:
        return False


def _check_places(table: PathTable, file: File) -> None:
    """Raise MotionFault for a place that is on no machine, or a time that no program takes."""
    for name, values in table.columns.items():
        is_time = name == "t_s"
        most, allowed = (LONGEST_S, "s") if is_time else (LARGEST_MM, "mm")
        far = np.flatnonzero(np.abs(values - (values[0] if is_time else 0.0)) > most)
        if len(far):
            raise MotionFault(
                f"{file}, line {table.lines[far[0]]}: {name} is {values[far[0]]:g}; it may be up to "
                f"{most:g} {allowed}{' after the first' if is_time else ''}; check the unit"
            )


def _check_times(table: PathTable, file: File) -> None:
    """Raise MotionFault where time goes back, or stands while the place changes."""
    if "t_s" not in table.columns:
        return
    step_s = np.diff(table.columns["t_s"])
    z_mm = table.columns.get("z_mm", np.zeros(len(table.lines)))
    places = np.column_stack([table.xy_mm, z_mm, table.further_mm])
    moves = np.any(np.diff(places, axis=0) != 0, axis=1)
    bad = np.flatnonzero((step_s < 0) | ((step_s == 0) & moves))
    if len(bad):
        before, now = table.columns["t_s"][bad[0] : bad[0] + 2]
        raise MotionFault(
            f"{file}, line {table.lines[bad[0] + 1]}: t_s is {now:g} after {before:g};"
            " times must grow, or leave the column t_s out",
            time_s=float(now),
        )
