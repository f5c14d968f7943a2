"""Thinned ink: the ink of a sheet reduced to lines of one pixel, which tell what lines hang together where.

Signals: a mask of ink in (0 paper, 1 ink); out the pixels that are left, and their neighbours. It plans only:
the path is felt by the cells along these lines, and no pixel of them comes into it.

Pixels are taken off the rim, layer by layer from the lower left and from the upper right in turn, as long as
this parts nothing and shortens no end. A pixel is looked at again only when one beside it has gone, so that
the time is that of the ink and not of the sheet times the depth of its layers.

    P9 P2 P3       a pixel P1 goes if its ink neighbours are in one piece, are two or three (P2 with P3 and so
    P8 P1 P4       on counted as one), and it lies on the side that is the layer's turn
    P7 P6 P5

Source: Guo and Hall, "Parallel thinning with two-subiteration algorithms", Communications of the ACM 32
(1989); the list of pixels to look at is our own.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.components import Mask

Indices = NDArray[np.int64]

LISTED, INK = 2, 1  # bits of a pixel while the sheet is thinned
NEIGHBOURS = 8
ALL_INK = 255  # the pattern of a pixel with ink all round
# rows and columns from a pixel to P2 … P9
DOWN = np.array([-1, -1, 0, 1, 1, 1, 0, -1])
RIGHT = np.array([0, 1, 1, 1, 0, -1, -1, -1])


def thinned(ink: Mask) -> tuple[Indices, Indices]:
    """Rows and columns of the pixels that are left of some ink, by rows."""
    sheet = np.pad((ink > 0).astype(np.uint8), 1)
    _thin(sheet.ravel(), sheet.shape[1], _goes(0), _goes(1))
    rows, columns = np.nonzero(sheet)
    return rows - 1, columns - 1


def neighbours(rows: Indices, columns: Indices) -> Indices:
    """Numbers of the neighbours of each pixel of some (sorted by rows), (n, 8), -1 where there is none.

    Two pixels that touch at a corner only are neighbours if no third one touches both by a side.
    """
    width = int(columns.max(initial=0)) + 2
    beside: Indices = _neighbours(rows * width + columns, width)
    return beside


def _goes(turn: int) -> NDArray[np.bool_]:
    """For each pattern of ink neighbours (P2 the lowest bit) whether the pixel goes in that turn."""
    bits = np.arange(256)[:, None] >> np.arange(NEIGHBOURS) & 1
    p2, p3, p4, p5, p6, p7, p8, p9 = bits.T.astype(bool)
    begins = (
        ~p2 & (p3 | p4),
        ~p4 & (p5 | p6),
        ~p6 & (p7 | p8),
        ~p8 & (p9 | p2),
    )
    pieces = np.sum(begins, axis=0)
    one = (p9 | p2) + 0 + (p3 | p4) + (p5 | p6) + (p7 | p8)
    other = (p2 | p3) + 0 + (p4 | p5) + (p6 | p7) + (p8 | p9)
    least = np.minimum(one, other)
    held = ((p6 | p7 | ~p9) & p8) if turn == 0 else ((p2 | p3 | ~p5) & p4)
    return np.asarray((pieces == 1) & (least >= 2) & (least <= 3) & ~held)


@njit(cache=True)
def _pattern(sheet, at, width):  # type: ignore[no-untyped-def]
    """The ink neighbours of a pixel, P2 the lowest bit."""
    found = 0
    for k in range(NEIGHBOURS):
        found |= (sheet[at + DOWN[k] * width + RIGHT[k]] & INK) << k
    return found


@njit(cache=True)
def _thin(sheet, width, goes_first, goes_second):  # type: ignore[no-untyped-def]
    """Take pixels off a sheet (padded with paper, in one row after the other) until none goes."""
    # 1. at first the rim is looked at
    listed = _rim(sheet, width)
    # 2. in two turns each time: those that go, and then all that had one of them beside it
    while len(listed):
        gone = np.empty(9 * len(listed) + 16, np.int64)
        first = _going(sheet, width, goes_first, listed, gone, 0)
        for n in range(first):
            sheet[gone[n]] &= LISTED
        went = _going(sheet, width, goes_second, listed, gone, first)
        went = _going_beside(sheet, width, goes_second, gone, first, went)
        for at in listed:
            sheet[at] &= INK
        for n in range(went):
            sheet[gone[n]] = 0
        listed = _beside(sheet, width, gone[:went])
    for at in range(len(sheet)):
        sheet[at] &= INK


@njit(cache=True)
def _rim(sheet, width):  # type: ignore[no-untyped-def]
    """List the pixels of ink that have paper beside them."""
    count = 0
    for at in range(len(sheet)):
        if sheet[at] & INK and _pattern(sheet, at, width) != ALL_INK:
            sheet[at] |= LISTED
            count += 1
    listed = np.empty(count, np.int64)
    count = 0
    for at in range(len(sheet)):
        if sheet[at] & LISTED:
            listed[count] = at
            count += 1
    return listed


@njit(cache=True)
def _going(sheet, width, goes, listed, gone, went):  # type: ignore[no-untyped-def]
    """Note, after those that went, the listed pixels that go in a turn; how many there are now."""
    for at in listed:
        if sheet[at] & INK and goes[_pattern(sheet, at, width)]:
            gone[went] = at
            went += 1
    return went


@njit(cache=True)
def _going_beside(sheet, width, goes, gone, first, went):  # type: ignore[no-untyped-def]
    """Note also the pixels on which the first turn has only just come, beside its own that went."""
    for n in range(first):
        for k in range(NEIGHBOURS):
            at = gone[n] + DOWN[k] * width + RIGHT[k]
            unlisted = sheet[at] & INK and not sheet[at] & LISTED
            if unlisted and goes[_pattern(sheet, at, width)]:
                gone[went] = at
                went += 1
                sheet[at] |= LISTED
    return went


@njit(cache=True)
def _beside(sheet, width, gone):  # type: ignore[no-untyped-def]
    """List the pixels of ink beside those that have gone."""
    fresh = np.empty(NEIGHBOURS * len(gone), np.int64)
    count = 0
    for place in gone:
        for k in range(NEIGHBOURS):
            at = place + DOWN[k] * width + RIGHT[k]
            if sheet[at] == INK:
                sheet[at] |= LISTED
                fresh[count] = at
                count += 1
    return fresh[:count].copy()


@njit(cache=True)
def _neighbours(places, width):  # type: ignore[no-untyped-def]
    """See `neighbours`; places are rows times the width and columns, sorted."""
    beside = np.full((len(places), NEIGHBOURS), -1)
    for n in range(len(places)):
        for k in range(NEIGHBOURS):
            beside[n, k] = _number(places, places[n] + DOWN[k] * width + RIGHT[k])
        for k in range(1, NEIGHBOURS, 2):
            if beside[n, k - 1] >= 0 or beside[n, (k + 1) % NEIGHBOURS] >= 0:
                beside[n, k] = -1
    return beside


@njit(cache=True)
def _number(places, place):  # type: ignore[no-untyped-def]
    """Which of the sorted places one is, -1 for none."""
    n = np.searchsorted(places, place)
    return n if n < len(places) and places[n] == place else -1
