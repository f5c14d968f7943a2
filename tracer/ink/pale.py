"""Pale lines: ink that is too pale to be taken for the sheet's lines, and yet no noise of its paper.

Signals: a drawing in; the stretches of pale line on it out, mm.

    darkness  1 ┤  ▟▙  line
             0.5┤··▐▌··················  what is darker is ink, and is followed
             0.2┤  ▐▌      ▟▙  pale line
                ┼──────────────────────  six standard deviations of the paper behind a spot of a pixel

Source: our own. Questions: what shows through the paper, and a fold, are pale lines too, if they are darker
than `LEAST`; the operator is told, and knows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import FEW_PX, Mask, strips
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.inked import INK
from morfax.tracer.drawing.thinning import neighbours, thinned

SPOT_PX = 1.0  # standard deviation of the spot that averages the paper's noise
LEFT_OF_NOISE = 0.5 / (math.sqrt(math.pi) * SPOT_PX)  # what it leaves of white noise
ABOVE_NOISE = 6.0  # standard deviations of the paper, as for ink (see `drawing.drawing`)
# of ink's darkness: paler are what shines through a sheet and a JPEG's rims; by trial
LEAST = 0.15
RIM_PX, SPOTS = (
    3,
    3.0,
)  # pixels, and spots of the picture's softness: so near to ink is its own rim
LEAST_MM = 5.0  # a shorter pale line is a smudge
LEAST_WIDTHS = 5.0  # of a line's length: less is a blot


class Pale(NamedTuple):
    """A stretch of pale line: about where its middle is, and its length, mm."""

    x_mm: float
    y_mm: float
    length_mm: float


def pale_lines(drawing: Drawing) -> list[Pale]:
    """The pale lines of a drawing, the longest first."""
    mask = _pale(drawing)
    return sorted(_lines(mask, drawing), key=lambda line: -line.length_mm) if mask.any() else []


def _pale(drawing: Drawing) -> Mask:
    """Where a drawing is darker than its paper's noise, and is no ink, nor its rim."""
    noise = drawing.noise
    level = max(LEAST, ABOVE_NOISE * LEFT_OF_NOISE * float(np.nan_to_num(noise.paper)))
    rim_px = RIM_PX + math.ceil(SPOTS * float(np.nan_to_num(noise.softness_px)))
    rim = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * rim_px + 1,) * 2)
    pale = np.zeros(drawing.darkness.shape, np.uint8)
    for top, bottom, rows in strips(
        pale.shape, halo=rim_px + math.ceil(4 * SPOT_PX), pixels=FEW_PX
    ):
        soft = cv2.GaussianBlur(drawing.darkness[rows], (0, 0), SPOT_PX)
        inked = cv2.dilate((soft > INK).view(np.uint8), rim)
        own = slice(top - rows.start, bottom - rows.start)
        pale[top:bottom] = ((soft > level) & (inked == 0))[own]
    return pale if drawing.shapes is None else pale & (1 - _shaded(drawing.shapes, pale.shape))


def _shaded(shapes: NDArray[np.bool_], shape: tuple[int, ...]) -> Mask:
    """Where filled shapes were taken for dark paper: their shade is no line."""
    large = cv2.resize(shapes.view(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST)
    return np.asarray(large, np.uint8)


def _lines(mask: Mask, drawing: Drawing) -> Iterator[Pale]:
    """The patches of a mask that are lines."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    rows, columns = thinned(mask)
    beside = neighbours(rows, columns)
    one, side = np.nonzero(beside >= 0)
    other = beside[one, side]
    steps_px = np.hypot(rows[other] - rows[one], columns[other] - columns[one])
    joined = coo_matrix((steps_px, (one, other)), (len(rows),) * 2)
    count, patch = connected_components(joined, directed=False)
    depth = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[rows, columns]
    pixels = np.maximum(np.bincount(patch, minlength=count), 1)
    lengths_px = 0.5 * np.bincount(
        patch[one], steps_px, count
    )  # each step was met from both its ends
    widths_px = 2 * np.bincount(patch, depth, count) / pixels
    least_px = np.maximum(LEAST_MM / drawing.pitch_mm, LEAST_WIDTHS * widths_px)
    for k in np.flatnonzero(lengths_px > least_px):
        here = np.flatnonzero(patch == k)
        middle = here[len(here) // 2]
        x_px, y_px = columns[middle] + 0.5, len(mask) - rows[middle] - 0.5
        x_mm, y_mm, length_mm = (
            drawing.pitch_mm * float(size) for size in (x_px, y_px, lengths_px[k])
        )
        yield Pale(round(x_mm, 1), round(y_mm, 1), round(length_mm, 1))
