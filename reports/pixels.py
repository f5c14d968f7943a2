"""Lines and areas on a canvas of pixels, by OpenCV.

Signals in: a canvas, (rows, columns, BGR), and lines (n, 2), columns and rows in pixels; where a line is not
a number it has a gap. Signals out: the canvas with them.

Source: our own. Questions: none.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array

Pixels = NDArray[np.uint8]

# OpenCV's soft edges make a line wider by about as much; by trial beside matplotlib's
SOFT_PX = 1.5
SHIFT = 4  # binary places of a pixel in which OpenCV takes places
MARGIN_PX = 50  # round a canvas: half of the widest line, and of a dash
FARTHEST_PX = 1 << 24  # OpenCV takes places as 32 bits with `SHIFT` binary places


def strokes_of(places: Array) -> list[Array]:
    """The pieces of a line between its gaps."""
    is_there = np.isfinite(places).all(axis=1)
    ends = np.flatnonzero(np.diff(np.r_[False, is_there, False].astype(np.int8)))
    return [places[a:b] for a, b in ends.reshape(-1, 2)]


def dashes(stroke: Array, on_px: float, off_px: float) -> list[Array]:
    """A stroke's dashes."""
    way = np.r_[0.0, np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))]
    dashes = list[Array]()
    for begin in np.arange(0.0, way[-1], on_px + off_px):
        end = min(begin + on_px, float(way[-1]))
        at = np.r_[begin, way[(way > begin) & (way < end)], end]
        dashes.append(np.column_stack([np.interp(at, way, side) for side in stroke.T]))
    return dashes


def seen(at_px: Array, shape: tuple[int, ...]) -> Array:
    """A line (n, 2) with gaps where it runs outside of a canvas, and without places less than a pixel on."""
    if len(at_px) < 2:
        return at_px
    # 1. without pieces of which both ends are beyond the same side
    shown = np.ones(len(at_px) - 1, bool)
    for at, size in zip(at_px.T, shape[1::-1], strict=True):
        before = at < -MARGIN_PX
        beyond = at > size + MARGIN_PX
        shown &= ~(before[:-1] & before[1:])
        shown &= ~(beyond[:-1] & beyond[1:])
    kept = np.flatnonzero(np.r_[shown, False] | np.r_[False, shown])
    near = np.insert(at_px[kept], np.flatnonzero(np.diff(kept) > 1) + 1, np.nan, axis=0)
    if len(near) < 2:
        return near
    # 2. a place of each pixel of the way, and both places beside a gap
    x, y = near.T
    steps = np.nan_to_num(np.hypot(np.diff(x), np.diff(y)))
    pixel = np.floor(np.cumsum(steps))
    is_next_pixel = np.r_[True, np.diff(pixel, prepend=0.0) > 0]
    is_gap = np.isnan(x)
    is_after_gap = np.r_[True, is_gap[:-1]]
    is_before_gap = np.r_[is_gap[1:], True]
    return np.asarray(near[is_next_pixel | is_after_gap | is_gap | is_before_gap])


def polylines(
    canvas: Pixels, strokes: list[Array], colour: str, width_px: float, *, closed: bool
) -> None:
    """Draw strokes, each (n, 2) columns and rows."""
    if not strokes:
        return
    whole = np.clip(np.concatenate(strokes), -FARTHEST_PX, FARTHEST_PX)
    ends = np.cumsum([len(stroke) for stroke in strokes])
    places = np.split(np.round(whole * (1 << SHIFT)).astype(np.int32), ends[:-1])
    whole_px = max(2, round(width_px - SOFT_PX))
    cv2.polylines(canvas, places, closed, _bgr(colour), whole_px, cv2.LINE_AA, SHIFT)


def blend(canvas: Pixels, corners_px: Array, colour: str, alpha: float) -> None:
    """Lay a colour over a polygon, so that what lies under it shines through."""
    low = np.maximum(np.floor(corners_px.min(axis=0)).astype(int) - 1, 0)
    high = np.ceil(corners_px.max(axis=0)).astype(int) + 2
    under = canvas[low[1] : max(high[1], 0), low[0] : max(high[0], 0)]
    if not under.size:
        return
    over = under.copy()
    places = np.round((corners_px - low) * (1 << SHIFT)).astype(np.int32)
    cv2.fillPoly(over, [places], _bgr(colour), cv2.LINE_AA, SHIFT)
    under[:] = cv2.addWeighted(over, alpha, np.ascontiguousarray(under), 1 - alpha, 0.0)


def _bgr(colour: str) -> tuple[int, int, int]:
    """Blue, green and red of #rrggbb."""
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)
