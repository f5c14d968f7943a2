"""Polarity: whether the strokes of a picture are darker or lighter than its paper.

Signals: the levels of a reduced picture, and how broad two strokes are where they cross, in; the polarity
out.

Without its strokes paper is even, but for its own borders and shadows. So the picture is closed, which takes
out dark strokes, and opened, which takes out light ones; where less is left that differs from its
neighbours, there was the paper:

    edges = Σ |step to the next pixel|, across and down, over the closed picture and over the opened one

      ░░▓▓░░░▓░░     closed  ░░░░░░░░░░      opened  ░░▓▓▓▓▓▓░░

Neither the share of the sheet that ink takes nor the desk about a photographed sheet tells for one of them:
the borders of a sheet on a desk stay in both.

Source: our own; grey closing and opening are Serra's. Questions: a scribble that covers its paper over
broader areas than a stroke is what it looks like, a dark sheet with light places; where neither is clearly
the more even one, that is told.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.discs import without_dark, without_light

Levels = NDArray[np.float32]

# of the edges: with less between them a picture is not told clearly; by trial on made photographs of bold
# lines, of which those that were told wrongly lay below it
CLEARLY = 1.25
LIGHT_LINES = (
    "the lines that are followed are lighter than the sheet about them; if yours are the dark ones, give"
    " --ink dark"
)
HARDLY_DARK = (
    "the lines that are followed are taken to be darker than the sheet, which is hardly to be told of this"
    " picture; if yours are the light ones, give --ink light"
)


class Polarity(NamedTuple):
    """Whether strokes are darker than their paper, as the paper is light; and what there is to tell of it."""

    is_light: bool
    notes: tuple[str, ...] = ()


def polarity_of(small: Levels, crossing_px: int) -> Polarity:
    """The polarity of a reduced picture on which no place where strokes cross is broader; an odd number."""
    closed, opened = (
        _edges(without(small, crossing_px // 2)) for without in (without_dark, without_light)
    )
    if opened < closed:
        return Polarity(False, (LIGHT_LINES,))
    return Polarity(True, () if opened >= CLEARLY * closed else (HARDLY_DARK,))


def _edges(levels: Levels) -> float:
    """How much each pixel differs from the next one across and down, altogether."""
    across = cv2.norm(levels[:, 1:], levels[:, :-1], cv2.NORM_L1)
    return float(across + cv2.norm(levels[1:], levels[:-1], cv2.NORM_L1))
