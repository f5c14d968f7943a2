"""Enclosure: which patch of ink goes round which area of paper, and which patch lies inside which.

Signals: patches of ink as runs of pixels in; out for each patch the patch inside which it lies, and each area
of paper that a patch goes round, with its size (pixels).

    ┌─────────────┐      patch 1 goes round one area; patch 2 lies inside it, goes round two areas, and
    │ 1  ┌───┬──┐ │      so is no single closed line
    │    │ 2 │  │ │
    │    └───┴──┘ │
    └─────────────┘

Paper is taken as runs between the runs of ink, joined where they touch along a side, since ink is joined at
corners too. The patch round an area is the ink before the first run of its top row; the area round a patch is
the paper before the first run of the patch's own top row.

Source: our own; the tree of patches and areas is the textbook's. Questions: a closed line with a gap goes
round nothing; the gap is ink only to the head.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.components import Patches, joined

NONE = -1  # no patch: the open paper


@dataclass(frozen=True, slots=True)
class Enclosure:
    """The patch inside which each patch lies (`NONE`: none); and of each area of paper that is closed in, the
    patch round it and its pixels.
    """

    inside: NDArray[np.int64]
    round_area: NDArray[np.int64]
    areas_px: NDArray[np.float64]

    @classmethod
    def of(cls, patches: Patches, rows: int) -> Enclosure:
        """Find the areas of paper on a sheet of so many rows."""
        ink = (patches.row, patches.begin, patches.end)
        columns = int(patches.end.max(initial=0))
        row, begin, end, after, before = _paper(*ink, rows, columns)
        area, count = joined(row, begin, end, False)
        # 1. the ink before each area's first run; the first of all areas is the paper all round
        _, first = np.unique(area, return_index=True)
        runs = after[first]
        surrounding = np.where(runs == NONE, NONE, patches.patch[runs]).astype(np.int64)
        # 2. the paper before each patch's first run
        _, top = np.unique(patches.patch, return_index=True)
        inside = surrounding[area[before[top]]]
        areas_px = np.bincount(area, end - begin, count).astype(float)
        return cls(inside, surrounding[1:], areas_px[1:])

    def loops(self, least_px: NDArray[np.float64]) -> NDArray[np.int64]:
        """How many areas of at least so many pixels each patch goes round; smaller ones are flaws of ink."""
        large = self.areas_px >= least_px[self.round_area]
        return np.bincount(self.round_area[large], minlength=len(self.inside))


@njit(cache=True)
def _paper(row, begin, end, rows, columns):  # type: ignore[no-untyped-def]
    """Runs of paper, with a frame of paper round the sheet; the run of ink before each; and the run of paper
    before each run of ink.
    """
    ink = len(row)
    runs = ink + rows + 2
    paper_row, paper_begin = np.empty(runs, np.int32), np.empty(runs, np.int32)
    paper_end, after = np.empty(runs, np.int32), np.empty(runs, np.int64)
    before = np.empty(ink, np.int64)
    i, k = 0, 0
    for r in range(-1, rows + 1):
        left, last = -1, NONE
        while i < ink and row[i] == r:
            paper_row[k], paper_begin[k], paper_end[k], after[k] = r, left, begin[i], last
            before[i] = k
            left, last = end[i], i
            i, k = i + 1, k + 1
        paper_row[k], paper_begin[k], paper_end[k], after[k] = r, left, columns + 1, last
        k += 1
    return paper_row, paper_begin, paper_end, after, before
