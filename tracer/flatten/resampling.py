"""The sheet alone, as pixels of one pitch: the photograph resampled once, and what is no drawing made paper.

Signals: a picture and the projection of the sheet in; the sheet's pixels (rows from the top, columns, 3) and
their pitch, mm, out.

The pitch is the finest scale that the photograph has anywhere on the sheet, so that nothing of it is lost.

Source: our own. Questions: cubic interpolation; anything finer sees no more in a photograph that is as soft
as a pixel.
"""

from __future__ import annotations

import math

import cv2
import numpy as np

from morfax.tracer.effort import FEW_PX
from morfax.tracer.flatten.edges import Picture
from morfax.tracer.flatten.layout import Box
from morfax.tracer.flatten.projection import Projection

# of a sheet, made paper: the table shows there if the sheet was cut or printed aslant
RIM_MM = 1.5
RING_MM = 1.0  # about a box: the paper with which it is filled
LIGHTER = 30.0  # percentile of the ring's pixels: what is darker may be ink
# the photograph's pixels: only a sheet tilted beyond 45 degrees would have more
MOST_TIMES = 4.0


def resampled(picture: Picture, projection: Projection) -> tuple[Picture, float]:
    """The sheet as pixels, and their pitch, mm: at the finest scale that the photograph has of it."""
    sheet = projection.sheet
    room_px = MOST_TIMES * projection.photo.width * projection.photo.height
    finest_mm = max(projection.mm_per_px()[0], math.sqrt(sheet.width * sheet.height / room_px))
    columns = math.ceil(sheet.width / finest_mm)
    pitch_mm = sheet.width / columns
    rows = math.ceil(sheet.height / pitch_mm - 1e-6)
    flat = np.empty((rows, columns, 3), np.uint8)
    x_mm = (np.arange(columns) + 0.5) * pitch_mm
    every = max(1, FEW_PX // columns)
    for top in range(0, rows, every):
        y_mm = (rows - np.arange(top, min(top + every, rows)) - 0.5) * pitch_mm
        places = np.column_stack([np.tile(x_mm, len(y_mm)), np.repeat(y_mm, columns)])
        at = (projection.to_photo(places) - 0.5).astype(np.float32).reshape(-1, columns, 2)
        flat[top : top + len(y_mm)] = cv2.remap(
            picture, at[..., 0], at[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
        )
    return flat, pitch_mm


def clean(flat: Picture, pitch_mm: float, printed_mm: list[Box]) -> None:
    """Make paper, in place, of boxes that are printed, and of the rim."""
    for box in printed_mm:
        _fill(flat, pitch_mm, box)
    rim = math.ceil(RIM_MM / pitch_mm)
    inner = flat[rim:-rim, rim:-rim]
    flat[:] = cv2.copyMakeBorder(inner, rim, rim, rim, rim, cv2.BORDER_REPLICATE)


def _fill(flat: Picture, pitch_mm: float, box: Box) -> None:
    """Make a box paper: the plane through the lighter part of the ring about it."""
    rows, columns = flat.shape[:2]
    left, right = (np.clip(round(x / pitch_mm), 0, columns) for x in (box[0], box[2]))
    top, bottom = (np.clip(round(rows - y / pitch_mm), 0, rows) for y in (box[3], box[1]))
    ring = max(2, round(RING_MM / pitch_mm))
    outer = flat[max(0, top - ring) : bottom + ring, max(0, left - ring) : right + ring]
    y, x = np.mgrid[0 : outer.shape[0], 0 : outer.shape[1]]
    dy, dx = min(ring, top), min(ring, left)
    about = np.ones(outer.shape[:2], bool)
    inner = (slice(dy, dy + bottom - top), slice(dx, dx + right - left))
    about[inner] = False
    light = outer.min(axis=2)
    about &= light >= np.percentile(light[about], LIGHTER)
    plane = np.stack([np.ones_like(x), x, y], axis=-1).astype(float)
    found = np.linalg.lstsq(plane[about], outer[about].astype(float), rcond=None)[0]
    levels = np.round(plane @ found)
    filled = np.clip(levels, 0, 255).astype(np.uint8)
    flat[top:bottom, left:right] = filled[inner]
