"""Outline: lines from CAD, in mm: contours as polylines, and the path on which a tool runs them.

Signals in: pieces (n, 2) mm as a file has them. Signals out: contours, pieces whose ends meet joined; a Path
with the tool in the work (z = 0) along each contour and up between them, as path files have it.

    piece  ·────·            one contour: ends within 0.01 mm are one place, if just two ends meet there
                 ·───·
    a single place is a hole

Source: our own. Questions: where more than two ends meet, no way on is the right one, and the pieces stay
apart. A line that is there twice is taken once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.motion import Path
from morfax.motion.pathfile import FEED_MM_S, at_feed
from morfax.motion.pathtable import PathTable
from morfax.motion.units import LONGEST_MM
from morfax.motion.usual import INCREMENT_MM

# the tolerance of a program: ends that CAD has snapped agree to a millionth of it
JOINED_MM = 0.01


@dataclass(frozen=True, slots=True)
class CadOutline:
    """Contours (n, 2) mm, in the order of the file; those of one place are holes."""

    contours_mm: tuple[Array, ...]
    notes: tuple[str, ...] = ()  # what the operator should know

    @classmethod
    def of(cls, pieces_mm: Sequence[Array], notes: Sequence[str] = ()) -> CadOutline:
        """Join the pieces of a file; a piece that is there twice is taken once.

        Raises DrawingFault for a place that is no number or more than a kilometre away, as of a path file.
        """
        furthest_mm = float(np.max([np.abs(piece).max() for piece in pieces_mm], initial=0.0))
        if not furthest_mm <= LONGEST_MM:
            raise DrawingFault(
                f"the drawing reaches {furthest_mm:.3g} mm from its zero, at most {LONGEST_MM:g} are taken; "
                "check its unit, or give it with --unit"
            )
        once = _once(pieces_mm)
        doubled = len(pieces_mm) - len(once)
        told = [f"{doubled} lines are there twice, and taken once"] if doubled else []
        return cls(tuple(_joined(once)), (*notes, *told))

    def path(self, feed_mm_s: float = FEED_MM_S) -> Path:
        """The path on which a tool runs the contours at a feed, up before, between and after them."""
        rows, tool, loop = [], [], []
        for number, contour in enumerate(self.contours_mm):
            rows.append(contour)
            tool.append(np.ones(len(contour)))
            loop.append(np.full(len(contour), float(number)))
        places = np.vstack([rows[0][:1], *rows, rows[-1][-1:]])
        down = np.concatenate([[0.0], *tool, [0.0]])
        numbers = np.concatenate([[0.0], *loop, [loop[-1][-1]]])
        columns = {"x_mm": places[:, 0], "y_mm": places[:, 1], "tool": down, "loop": numbers}
        return at_feed(PathTable(columns, np.arange(len(places))), feed_mm_s, "the outline")


def _once(pieces_mm: Sequence[Array]) -> list[Array]:
    """The pieces without those that are there already, this way round or the other."""
    seen, kept = set[bytes](), list[Array]()
    for piece in pieces_mm:
        key = np.round(piece / INCREMENT_MM).astype(np.int64)
        if key.tobytes() in seen:
            continue
        seen |= {key.tobytes(), np.ascontiguousarray(key[::-1]).tobytes()}
        kept.append(piece)
    return kept


def _joined(pieces_mm: Sequence[Array]) -> list[Array]:
    """Pieces as contours: those whose ends meet as one, where the first of them was."""
    open_ones = [
        k for k, piece in enumerate(pieces_mm) if len(piece) > 1 and not _closes(piece)
    ]
    partner = _partners([pieces_mm[k] for k in open_ones])
    of_piece = {k: n for n, k in enumerate(open_ones)}
    done, contours = set[int](), list[Array]()
    for k, piece in enumerate(pieces_mm):
        if k not in of_piece:
            contours.append(_closed_exactly(piece))
        elif of_piece[k] not in done:
            chain = _chain(of_piece[k], partner)
            done |= {end // 2 for end in chain}
            parts = [pieces_mm[open_ones[end // 2]][:: 1 - 2 * (end % 2)] for end in chain]
            contours.append(_closed_exactly(_strung(parts)))
    return contours


def _closes(piece: Array) -> bool:
    """Whether a piece ends where it begins."""
    return float(np.hypot(*(piece[-1] - piece[0]))) <= JOINED_MM


def _closed_exactly(contour: Array) -> Array:
    """A contour that ends where it begins, exactly so."""
    if len(contour) < 3 or not _closes(contour):
        return contour
    return np.vstack([contour[:-1], contour[:1]])


def _partners(pieces: Sequence[Array]) -> dict[int, int]:
    """Which end meets which other one: of piece n the first is 2 n, the last 2 n + 1."""
    from scipy.spatial import cKDTree

    if not pieces:
        return {}
    ends = np.array([place for piece in pieces for place in (piece[0], piece[-1])])
    tree = cKDTree(ends)
    near = tree.query_ball_point(ends, JOINED_MM)
    return {
        end: next(other for other in found if other != end)
        for end, found in enumerate(near)
        if len(found) == 2 and all(len(near[other]) == 2 for other in found)
    }


def _chain(first: int, partner: dict[int, int]) -> list[int]:
    """The pieces of a chain, each by the end that it is begun at."""
    begin = 2 * first
    while begin in partner:  # back to where the chain begins, or once round
        begin = partner[begin] ^ 1
        if begin == 2 * first:
            break
    chain = [begin]
    while (end := chain[-1] ^ 1) in partner and partner[end] != begin:
        chain.append(partner[end])
    return chain


def _strung(parts: Sequence[Array]) -> Array:
    """Parts one after the other; where two meet, the one's place counts."""
    return np.vstack([parts[0], *(part[1:] for part in parts[1:])])
