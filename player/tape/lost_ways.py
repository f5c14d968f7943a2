"""Lost ways: gaps of a checked tape that the next count settles.

Signals in: the gaps as they were bridged, and how far each count lies off what the track says, cycles.
Signals out: whether the count vouches for the way until there, or which gap lost it.

    gap       count k       gap         count k + 1
    certain      0        certain            0            vouched for
                          not certain      0, N           the way within is not known: the machine holds
                                                          before it, or mending lays it, N cycles more
                          certain            N            the same: N cycles were lost in it after all
                          none               N            a fault: cycles were lost where nothing shows it

Between two counts the gaps of an axis are one where any of them lost its way, since nothing tells which of
them lost the cycles.

Source: our own. Questions: none.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.bridges import Bound
from morfax.player.tape.gap import Gap
from morfax.player.tape.phases import Phases
from morfax.recorder.tape.format import SURE_CYCLES

# of a symbol: half of the window through which a symbol is seen is a quarter, and what the filter before it
# reaches further; one of 1 000 dropouts of 50 ms was weak a third of a symbol beside its gap
BESIDE = 0.4
HALF_CYCLE = 0.5  # less travel than this cannot be another count


class Laid(NamedTuple):
    """A gap whose way was laid, the whole cycles put back, and what the program likely asks for there."""

    gap: Gap
    cycles: int
    likely: Bound


class LostWays:
    """The gaps of the axes of one tape that no count has settled yet.

    `shift_cycles` is what mending has put back so far, by which the rows to come lie off.
    """

    def __init__(self, axes: int, symbol_rows: float) -> None:
        self._beside = BESIDE * symbol_rows
        self._open: list[list[Gap]] = [[] for _ in range(axes)]
        self.shift_cycles: Array = np.zeros(axes)

    def take(self, gaps: Sequence[Gap]) -> None:
        """Take the gaps that lie in the next rows, as they were counted."""
        for gap in gaps:
            self._open[gap.axis].append(gap.moved(float(self.shift_cycles[gap.axis])))

    def any_open(self, axis: int) -> bool:
        """Whether an axis has a gap that no count has settled yet."""
        return bool(self._open[axis])

    @property
    def are_open(self) -> bool:
        """Whether any axis has such a gap."""
        return any(self._open)

    def uncovered(self, axes: Iterable[int], row: float) -> list[int]:
        """Those of some axes for which a row lies in no gap."""
        if not self.are_open:  # as nearly always, and it is asked twice a frame
            return list(axes)
        return [
            axis
            for axis in axes
            if not any(gap.first - 1 <= row <= gap.last for gap in self._open[axis])
        ]

    def bare(self, axis: int, rows: Sequence[float]) -> float | None:
        """The first of some rows that lies in no gap, nor close beside one."""
        for row in rows:
            if not any(
                gap.first - self._beside <= row <= gap.last + self._beside
                for gap in self._open[axis]
            ):
                return row
        return None

    def lost(self, axis: int, row: float, off_cycles: float) -> Gap | None:
        """The gap that lost its way before a count at a row; None where the count vouches for all."""
        before = [gap for gap in self._open[axis] if gap.last <= row]
        doubtful = [gap for gap in before if not gap.certain]
        if abs(off_cycles) > SURE_CYCLES and not doubtful:
            doubtful = before
        if not doubtful or abs(off_cycles - round(off_cycles)) > SURE_CYCLES:
            return None
        return doubtful[0].upto(doubtful[-1]) if len(doubtful) > 1 else doubtful[0]

    def settle(self, axis: int, row: float, cycles: float = 0.0) -> None:
        """Drop the gaps before a row; those behind it, and all rows to come, are some cycles further on."""
        self._open[axis] = [gap.moved(cycles) for gap in self._open[axis] if gap.last > row]
        self.shift_cycles[axis] += cycles

    def unsettled(self) -> Gap | None:
        """The first gap that only a count could have settled, at the tape's end."""
        left = [gap for gaps in self._open for gap in gaps if not _sure(gap)]
        return min(left, key=lambda gap: gap.first, default=None)


def _sure(gap: Gap) -> bool:
    """Whether a gap needs no count behind it: its sides tell it, or its axis hardly moves."""
    return gap.certain and (gap.bridge.counted or gap.bound.speed * gap.rows < HALF_CYCLE)


def laid(held: Phases, gap: Gap, cycles: int) -> Phases:
    """Rows whose gap is laid anew, with some cycles more behind it."""
    changed = held.cycles.copy()
    first, last = gap.first - held.first_row, gap.last - held.first_row
    changed[last:, gap.axis] += cycles
    changed[first:last, gap.axis] = gap.ending(cycles).laid()
    return Phases(held.first_row, changed, held.surprise, held.levels)
