"""Deepening: pale lines of a quiet sheet are made as dark as its ink, so that the cells see them too.

Signals: darkness of a sheet (0 paper, 1 ink), changed in place; out the length of the lines that were made
darker, mm. It serves sheets of which all the ink is asked for.

    darkness 1 ┤  ▟▙                   ▟▙      ▗▖
            0.5┤··▐▌········  becomes  ▐▌······▐▌···
            0.3┤  ▐▌      ▗▖           ▐▌      ▐▌
               └──────────────         └────────────

Each pale line is divided by its own darkness; as that is one figure for all of the line, its middle stays
where it is. A line that fades is taken up again at its end, in a few rounds.

Source: our own. Questions: what shines through the paper and what is printed on it may be as dark as a pale
line. `LEAST` is above what shines through a sheet; on paper with grain nothing is made darker.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import INK, Mask, strips
from morfax.tracer.drawing.contrast import DARKER, LEAST_STROKE_MM, LEAST_STROKE_PX
from morfax.tracer.drawing.depth import depth_of
from morfax.tracer.drawing.noise import measured
from morfax.tracer.drawing.solids import LONG
from morfax.tracer.drawing.spots import (
    PART_PX,
    SPOT_PX,
    Darkness,
    disc,
    noise_of_spots,
    of_pixels,
    times_as_noisy,
)
from morfax.tracer.effort import FEW_PX, ROUNDS

SURELY = 0.6  # of ink's darkness: paler ink is that of a pale line in noise
# of ink's darkness behind that spot. Paler are what shines through a sheet and a JPEG's rims; chosen
LEAST = 0.15
# times the noise of spots: so far a pale line stands out from paper. That noise is up to 0.011 on scans,
# 0.013 to 0.03 on photographs of crumpled and of squared paper and of boards; by trial
ABOVE_NOISE = 12.5
# pixels, and spots of the picture's softness: so near to ink is its own rim
RIM_PX, SPOTS = 2, 2.0
# a line is made darker so much farther than that rim: up to ink, and into its edge
BEYOND_PX = 2
TOUCHED = 0.7  # of a pale line's darkness: within the rim of ink it goes on where it is as dark
# letters are as low (see `lettering`): a shorter line than others counts if it stands out so much farther
LETTER_MM, TWICE = 1.0, 2.0
BROAD, BROAD_PX = 2.0, 2.0  # usual widths and pixels: a broader patch is shade
FULL = 0.9  # a thin line may be as dark as ink and be seen pale behind the spot: it stays


class _Lines(NamedTuple):
    """The pale lines of a sheet: numbers of their pixels (0 elsewhere), the darkness of each, the length."""

    labels: NDArray[np.int32]
    dark: Darkness
    length_px: float


def deepened(
    darkness: Darkness,
    pitch_mm: float,
    paper_noise: float | None,
    shapes: NDArray[np.bool_],
    *,
    is_pencil: bool = False,
) -> float:
    """Make pale lines as dark as ink, in place; the length of all of them, mm. The shade of filled shapes is
    no line. What is noise of the paper on one side of a sheet alone may be a pencil's shade.
    """
    noise = measured(darkness, pitch_mm, paper_noise)
    if not math.isfinite(noise.softness_px):
        return 0.0
    noisy = ABOVE_NOISE * noise_of_spots(darkness)
    if noisy > INK:
        return 0.0
    times = times_as_noisy(darkness)
    levels = np.maximum(LEAST, noisy * (np.ones_like(times) if is_pencil else times))
    rim_px = RIM_PX + math.ceil(SPOTS * noise.softness_px)
    length_px, shortest_px = 0.0, max(LEAST_STROKE_PX, LEAST_STROKE_MM / pitch_mm)
    for _ in range(ROUNDS):
        pale = pale_ink(darkness, levels, rim_px, shortest_px)
        if shapes.any():
            pale &= 1 - shaded(shapes, pale.shape)
        lines = _lines(pale, darkness, noise.width_mm / pitch_mm, levels, pitch_mm)
        if lines is None:
            break
        length_px += lines.length_px
        _deepen(darkness, lines, rim_px)
    return length_px * pitch_mm


def deepened_note(pale_mm: float) -> str:
    """What the operator should know of pale lines that are followed."""
    return (
        f"{pale_mm:.0f} mm of line are less than half as dark as the rest, and are followed as well; if they"
        " shine through the paper, or are printed on it, rub them out (morfax correct --rub)"
    )


def pale_ink(darkness: Darkness, levels: Darkness, rim_px: int, shortest_px: float) -> Mask:
    """Where a sheet is darker behind a spot than the level of its part (see `spots`), and is no ink, nor so
    near to ink as its rim.

    Shorter patches that are hardly ink are places at which a pale line is a little darker.
    """
    pale, inked = np.zeros((2, *darkness.shape), np.uint8)
    for top, bottom, rows in strips(pale.shape, halo=math.ceil(4 * SPOT_PX), pixels=FEW_PX):
        soft = cv2.GaussianBlur(darkness[rows], (0, 0), SPOT_PX)[top - rows.start :]
        soft = soft[: bottom - top]
        pale[top:bottom] = soft > of_pixels(levels, top, bottom, pale.shape[1])
        inked[top:bottom] = (soft > INK).view(np.uint8) + (soft > SURELY)
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(inked, connectivity=8)
    is_ink = boxes[:, 2:4].max(axis=1) >= shortest_px
    is_ink[labels[inked > 1]] = True
    is_ink[0] = False
    inked = is_ink[labels].view(np.uint8)
    pale &= 1 - np.asarray(cv2.dilate(inked, disc(rim_px)), np.uint8)
    return pale


def shaded(shapes: NDArray[np.bool_], shape: tuple[int, ...]) -> Mask:
    """Where filled shapes were taken for dark paper: their shade is no line."""
    large = cv2.resize(shapes.view(np.uint8), shape[::-1], interpolation=cv2.INTER_NEAREST)
    return np.asarray(large, np.uint8)


def _lines(
    pale: Mask, darkness: Darkness, usual_px: float, levels: Darkness, pitch_mm: float
) -> _Lines | None:
    """The patches of a mask that are lines; None if none is. Lines are usually so wide; from the levels of
    the sheet's parts on ink may be pale.
    """
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(pale, connectivity=8)
    if count < 2:
        return None
    rows, columns = np.nonzero(pale)
    patch = labels[rows, columns]
    depth = depth_of(pale)
    areas = np.maximum(np.bincount(patch, minlength=count), 1)
    # a line's pixels are a quarter of its breadth deep, and half a pixel, as a mean
    broad_px = np.maximum(4 * np.bincount(patch, depth, count) / areas - 2, 1)
    lengths_px = areas / broad_px
    long_px = boxes[:, 2:4].max(axis=1)
    are_lines = long_px >= max(LEAST_STROKE_PX, LETTER_MM / pitch_mm)
    are_lines &= lengths_px > LONG * broad_px
    are_lines &= broad_px < BROAD * usual_px + BROAD_PX
    are_lines[0] = False
    dark = _usual(darkness[rows, columns], patch, count)
    level = levels[boxes[:, 1] // PART_PX, boxes[:, 0] // PART_PX]
    # paper beside ink is dark behind the spot alone
    are_lines &= (level < dark) & (dark < FULL)
    are_lines &= (long_px >= LEAST_STROKE_MM / pitch_mm) | (dark > TWICE * level)
    if not are_lines.any():
        return None
    numbers = (np.arange(count) * are_lines).astype(np.int32)
    return _Lines(numbers[labels], dark, float(lengths_px[are_lines].sum()))


def _usual(seen: Darkness, patch: NDArray[Any], count: int) -> Darkness:
    """How dark each patch is by its pixels; that of number 0 is the paper."""
    order = np.lexsort((seen, patch))
    begins = np.searchsorted(patch[order], np.arange(count + 1))
    at = begins[:-1] + (DARKER / 100 * (np.diff(begins) - 1)).astype(int)
    return np.where(np.diff(begins) > 0, seen[order][at], np.float32(1))


def _deepen(darkness: Darkness, lines: _Lines, rim_px: int) -> None:
    """Divide each pale line with its soft rims by its darkness, up to the ink that it runs into."""
    away, nearest = cv2.distanceTransformWithLabels(
        (lines.labels == 0).view(np.uint8),
        cv2.DIST_L2,
        cv2.DIST_MASK_PRECISE,
        labelType=cv2.DIST_LABEL_PIXEL,
    )
    line_of = np.zeros(int(nearest.max()) + 1, np.int32)
    line_of[nearest[lines.labels > 0]] = lines.labels[lines.labels > 0]
    rows, columns = np.nonzero(away < rim_px + BEYOND_PX)
    seen = darkness[rows, columns]
    dark = lines.dark[line_of[nearest[rows, columns]]]
    # in ink's rim only what is as dark as the line is the line
    soft = cv2.GaussianBlur(darkness, (0, 0), SPOT_PX)
    in_rim = cv2.dilate((soft > INK).view(np.uint8), disc(rim_px))[rows, columns] > 0
    is_line = ~in_rim | (seen > TOUCHED * dark)
    darker = np.maximum(np.minimum(seen / dark, 1.0), seen)
    darkness[rows, columns] = np.where(is_line, darker, seen)
