"""The step recorder: a motion becomes differences of steps per interval, punched in rows.

Signals: a stream of Motion or a Path in, a `.steps` file out. The motion is cut into legs (`recorder.legs`),
each leg into lengths of one interval (`recorder.lengths`), and of each length only the difference from the
one before is punched, two bits for an axis; or, where both lengths are of one ring, the step along the ring,
two bits for both.

    bit        8       7 6      5    4 3          2 1
    axis row   tool    Z 01 10  1    Y 01 10      X 01 up, 10 down, 00 same
    vector     tool    Z        0    the second   01 previous, 10 next, 00 the same vector

With two vector commands in a row (figure 11) a vector row lasts two intervals, an axis row one. What is left
over of a run of vectors is punched as an axis row, which every change can be.

Instead, the orders may be the counts themselves, four bits an axis (claim 8): a larger tape, on which a wrong
hole spoils one interval and not all that follow.

Source: patent ES 443122, figures 1, 3, 6 and 11. Questions: which bit of a pair is printed first the figures
leave open; "01" is read as the higher bit 0, the lower bit
1. In a row with two vector commands the Z bits hold for the first interval, and the recorder pairs no
interval with a change of Z behind it. The program may be off the motion by one step; a motion whose bends ask
for more is run slower.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import MotionFault
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.motion.segments import Limits, Segment, Source, as_path, segments
from morfax.recorder.report import WrittenIntervals
from morfax.recorder.steps.file import (
    MOST_ROWS,
    STANDSTILL,
    STEP_MM,
    Rows,
    StepFormat,
    StepProgram,
    write_program,
)
from morfax.recorder.steps.lengths import cut
from morfax.recorder.steps.rings import LARGEST, SAME, commands

AXIS_ROW, TOOL_DOWN = 0b0001_0000, 0b1000_0000
# how the orders are punched: entries of the format
ORDERS: dict[str, dict[str, Any]] = {
    "differences": {"vectors": 2, "channels": 8},
    "counts": {"vectors": 0, "channels": 13},
}
_UP_DOWN_SAME = {0: 0b00, 1: 0b01, -1: 0b10}
_SLOWER = (1.0, 0.7, 0.5, 0.3)  # shares of the speed that are tried in turn
_MARGIN = 0.98  # of the largest rate, so that the fractions of a step find room

Steps = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class StepReport(WrittenIntervals[StepFormat]):
    """What was punched: rows, vector intervals, steps, and the largest distance of an interval's end."""

    rows: int
    vector_intervals: int
    steps: int

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        share = self.vector_intervals / max(1, self.intervals)
        punched = self.rows * self.format.channels
        return {
            "rows": self.rows,
            "punched_bits": punched,
            "vector_share": share,
            "deviation_mm": self.deviation_mm,
        }


def record_steps(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float | None = None,
    fmt: StepFormat | None = None,
    orders: str = "differences",
) -> StepReport:
    """Record a motion as a step program within a tolerance of it, by default one step.

    `orders`, where no format is given: differences of the counts, or the counts themselves.

    Without a format the step is the tolerance. Raises MotionFault for a motion that is empty, or cannot be
    had within the tolerance; nothing is left under the name then.
    """
    if tolerance_mm is not None and not tolerance_mm > 0:
        raise ValueError(
            f"a tolerance of {tolerance_mm} mm leaves no room; give one above zero"
        )
    fmt = fmt or StepFormat(step_mm=min(tolerance_mm or STEP_MM, 1.0), **ORDERS[orders])
    path = as_path(stream)
    tolerance_mm = tolerance_mm or fmt.step_mm
    lengths, down, off_mm = _within(tolerance_mm, path, fmt)
    start_mm = tuple(np.round(path.positions_mm[0], 6).tolist())
    end_mm = tuple(
        np.round(path.positions_mm[0] + lengths.sum(axis=0) * fmt.step_mm, 6).tolist()
    )
    fmt = replace(fmt, start_mm=start_mm, end_mm=end_mm)
    rows = encode(lengths, down, fmt)
    if len(rows) > MOST_ROWS:
        raise MotionFault(
            f"the program has {len(rows)} rows; at most {MOST_ROWS} are allowed: record it in parts"
        )
    write_program(StepProgram(fmt, rows), file)
    axis_rows = len(rows) if fmt.holds_counts else int(np.count_nonzero(rows & AXIS_ROW))
    vectors = len(lengths) - axis_rows
    steps = int(np.abs(lengths).sum())
    return StepReport(FilePath(file), fmt, len(lengths), off_mm, len(rows), vectors, steps)


