"""Riding: the way across a gap, as its sides and what the tape tells of the program suggest it.

Signals in: rows of phases with a gap, the most that the machine's motors can do, and on a checked tape the
bounds that its tracks tell. Signals out: the gap, bridged one way or another, and whether that is certain.

    bare       sides of 6 ms, an even jerk between them
    checked    the first of these that is certain, or else the first:
               sides of 6 ms, even jerk; one change of acceleration; sides of 4 ms, the same two

Source: the ways are those of bridges.py. Questions: none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.player.tape.bridges import (
    SHORT_ROWS,
    SIDE_ROWS,
    Bound,
    Bridge,
    GapEdge,
    bridge,
    side,
    turned,
)
from morfax.player.tape.gap import Gap
from morfax.player.tape.phases import Phases
from morfax.player.tape.standstill import SILENT_LEVEL
from morfax.player.tape.told_bounds import ToldBounds


@dataclass(frozen=True, slots=True)
class Riding:
    """How gaps are ridden over: the most that the machine's motors can do, cycles/row and cycles/row².

    `bounds`: what the tape tells of the program, axis by axis, as far as it was read; None on a bare tape.
    `told`: whole cycles to add at a gap (row, axis), if what is not certain is no fault.
    """

    motors: Bound
    bounds: Callable[[], Sequence[ToldBounds]] | None = None
    told: dict[tuple[int, int], int] | None = None

    def across(self, rows: Phases, axis: int, within: tuple[int, int], side_rows: int) -> Gap:
        """The gap of an axis from one row of a block to before another; `side_rows`: of sound tape beside."""
        a, b = within
        first, last = rows.first_row + a, rows.first_row + b
        told = self.bounds()[axis].between(first, last) if self.bounds is not None else None
        gaps: list[Gap] = []
        level_step = _level_step(rows.levels[:, [0, axis + 1]], within, side_rows)
        short_side = side_rows * SHORT_ROWS // SIDE_ROWS
        for length in (side_rows,) if told is None else (side_rows, short_side):
            before, after = _sides(rows.cycles[:, axis], a, b, length)
            short = bridge(before, after, b - a + 1, self.motors.acceleration).counted
            for way in self._ways(before, after, b - a + 1, told):
                behind = replace(after, place=before.place + way.travel)
                gap = Gap(axis, first, last, before, behind, way, told or self.motors, short)
                gaps.append(replace(gap, level_step=level_step))
                if gaps[-1].certain:
                    return gaps[-1]
        return gaps[0]

    def _ways(
        self, before: GapEdge, after: GapEdge, rows: int, told: Bound | None
    ) -> Sequence[Bridge]:
        """The ways across a gap of so many rows, the likeliest first."""
        if told is None:
            return [bridge(before, after, rows, self.motors.acceleration)]
        most = min(self.motors.acceleration, told.acceleration)
        turn = turned(before, after, rows, most)
        return [bridge(before, after, rows, most), *([] if turn is None else [turn])]


def _level_step(levels: NDArray[np.float32], within: tuple[int, int], rows: int) -> float:
    """How far the levels (n, tracks) on both sides of a gap lie apart, as a share, by so many rows."""
    a, b = within
    before = levels[a - rows : a].mean(axis=0)
    after = levels[b : b + rows].mean(axis=0)
    ratio = after / np.maximum(before, SILENT_LEVEL)
    return float(np.abs(ratio - 1).max())


def _sides(cycles: Array, a: int, b: int, rows: int) -> tuple[GapEdge, GapEdge]:
    """The sides of a gap from row `a` to before `b`, from so many rows each; the second in any turn."""
    before = side(cycles[a - rows : a], rows - 1)
    return before, side(np.unwrap(cycles[b : b + rows], period=1.0), 0)
