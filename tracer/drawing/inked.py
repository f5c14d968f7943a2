"""Inked: where on a sheet there is ink, how deep it is, and which of it belongs to filled shapes.

Signals: a Drawing in; runs of pixels of ink (see `components`) and figures of them out. Ink is what is darker
than half behind a small spot. Paper takes no time: blocks of a sheet without anything dark are not looked at.

Source: our own.
"""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.drawing.blocks import BLOCK_PX, Runs, near, runs_behind_spot
from morfax.tracer.drawing.components import INK, SOFTENED_PX, Patches, strips
from morfax.tracer.drawing.depth import depth_along
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.large import runs_darker
from morfax.tracer.drawing.paper import WIDEST_STROKE_MM
from morfax.tracer.drawing.tiles import Tiles
from morfax.tracer.limits import PAPER

DEEPEST_PX = 200  # a line of 6 mm at 1200 dpi is 142 deep; the middle of a darker patch is not that of a line
# the rim of a filled shape is half of the widest stroke broad, or a little less: 2.9 to 3.5 mm at 100 to 600
# dpi; a line that is drawn in a shadow as dark as a shape is narrower
RIM_MM = 0.25 * WIDEST_STROKE_MM
SOLID = 0.5  # of a patch's ink is beside filled shapes: it is theirs
# A shape's own paper is smoothed over half of the widest stroke: inwards the rim's darkness falls slowly, and
# so far beyond its ink it is still darker than this. A line has an edge there, on either side.
BEYOND_MM = 0.05 * WIDEST_STROKE_MM
SOFT = 0.25  # of the paper about a patch of ink is as dark: half of it about a rim, by trial


def inked(drawing: Drawing) -> Runs:
    """The runs of ink on a sheet."""
    if isinstance(drawing.darkness, Tiles):
        found = runs_darker(drawing.darkness, SOFTENED_PX, INK)
        row, begin, end = zip(*found, strict=True)
        return np.concatenate(row), np.concatenate(begin), np.concatenate(end)
    dark = near(drawing.darkest > INK)
    return runs_behind_spot(drawing.darkness, dark, BLOCK_PX, SOFTENED_PX, INK)


def depths_px(runs: Runs, shape: tuple[int, int]) -> Array:
    """The depth of the pixels of each run, added up."""
    row, begin, end = runs
    sums = np.zeros(len(row))
    for top, bottom, rows in strips(shape, DEEPEST_PX):
        first, own, own_end, last = np.searchsorted(row, (rows.start, top, bottom, rows.stop))
        if own == own_end:
            continue
        part = slice(first, last)
        depth = depth_along(
            row[part] - rows.start, begin[part], end[part], (rows.stop - rows.start, shape[1])
        ).astype(float)
        places = np.r_[0, np.cumsum(end[part] - begin[part])[:-1]]
        sums[own:own_end] = np.add.reduceat(depth, places)[own - first : own_end - first]
    return sums


def are_solid(drawing: Drawing, patches: Patches, widths_mm: Array) -> NDArray[np.bool_]:
    """Which patches of ink, of some widths, are the rims of filled shapes, and no lines in a shadow."""
    if drawing.shapes is None:
        return np.zeros(patches.count, bool)
    beside = _beside_shapes(drawing, patches, slice(None))
    inked = np.bincount(patches.patch, beside * (patches.end - patches.begin), patches.count)
    solid = np.asarray(inked > SOLID * patches.areas)
    narrow = np.flatnonzero(solid & (widths_mm <= RIM_MM))
    solid[narrow] = [_falls_slowly(drawing, patches, patch) for patch in narrow.tolist()]
    return solid


def _falls_slowly(drawing: Drawing, patches: Patches, patch: int) -> bool:
    """Whether the darkness of a patch of ink falls slowly at one side, as that of a rim does inwards."""
    beyond_px = max(2, round(BEYOND_MM / drawing.pitch_mm))
    halo, shape = beyond_px + 1, drawing.darkness.shape
    top, bottom, left, right = patches.boxes[patch].tolist()
    rows = max(0, top - halo), min(shape[0], bottom + halo)
    columns = max(0, left - halo), min(shape[1], right + halo)
    ink = patches.painted(patch, *rows, *columns)
    away_px = cv2.distanceTransform(1 - ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    about = np.abs(away_px - beyond_px) < 0.5
    darkness = drawing.darkness[slice(*rows), slice(*columns)]
    return bool(np.mean(darkness[about] > PAPER) > SOFT) if about.any() else False


def is_filled(drawing: Drawing, patches: Patches, patch: int) -> bool:
    """Whether a patch of ink is beside a filled shape: its rim, or a line in a shadow as dark as one."""
    if drawing.shapes is None:
        return False
    runs = np.flatnonzero(patches.patch == patch)
    long_px = patches.end[runs] - patches.begin[runs]
    inked = float(_beside_shapes(drawing, patches, runs) @ long_px)
    return inked > SOLID * float(patches.areas[patch])


def _beside_shapes(drawing: Drawing, patches: Patches, runs: Any) -> NDArray[np.bool_]:
    """Which of some runs of ink are where a filled shape is."""
    assert drawing.shapes is not None
    down, across = (
        math.ceil(whole / part)
        for whole, part in zip(drawing.darkness.shape, drawing.shapes.shape, strict=True)
    )
    middle = (patches.begin[runs] + patches.end[runs]) // 2
    return np.asarray(drawing.shapes[patches.row[runs] // down, middle // across])