def encode(lengths: Steps, down: NDArray[np.bool_], fmt: StepFormat) -> Rows:
    """The rows for steps (k, 3) of the intervals, the first after standstill; raises ValueError.

    A program of five channels holds X and Y only.
    """
    changes = np.diff(lengths, axis=0, prepend=np.zeros((1, 3), np.int64))
    if np.abs(changes).max(initial=0) > 1 or np.abs(lengths).max(initial=0) > LARGEST:
        raise ValueError(
            "a length differs by more than one step from the one before; cut the motion anew"
        )
    if fmt.channels == 5 and changes[:, 2].any():
        raise ValueError("the motion moves Z, and five channels hold X and Y only; take eight")
    if fmt.holds_counts:
        counts = lengths + STANDSTILL
        return np.asarray(counts @ [1, 16, 256] + fmt.tool_bit * down, np.uint16)
    return np.array(list(_rows(lengths, changes, down, fmt)), np.uint16) & (2**fmt.channels - 1)


def _rows(
    lengths: Steps, changes: Steps, down: NDArray[np.bool_], fmt: StepFormat
) -> Iterator[int]:
    """The rows one by one; with two vector commands in a row, runs of vectors are taken in pairs."""
    vectors = _vector_commands(lengths, changes).tolist()
    z_moves = (changes[:, 2] != 0).tolist()
    tool = (down * TOOL_DOWN).tolist()
    axis = _axis_codes(changes).tolist()
    at = 0
    while at < len(vectors):
        second = at + 1
        if vectors[at] < 0:
            yield axis[at] | AXIS_ROW | tool[at]
        elif fmt.vectors == 1:
            yield vectors[at] | axis[at] & 0b0110_0000 | tool[at]
        elif (
            second < len(vectors)
            and vectors[second] >= 0
            and not z_moves[second]
            and tool[at] == tool[second]
        ):
            yield vectors[at] | vectors[second] << 2 | axis[at] & 0b0110_0000 | tool[at]
            at += 1
        else:
            yield axis[at] | AXIS_ROW | tool[at]
        at += 1


def _vector_commands(lengths: Steps, changes: Steps) -> NDArray[np.int8]:
    """The vector command from each interval to the next; -1 where no command leads."""
    x, y = (lengths[:, :2] - changes[:, :2]).T + LARGEST
    return np.asarray(commands()[x, y, changes[:, 0] + 1, changes[:, 1] + 1])


def _axis_codes(changes: Steps) -> NDArray[np.int64]:
    """Bits 2 1, 4 3 and 7 6 of the changes of X, Y and Z."""
    code = np.where(
        changes > 0, _UP_DOWN_SAME[1], np.where(changes < 0, _UP_DOWN_SAME[-1], SAME)
    )
    return np.asarray(code[:, 0] | code[:, 1] << 2 | code[:, 2] << 5)


def _within(
    tolerance_mm: float, path: Source, fmt: StepFormat
) -> tuple[Steps, NDArray[np.bool_], float]:
    """The lengths of the motion, the tool in each, and the deviation; slower where it would be too large."""
    off_mm = np.inf
    for share in _SLOWER:
        try:
            lengths, down, off_mm = _lengths(segments(path, _limits(fmt, share)), fmt)
        except ValueError:
            continue
        if off_mm <= tolerance_mm:
            return lengths, down, off_mm
    raise MotionFault(
        f"the steps of {fmt.step_mm:g} mm come no nearer to the motion than {off_mm:.4f} mm; allowed "
        f"{tolerance_mm:g} mm: give a larger tolerance, or smaller steps"
    )


def _limits(fmt: StepFormat, share: float) -> Limits:
    """The limits of the motors, in mm: one step more or less per interval."""
    step = fmt.step_mm
    speed = share * _MARGIN * LARGEST * step * fmt.rate_hz
    return Limits(
        speed, share**2 * step * fmt.rate_hz**2, spacing_mm=step / 4, window_mm=5 * step
    )


def _lengths(parts: list[Segment], fmt: StepFormat) -> tuple[Steps, NDArray[np.bool_], float]:
    """The lengths of all legs with the rests between them, and the largest distance from the motion, mm."""
    taken = [np.zeros((0, 3), np.int64)]
    down = [np.zeros(0, np.bool_)]
    off = 0.0
    origin = parts[0].places_mm[0] if parts else np.zeros(3)
    at = np.zeros(3, np.int64)
    for leg in parts:
        rest = np.zeros((round(leg.rest_s / fmt.interval_s), 3), np.int64)
        places, speeds = (
            (leg.places_mm - origin) / fmt.step_mm,
            leg.speed_mm_s / fmt.step_mm * fmt.interval_s,
        )
        lengths, away = cut(places, speeds, leg.spacing_mm / fmt.step_mm, at)
        z_steps = at[2] + np.cumsum(np.r_[rest, lengths][:, 2])
        z_mm = origin[2] + z_steps * fmt.step_mm
        at = at + lengths.sum(axis=0)
        taken += [rest, lengths]
        down.append(z_mm <= IN_WORK_BELOW_MM)
        off = max(off, float(away.max(initial=0.0)))
    return np.vstack(taken), np.concatenate(down), off * fmt.step_mm
