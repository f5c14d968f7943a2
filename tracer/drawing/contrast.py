"""Contrast: how much darker than the paper each pixel of a picture is, made where it is asked for.

Signals: grey levels (0..255) and the level of the paper on a reduced picture in; contrast out, grey levels
(float32), positive on the strokes whether they are dark on light or light on dark.

The paper between the places of the reduced picture is interpolated, across first and then down, each time

    between = left + share · (right - left)

with one rounding, as OpenCV does it: where the picture is reduced by 4, 8 or 16, the result is the same to
the bit.

    ░░░░░░░░░░░░      bare paper, farther from anything dark than the head's cells look: it is 0, and takes
    ░░░▒▒▒▒░░░░░      neither time nor memory
    ░░░▒██▒░░░░░      paper near something dark keeps its noise

Source: our own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.motion.faults import DrawingFault
from morfax.tracer.drawing.blocks import ABOUT, Blocks, Near, in_parts, near, stretches_of
from morfax.tracer.drawing.components import Patches
from morfax.tracer.drawing.paper import Paper
from morfax.tracer.drawing.polarity import Polarity
from morfax.tracer.drawing.scan import Grey
from morfax.tracer.drawing.spot import mirrored, row_of_spot, weights_of, with_mirrored

Darkness = NDArray[np.float32]

LEAST_CONTRAST = 10.0  # grey levels of 255 between paper and ink
# grey levels darker than the paper, half of all: where more is asked, no other scan helps
MOST_ASKED = 256 / 2
ABOVE_NOISE = 6.0  # standard deviations of the paper: what is darker is no noise
DARKER = 80.0  # percentile of the strokes' pixels: those that no edge makes lighter
LEAST_STROKE_MM, LEAST_STROKE_PX = 2.0, 12  # shorter strokes are specks
SOFT_PX = 1.0  # standard deviation of the spot behind which strokes are looked for
ROUNDED = 1e-3  # grey levels: more than interpolation and a spot's weights are rounded by
FAINT = 0.1  # darkness: what is lighter is paper and its noise
# from what is darker: no cell that is held against a level sees as far (see `photocell`)
BARE_FROM_MM = 5.0
EVERY_ROW, EVERY_COLUMN = 32, 4  # of a sample: pixels that are nearer are alike behind a spot
MOST_ROWS = 64  # of a sample


def strokes_of(patches: Patches, least: float, pitch_mm: float) -> NDArray[np.bool_]:
    """Which patches of what is darker than the paper by `least` (grey levels) are strokes, and no specks.

    Raises DrawingFault if none is.
    """
    strokes = patches.longer_sides >= max(LEAST_STROKE_PX, LEAST_STROKE_MM / pitch_mm)
    if strokes.any():
        return np.asarray(strokes)
    if least > MOST_ASKED:
        raise DrawingFault(
            "no line on the drawing: its grey levels vary everywhere, as in noise, hatching or a pattern, "
            "and no line stands out; check the file"
        )
    raise DrawingFault(
        f"no line on the drawing: nothing longer than {LEAST_STROKE_MM:g} mm is {least:.0f} or more"
        " of 255 grey levels darker than the paper; check the file, or scan it with more contrast"
    )


@dataclass(frozen=True, slots=True)
class Contrast:
    """The contrast of a picture against its paper."""

    grey: Grey
    paper: Paper
    blocks: Blocks

    @classmethod
    def of(cls, grey: Grey, pitch_mm: float, known: Polarity | None = None) -> Contrast:
        """Find the paper of a picture of a pixel pitch, of a polarity if it is known."""
        by = Paper.by(pitch_mm)
        blocks = Blocks.of(grey, by)
        level = Paper.of_reduced(blocks.mean, by, grey.shape[1], pitch_mm, known)
        return cls(grey, level, blocks)

    def with_shapes(self, ink: float) -> Contrast:
        """The same with filled shapes as ink of a contrast, and no dark paper."""
        return replace(self, paper=self.paper.beneath_shapes(self.blocks.mean, ink))

    def above(self, least: float) -> Near:
        """The blocks in which a pixel's contrast may be above a level, and those about them."""
        paper, blocks = self.paper.reduced, self.blocks
        if self.paper.is_light:
            most = cv2.dilate(paper, ABOUT) - blocks.low
        else:
            most = blocks.high - cv2.erode(paper, ABOUT)
        return near(np.asarray(most > least - ROUNDED))

    def within(self, blocks: Near) -> Darkness:
        """Contrast in some blocks and those about them; 0 elsewhere, which takes no memory."""
        return self._filled(np.zeros(self.grey.shape, np.float32), near(blocks.view(bool)), 1.0)

    def darkness(self, ink: float) -> Darkness:
        """The sheet, where the contrast of ink is 1; bare paper far from anything dark is 0."""
        seen = np.zeros(self.grey.shape, np.float32)
        return self._filled(seen, self._about_dark(ink), ink)

    def in_parts_of(self, ink: float, everywhere: Darkness) -> Darkness:
        """The same of the contrast on the whole sheet, in its place."""
        part = np.float32(ink)
        _in_parts_of(everywhere, self._about_dark(ink), self.blocks.by, part)
        return everywhere

    def _about_dark(self, ink: float) -> Near:
        """The blocks that are near something a tenth as dark as ink."""
        about = 2 * math.ceil(BARE_FROM_MM / self.paper.pitch_mm) + 1
        blocks = cv2.dilate(self.above(FAINT * ink), np.ones((about, about), np.uint8))
        return np.asarray(blocks, np.uint8)

    def everywhere(self) -> Darkness:
        """Contrast on the whole sheet."""
        blocks = np.ones(self.blocks.mean.shape, np.uint8)
        return self._filled(np.empty(self.grey.shape, np.float32), blocks, 1.0)

    def sample(self, spread_px: float) -> Darkness:
        """The contrast of some pixels behind a spot of a standard deviation."""
        rows = len(self.grey)
        every = max(EVERY_ROW, rows // MOST_ROWS)
        chosen = np.arange(min(every // 2, rows - 1), rows, every)
        return self._rows(chosen, weights_of(spread_px))[:, ::EVERY_COLUMN].ravel()

    def pixels(self, every: int) -> Darkness:
        """The contrast of pixels so far apart, across and down."""
        chosen = np.arange(0, len(self.grey), every)
        return self._rows(chosen, np.ones(1, np.float32))[:, ::every]

    def _rows(self, chosen: NDArray[np.int64], weights: Darkness) -> Darkness:
        """The contrast of some rows behind a spot of these weights."""
        seen, how = np.empty((len(chosen), self.grey.shape[1]), np.float32), self._how(1.0)
        _softened(self.grey, self.paper.reduced, how, chosen, weights, seen)
        return seen

    def _filled(self, seen: Darkness, blocks: Near, unit: float) -> Darkness:
        """Fill in the contrast, in parts of a unit, within some blocks."""
        how = self._how(unit)
        in_parts(
            self.grey.size,
            len(blocks),
            lambda a, b: _fill(self.grey, self.paper.reduced, how, blocks, seen, a, b),
        )
        return seen

    def _how(self, unit: float) -> tuple[int, bool, np.float32]:
        """By what the paper is reduced, whether the strokes are darker than it, and the unit."""
        return self.blocks.by, self.paper.is_light, np.float32(unit)


@njit(cache=True, nogil=True)
def _fill(grey, paper, how, blocks, seen, first, last):  # type: ignore[no-untyped-def]
    """Fill in the contrast in some rows of blocks."""
    rows, columns = grey.shape
    by = how[0]
    wide = np.empty(
        (3, columns), np.float32
    )  # rows of the paper, interpolated, each in its place
    held = np.full(3, -1)  # which they are
    line, shares = np.empty(columns, np.float32), _shares(columns, by)
    for i in range(first, last):
        stretches = stretches_of(blocks[i], by, columns)
        if not len(stretches):
            continue
        for row in range(max(i - 1, 0), min(i + 2, len(paper))):
            if held[row % 3] != row:
                _across(paper[row], by, shares, wide[row % 3])
                held[row % 3] = row
        for k in range(i * by, min(i * by + by, rows)):
            at = (k + 0.5) / by - 0.5
            above = int(np.floor(at))
            share = np.float32(at - above)
            upper, lower = max(above, 0) % 3, min(above + 1, len(paper) - 1) % 3
            for stretch in stretches:
                begin, end = stretch[0], stretch[1]
                part = line[: end - begin]
                _between(wide[upper, begin:end], wide[lower, begin:end], share, part)
                _held_against(grey[k, begin:end], part, how, seen[k, begin:end])


@njit(cache=True, nogil=True)
def _softened(grey, paper, how, chosen, weights, seen):  # type: ignore[no-untyped-def]
    """Fill in the contrast of the chosen rows behind a spot."""
    rows, columns = grey.shape
    by, reach = how[0], len(weights) // 2
    wide, line = np.empty((2, columns), np.float32), np.empty(columns, np.float32)
    shares = _shares(columns, by)
    down, longer = np.empty(columns, np.float32), np.empty(columns + 2 * reach, np.float32)
    before = -2  # the row of the paper that is interpolated already
    for n in range(len(chosen)):
        down[:] = 0.0
        for d in range(-reach, reach + 1):
            k = mirrored(chosen[n] + d, rows)
            at = (k + 0.5) / by - 0.5
            upper = int(np.floor(at))
            if upper != before:
                _across(paper[max(upper, 0)], by, shares, wide[0])
                _across(paper[min(upper + 1, len(paper) - 1)], by, shares, wide[1])
                before = upper
            _between(wide[0], wide[1], np.float32(at - upper), line)
            _held_against(grey[k], line, how, line)
            _add(weights[reach + d], line, down)
        with_mirrored(down, -reach, longer)
        row_of_spot(longer, weights, seen[n])


@njit(cache=True, nogil=True)
def _add(weight, line, total):  # type: ignore[no-untyped-def]
    """Add a weighted line."""
    for j in range(len(total)):
        total[j] += weight * line[j]


@njit(cache=True, nogil=True)
def _in_parts_of(seen, blocks, by, unit):  # type: ignore[no-untyped-def]
    """Divide the contrast by a unit in some blocks, and make it 0 elsewhere."""
    rows, columns = seen.shape
    for i in range(len(blocks)):
        stretches = stretches_of(blocks[i], by, columns)
        for k in range(i * by, min(i * by + by, rows)):
            done, line = 0, seen[k]
            for stretch in stretches:
                begin, end = stretch[0], stretch[1]
                line[done:begin] = 0.0
                for j in range(begin, end):
                    line[j] /= unit
                done = end
            line[done:] = 0.0


@njit(cache=True, nogil=True)
def _first_beyond(block, by):  # type: ignore[no-untyped-def]
    """The first pixel of a block beyond its middle, or at it."""
    half = by - by // 2
    return block * by + half if 2 * half == by else block * by + half - 1


@njit(cache=True, nogil=True)
def _shares(columns, by):  # type: ignore[no-untyped-def]
    """How far each column is from the middle of the block to its left to that of the next, of the way."""
    shares = np.empty(columns, np.float32)
    for block in range(-1, columns // by + 1):
        begin = _first_beyond(block, by)
        for j in range(max(begin, 0), min(begin + by, columns)):
            shares[j] = np.float32((j + 0.5) / by - 0.5 - block)
    return shares


@njit(cache=True, nogil=True, fastmath={"contract"})
def _across(paper, by, shares, wide):  # type: ignore[no-untyped-def]
    """Interpolate a row of the paper at each column."""
    columns, last = len(wide), len(paper) - 1
    for block in range(-1, last + 1):
        left, right = paper[max(block, 0)], paper[min(block + 1, last)]
        step, begin = right - left, _first_beyond(block, by)
        for j in range(max(begin, 0), min(begin + by, columns)):
            wide[j] = left + shares[j] * step


@njit(cache=True, nogil=True, fastmath={"contract"})
def _between(upper, lower, share, line):  # type: ignore[no-untyped-def]
    """Interpolate between two rows."""
    for j in range(len(line)):
        line[j] = upper[j] + share * (lower[j] - upper[j])


@njit(cache=True, nogil=True)
def _held_against(grey, paper, how, seen):  # type: ignore[no-untyped-def]
    """How much darker than the paper a row is, or lighter, in parts of the unit."""
    unit = how[2]
    if how[1]:
        for j in range(len(seen)):
            seen[j] = (paper[j] - np.float32(grey[j])) / unit
    else:
        for j in range(len(seen)):
            seen[j] = (np.float32(grey[j]) - paper[j]) / unit
