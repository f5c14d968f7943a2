"""Middles: places of a line that lie as deep in its ink as any about them, and how much ink is round them.

Signals: runs of ink (see `components`) and the depth of their pixels in; rows, columns and pixels of ink
under a disc out. Paper takes no time: a disc is held against the runs of its rows.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.compiled import njit

# px: places of a slanting line are so much less deep from pixel to pixel
SHALLOWER = np.float32(0.3)


@njit(cache=True)
def deepest(row, begin, end, depth, inner):  # type: ignore[no-untyped-def]
    """Row and column of the pixels of some runs that lie deeper than all about them.

    `inner` are first and last + 1 row and column of the pixels that count.
    """
    if not len(row):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    top, columns = row[0] - 1, end.max()  # from the row above the first, which is paper
    first = np.searchsorted(row, np.arange(top, row[-1] + 3))  # the first run of each row
    places = np.zeros(len(row) + 1, np.int64)
    places[1:] = np.cumsum(end - begin)
    # 1. rows of depth: the one before, that of the pixels, and the one after
    lines = np.zeros((3, columns + 2), np.float32)
    found_row, found_column = np.empty(len(depth), np.int64), np.empty(len(depth), np.int64)
    count = 0
    for i in range(top, row[-1] + 1):
        line = lines[(i + 1) % 3]
        line[:] = 0.0
        for n in range(first[i + 1 - top], first[i + 2 - top]):
            line[begin[n] + 1 : end[n] + 1] = depth[places[n] : places[n + 1]]
        # 2. its pixels that are the deepest of nine
        before, line, after = lines[(i - 1) % 3], lines[i % 3], lines[(i + 1) % 3]
        for n in range(first[i - top], first[i - top + 1]):
            for j in range(max(begin[n], inner[2]), min(end[n], inner[3])):
                most = line[j]
                for c in range(j, j + 3):
                    most = max(most, before[c], line[c], after[c])
                if inner[0] <= i < inner[1] and line[j + 1] >= most - SHALLOWER:
                    found_row[count], found_column[count] = i, j
                    count += 1
    return found_row[:count].copy(), found_column[:count].copy()


@njit(cache=True)
def ink_about(row, begin, end, places, disc):  # type: ignore[no-untyped-def]
    """Pixels of ink of some runs under a disc centred on each of some places, rows and columns of its ink."""
    (rows, columns), half = places, len(disc) // 2
    filled = np.zeros(len(rows))
    if not len(row):
        return filled
    top = row[0]
    first = np.searchsorted(row, np.arange(top, row[-1] + 2))  # the first run of each row
    left, right = np.zeros(len(disc), np.int64), np.zeros(len(disc), np.int64)
    for d in range(len(disc)):  # each row of a disc is one stretch
        inside = np.flatnonzero(disc[d])
        left[d], right[d] = inside[0] - half, inside[-1] - half + 1
    for k in range(len(rows)):
        for d in range(len(disc)):
            at = rows[k] + d - half - top
            if at < 0 or at >= len(first) - 1:
                continue
            low, high = columns[k] + left[d], columns[k] + right[d]
            n = first[at] + np.searchsorted(end[first[at] : first[at + 1]], low)
            while n < first[at + 1] and begin[n] < high:
                filled[k] += max(0, min(end[n], high) - max(begin[n], low))
                n += 1
    return filled
