"""Told bounds: what the check signal tells of the speed and acceleration to come.

Signals in: what each track says, frame by frame, and the rows of the frame. Signals out: the most that an
axis is asked for between two rows of the tape, cycles/row and cycles/row².

    frame k tells     |- frame k -|- frame k + 1 -|        the largest of both
    known between two rows where frames that were read cover all of them
    likely between two rows: what the frames before and behind tell

A tape that runs fast by a share makes its speeds greater by that share, and its accelerations twice. Flutter
adds to the acceleration of an axis that runs: 0.5 % at 10 Hz changes a speed by 0.3 of it in a second.

Source: our own. Questions: an axis that asks for more than a frame can tell is not bounded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.player.tape.bridges import Bound
from morfax.player.tape.frame_report import FrameReport
from morfax.player.tape.symbols import PARTS

KEPT = 8  # frames: a gap of 1.1 s, and those that a row is held for
FLUTTER_HZ = 0.3  # change of a speed by flutter, in a second


class ToldBounds:
    """The bounds that one axis has been told of."""

    def __init__(self, rate_hz: float, frame_s: float) -> None:
        self._rate_hz, self._frame_rows = rate_hz, frame_s * rate_hz
        self._told: list[tuple[float, float, Bound]] = []  # first row, last row, bound

    @property
    def largest(self) -> float:
        """The largest acceleration told of late, cycles/row²."""
        return max([bound.acceleration for *_, bound in self._told], default=0.0)

    def add(self, report: FrameReport, track: int) -> None:
        """Take what a track says in a frame that was read."""
        said = report.said[track]
        if said is None or not math.isfinite(said.speed + said.acceleration):
            return
        rows = report.row, report.part_rows[0], report.part_rows[-1]
        most = said.speed, said.acceleration
        self.take([told_span.py_func(rows, most, (self._rate_hz, self._frame_rows))])

    def take(self, spans: Sequence[Sequence[float]]) -> None:
        """Take what frames tell, one behind the other, as `told_span` has it."""
        for starts, ends, acceleration, speed in spans[-KEPT:]:
            self._told.append((starts, ends, Bound(acceleration, speed)))
        del self._told[:-KEPT]

    def around(self, first: int, last: int) -> Bound | None:
        """The bound that the frames before, between and behind two rows tell, even if they do not reach."""
        before = [bound for starts, _, bound in self._told if starts < first][-1:]
        behind = [bound for starts, _, bound in self._told if starts >= first]
        if not before or not behind:
            return None
        near = before + behind
        return Bound(max(one.acceleration for one in near), max(one.speed for one in near))

    def tell(self, first: int, told: Array) -> None:
        """Fill the largest acceleration and speed told of each of some rows (2, rows); nan where none is."""
        spans = [
            (max(math.ceil(starts) - first, 0), max(math.ceil(ends) - first, 0), bound)
            for starts, ends, bound in self._told
        ]
        # between two edges the same frames tell of all rows
        edges = sorted({0, told.shape[1], *(edge for span in spans for edge in span[:2])})
        for begins, ends in pairwise(edges):
            near = [bound for one, other, bound in spans if one <= begins and other >= ends]
            told[0, begins:ends] = max((bound.acceleration for bound in near), default=math.nan)
            told[1, begins:ends] = max((bound.speed for bound in near), default=math.nan)

    def rests(self, first: int, last: int) -> bool:
        """Whether the axis tells that it stands still between two rows."""
        bound = self.between(first, last)
        return bound is not None and not bound.speed

    def between(self, first: int, last: int) -> Bound | None:
        """The bound between two rows, or None where no frame tells it."""
        known, acceleration, speed = float(first), 0.0, 0.0
        for starts, ends, bound in self._told:
            if ends <= first or starts > known:
                continue
            known = max(known, ends)
            acceleration = max(acceleration, bound.acceleration)
            speed = max(speed, bound.speed)
            if known >= last:
                return Bound(acceleration, speed)
        return None


@njit(cache=True, nogil=True)
def told_span(rows, most, usual):  # type: ignore[no-untyped-def]
    """The first and last row of which a frame tells, and the most acceleration and speed there, of rows.

    `rows`: of its start, and of the middle of its first part and its last; `most`: cycles/s and cycles/s²;
    `usual`: Hz of the rows, and the rows of a frame where the tape runs at its own speed.
    """
    (row, first, last), (speed, acceleration), (rate_hz, frame_rows) = rows, most, usual
    rows = (last - first) * PARTS / (PARTS - 1)
    fast = frame_rows / rows
    most = acceleration * fast**2 + FLUTTER_HZ * speed
    return row, row + 2 * rows, most / rate_hz**2, speed * fast / rate_hz
