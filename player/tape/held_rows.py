"""Held rows: rows of the tape that wait to be vouched for, block by block, as they came.

Signals in: blocks of rows, one behind the other. Signals out: any stretch of them, and of one axis.

Nothing is moved when a block comes, and a stretch is copied only where it reaches over the edge of a block.

Source: our own. Questions: none.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.player.tape.phases import Phases


class HeldRows:
    """Rows of one tape; row 0 of them is row `first_row` of the tape."""

    def __init__(self) -> None:
        self._blocks: list[Phases] = []
        self._count = 0  # of the rows in all blocks
        self._dropped = 0  # rows of the first block

    def __len__(self) -> int:
        return self._count - self._dropped

    @property
    def first_row(self) -> int:
        """The row of the tape at which they begin."""
        assert self._blocks, "no rows were taken yet"
        return self._blocks[0].first_row + self._dropped

    def add(self, rows: Phases) -> None:
        """Take the next rows."""
        if len(rows) or not self._blocks:
            self._blocks.append(rows)
            self._count += len(rows)

    def drop(self, count: int) -> None:
        """Let the first rows go."""
        self._dropped += count
        while len(self._blocks) > 1 and self._dropped >= len(self._blocks[0]):
            gone = len(self._blocks.pop(0))
            self._dropped, self._count = self._dropped - gone, self._count - gone

    def cut(self, first: int, last: int) -> Phases:
        """The rows from `first` to before `last`, as far as there are any."""
        first, last = max(first, 0) + self._dropped, max(last, first, 0) + self._dropped
        found: Phases | None = None
        for block in self._blocks:
            if found is None and (first <= len(block) or block is self._blocks[-1]):
                found = block.cut(first, last)
            elif found is not None and last > 0:
                found = found.joined(block.cut(0, last))
            first, last = first - len(block), last - len(block)
        assert found is not None, "no rows were taken yet"
        return found

    def axis(self, axis: int, first: int, last: int) -> Array:
        """The places of one axis in the rows from `first` to before `last`, cycles."""
        first = max(first, 0) + self._dropped
        last = max(last, 0) + self._dropped
        if last <= len(self._blocks[0]):
            return self._blocks[0].cycles[first:last, axis]
        parts = []
        for block in self._blocks:
            if first < len(block) and last > 0:
                parts.append(block.cycles[max(first, 0) : last, axis])
            first, last = first - len(block), last - len(block)
        return parts[0] if len(parts) == 1 else np.concatenate([np.zeros(0), *parts])

    def places(self, at: float) -> list[float]:
        """The places of all axes between two rows, straight from one to the next, cycles."""
        at = min(max(at, 0.0), self._count - self._dropped - 1.0)
        low = int(at)
        row, share = low + self._dropped, at - low
        for block in self._blocks:
            cycles = block.cycles
            if row + 1 < len(cycles):
                near = cycles[row : row + 2].tolist()
                break
            if row < len(cycles):  # between this block and the next
                near = self.cut(low, low + 2).cycles.tolist()
                break
            row -= len(cycles)
        return [
            before + share * (after - before)
            for before, after in zip(near[0], near[-1], strict=True)
        ]

    def around(self, row: float) -> tuple[int, Array]:
        """The block in which a row of the tape lies, or the first one: its first row, and its places."""
        found, dropped = self._blocks[0], self._dropped
        for block in self._blocks[1:]:
            if block.first_row <= row:
                found, dropped = block, 0
        return found.first_row + dropped, found.cycles[dropped:]

    def become(self, rows: Phases) -> None:
        """Hold these rows in place of all."""
        self._blocks, self._dropped, self._count = [rows], 0, len(rows)
