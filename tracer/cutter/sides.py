"""Edges of the part: on which side of each line the cutter runs, and how wide the room is that a line leaves
it.

Signals: closed lines and open ones, (n, 2) mm, in; out guides, each with its side, and the largest circle
that has room beside a line (mm).

    lines that cross each other are both edges: none of them lies in the other. A line that crosses itself has
    no outside and no inside: what lies between its lobes is as much the one as the other.

Source: our own. The largest circle is found on a grid, by the distances from all lines, and again on finer
ones about its middle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion import nesting
from morfax.motion.arrays import Array
from morfax.motion.offset import Guide
from morfax.motion.polyline import Nearest, crossings_of, lengths_mm, with_places
from morfax.tracer.following.followed import THINNED

LOOP_MM = 1.0  # a shorter loop is the head's swivel, and not drawn
CELLS = 500  # of the grid, along the longer side of what is looked at
FINER = 10  # times, again and again about the best cell
WITHIN_MM = 0.001
PASSES_MM = 0.05  # steps of the cutter that is said to pass, and room that it needs at least


@dataclass(frozen=True, slots=True)
class Room:
    """The largest circle beside a line: where its middle is, and how wide it is (mm)."""

    place_mm: tuple[float, float]
    wide_mm: float

    @property
    def passes_mm(self) -> float:
        """The diameter of a cutter that goes into it, in steps that one finds in a drawer."""
        return PASSES_MM * max(0, int(self.wide_mm / PASSES_MM - 0.5))


def closed_up(guide: Guide) -> Array:
    """The places of a guide, the first once more at the end of a closed one."""
    return (
        np.vstack([guide.points_mm, guide.points_mm[:1]]) if guide.closed else guide.points_mm
    )


def is_counterclockwise(places: Array) -> bool:
    """Whether a closed line goes round counterclockwise."""
    x, y = (places - places[0]).T
    return bool(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0)


def thinned(line_mm: Array) -> Array:
    """Places of a closed line by which it is known where it is, (n, 2) mm."""
    return (
        line_mm[::THINNED]
        if len(line_mm) >= 4 * THINNED
        else with_places(line_mm, LOOP_MM)[:-1]
    )


def crossing(lines_mm: Sequence[Array]) -> NDArray[np.bool_]:
    """Which lines (n, 2) mm, taken for closed, cross which: `crossing[i, j]`; `[i, i]` if line i crosses
    itself.
    """
    closed = [np.vstack([line, line[:1]]) for line in lines_mm]
    owner = np.concatenate([np.full(len(line), k) for k, line in enumerate(closed)])
    last = np.flatnonzero(np.r_[np.diff(owner) != 0, True])
    pairs = crossings_of(np.vstack(closed), np.setdiff1d(np.arange(len(owner)), last))
    crossed = np.zeros((len(closed), len(closed)), bool)
    lengths = [lengths_mm(line) for line in closed]
    firsts = np.r_[0, last + 1]
    for a, b in pairs:
        i, j = owner[int(a)], owner[int(b)]
        if i == j:
            loop_mm = float(
                abs(
                    np.diff(
                        np.interp([a, b], firsts[i] + np.arange(len(lengths[i])), lengths[i])
                    )[0]
                )
            )
            crossed[i, i] |= min(loop_mm, lengths[i][-1] - loop_mm) > LOOP_MM
        else:
            crossed[i, j] = crossed[j, i] = True
    return crossed


def depths(lines_mm: Sequence[Array], crossed: NDArray[np.bool_]) -> list[int]:
    """In how many of the others each closed line lies."""
    return [
        int(n)
        for n in (nesting.nested(lines_mm, [True] * len(lines_mm)) & ~crossed).sum(axis=1)
    ]


def room(guides: Sequence[Guide], number: int) -> Room | None:
    """The largest circle that goes beside one of the lines, on its side; None if it is not shut in."""
    own = guides[number]
    if not own.closed:
        return None
    inside = is_counterclockwise(own.points_mm) == own.left
    around = own.points_mm if inside else np.vstack([guide.points_mm for guide in guides])
    low, size = around.min(axis=0), np.ptp(around, axis=0)
    near_by = [
        closed_up(guide)
        for guide in guides
        if ((guide.points_mm >= low) & (guide.points_mm <= low + size)).all(axis=1).any()
    ]
    cell_mm = float(size.max()) / CELLS
    free, here = _free(near_by, own, inside, low, size, cell_mm)
    if not here.any() or here[0].any():  # the outermost cells are outside of all lines
        return None
    away = np.where(here, cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE), 0)
    row, column = np.unravel_index(int(away.argmax()), away.shape)
    place, near = (
        low + (np.array([column, row]) - 2) * cell_mm,
        Nearest(near_by, float(away.max()) * cell_mm),
    )
    while cell_mm > WITHIN_MM:
        steps = np.arange(-FINER, FINER + 1) * 2 * cell_mm / FINER
        places = place + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
        away_mm = near.distances_mm(places)
        place, cell_mm = places[int(away_mm.argmax())], cell_mm * 2 / FINER
    return Room((float(place[0]), float(place[1])), 2 * float(away_mm.max()))


def _free(
    lines_mm: Sequence[Array], own: Guide, inside: bool, low: Array, size: Array, cell_mm: float
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """A grid that is 0 where a line runs, else 1; and which of its cells can be come to from a line's own
    side without crossing any.
    """
    columns, rows = (np.ceil(size / cell_mm).astype(int) + 5).tolist()
    free, filled, beside = (
        np.ones((rows, columns), np.uint8),
        *np.zeros((2, rows, columns), np.uint8),
    )
    cv2.polylines(
        free,
        [np.round((line - low) / cell_mm + 2).astype(np.int32) for line in lines_mm],
        False,
        0,
    )
    line = np.round((own.points_mm - low) / cell_mm + 2).astype(np.int32)
    cv2.fillPoly(filled, [line], 1)
    cv2.polylines(beside, [line], True, 1, 5)
    _, rooms = cv2.connectedComponents(free, connectivity=4)
    ours = np.unique(rooms[(beside > 0) & (free > 0) & ((filled > 0) == inside)])
    return free, np.isin(rooms, ours[ours > 0])
