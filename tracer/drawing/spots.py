"""Spots: what the noise of paper leaves behind a spot of a pixel, over a sheet and in each part of it.

Signals: darkness of a sheet (0 paper, 1 ink) in; a standard deviation out, and how many times as noisy as
most of the paper each part of the sheet is.

            │    ▁▂▁▂▃▂▁▂▁        ▟▙       a camera makes corners brighter, and their noise with them. What
    darkness│▁▁▁▁         ▁▁▁▁▁▁▁▁▐▌▁▁     stands out from it to the bright side too is noise: a pale line
            └─────────────────────────     leaves the paper on that side as it is

Source: our own.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.median import MIDDLE, ONE_BELOW, TWO_BELOW, percentile
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.contrast import EVERY_COLUMN
from morfax.tracer.drawing.discs import disc

Darkness = NDArray[np.float32]

SPOT_PX = 1.0  # standard deviation of the spot behind which lines are told from noise
STRIPS = 32  # of the sheet, that tell its noise
ABOUT_PX = 3.0  # standard deviation of the paper about a spot against which its noise is told
# percentiles half a standard deviation apart: rims of ink are on one side, and pale lines, which may be a
# fifth of the paper that is near ink, beyond the other
HALF_ABOVE, APART = 69.15, 0.5
FAR_PX = 7  # from ink: its rims are no paper
PART_PX = 96  # of the sheet: light and noise change little over it
LEAST_PAPER = 0.2  # of a part: less paper tells no noise
# of ink's darkness, behind a spot: half of a scan's noise. Quieter paper counts as so noisy: what differs
# there is shade, and rims that a JPEG leaves
QUIET = 0.005


def noise_of_spots(darkness: Darkness, *, stains: bool = False) -> float:
    """The standard deviation of the paper behind a spot; without its stains against the paper about it.

    Grain, and what a camera has made of noise, is broader than pixels: a spot averages little of it. Shade
    that is even, such as a tinted room of a plan, is none. Stains are noise where a slit makes strands of
    them, which may be broader than what is about a place.
    """
    every = max(1, darkness.shape[0] // (STRIPS * PART_PX))
    seen = list[Darkness]()
    for top in range(0, darkness.shape[0], every * PART_PX):
        strip = darkness[top : top + PART_PX]
        soft = np.asarray(cv2.GaussianBlur(strip, (0, 0), SPOT_PX), np.float32)
        about = 0 if stains else cv2.GaussianBlur(soft, (0, 0), ABOUT_PX)
        seen.append((soft - about)[_is_paper(strip, soft)][::EVERY_COLUMN])
    paper = np.concatenate(seen)
    if not len(paper):
        return 0.0
    middle, high = (percentile(paper, percent) for percent in (MIDDLE, HALF_ABOVE))
    return (high - middle) / APART


def times_as_noisy(darkness: Darkness) -> NDArray[np.float32]:
    """How many times as noisy as most of the paper each part of a sheet is, PART_PX square; 1 at least."""
    rows, columns = (-(-side // PART_PX) for side in darkness.shape)
    found = np.zeros((rows, columns), np.float32)
    for k in range(rows):
        strip = darkness[k * PART_PX : (k + 1) * PART_PX]
        soft = np.asarray(cv2.GaussianBlur(strip, (0, 0), SPOT_PX), np.float32)
        is_paper = _is_paper(strip, soft)
        for n in range(columns):
            part = slice(n * PART_PX, (n + 1) * PART_PX)
            paper = soft[:, part][is_paper[:, part]]
            if len(paper) > LEAST_PAPER * PART_PX**2:
                # a standard deviation apart; 1.35 where pale lines cover a quarter of a part
                low, high = (percentile(paper, percent) for percent in (TWO_BELOW, ONE_BELOW))
                found[k, n] = high - low
    known = found[found > 0]
    usual = percentile(known, MIDDLE) if len(known) else QUIET
    return np.maximum(found / np.float32(max(usual, QUIET)), np.float32(1))


def of_pixels(parts: Darkness, top: int, bottom: int, columns: int) -> Darkness:
    """A figure of each part of a sheet for each pixel of some of its rows."""
    return parts[np.arange(top, bottom) // PART_PX].repeat(PART_PX, axis=1)[:, :columns]


def _is_paper(strip: Darkness, soft: Darkness) -> NDArray[np.bool_]:
    """Where a strip of a sheet, and behind a spot, is paper with noise; bare paper is made 0."""
    inked = cv2.dilate((soft > INK).view(np.uint8), disc(FAR_PX))
    return (strip != 0) & (inked == 0)
