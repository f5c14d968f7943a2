"""Path files: CSV with the columns t_s, x_mm, y_mm, z_mm, tool, and one for each further axis: u_mm, v_mm …

Signals: times in s, places in mm; `tool` is 1 where the tool is in the work. Written to 0.1 us and 0.01 um,
well inside the thinning's 0.2 um.

Reading is tolerant, since paths also come from other programs. Columns stand in any order and only x_mm and
y_mm (or x and y, in mm) are required:

    no t_s     the points are run through at the feed, along the polyline
    no z_mm    the tool column gives Z: in the work 0, up +2 mm; without either the tool is always in the work
    u_mm …     (A, B, C, U, V or W) a further axis, in the order of the columns
    else       a column of another name is passed over, but for one of an axis in a unit other than mm, which is refused
    loop       (truth files) where it changes a new contour starts, and the tool goes over to it at +2 mm

Where Z follows from tool or loop, X and Y stand while Z moves at the feed:

    z  +2         ______________            a new point stands over the last point in the work and
                 |              |           another over the first one after it; later times move on
        0  ______|              |______

Questions: a change of `tool` from one row to the next does not say where between them the tool moves; here it
moves over the row that is in the work.
"""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import FileFault, MotionFault
from morfax.motion.files import written_beside
from morfax.motion.motion import AXES, FURTHER_AXES, IN_WORK_BELOW_MM, Path

CLEARANCE_MM = 2.0  # where the tool stands when it is up, docs/design.md
FEED_MM_S = 10.0

_NAMES = {
    "t": "t_s",
    "time_s": "t_s",
    "x": "x_mm",
    "y": "y_mm",
    "z": "z_mm",
}  # short names of the columns
_COLUMNS = (
    "t_s",
    "x_mm",
    "y_mm",
    "z_mm",
    "tool",
    "loop",
    *(f"{axis}_mm" for axis in FURTHER_AXES),
)
_OTHER_UNITS = {"", "in", "inch", "cm", "m", "um", "deg", "rad", "ms", "us", "min"}
_UP = {"0", "0.0", "false", "up"}
_DOWN = {"1", "1.0", "true", "down"}
_ROWS_AT_ONCE = 4096
_EXPECTED = "a line of names such as t_s,x_mm,y_mm,z_mm,tool"


def write_path(path: Path, file: str | os.PathLike[str]) -> None:
    """Write a path as CSV: t_s, x_mm, y_mm, z_mm, tool, further axes."""
    with written_beside(file) as beside, beside.open("w", encoding="ascii", newline="") as out:
        write_rows(path, out, header=True)


def write_rows(path: Path, out: TextIO, *, header: bool = False) -> None:
    """Write the rows of a path, or of a piece of one, to a file that is open, after the line of names if that
    is asked for.
    """
    if header:
        out.write(_header(path))
    places_mm = np.round(path.positions_mm, 5)
    rows = (
        np.column_stack([np.round(path.t_s, 7), places_mm[:, :3], path.tool, places_mm[:, 3:]])
        + 0.0
    )  # no minus zero
    line = "%.7f,%.5f,%.5f,%.5f,%d" + ",%.5f" * len(path.axes[3:]) + "\n"
    for first in range(0, len(rows), _ROWS_AT_ONCE):
        some = rows[first : first + _ROWS_AT_ONCE]
        out.write(line * len(some) % tuple(some.ravel()))


def _header(path: Path) -> str:
    """The line of names."""
    return (
        ",".join(["t_s,x_mm,y_mm,z_mm,tool", *(f"{axis}_mm" for axis in path.axes[3:])]) + "\n"
    )


