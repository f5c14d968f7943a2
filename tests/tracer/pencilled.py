"""Lines that were drawn with a pencil: a third as dark as ink, with grain."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from tests.tracer.inked import DPI, Points, inked

GRAIN, SPOT_PX = 0.35, 1.2


def pencilled(*lines: Points, seed: int = 1) -> Drawing:
    """The drawing of lines that were drawn with a pencil."""
    return of_pencil(inked(*lines, width_mm=0.45).darkness, seed)


def of_pencil(ink: Darkness, seed: int = 1) -> Drawing:
    """The drawing of ink, darkness 0..1, if it is a pencil's."""
    rng = np.random.default_rng(seed)
    wave = cv2.GaussianBlur(rng.normal(size=ink.shape), (0, 0), SPOT_PX)
    left = np.clip(1 + GRAIN * wave / wave.std(), 0, 2)
    grey = np.clip(np.round(235 - 65 * ink * left + rng.normal(0, 8, ink.shape)), 0, 255)
    scan = Scan(Path("made.png"), grey.astype(np.uint8), Stated((DPI, DPI)))
    drawing = Drawing.of(scan, Scale())
    assert drawing.grainy
    return drawing
