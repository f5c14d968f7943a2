"""The noise of the paper: the standard deviation of its pixels' darkness.

Signals: darkness (0 paper, 1 ink) of a sheet, or of a sample of its pixels, in; a standard deviation out.
Source: our own. Questions: none.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.median import MIDDLE, ONE_ABOVE, percentile
from morfax.tracer.limits import PAPER

PAPER_SAMPLES = 1 << 16  # pixels of paper: they give its standard deviation to 1/360


def of_sheet(darkness: Any) -> float:
    """The noise of the paper of a sheet that is nowhere made bare (see `contrast`)."""
    every = every_px(darkness.size)
    return paper_noise(darkness[::every, ::every])


def paper_noise(sample: NDArray[np.float32]) -> float:
    """Standard deviation of the paper's pixels, by the darker ones of a sample: scanners clip the white."""
    paper = sample[sample < PAPER]
    if not len(paper):
        return math.nan
    usual, darker = (percentile(paper, percent, np.float64) for percent in (MIDDLE, ONE_ABOVE))
    return darker - usual


def every_px(size: int) -> int:
    """How far apart, across and down, those of so many pixels are that tell the paper's noise."""
    return max(1, math.isqrt(size // PAPER_SAMPLES))
