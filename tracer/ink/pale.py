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

from morfax.motion.arrays import Array
from morfax.tracer.drawing.components import INK, Mask, grouped, strips
from morfax.tracer.drawing.contrast import ABOVE_NOISE
from morfax.tracer.drawing.deepening import ABOVE_NOISE as STANDS_OUT
from morfax.tracer.drawing.deepening import LEAST, shaded
from morfax.tracer.drawing.depth import depth_at
from morfax.tracer.drawing.discs import disc
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.spots import SPOT_PX, noise_of_spots, of_pixels, times_as_noisy
from morfax.tracer.drawing.thinning import Indices, neighbours, thinned
from morfax.tracer.effort import FEW_PX
from morfax.tracer.limits import FADES

LEFT_OF_NOISE = 0.5 / (math.sqrt(math.pi) * SPOT_PX)  # what it leaves of white noise
RIM_PX = 3  # beyond where ink fades: so near to ink is its own rim
LEAST_MM = 5.0  # a shorter pale line is a smudge
# of the length of all its branches that the box about it measures: on a grained paper what is more branched
# is grain, which thins to a web; by trial on photographs of paper and boards
STRETCHED = 0.5
MOSTLY = 0.5  # of a line's middle
LEAST_WIDTHS = 5.0  # of a line's length: less is a blot


class Pale(NamedTuple):
    """A stretch of pale line: about where its middle is, and its length, mm."""

    x_mm: float
    y_mm: float
    length_mm: float


def pale_lines(drawing: Drawing) -> list[Pale]:
    """The pale lines of a drawing, the longest first."""
    mask = _pale(drawing)
    if not mask.any():
        return []
    return sorted(_lines(mask, drawing), key=lambda line: -line.length_mm)


def _pale(drawing: Drawing) -> Mask:
    """Where a drawing is darker than its paper's noise, and is no ink, nor its rim."""
    noise = drawing.noise
    rim_px = RIM_PX + math.ceil(FADES * float(np.nan_to_num(noise.softness_px)))
    level = max(LEAST, ABOVE_NOISE * LEFT_OF_NOISE * float(np.nan_to_num(noise.paper)))
    levels = level * times_as_noisy(drawing.darkness)
    if drawing.grainy:  # a slit makes strands of the paper's grain
        levels[:] = max(level, STANDS_OUT * noise_of_spots(drawing.darkness, stains=True))
    pale = np.zeros(drawing.darkness.shape, np.uint8)
    for top, bottom, rows in strips(
        pale.shape, halo=rim_px + math.ceil(4 * SPOT_PX), pixels=FEW_PX
    ):
        soft = cv2.GaussianBlur(drawing.darkness[rows], (0, 0), SPOT_PX)
        inked = cv2.dilate((soft > INK).view(np.uint8), disc(rim_px))
        own = slice(top - rows.start, bottom - rows.start)
        pale[top:bottom] = (inked == 0)[own]
        pale[top:bottom] &= soft[own] > of_pixels(levels, top, bottom, soft.shape[1])
    return pale if drawing.shapes is None else pale & (1 - shaded(drawing.shapes, pale.shape))


def _sides(patch: Indices, rows: Indices, columns: Indices, count: int) -> tuple[Array, Array]:
    """The height and the width of the box about the pixels of each patch."""
    sides = list[Array]()
    for places in (rows, columns):
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, patch, places)
        np.maximum.at(high, patch, places)
        sides.append(high - low)
    return sides[0], sides[1]


def _lines(mask: Mask, drawing: Drawing) -> Iterator[Pale]:
    """The patches of a mask that are lines."""
    rows, columns = thinned(mask)
    beside = neighbours(rows, columns)
    one, side = np.nonzero(beside >= 0)
    other = beside[one, side]
    steps_px = np.hypot(rows[other] - rows[one], columns[other] - columns[one])
    patch = grouped(np.column_stack([one, other]), len(rows))
    count = int(patch.max(initial=-1)) + 1
    depth = depth_at(mask, rows, columns)
    pixels = np.maximum(np.bincount(patch, minlength=count), 1)
    lengths_px = 0.5 * np.bincount(
        patch[one], steps_px, count
    )  # each step was met from both its ends
    widths_px = 2 * np.bincount(patch, depth, count) / pixels
    least_px = np.maximum(LEAST_MM / drawing.pitch_mm, LEAST_WIDTHS * widths_px)
    are_lines = lengths_px > least_px
    # a line of one hard pixel is ink, and pale behind the spot alone
    inked = np.bincount(patch, drawing.darkness[rows, columns] > INK, count)
    are_lines &= inked < MOSTLY * pixels
    if ABOVE_NOISE * noise_of_spots(drawing.darkness, stains=True) > LEAST:
        are_lines &= np.hypot(*_sides(patch, rows, columns, count)) > STRETCHED * lengths_px
    for k in np.flatnonzero(are_lines):
        here = np.flatnonzero(patch == k)
        middle = here[len(here) // 2]
        x_px, y_px = columns[middle] + 0.5, len(mask) - rows[middle] - 0.5
        x_mm, y_mm, length_mm = (
            drawing.pitch_mm * float(size) for size in (x_px, y_px, lengths_px[k])
        )
        yield Pale(round(x_mm, 1), round(y_mm, 1), round(length_mm, 1))
