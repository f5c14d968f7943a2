"""The paper of a picture: its level behind the strokes, however unevenly it is lit.

Signals: a grey picture (0..255), or a channel of a coloured one, in; the paper's level at every pixel out.

The paper is the picture with its dark strokes narrower than a few mm closed (a grey closing), smoothed.
Whether the strokes are dark on light or light on dark is read off the skew of the grey levels about their
local mean: strokes are the smaller part, so they stand out further.

Source: our own; the patent takes the drawing for granted.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.blocks import Blocks

ROBUST = 1.4826  # standard deviations to a median absolute deviation of normal noise
WIDEST_STROKE_MM = 6.0  # broader dark areas count as paper that is dark
SHAPE = 0.6  # of the ink's contrast: paper that is darker by so much is no shadow
# light falls off over a sheet, by ink's whole contrast beneath a lamp; behind a shape's edge, blurred by a
# stroke's width, the paper is bright again within three of these
BESIDE_SHAPE_MM = 18.0
REDUCED_PITCH_MM = 0.34  # the paper is estimated on a picture reduced to this, by 4 at least

Levels = NDArray[np.float32]
Grey = NDArray[np.uint8] | NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Paper:
    """The level of the paper on a picture reduced by a whole number to a pitch.

    And the columns of the picture itself, and whether the strokes are darker than the paper.
    """

    reduced: Levels
    by_px: int
    columns: int
    is_light: bool
    pitch_mm: float

    @classmethod
    def of(cls, grey: Grey, pitch_mm: float) -> Paper:
        """The paper of a picture of a pixel pitch."""
        by = cls.by(pitch_mm)
        return cls.of_reduced(Blocks.of(grey, by).mean, by, grey.shape[1], pitch_mm)

    @staticmethod
    def by(pitch_mm: float) -> int:
        """By what whole number a picture of a pixel pitch is reduced."""
        return max(4, round(REDUCED_PITCH_MM / pitch_mm))

    @classmethod
    def of_reduced(cls, small: Levels, by: int, columns: int, pitch_mm: float) -> Paper:
        """The paper of a picture of so many columns that was reduced already."""
        across = 2 * (max(24, round(WIDEST_STROKE_MM / pitch_mm)) // (2 * by)) + 1
        stroke = _disc(across // 2)
        relief = small - cv2.blur(small, (across, across))
        # strokes take less room than paper: the few stand out further
        is_light = float((relief * relief * relief).sum()) <= 0
        level = cv2.morphologyEx(small, cv2.MORPH_CLOSE if is_light else cv2.MORPH_OPEN, stroke)
        smooth = np.asarray(cv2.GaussianBlur(level, (0, 0), across / 2), np.float32)
        return cls(smooth, by, columns, is_light, by * pitch_mm)

    def rows(self, top: int, bottom: int) -> Levels:
        """The paper of some rows of the picture."""
        by = self.by_px
        first = max(0, top // by - 1)
        last = min(len(self.reduced), -(-bottom // by) + 1)
        part = self.reduced[first:last]
        large = cv2.resize(part, None, fx=by, fy=by, interpolation=cv2.INTER_LINEAR)
        rows = slice(top - first * by, bottom - first * by)
        return np.asarray(large[rows, : self.columns], np.float32)

    def shapes(self, contrast: float) -> NDArray[np.bool_]:
        """Where the edges of filled shapes broader than a stroke are, and about them, on the reduced picture.

        There the paper is nearly as dark as ink of a contrast, and close by it is bright.
        """
        level = -self.reduced if self.is_light else self.reduced
        if float(level.max() - level.min()) <= SHAPE * contrast:
            return np.zeros(level.shape, bool)
        beside = 2 * round(BESIDE_SHAPE_MM / self.pitch_mm) + 1
        brightest = cv2.erode(level, np.ones((beside, beside), np.uint8))
        dark = (level - brightest > SHAPE * contrast).view(np.uint8)
        grown = cv2.dilate(dark, _disc(round(WIDEST_STROKE_MM / 2 / self.pitch_mm)))
        return np.asarray(grown, bool)


def _disc(radius_px: int) -> NDArray[np.uint8]:
    """Mask of a disc."""
    across = 2 * radius_px + 1
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (across, across)), np.uint8)
