"""Filled shapes, drawn apart from the tracer."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from morfax.motion.units import MM_PER_INCH
from tests.tracer.inked import DPI, SOFTNESS_MM, Points, arc

CIRCLE = arc((16, 16), 10)


def filled(
    file: Path,
    *outlines: Points,
    holes: tuple[Points, ...] = (),
    seed: int = 1,
    shade: float = 0,
    light: bool = False,
) -> Path:
    """Filled shapes on a sheet of 36 x 34 mm at 300 dpi, eight times too fine by the middles of the pixels,
    as a scanner sees them.

    The paper is darker to the right by `shade` levels; `light` shapes are on dark paper.
    """
    rows, columns = (round(side * DPI / MM_PER_INCH) for side in (34, 36))
    fine = np.zeros((8 * rows, 8 * columns), np.float32)
    scale = 8 * DPI / MM_PER_INCH
    for outline, level in (
        *((outline, 1.0) for outline in outlines),
        *((hole, 0.0) for hole in holes),
    ):
        x, y = outline[:, 0] * scale - 0.5, 8 * rows - outline[:, 1] * scale - 0.5
        fine[inside(x, y, fine.shape)] = level
    dark = cv2.GaussianBlur(
        cv2.resize(fine, (columns, rows), interpolation=cv2.INTER_AREA),
        (0, 0),
        SOFTNESS_MM * DPI / MM_PER_INCH,
    )
    grey = (
        (235 - shade * np.linspace(0, 1, columns)) * (1 - dark)
        + 40 * dark
        + np.random.default_rng(seed).normal(0, 8, dark.shape)
    )
    grey = 255 - grey if light else grey
    Image.fromarray(np.clip(np.round(grey), 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    return file


def inside(x: Points, y: Points, shape: tuple[int, ...]) -> Points:
    """Which pixel middles lie inside a closed polygon: right of an odd number of its edges."""
    rows, columns = shape
    x, y = np.append(x, x[0]), np.append(y, y[0])
    low, high = np.minimum(y[:-1], y[1:]), np.maximum(y[:-1], y[1:])
    first, last = (np.clip(np.ceil(side), 0, rows).astype(int) for side in (low, high))
    # 1. every row that an edge crosses, and where
    crossed = last - first
    edge = np.repeat(np.arange(len(crossed)), crossed)
    row = np.arange(len(edge)) - (np.cumsum(crossed) - crossed - first)[edge]
    along = (row - y[edge]) / (y[edge + 1] - y[edge])
    column = np.ceil(x[edge] + along * (x[edge + 1] - x[edge])).clip(0, columns).astype(int)
    # 2. each crossing turns all pixels to its right
    turns = np.zeros((rows, columns + 1), np.uint8)
    np.add.at(turns, (row, column), 1)
    return np.cumsum(turns, axis=1, dtype=np.uint8)[:, :-1] % 2 == 1
