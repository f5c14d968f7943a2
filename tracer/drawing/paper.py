"""The paper of a picture: its level behind the strokes, however unevenly it is lit.

Signals: a grey picture (0..255), or a channel of a coloured one, in; the paper's level at every pixel out.

The paper is the picture with its dark strokes narrower than a few mm closed (a grey closing), smoothed.
Whether the strokes are dark on light or light on dark tells `polarity`.

Source: our own; the patent takes the drawing for granted.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.blocks import Blocks
from morfax.tracer.drawing.discs import disc, without_dark, without_light
from morfax.tracer.drawing.lighting import Lighting, from_beside
from morfax.tracer.drawing.polarity import Polarity, polarity_of

WIDEST_STROKE_MM = 6.0  # broader dark areas count as paper that is dark
SHAPE = 0.6  # of the ink's contrast: paper that is darker by so much is no shadow
SHARP_MM = 1.5  # a shape's edge is no broader, most shadows' are; by trial
DARK = 0.5  # of the ink's contrast: what is darker than the paper by more is ink
BLACK = 0.8  # of the ink's contrast: a paler area is a panel, or in shadow; by trial
ALIKE = 0.02  # of the ink's contrast: levels that differ by less are one
CROSSED = math.sqrt(2)  # of a stroke's width: as broad is the place where two of them cross
FEW = 0.01  # of a spot: so little bare paper in it tells no level
REDUCED_PITCH_MM = 0.34  # the paper is estimated on a picture reduced to this, by 4 at least

Levels = NDArray[np.float32]
Grey = NDArray[np.uint8] | NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Paper:
    """The level of the paper on a picture reduced by a whole number to a pitch, and before it was smoothed.

    And the columns of the picture itself, and whether the strokes are darker than the paper.
    """

    reduced: Levels
    closed: Levels
    by_px: int
    columns: int
    polarity: Polarity
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
    def of_reduced(
        cls,
        small: Levels,
        by: int,
        columns: int,
        pitch_mm: float,
        known: Polarity | None = None,
    ) -> Paper:
        """The paper of a picture of so many columns that was reduced already; its polarity may be known."""
        across = _stroke_px(by, pitch_mm)
        polarity = known or polarity_of(small, 2 * round(CROSSED * across / 2) + 1)
        level = _closed(small, polarity.is_light, across)
        smooth = np.asarray(cv2.GaussianBlur(level, (0, 0), across / 2), np.float32)
        return cls(smooth, level, by, columns, polarity, by * pitch_mm)

    @property
    def is_light(self) -> bool:
        """Whether it is lighter than the strokes."""
        return self.polarity.is_light

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
        # light falls off over a sheet, by ink's whole contrast beneath a lamp; behind a shape's edge, blurred
        # by a stroke's width, the paper is bright again within three of these
        beside = 2 * round(3 * WIDEST_STROKE_MM / self.pitch_mm) + 1
        brightest = cv2.erode(level, np.ones((beside, beside), np.uint8))
        dark = (level - brightest > SHAPE * contrast).view(np.uint8)
        grown = cv2.dilate(dark, disc(round(WIDEST_STROKE_MM / 2 / self.pitch_mm)))
        return np.asarray(grown, bool)

    def lighting(self, small: Levels) -> Lighting | None:
        """How the sheet of the reduced picture is lit; None if evenly, and for light strokes on dark."""
        return Lighting.of(self.closed, small) if self.is_light else None

    def light(self, lighting: Lighting, ink: float | None = None) -> Levels:
        """The light on the reduced picture, filled shapes as dark as ink of a contrast apart."""
        stroke_px = WIDEST_STROKE_MM / 2 / self.pitch_mm
        if ink is not None:
            sharp_px = round(SHARP_MM / self.pitch_mm)
            darker = SHAPE * ink / lighting.white
            lighting = lighting.beneath_shapes(darker, sharp_px, stroke_px)
        return lighting.light(stroke_px)

    def beneath_shapes(self, small: Levels, contrast: float) -> Paper:
        """The same with filled shapes as ink of a contrast: beneath them it is as bright as about them.

        `small` is the reduced picture. A shape is uncovered from its edges inwards, as far each time as
        `shapes` sees.
        """
        paper, about = self, disc(round(WIDEST_STROKE_MM / self.pitch_mm))
        uncovered = np.zeros(self.reduced.shape, np.uint8)
        while True:
            uncovered |= paper.shapes(contrast).view(np.uint8)
            hidden = np.asarray(cv2.dilate(uncovered, about), np.uint8)
            if hidden.all():
                return self
            nearest = from_beside(self.reduced, hidden)
            level = np.where(hidden > 0, self._seen(small, nearest, contrast), self.reduced)
            further = replace(self, reduced=np.asarray(level, np.float32))
            if not (further.shapes(contrast) & (uncovered == 0)).any():
                return replace(self, reduced=self._black_only(small, further.reduced, contrast))
            paper = further

    def _black_only(self, small: Levels, level: Levels, contrast: float) -> Levels:
        """A level, but this one's own about areas that are paler than ink: lines may be drawn on them."""
        depth = np.abs(level - small) / contrast
        hidden = np.abs(level - self.reduced) > ALIKE * contrast
        count, labels = cv2.connectedComponents(hidden.view(np.uint8), connectivity=8)
        inked = hidden & (depth > DARK)
        areas = np.maximum(np.bincount(labels[inked], minlength=count), 1)
        depths = np.bincount(labels[inked], depth[inked], count) / areas
        return np.where((depths < BLACK)[labels] & hidden, self.reduced, level)

    def _seen(self, small: Levels, about: Levels, contrast: float) -> Levels:
        """The level of the paper that is to be seen near by: of what is not much darker than a level about
        it; that level itself where there is none.
        """
        dark = np.abs(small - about) > DARK * contrast
        bare = 1 - cv2.dilate(dark.view(np.uint8), np.ones((3, 3), np.uint8))
        weights, spot = bare.astype(np.float32), WIDEST_STROKE_MM / 2 / self.pitch_mm
        among = cv2.GaussianBlur(weights, (0, 0), spot)
        level = cv2.GaussianBlur(weights * small, (0, 0), spot) / np.maximum(among, FEW)
        return np.asarray(np.where(among > FEW, level, about), np.float32)


def _stroke_px(by: int, pitch_mm: float) -> int:
    """How broad the widest stroke is on a picture of a pitch that was reduced; an odd number."""
    return 2 * (max(24, round(WIDEST_STROKE_MM / pitch_mm)) // (2 * by)) + 1


def _closed(small: Levels, is_light: bool, across: int) -> Levels:
    """A reduced picture without its strokes."""
    return (without_dark if is_light else without_light)(small, across // 2)