def read_path(file: str | os.PathLike[str], feed_mm_s: float = FEED_MM_S) -> Path:
    """Read a path file; raises MotionFault with the line if it is no path, FileFault if it cannot be read."""
    if not feed_mm_s > 0:
        raise ValueError(f"a feed of {feed_mm_s} mm/s does not move; give one above zero")
    table = _read_table(file)
    _check(table, file)
    rows = _with_z_moves(table)
    t_s = rows.times_s(feed_mm_s)
    keep = np.r_[True, np.diff(t_s) > 0]  # points that take no time are doubled points
    if np.count_nonzero(keep) < 2:
        raise MotionFault(
            f"{file}: the path stands still at one place; a path needs at least two different points"
        )
    return Path(
        t_s[keep], np.ascontiguousarray(rows.positions_mm[keep]), (*AXES, *table.further)
    )


@dataclass(frozen=True, slots=True)
class _Table:
    """The columns of a file as read: what is absent is None; `lines` holds each row's line in the file."""

    columns: dict[str, Array]
    lines: NDArray[np.int64]

    @property
    def xy_mm(self) -> Array:
        return np.column_stack([self.columns["x_mm"], self.columns["y_mm"]])

    @property
    def further(self) -> tuple[str, ...]:
        """The axes beyond X, Y and Z, in the order of their columns."""
        return tuple(
            axis
            for axis in (name.removesuffix("_mm") for name in self.columns)
            if axis in FURTHER_AXES
        )

    @property
    def further_mm(self) -> Array:
        """Their places, (n, axes beyond Z)."""
        return np.column_stack(
            [
                np.empty((len(self.lines), 0)),
                *(self.columns[f"{axis}_mm"] for axis in self.further),
            ]
        )


@dataclass(frozen=True, slots=True)
class _Rows:
    """Points with the time since the point before, from the file: NaN where it says nothing and the feed
    decides.
    """

    positions_mm: Array
    since_last_s: Array
    start_s: float

    def times_s(self, feed_mm_s: float) -> Array:
        """Times of the points, s."""
        at_feed_s = (
            np.r_[0.0, np.sqrt((np.diff(self.positions_mm, axis=0) ** 2).sum(axis=1))]
            / feed_mm_s
        )
        return self.start_s + np.cumsum(
            np.where(np.isnan(self.since_last_s), at_feed_s, self.since_last_s)
        )


