"""Path files: CSV with the columns t_s, x_mm, y_mm, z_mm, tool, and one for each further axis: u_mm, v_mm …

Signals: times in s, places in mm; `tool` is 1 where the tool is in the work. Written to 0.1 us and 0.01 um,
well inside the thinning's 0.2 um.

Reading is tolerant, since paths also come from other programs (see `pathtable`). Only x_mm and y_mm are
required:

    no t_s     the points are run through at the feed, along the polyline
    no z_mm    the tool column gives Z: in the work 0, up +2 mm; without either the tool is always in the work
    u_mm …     (A, B, C, U, V or W) a further axis, in the order of the columns
    loop       (truth files) where it changes a new contour starts, and the tool goes over to it at +2 mm
    else       a column of another name is ignored; one of an axis in a unit other than mm is refused

Where Z follows from tool or loop, X and Y stand while Z moves at the feed:

    z  +2         ______________            a new point stands over the last point in the work and
                 |              |           another over the first one after it; later times move on
        0  ______|              |______

Questions: a change of `tool` from one row to the next does not say where between them the tool moves; here it
moves over the row that is in the work.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.decimals import lines_of
from morfax.motion.faults import MotionFault
from morfax.motion.files import written_beside
from morfax.motion.motion import AXES, IN_WORK_BELOW_MM, Path
from morfax.motion.pathtable import LONGEST_S, PathTable, read_table
from morfax.motion.usual import AT_ONCE
from morfax.motion.usual import FEED_MM_S as FEED_MM_S

CLEARANCE_MM = 2.0  # where the tool stands when it is up, docs/design.md


def write_path(path: Path, file: str | os.PathLike[str]) -> None:
    """Write a path as CSV: t_s, x_mm, y_mm, z_mm, tool, further axes."""
    with written_beside(file) as beside, beside.open("w", encoding="ascii", newline="") as out:
        write_rows(path, out, header=True)


def write_rows(path: Path, out: TextIO, *, header: bool = False) -> None:
    """Write the rows of a path, or of a piece of one, to an open file, `header`: after the names."""
    if header:
        out.write(_header(path))
    places_mm = path.positions_mm
    rows = np.column_stack([path.t_s, places_mm[:, :3], path.tool, places_mm[:, 3:]])
    decimals = [7, 5, 5, 5, 0, *[5] * len(path.axes[3:])]
    for first in range(0, len(rows), AT_ONCE):
        out.write(lines_of(rows[first : first + AT_ONCE], decimals))


def _header(path: Path) -> str:
    """The line of names."""
    further = [f"{axis}_mm" for axis in path.axes[3:]]
    return ",".join(["t_s,x_mm,y_mm,z_mm,tool", *further]) + "\n"


def read_path(file: str | os.PathLike[str], feed_mm_s: float = FEED_MM_S) -> Path:
    """Read a path file; raises MotionFault with the line if it is no path, FileFault if it cannot be read."""
    return at_feed(read_table(file), feed_mm_s, str(file))


def at_feed(table: PathTable, feed_mm_s: float, name: str) -> Path:
    """The path of a table, run at a feed where it has no times; raises MotionFault if it stands still."""
    if not feed_mm_s > 0:
        raise ValueError(f"a feed of {feed_mm_s} mm/s does not move; give one above zero")
    rows = _with_z_moves(table)
    t_s = rows.times_s(feed_mm_s)
    if t_s[-1] - t_s[0] > LONGEST_S:
        raise MotionFault(
            f"{name} takes {(t_s[-1] - t_s[0]) / 3600:.4g} h; a program may take a day: check the unit, "
            "or run it faster with --feed"
        )
    keep = np.r_[True, np.diff(t_s) > 0]  # points that take no time are doubled points
    if np.count_nonzero(keep) < 2:
        raise MotionFault(
            f"{name}: the path stands still at one place; a path needs at least two different points"
        )
    positions_mm = np.ascontiguousarray(rows.positions_mm[keep])
    return Path(t_s[keep], positions_mm, (*AXES, *table.further))


@dataclass(frozen=True, slots=True)
class _Rows:
    """Points with the time since the point before: NaN where the file has no time and the feed decides."""

    positions_mm: Array
    since_last_s: Array
    start_s: float

    def times_s(self, feed_mm_s: float) -> Array:
        """Times of the points, s."""
        steps_mm = np.sqrt((np.diff(self.positions_mm, axis=0) ** 2).sum(axis=1))
        at_feed_s = np.r_[0.0, steps_mm] / feed_mm_s
        steps_s = np.where(np.isnan(self.since_last_s), at_feed_s, self.since_last_s)
        return self.start_s + np.cumsum(steps_s)


@dataclass(slots=True)
class _NewPoints:
    """Points that are put in: after which row, where, and the time since the point before."""

    after: list[int] = field(default_factory=list)
    points: list[Array] = field(default_factory=list)
    since_s: list[float] = field(default_factory=list)

    def add(self, after: int, point_mm: Array, since_s: float = np.nan) -> None:
        """Put in a point with the tool up; without a time the feed decides."""
        self.after.append(after)
        self.points.append(np.r_[point_mm[:2], CLEARANCE_MM, point_mm[3:]])
        self.since_s.append(since_s)


def _with_z_moves(table: PathTable) -> _Rows:
    """The table's points with Z, and with the moves of Z that follow from tool and loop put in."""
    n = len(table.lines)
    down = table.columns.get("tool", np.ones(n)) > 0
    z_mm = table.columns.get("z_mm", np.where(down, 0.0, CLEARANCE_MM))
    points = np.column_stack([table.xy_mm, z_mm, table.further_mm])
    times = table.columns.get("t_s")
    since = np.full(n, np.nan) if times is None else np.r_[0.0, np.diff(times)]
    start_s = 0.0 if times is None else float(times[0])
    new = _z_moves(table, points, since)
    before = np.array(new.after, np.int64) + 1
    over = np.array(new.points).reshape(-1, points.shape[1])
    return _Rows(
        np.insert(points, before, over, axis=0), np.insert(since, before, new.since_s), start_s
    )


def _z_moves(table: PathTable, points: Array, since: Array) -> _NewPoints:
    """The points of the moves of Z that the file does not have; changes `since` for the step after."""
    new = _NewPoints()
    for i in np.flatnonzero(_changes(table, points)).tolist():
        z0 = points[i, 2]
        z1 = points[i + 1, 2]
        if z0 <= IN_WORK_BELOW_MM:  # up over the last point in the work, at the feed
            new.add(i, points[i])
        if z1 <= IN_WORK_BELOW_MM:  # over to the first point in the work, then down at the feed
            new.add(i, points[i + 1], since[i + 1] if z0 > IN_WORK_BELOW_MM else np.nan)
            since[i + 1] = np.nan
    return new


def _changes(table: PathTable, points: Array) -> NDArray[np.bool_]:
    """Whether Z must move between each row and the next though the file does not say so."""
    work = points[:, 2] <= IN_WORK_BELOW_MM
    loop = table.columns.get("loop", np.zeros(len(points)))
    new_contour = (np.diff(loop) != 0) & work[1:] & work[:-1]
    return new_contour if "z_mm" in table.columns else new_contour | (work[1:] != work[:-1])
