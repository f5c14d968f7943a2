"""Discs: a grey picture without the dark strokes that are narrower than a disc.

Signals: levels (rows, columns) in; the same closed with a disc out, each time the lightest level within it
and then the darkest of these:

    ░░▓▓░░▓▓▓▓▓░░   →   ░░░░░░▓▓▓▓▓░░       a stroke is gone, what is broader than the disc stays

A disc is a stack of rows. The lightest level along a row of it is that of the next shorter row and of two
more pixels, so each row of the picture is gone through once for each of the lengths of the disc, and not for
each of its pixels: a disc 25 pixels across takes 49 steps a pixel instead of 490.

Source: grey closing is Serra's; beyond the picture's edges there is nothing, as OpenCV has it, and the levels
are the same. Questions: none.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

Levels = NDArray[np.float32]


def disc(radius_px: int) -> NDArray[np.uint8]:
    """Mask of a disc."""
    across = 2 * radius_px + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across)), np.uint8)


def without_dark(levels: Levels, radius_px: int) -> Levels:
    """A picture closed with a disc: what is dark and narrower is gone."""
    reaches = disc(radius_px).sum(axis=1, dtype=np.int64) // 2
    return -_lightest(-_lightest(np.ascontiguousarray(levels), reaches), reaches)


def without_light(levels: Levels, radius_px: int) -> Levels:
    """A picture opened with a disc: what is light and narrower is gone."""
    return -without_dark(-levels, radius_px)


def _lightest(levels: Levels, reaches: NDArray[np.int64]) -> Levels:
    """The lightest level within a disc about each pixel; `reaches`: how far each of its rows reaches to both
    sides of its middle.
    """
    lightest = np.full(levels.shape, -np.inf, np.float32)
    _widened(levels, reaches, lightest)
    return lightest


@njit(cache=True, nogil=True)
def _widened(levels, reaches, lightest):  # type: ignore[no-untyped-def]
    """Raise `lightest` to the levels within the disc about each pixel."""
    (rows, columns), middle = levels.shape, len(reaches) // 2
    longer = np.full(columns + 2 * middle, -np.float32(np.inf), np.float32)
    along = np.empty(columns, np.float32)
    for row in range(rows):
        longer[middle : middle + columns] = levels[row]
        along[:] = levels[row]
        reach = 0
        for down in range(middle, -1, -1):  # the disc's rows from its shortest on
            while reach < reaches[middle - down]:
                reach += 1
                _raise(along, longer[middle - reach : middle - reach + columns])
                _raise(along, longer[middle + reach : middle + reach + columns])
            if row >= down:
                _raise(lightest[row - down], along)
            if down and row + down < rows:
                _raise(lightest[row + down], along)


@njit(cache=True, nogil=True)
def _raise(levels, others):  # type: ignore[no-untyped-def]
    """Raise levels to others where these are lighter."""
    for j in range(len(levels)):
        levels[j] = others[j] if others[j] > levels[j] else levels[j]