def _read_table(file: str | os.PathLike[str]) -> _Table:
    """Read the columns that a path needs, all rows at once; look for the culprit only when that fails."""
    written = enumerate(_read_text(file).splitlines(), 1)
    lines = [
        (number, line)
        for number, line in written
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if len(lines) < 3:
        raise MotionFault(
            f"{file}: {max(0, len(lines) - 1)} points in it; a path needs {_EXPECTED}, then two or more"
        )
    separator = max(",;\t", key=lines[0][1].count)
    where = _find_columns(lines[0][1], separator, f"{file}, line {lines[0][0]}")
    values = _convert([line for _, line in lines[1:]], where, separator)
    if values is None:
        raise MotionFault(f"{file}{_culprit(lines[1:], where, separator)}")
    columns = {name: values[:, i] for i, name in enumerate(where)}
    return _Table(columns, np.array([number for number, _ in lines[1:]]))


def _read_text(file: str | os.PathLike[str]) -> str:
    """The file's text; a byte-order mark is dropped."""
    try:
        return FilePath(file).read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise MotionFault(
            f"{file}: this is not a text file; a path file is CSV and starts with {_EXPECTED}"
        ) from None
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from error


def _find_columns(header: str, separator: str, place: str) -> dict[str, int]:
    """Which column holds what."""
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
        axis, _, unit = name.partition("_")
        if (
            name not in _COLUMNS
            and unit in _OTHER_UNITS
            and axis in ("t", *AXES, *FURTHER_AXES)
        ):
            wanted = "t_s, in seconds" if axis == "t" else f"{axis}_mm, in mm"
            raise MotionFault(
                f"{place}: column {name} cannot be read; give {wanted}, or take the column out"
            )
    return {name: names.index(name) for name in names if name in _COLUMNS}


def _convert(lines: list[str], where: dict[str, int], separator: str) -> Array | None:
    """All rows as numbers, one column per entry of `where`; None if a row is bad."""
    tool: dict[int | str, Callable[[str], float]] = (
        {where["tool"]: _tool} if "tool" in where else {}
    )
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
    word = text.strip().lower()
    if word not in _UP | _DOWN:
        raise ValueError(text)
    return float(word in _DOWN)


def _culprit(lines: list[tuple[int, str]], where: dict[str, int], separator: str) -> str:
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


def _check(table: _Table, file: str | os.PathLike[str]) -> None:
    """Raise MotionFault where time goes back, or stands while the place changes."""
    if "t_s" not in table.columns:
        return
    step_s = np.diff(table.columns["t_s"])
    moves = np.any(np.diff(table.xy_mm, axis=0) != 0, axis=1)
    if "z_mm" in table.columns:
        moves |= np.diff(table.columns["z_mm"]) != 0
    moves |= np.any(np.diff(table.further_mm, axis=0) != 0, axis=1)
    bad = np.flatnonzero((step_s < 0) | ((step_s == 0) & moves))
    if len(bad):
        before, now = table.columns["t_s"][bad[0] : bad[0] + 2]
        where = f"{file}, line {table.lines[bad[0] + 1]}"
        message = f"{where}: t_s is {now:g} after {before:g}; times must grow, or leave the column t_s out"
        raise MotionFault(message, time_s=float(now))


def _with_z_moves(table: _Table) -> _Rows:
    """The table's points with Z, and with the moves of Z that follow from tool and loop put in."""
    n = len(table.lines)
    down = table.columns.get("tool", np.ones(n)) > 0
    z_mm = table.columns.get("z_mm", np.where(down, 0.0, CLEARANCE_MM))
    points = np.column_stack([table.xy_mm, z_mm, table.further_mm])
    times = table.columns.get("t_s")
    since = np.full(n, np.nan) if times is None else np.r_[0.0, np.diff(times)]
    after, over, over_since = _z_moves(table, points, since)
    start_s = 0.0 if times is None else float(times[0])
    return _Rows(
        np.insert(points, after + 1, over, axis=0),
        np.insert(since, after + 1, over_since),
        start_s,
    )


def _z_moves(
    table: _Table, points: Array, since: Array
) -> tuple[NDArray[np.int64], Array, Array]:
    """After which rows new points come, the points, their times since the last; changes `since` for the step
    after.
    """
    after: list[int] = []
    over: list[Array] = []
    over_since: list[float] = []
    for i in np.flatnonzero(_changes(table, points)).tolist():
        z0, z1 = points[i, 2], points[i + 1, 2]
        if z0 <= IN_WORK_BELOW_MM:  # up over the last point in the work, at the feed
            after.append(i)
            over.append(_raised(points[i]))
            over_since.append(np.nan)
        if z1 <= IN_WORK_BELOW_MM:  # over to the first point in the work, then down at the feed
            after.append(i)
            over.append(_raised(points[i + 1]))
            over_since.append(since[i + 1] if z0 > IN_WORK_BELOW_MM else np.nan)
            since[i + 1] = np.nan
    return (
        np.array(after, np.int64),
        np.array(over).reshape(-1, points.shape[1]),
        np.array(over_since),
    )


def _raised(point_mm: Array) -> Array:
    """The same point with the tool up."""
    return np.r_[point_mm[:2], CLEARANCE_MM, point_mm[3:]]


def _changes(table: _Table, points: Array) -> NDArray[np.bool_]:
    """Whether Z must move between each row and the next though the file says nothing of it."""
    work = points[:, 2] <= IN_WORK_BELOW_MM
    loop = table.columns.get("loop", np.zeros(len(points)))
    new_contour = (np.diff(loop) != 0) & work[1:] & work[:-1]
    return new_contour if "z_mm" in table.columns else new_contour | (work[1:] != work[:-1])
