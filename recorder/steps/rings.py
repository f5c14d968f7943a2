"""The endless series of vectors: rings of steps per interval, one ring for each speed of nearly constant
length.

Signals: a vector is (steps in X, steps in Y) of one interval. In a ring each vector differs from its
neighbours by one step or less on each axis, and the last is the neighbour of the first; the vectors laid end
to end draw a circle whose radius is the smallest that the machine can run at that speed. No vector is in two
rings, so a vector tells its ring.

    steps per interval      2     3     4     5      6      7
    vectors in the ring    12    16    20    28     32     40        148 in all
    radius, steps           4    7.5   12   22.5    30    44.5

Each ring is given by its first octant, from (s, 0) to the diagonal, and mirrored from there. It runs on
towards -Y.

Source: patent ES 443122, figures 5 and 10. Questions: figure 5 prints the ring of six; the others are told by
their radii alone. Of all rings with eightfold symmetry, changes of one and lengths within half a step there
is exactly one to each radius. The text lets the vectors run on towards +Y, figure 8 and the example of the
memory towards -Y; built is what the figure shows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Vector = tuple[int, int]

SAME, PREVIOUS, NEXT = 0b00, 0b01, 0b10  # figure 6, bits 2 and 1
LARGEST = 7  # steps of an axis in an interval
NOT_IN_A_RING = -1  # no command leads there

_OCTANTS: dict[int, tuple[Vector, ...]] = {
    2: ((2, 0), (2, 1)),
    3: ((3, 0), (3, 1), (2, 2)),
    4: ((4, 0), (4, 1), (3, 2)),
    5: ((5, 0), (5, 1), (5, 2), (4, 3)),
    6: ((6, 0), (6, 1), (6, 2), (5, 3), (4, 4)),
    7: ((7, 0), (7, 1), (7, 2), (6, 3), (6, 4), (5, 5)),
}


def _ring(octant: tuple[Vector, ...]) -> tuple[Vector, ...]:
    """The whole ring of an octant from (s, 0) on, clockwise."""
    up_to_diagonal = [*octant, *((y, x) for x, y in reversed(octant) if x != y)]
    quarter = [(x, -y) for x, y in up_to_diagonal[:-1]]  # (0, s) belongs to the next one
    turned = [quarter]
    for _ in range(3):
        turned.append([(y, -x) for x, y in turned[-1]])
    return tuple(vector for part in turned for vector in part)


RINGS: dict[int, tuple[Vector, ...]] = {
    speed: _ring(octant) for speed, octant in _OCTANTS.items()
}


def command(present: Vector, wanted: Vector) -> int | None:
    """The vector command from one vector to another: SAME, PREVIOUS or NEXT; None where no command leads."""
    for ring in RINGS.values():
        if present in ring and wanted in ring:
            places = (ring.index(wanted) - ring.index(present)) % len(ring)
            return {0: SAME, 1: NEXT, len(ring) - 1: PREVIOUS}.get(places)
    return None


def commands() -> NDArray[np.int8]:
    """All commands: [x + 7, y + 7, wanted x - x + 1, wanted y - y + 1]; -1 where no command leads."""
    size = 2 * LARGEST + 1
    table = np.full((size, size, 3, 3), NOT_IN_A_RING, np.int8)
    for ring in RINGS.values():
        for place, (x, y) in enumerate(ring):
            for code, other in ((SAME, 0), (PREVIOUS, -1), (NEXT, 1)):
                to_x, to_y = ring[(place + other) % len(ring)]
                table[x + LARGEST, y + LARGEST, to_x - x + 1, to_y - y + 1] = code
    return table
