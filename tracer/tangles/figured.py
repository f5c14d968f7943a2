"""What is drawn by figures: ways whose ink a fit moves to the ink that is seen.

    rule    the corners of a folding rule, their rounding, half the pen's width (see `bent_rule`)
    core    the points of a core, the distance from it, half the pen's width (see `core_ink`)
    moved   how far the places of a way are moved, each along ways of its own (see `moved_way`)

Signals: what is drawn, the ink that is seen and the figures (k,) in; what is drawn too dark at each place of
the ink (n,), and by how much each figure darkens it (n, k), out.

Source: our own. A kernel takes no function of another kind for an argument, so the kinds are told by number.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.tangles import bent_rule, core_ink, moved_way

RULE, CORE, MOVED = range(3)


class Figured(NamedTuple):
    """Which kind is drawn; of a rule its ends (2, 2) mm and which of its corners are rounded; of a way that
    is moved its places (m, 2) mm, how far each figure moves them (m, f, 2), and which are sharp corners.
    """

    kind: int
    ends_mm: Array = np.empty((2, 2))
    rounded: NDArray[np.bool_] = np.empty(0, np.bool_)
    way_mm: Array = np.empty((0, 2))
    moves: Array = np.empty((0, 0, 2))
    sharp: NDArray[np.bool_] = np.empty(0, np.bool_)

    @classmethod
    def rule(cls, ends_mm: Array, rounded: NDArray[np.bool_]) -> Figured:
        """A folding rule between two places."""
        return cls(RULE, ends_mm, rounded)

    @classmethod
    def core(cls) -> Figured:
        """The way about a core: its figures are all there is."""
        return cls(CORE)

    @classmethod
    def moved(cls, way_mm: Array, moves: Array, sharp: NDArray[np.bool_]) -> Figured:
        """A way whose places are moved."""
        way_mm, moves = np.ascontiguousarray(way_mm), np.ascontiguousarray(moves)
        return cls(MOVED, way_mm=way_mm, moves=moves, sharp=sharp)


@njit(cache=True)
def wrong(figured, ink, figures, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n,) with what some figures draw too dark at the places of an ink, and `near` (n, 3) with
    where a way is nearest to these (see `moved_way.nearest`).
    """
    if figured.kind == RULE:
        bent_rule.wrong(ink, (figured.ends_mm, figured.rounded), figures, near, out)
    elif figured.kind == CORE:
        core_ink.ink(ink.places_mm, _core_of(figures), ink.softness_mm, False, out)
        out -= ink.darkness
    else:
        moved_way.wrong(ink, _moved(figured, figures), figured.sharp, near, out)


@njit(cache=True)
def changes(figured, ink, figures, near, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, k) with by how much each figure darkens the places of an ink, per unit of it; `near` is
    what `wrong` filled in for the same figures.
    """
    if figured.kind == RULE:
        bent_rule.changes(ink, (figured.ends_mm, figured.rounded), figures, near, out)
    elif figured.kind == CORE:
        core_ink.changes(ink.places_mm, _core_of(figures), ink.softness_mm, out)
        if len(figures) % 2 == 0 and figures[-2] < 0:  # a radius below 0 is drawn as one above
            out[:, -2] *= -1.0
    else:
        moved = _moved(figured, figures), figured.moves, figured.sharp
        moved_way.changes(ink, moved, near, out)


@njit(cache=True)
def _core_of(figures):  # type: ignore[no-untyped-def]
    """A core of some figures: its points (m, 2), the distance from it, 0 where that is no figure, and half
    the pen's width, mm.
    """
    count = (len(figures) - 1) // 2
    radius_mm = figures[2 * count] if len(figures) > 2 * count + 1 else 0.0
    return figures[: 2 * count].reshape(-1, 2), abs(radius_mm), figures[-1]


@njit(cache=True)
def _moved(figured, figures):  # type: ignore[no-untyped-def]
    """A way with its places moved by some figures."""
    way, moves = figured.way_mm.copy(), figured.moves
    for i in range(len(way)):
        for k in range(len(figures)):
            way[i, 0] += moves[i, k, 0] * figures[k]
            way[i, 1] += moves[i, k, 1] * figures[k]
    return way
