"""Lettering: patches of ink that stand in a row like the letters of a word.

Signals: a Sheet in; out the patches that are likely letters.

    ╭╮ ┌╮ ╶┐ ┌╴       as high as one another, close together side by side, three or more,
    ╰╯ ├┴ ╶┤ └┐       and unlike one another: holes in a row are alike, or all are round

    ╭╮ ╶┐             two are letters too where others are as high: the 24 beside R10
    ╶╯ ╶┤

Source: our own. Questions: what is written with joined letters is one patch, and is not found.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.neighbours import pairs_within
from morfax.tracer.drawing.components import grouped
from morfax.tracer.drawing.strokes import Sheet

# All limits below were chosen by trial on the test drawings.
LEAST_MM, LARGEST_MM = 1.0, 12.0  # of a letter's height
ALIKE = 0.35  # the lower of two letters is at least so high as the other
APART = 1.0  # mean heights from letter to letter, at most
BESIDE = 0.5  # of the lower letter's height stands beside the other
FEWEST = 3  # letters in a row
UNLIKE = 0.15  # the lengths of letters differ by more than this share of their mean
# as wide as high, but for this share or so many pixels: where all of a row are so, they are holes
ROUND, ROUND_PX = 0.08, 1.5
# of two: each is so much narrower than high (a hole is round), and as high, by this share, as a letter
NARROW = 0.85


def lettering(sheet: Sheet) -> set[int]:
    """The patches that are likely letters."""
    return set(sheet.once(_letters))


def _letters(sheet: Sheet) -> set[int]:
    """The same, of a sheet of which it was not asked before."""
    pitch_mm = sheet.drawing.pitch_mm
    boxes_mm = np.asarray(sheet.patches.boxes, float) * pitch_mm
    heights_mm = boxes_mm[:, 1] - boxes_mm[:, 0]
    wide_mm = boxes_mm[:, 3] - boxes_mm[:, 2]
    sized = (heights_mm >= LEAST_MM) & (heights_mm <= LARGEST_MM) & (wide_mm <= LARGEST_MM)
    patches = np.flatnonzero(sized & ~sheet.are_solid)
    if len(patches) < FEWEST:
        return set()
    numbers = _rows(boxes_mm[patches])
    rows = [patches[numbers == row] for row in range(int(numbers.max()) + 1)]
    letters = set[int]()
    for own in rows:
        lengths_mm = sheet.lengths_mm[own]
        is_unlike = lengths_mm.std() > UNLIKE * lengths_mm.mean()
        apart_mm = np.abs(wide_mm[own] - heights_mm[own])
        are_round = np.all(apart_mm < np.maximum(ROUND * heights_mm[own], ROUND_PX * pitch_mm))
        if len(own) >= FEWEST and is_unlike and not are_round:
            letters |= set(own.tolist())
    high_mm = heights_mm[sorted(letters)]
    for own in rows:
        is_narrow = wide_mm[own] < NARROW * heights_mm[own]
        as_high = np.abs(heights_mm[own][:, None] / high_mm - 1) < ROUND
        if len(own) == FEWEST - 1 and is_narrow.all() and as_high.any(axis=1).all():
            letters |= set(own.tolist())
    return letters


def lower_than(sheet: Sheet, letters: set[int], high_mm: float) -> set[int]:
    """The letters that are lower than a height."""
    pitch_mm, boxes = sheet.drawing.pitch_mm, sheet.patches.boxes
    return {n for n in letters if float(boxes[n, 1] - boxes[n, 0]) * pitch_mm < high_mm}


def _rows(boxes_mm: Array) -> NDArray[np.int32]:
    """The row in which each of some boxes (top, bottom, left, right; downwards) stands."""
    top, bottom, left, right = boxes_mm.T
    middles = np.column_stack([0.5 * (left + right), 0.5 * (top + bottom)])
    high = bottom - top
    within_mm = LARGEST_MM + APART * LARGEST_MM
    pairs = pairs_within(middles, within_mm)
    a, b = pairs.T
    lower = np.minimum(high[a], high[b])
    shared = np.minimum(bottom[a], bottom[b]) - np.maximum(top[a], top[b])
    beside = shared > BESIDE * lower
    alike = lower > ALIKE * np.maximum(high[a], high[b])
    apart_mm = np.maximum(left[a], left[b]) - np.minimum(right[a], right[b])
    mean_mm = 0.5 * (high[a] + high[b])
    near = beside & alike & (apart_mm < APART * mean_mm) & (apart_mm > -BESIDE * lower)
    return np.asarray(grouped(pairs[near], len(high)))
