"""Levelling: the grey picture of a sheet becomes darkness, whatever its light and its ink.

Signals: grey levels 0..255 (rows from the top, columns) on square pixels in; darkness out: float32, 0 =
paper, 1 = the ink of the drawing's lines. Uneven paper is levelled (see `paper`), dark on light or light on
dark. Ink is how dark the longer strokes are at their darkest.

Source: our own. Questions: none; the patent takes ink that is black for granted.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.faults import DrawingFault
from morfax.motion.median import ROBUST, median, percentile
from morfax.tracer.drawing.blocks import ABOUT, runs_behind_spot, runs_in
from morfax.tracer.drawing.components import Patches, strips
from morfax.tracer.drawing.contrast import (
    ABOVE_NOISE,
    DARKER,
    EVERY_COLUMN,
    LEAST_CONTRAST,
    MOST_ASKED,
    SOFT_PX,
    Contrast,
    strokes_of,
)
from morfax.tracer.drawing.memory import SHEET_BYTES, give_back
from morfax.tracer.drawing.paper import WIDEST_STROKE_MM
from morfax.tracer.drawing.paper_noise import every_px, paper_noise
from morfax.tracer.drawing.polarity import Polarity
from morfax.tracer.drawing.scan import Grey
from morfax.tracer.drawing.tiles import Tiles
from morfax.tracer.effort import FEW_PX

SURELY = 0.8  # of the least contrast: the noise of a sample tells that the noise of all pixels is less
# of the light, over three pixels of the reduced picture, a millimetre: glued paper or a hard shadow; chosen
STEP = 0.1
# where two such lines meet their ink is broader than a stroke may be
BOLD_MM = WIDEST_STROKE_MM / 2

Darkness = NDArray[np.float32]
Shapes = NDArray[np.bool_]


class Levelled(NamedTuple):
    """A sheet as darkness, paper 0, the strokes 1, or tiles of it; where filled shapes are that are no ink,
    on a picture reduced by a whole number; the noise of the paper; whether there are filled shapes; and
    its polarity, with what there is to tell of that.
    """

    darkness: Darkness | Tiles
    shapes: Shapes
    paper_noise: float
    has_shapes: bool
    polarity: Polarity


def levelled(
    grey: Grey, pitch_mm: float, shapes_are_ink: bool = False, known: Polarity | None = None
) -> Levelled:
    """Darkness of a grey picture (0..255), of a polarity if it is known. Raises DrawingFault if nothing is
    long and dark enough to be a line.
    """
    contrast = _in_even_light(Contrast.of(grey, pitch_mm, known), pitch_mm)
    ink, everywhere = _ink_contrast(contrast, pitch_mm)
    shapes = contrast.paper.shapes(ink)
    has_shapes = bool(shapes.any())
    if shapes_are_ink and has_shapes:  # another paper beneath them, and so another contrast
        contrast, everywhere = contrast.with_shapes(ink), None
        shapes = contrast.paper.shapes(ink)
    every = every_px(grey.size)
    sample = contrast.pixels(every) if everywhere is None else everywhere[::every, ::every]
    told = (
        shapes,
        paper_noise(sample / np.float32(ink)),
        has_shapes,
        contrast.paper.polarity,
    )
    if everywhere is None:
        return Levelled(contrast.darkness(ink), *told)
    if everywhere.nbytes > SHEET_BYTES:
        give_back()
    return Levelled(contrast.in_parts_of(ink, everywhere), *told)


def _in_even_light(contrast: Contrast, pitch_mm: float) -> Contrast:
    """A picture in uneven light made one in even light; filled shapes stay as dark as they are."""
    paper = contrast.paper
    lighting = paper.lighting(contrast.blocks.mean)
    if lighting is None:
        return contrast
    try:
        # shapes are known by how dark the lines are, and that by the light: all that is dark is in a shadow
        ink, _ = _ink_contrast(
            _lit(contrast, paper.light(lighting), lighting.white, pitch_mm), pitch_mm
        )
    except DrawingFault:
        return contrast
    return _lit(contrast, paper.light(lighting, ink), lighting.white, pitch_mm)


def _lit(contrast: Contrast, light: Darkness, white: float, pitch_mm: float) -> Contrast:
    """The same of the picture divided by the light on it, which is given on the reduced picture."""
    by, grey = contrast.blocks.by, contrast.grey
    large = cv2.resize(light, None, fx=by, fy=by, interpolation=cv2.INTER_LINEAR)
    # beside a sharp step a pixel's own level tells the light on it: a line would be left along the step
    low, high = (np.asarray(f(light, ABOUT), np.float32) for f in (cv2.erode, cv2.dilate))
    steps = high - low > STEP
    lit = np.empty(grey.shape, np.uint8)
    # strip by strip: of a sheet as floats only the light is held
    for top, bottom, _ in strips(grey.shape, pixels=FEW_PX):
        seen = grey[top:bottom].astype(np.float32)
        light_there = np.ascontiguousarray(large[top:bottom, : grey.shape[1]], np.float32)
        block = np.arange(top, bottom) // by
        row, column = np.nonzero(steps[block].repeat(by, axis=1)[:, : grey.shape[1]])
        at = block[row], column // by
        light_there[row, column] = np.clip(seen[row, column] / white, low[at], high[at])
        lit[top:bottom] = np.clip(np.rint(cv2.divide(seen, light_there)), 0, 255)
    return Contrast.of(lit, pitch_mm, contrast.paper.polarity)


def _ink_contrast(contrast: Contrast, pitch_mm: float) -> tuple[float, Darkness | None]:
    """Contrast of the strokes against the paper, grey levels: that of the longer strokes' darker part; and
    that of the whole sheet where its noise asked for it.
    """
    least = LEAST_CONTRAST
    is_quiet = _above_noise(contrast.sample(SOFT_PX)) < SURELY * LEAST_CONTRAST
    if is_quiet:
        dark = contrast.above(least)
        seen = contrast.within(dark)
        runs = runs_behind_spot(seen, dark, contrast.blocks.by, SOFT_PX, least)
    else:
        seen = contrast.everywhere()
        soft = np.asarray(cv2.GaussianBlur(seen, (0, 0), SOFT_PX), np.float32)
        some = soft[::EVERY_COLUMN, ::EVERY_COLUMN]
        least = max(least, _above_noise(some.ravel()))
        if least > MOST_ASKED:  # where ink takes much of the picture its levels are no noise
            least = max(LEAST_CONTRAST, _above_neighbours(some))
        runs = runs_in(soft, least)
    patches = Patches.of([runs])
    strokes = strokes_of(patches, least, pitch_mm)
    every = max(1, int(patches.areas[strokes].sum()) // FEW_PX)
    ink = percentile(patches.pixels_of(strokes, seen)[::every], DARKER)
    return ink, None if is_quiet else seen


def _above_noise(sample: Darkness) -> float:
    """What is above the noise of a sample."""
    centre = median(sample)
    return centre + ABOVE_NOISE * ROBUST * median(np.abs(sample - centre))


def _above_neighbours(sample: Darkness) -> float:
    """What is above the noise of a sample by how much neighbours along its rows differ."""
    differ = np.abs(np.diff(sample, axis=1)).ravel()
    return ABOVE_NOISE * ROBUST * median(differ) / math.sqrt(2)
