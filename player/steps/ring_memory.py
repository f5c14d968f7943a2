"""The ring memory: from the counts of X and Y and a direction, which way each counter goes.

Signals: an address of nine bits in, four of each count and the direction; out four bits, up and down of X and
of Y, as a table of all entries. Where the counts are no vector of a ring it gives nothing.

Source: patent ES 443122, figure 9, read-only memory 61.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.recorder.steps.file import STANDSTILL
from morfax.recorder.steps.rings import RINGS

UP_X, DOWN_X, UP_Y, DOWN_Y = 1, 2, 4, 8  # outputs of the ring memory
MEMORY_ENTRIES = 512  # four bits of each count, and the direction


def ring_memory() -> NDArray[np.uint8]:
    """The read-only memory 61: changes of the counters, by counts of X and Y and direction (1: next)."""
    memory = np.zeros(MEMORY_ENTRIES, np.uint8)
    for ring in RINGS.values():
        for place, (x, y) in enumerate(ring):
            for direction, other in ((1, place + 1), (0, place - 1)):
                to_x, to_y = ring[other % len(ring)]
                memory[_address(x + STANDSTILL, y + STANDSTILL, direction)] = _outputs(
                    to_x - x, to_y - y
                )
    return memory


def _address(count_x: int, count_y: int, direction: int) -> int:
    """Nine inputs of the memory."""
    return count_x << 5 | count_y << 1 | direction


def _outputs(change_x: int, change_y: int) -> int:
    """Four outputs of the memory."""
    x = {1: UP_X, -1: DOWN_X, 0: 0}[change_x]
    return x | {1: UP_Y, -1: DOWN_Y, 0: 0}[change_y]
