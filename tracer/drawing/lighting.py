"""Lighting: what light fell on a sheet, so that a picture of it can be made one in even light.

Signals: the level of the paper on a reduced picture (0..255, a grey closing, see `paper`) in; the light out,
1 where it is that on the brightest paper.

    seen = light · (what the paper or the ink throws back)

so that a line in a shadow is as much paler against its paper as the shadow takes of the light. A camera's
levels are a power of the light, which leaves ratios ratios.

    level   ▔▔▔▔▔▔▔▔╲               where the level is alike in a window, its mean is the light; where it has
                     ╲▁▁▁▁▁▁▁▁      a step, the step stays as sharp as it is: share = var / (var + noise²)
    window     ├────┤

Source: He, Sun and Tang, Guided Image Filtering (2010), the picture being its own guide. Questions: grey
paper, glued or printed, is white paper in a shadow, and what is drawn on it is drawn on white paper then.
A dark area with a sharp edge that is nearly as dark as the ink of the lines, and has no lines in it, is a
filled shape: beneath it the light is that beside it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.median import NEARLY_ALL, percentile
from morfax.tracer.drawing.blocks import ABOUT

Levels = NDArray[np.float32]

EVEN = 0.85  # of the brightest paper: a scanner's lamp lights the sheet that evenly; by trial
INK = 0.35  # of the brightest paper: what is darker is ink; a shadow that takes 0.7 of the light leaves 0.58
LEAST = 0.5  # a place is made at most twice as bright: its noise is, too
NOISE = 0.02  # of the brightest paper: by so much a paper's level differs from place to place
LINES = 0.4  # of the ink's darkness: so dark a line of a few tenths of a millimetre is on the reduced picture
FEW = 0.002  # of an area: specks; a single line across 50 mm covers more


@dataclass(frozen=True, slots=True)
class Lighting:
    """The level of the paper, and what is seen with the strokes on it, in parts of the brightest paper's
    level, which is `white` grey levels.
    """

    level: Levels
    seen: Levels
    white: float

    @classmethod
    def of(cls, level: Levels, seen: Levels) -> Lighting | None:
        """The lighting of a sheet by its paper's level; None where it is even."""
        white = percentile(level.ravel(), NEARLY_ALL)  # the rest is glare
        if float(level.min()) >= EVEN * white:
            return None
        black = (level < INK * white).view(np.uint8)
        paper, all_ink = (
            np.asarray(each / np.float32(white), np.float32) for each in (level, seen)
        )
        return cls(paper, all_ink, white)._beneath(black)

    def beneath_shapes(self, darker: float, sharp_px: int, stroke_px: float) -> Lighting:
        """The same, where what is darker than the paper beside it, no farther away than a sharp edge is
        broad, by so many parts of that is a shape; it is uncovered from its edges inwards.
        """
        beside = np.ones((2 * sharp_px + 1,) * 2, np.uint8)
        dark, lit = np.zeros(self.level.shape, bool), np.asarray(self.level)
        while True:
            brightest = np.asarray(cv2.dilate(lit, beside), np.float32)
            further = dark | (self.level < (1 - darker) * brightest)
            if np.array_equal(further, dark):
                return self._beneath(self._without_lines(dark, darker, stroke_px))
            dark, lit = further, np.where(further, brightest, self.level)

    def _without_lines(
        self, dark: NDArray[np.bool_], darker: float, stroke_px: float
    ) -> NDArray[np.uint8]:
        """The dark areas in which nothing is darker, half of a stroke's width within their edges."""
        count, areas = cv2.connectedComponents(dark.view(np.uint8), connectivity=8)
        depth = cv2.distanceTransform(dark.view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        inner = depth > stroke_px
        lines = inner & (self.seen < (1 - LINES * darker) * self.level)
        lined, all_of = (np.bincount(areas[each], minlength=count) for each in (lines, inner))
        return (dark & (lined <= FEW * all_of)[areas]).view(np.uint8)

    def _beneath(self, dark: NDArray[np.uint8]) -> Lighting:
        """The same with the light at the nearest place beside dark areas beneath them."""
        # a pixel of the reduced picture may be half on a shape's edge
        grown = np.asarray(cv2.dilate(dark, ABOUT), np.uint8)
        if not grown.any() or grown.all():
            return self
        return replace(self, level=from_beside(self.level, grown))

    def light(self, window_px: float) -> Levels:
        """The light, seen in windows (standard deviation)."""
        level = np.asarray(np.maximum(self.level, LEAST), np.float32)
        mean, square = (_seen(x, window_px) for x in (level, level * level))
        spread = np.maximum(square - mean * mean, 0)
        share = np.asarray(spread / (spread + NOISE**2), np.float32)
        rest = _seen(np.asarray(mean - share * mean, np.float32), window_px)
        return np.asarray(_seen(share, window_px) * level + rest, np.float32)


def _seen(level: Levels, window_px: float) -> Levels:
    """A level seen in windows."""
    return np.asarray(cv2.GaussianBlur(level, (0, 0), window_px), np.float32)


def from_beside(level: Levels, hidden: NDArray[np.uint8]) -> Levels:
    """A level that is that of the nearest place beside what is hidden."""
    _, nearest = cv2.distanceTransformWithLabels(
        hidden, cv2.DIST_L2, cv2.DIST_MASK_PRECISE, labelType=cv2.DIST_LABEL_PIXEL
    )
    seen = hidden == 0
    at = np.zeros(int(nearest.max()) + 1, np.float32)
    at[nearest[seen]] = level[seen]
    return np.asarray(at[nearest], np.float32)
