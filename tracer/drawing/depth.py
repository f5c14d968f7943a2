"""How deep ink is: the distance of each pixel of ink from the nearest paper.

Signals in: a mask of ink, (rows, columns). Signals out: depths in pixels, float32, 0 on paper; what lies
outside the mask is no paper.

The nearest paper of a pixel is as far down its own column, or that of a column beside it, as it is nearest
there: d² = min over columns of (their distance² + their own depth²). On lines that takes a few columns; on a
sheet with a broad shape OpenCV is faster, and gives the same to the bit. Paper takes neither time nor memory:
OpenCV takes four times as long for a page of lines, and as many bytes as the page has pixels, four times.

Source: Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions (2012), of which the second
step is done by looking, since lines are narrow.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.blocks import runs_in
from morfax.tracer.drawing.components import INK, Mask, Numbers, painted, runs_at
from morfax.tracer.drawing.thinning import Indices

MOST_LOOKS_EACH = 40  # to a pixel of ink; by trial on sheets with lines and with filled squares


def depth_px(ink: Mask) -> NDArray[np.float32]:
    """How far each pixel of ink is from the paper, pixels; memory is taken where there is ink."""
    depth = np.zeros(ink.shape, np.float32)
    depth[ink.view(bool)] = depth_of(ink)
    return depth


def depth_of(ink: Mask) -> NDArray[np.float32]:
    """The same of the pixels of ink alone, by rows."""
    return depth_along(*runs_in(ink, INK), ink.shape)


def depth_at(ink: Mask, rows: Indices, columns: Indices) -> NDArray[np.float32]:
    """The same of some pixels of ink."""
    row, begin, end = runs_in(ink, INK)
    depth = depth_along(row, begin, end, ink.shape)
    first = np.cumsum(end - begin) - (end - begin)
    run = runs_at(row, begin, rows, columns)
    return depth[first[run] + columns - begin[run]]


def depth_along(
    row: Numbers, begin: Numbers, end: Numbers, shape: tuple[int, int]
) -> NDArray[np.float32]:
    """The same for runs of ink (see `components`), pixel after pixel."""
    count = int((end - begin).sum())
    # more looks to a pixel of ink than a line of 30 pixels takes: one broad shape has taken over
    values, is_whole = _along_runs(row, begin, end, shape, MOST_LOOKS_EACH * count)
    if is_whole:
        return np.asarray(values)
    ink = painted(row, begin, end, shape)
    exact = cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.asarray(exact[ink.view(bool)], np.float32)


@njit(cache=True)
def _along_runs(row, begin, end, shape, most_looks):  # type: ignore[no-untyped-def]
    """The same for runs of lines; False where it is given up."""
    rows, columns = shape
    first, depth = _in_columns(row, begin, end, rows, columns)
    square, looks = np.empty(columns), 0
    for k in range(len(row)):
        if looks > most_looks:
            return depth, False
        looks += _along(depth[first[k] : first[k + 1]], begin[k], columns, square)
    return depth, True


@njit(cache=True)
def _in_columns(row, begin, end, rows, columns):  # type: ignore[no-untyped-def]
    """How far paper is in each pixel's own column, for runs of lines, and where each run begins."""
    first = np.zeros(len(row) + 1, np.int64)  # the place of each run's first pixel
    first[1:] = np.cumsum(end - begin)
    depth = np.empty(first[-1], np.float32)
    # what was last met in each column, and in which row: downwards, then upwards
    last, met = np.zeros(columns, np.float32), np.full(columns, -2)
    for k in range(len(row)):
        for j in range(begin[k], end[k]):
            deep = last[j] + 1 if met[j] == row[k] - 1 else np.float32(1)
            if row[k] == 0:
                deep = np.float32(rows + columns)
            last[j], met[j] = deep, row[k]
            depth[first[k] + j - begin[k]] = deep
    met[:] = -2
    for k in range(len(row) - 1, -1, -1):
        for j in range(begin[k], end[k]):
            deep = depth[first[k] + j - begin[k]]
            if row[k] < rows - 1 and deep > 1:
                deep = min(deep, last[j] + 1 if met[j] == row[k] + 1 else np.float32(1))
            last[j], met[j] = deep, row[k]
            depth[first[k] + j - begin[k]] = deep
    return first, depth


@njit(cache=True)
def _along(run, begin, columns, square):  # type: ignore[no-untyped-def]
    """Make depths in their own columns those in any, looked for as far as paper may be nearer; the number of
    looks that it took.

    All beside the run is paper.
    """
    looks = 0
    for j in range(len(run)):
        square[j] = run[j] * run[j]
    for j in range(len(run)):
        best = square[j]
        for way in (-1, 1):
            step = 1
            while step * step < best and 0 <= begin + j + way * step < columns:
                beside = j + way * step
                there = square[beside] if 0 <= beside < len(run) else 0.0
                best = min(best, step * step + there)
                step += 1
            looks += step
        if best > 0:
            run[j] = math.sqrt(best)
    return looks
