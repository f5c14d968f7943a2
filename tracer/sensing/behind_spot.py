"""A sheet behind a spot: the darkness that cells see, made for a whole sheet, near its ink, or for a part.

Signals: darkness (rows, columns) and the spot's standard deviation, pixels, in; the darkness behind the spot
out. On large sheets it is made where the head goes (see `aperture`).

Source: our own; the spot is OpenCV's Gaussian.
"""

from __future__ import annotations

import math
import mmap
from collections.abc import Callable

import cv2
import numpy as np

from morfax.tracer.drawing.blocks import BLOCK_PX
from morfax.tracer.drawing.contrast import FAINT
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.strokes import Window
from morfax.tracer.sensing.aperture import SPREADS

HALO_SPREADS = SPREADS + 1  # standard deviations of a spot that OpenCV looks at, and one more
# from what is drawn: no cell that is held against a level looks further; by trial
ABOUT_MM = 4.0
TILE_BLOCKS = 16  # blocks of a sheet to the side of a tile that is seen behind a spot at a time

# rows above a part of a sheet, columns to the left of it, rows below, columns to the right
Beyond = tuple[int, int, int, int]
Seen = Callable[[int, int, int, int], Darkness]  # rows from, to; columns from, to


def _bare(shape: tuple[int, ...]) -> Darkness:
    """A sheet of plain paper: it takes memory, and time, only where something is written on it."""
    room = mmap.mmap(-1, max(4 * math.prod(shape), 1))
    return np.frombuffer(room, np.float32, math.prod(shape)).reshape(shape)


def near_ink(drawing: Drawing, sigma_px: float) -> Darkness:
    """A sheet behind a spot, as far as anything is drawn; plain paper far from it is zeros."""
    darkness = drawing.darkness
    inked = (drawing.darkest > FAINT).view(np.uint8)
    if not inked.any():
        return _bare(darkness.shape)
    # 1. the tiles that are near something, in stretches of each row of tiles
    tiles = [-(-side // TILE_BLOCKS) for side in inked.shape]
    padded = np.zeros([side * TILE_BLOCKS for side in tiles], np.uint8)
    about = 2 * math.ceil(ABOUT_MM / (BLOCK_PX * drawing.pitch_mm)) + 1
    padded[: inked.shape[0], : inked.shape[1]] = cv2.dilate(
        inked, np.ones((about, about), np.uint8)
    )
    near = padded.reshape(tiles[0], TILE_BLOCKS, tiles[1], TILE_BLOCKS).any(axis=(1, 3))
    if near.all():
        return np.asarray(cv2.GaussianBlur(darkness, (0, 0), sigma_px), np.float32)
    # 2. each stretch behind the spot
    seen, side = _bare(darkness.shape), TILE_BLOCKS * BLOCK_PX
    edges = np.diff(np.pad(near, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, begin = np.nonzero(edges == 1)
    right = np.nonzero(edges == -1)[1]
    for top, first, last in (side * np.column_stack([row, begin, right])).tolist():
        window = top, first, top + side, last
        seen[top : top + side, first:last] = _behind(
            lambda a, b, c, d: darkness[a:b, c:d], sigma_px, window
        )
    return seen


def part_behind(
    seen: Seen, shape: tuple[int, int], sigma_px: float, window: Window
) -> tuple[Darkness, Beyond]:
    """A window of a sheet of a shape behind a spot, within a rim of paper where the sheet goes on; and how
    much of the sheet is beyond. `seen` gives the sheet's darkness.
    """
    (rows, columns), (top, left, bottom, right) = shape, window
    soft, (above, beside) = _with_halo(seen, sigma_px, window)
    # the halo is the rim: no other array is made for it
    first, begin = top - above, left - beside
    soft[:first], soft[:, :begin] = 0.0, 0.0
    soft[bottom - above :], soft[:, right - beside :] = 0.0, 0.0
    below, further = rows - above - len(soft), columns - beside - soft.shape[1]
    return soft, (above, beside, below, further)


def _behind(seen: Seen, sigma_px: float, window: Window) -> Darkness:
    """A window of a sheet, as far as the sheet goes, behind a spot."""
    top, left, bottom, right = window
    soft, (above, beside) = _with_halo(seen, sigma_px, window)
    return soft[top - above : bottom - above, left - beside : right - beside]


def _with_halo(seen: Seen, sigma_px: float, window: Window) -> tuple[Darkness, tuple[int, int]]:
    """The same with a halo, beyond which the spot does not look, and the halo's first row and column."""
    top, left, bottom, right = window
    halo = math.ceil(HALO_SPREADS * sigma_px) + 1
    above, beside = max(0, top - halo), max(0, left - halo)
    soft = cv2.GaussianBlur(seen(above, bottom + halo, beside, right + halo), (0, 0), sigma_px)
    return np.asarray(soft, np.float32), (above, beside)
