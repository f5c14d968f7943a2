"""A line on white paper, as an image of any kind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.inked import UM, polyline

DPI = (300.0, 300.0)
PEN_MM = 1 * UM  # to which the pen draws: a tenth of its fine pixels of 10.6 um
LINE = polyline((4, 5), (34, 11))  # aslant, so that it crosses pixels at every phase
Grey = NDArray[np.uint8]


def off_the_line_mm(drawing: Drawing) -> NDArray[np.float64]:
    """How far above the drawn line the middle of its ink is, column by column, its ends left out, mm."""
    x = (np.arange(drawing.darkness.shape[1]) + 0.5) * drawing.pitch_mm
    y = (
        drawing.darkness.shape[0] - np.arange(drawing.darkness.shape[0]) - 0.5
    ) * drawing.pitch_mm
    told = np.interp(x, *LINE.T)
    dark = np.where(np.abs(y[:, None] - told) < 1.0, np.clip(drawing.darkness, 0, None), 0.0)
    inner = (x > LINE[0, 0] + 1) & (x < LINE[1, 0] - 1)
    return ((dark * y[:, None]).sum(axis=0) / np.maximum(dark.sum(axis=0), 1e-9) - told)[inner]


def opened(image: Image.Image, file: Path, **stated: object) -> Drawing:
    """Save an image under a name and open it as a drawing."""
    image.save(file, **stated)
    return Drawing.open(file)
