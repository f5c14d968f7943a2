"""Grain: the line of a pencil on rough paper, of chalk or a dry pen, seen through a slit along the line.

Signals: darkness of a sheet (0 paper, 1 ink) in; the same behind the slit out, if the ink has grain.

A pencil leaves ink on the paper's high places only. Across the line that hides the edges, and a spot small
enough to see them sees gaps. A slit as long as the line is straight averages the grain and keeps the edges:

         ▓▓░▓ ░▓▓░ ▓▓▓        slit  s_along = 0.4 mm or 0.8 widths   (standard deviations of a normal weight)
        ════╪═════╪════             s_across = 0.1 widths
         ░▓▓▓░▓▓ ▓░▓▓▓        flanks, a width to each side, tell the line's direction:

    fit(k)  = slit(k) - ½ · (slit(k) one width to the left + one width to the right)
    seen    = slit(k) of the direction k that fits best within 0.6 widths

A slit across the line fits nowhere, as its flanks lie on the line too. Without them the line would get a halo
as wide as the slit is long. What a slit some pixels wide sees is smooth: it looks at a picture reduced by as
much, and what that and the way back soften is taken off its width.

Source: our own; filters matched to a direction are the textbook's way (S. Chaudhuri and others, 1989, blood
vessels in fundus images). Questions: ends of lines stay where they are (half of the slit is on paper there),
and a corner is rounded by some 0.1 mm, which `program.laid.grain_corners` mends.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing import coarse
from morfax.tracer.drawing.components import INK, SOFTENED_PX
from morfax.tracer.drawing.discs import disc
from morfax.tracer.effort import FEW_PX
from morfax.tracer.limits import PAPER, USUAL_WIDTH_MM

if TYPE_CHECKING:
    from morfax.tracer.drawing.noise import Within
    from morfax.tracer.drawing.tiles import Kept

Darkness = NDArray[np.float32]

# Chosen by trial on `python -m benchmarks pencil`.
LEAST_GRAIN = 0.15  # standard deviation of the ink's darkness; a clean scan has 0.02
# half of the strokes may be dry, as of a worn marker: the ink of all then has this, and the slit has to leave
# no more than this share of its pieces
LEAST_OF_SOME, JOINED = 0.08, 0.5
ENOUGH_TIMES = 2.0  # finer pixels, of lines that look 1.5 pixels wide or more
ALONG_WIDTHS = 0.8  # of the slit, standard deviation, ...
ALONG_MM = ALONG_WIDTHS * USUAL_WIDTH_MM  # ... at least
ACROSS_WIDTHS = 0.12
FLANK_WIDTHS = 1.0  # from the slit to each of its flanks
SMOOTH_WIDTHS = 0.3  # over which a fit is averaged
REACH_WIDTHS = 0.6  # so far around a place the best fit counts: just over the line's edge
DIRECTIONS = 16
SPREADS = 2.5  # standard deviations of the slit: its weight beyond that is 1 %
TILE_PX = math.isqrt(FEW_PX)
# a slit that is as wide on a picture reduced by one of these, standard deviation, looks at that
REDUCED, NARROWEST_PX = (8, 4, 2), 1.0
# px²: variance of means of pixels, 1/12, and of interpolation between them, 1/6
SOFTENED_BY = 1 / 4


class Slit(NamedTuple):
    """The slit: standard deviations along and across the line, and the line's width, pixels."""

    along_px: float
    across_px: float
    width_px: float

    @property
    def halo_px(self) -> int:
        """How far from a place the slit, its flanks and its neighbours see."""
        beside = (FLANK_WIDTHS + 3 * SMOOTH_WIDTHS + REACH_WIDTHS) * self.width_px
        return math.ceil(SPREADS * self.along_px + beside) + 2

    @property
    def by(self) -> int:
        """By how much the picture is reduced at which it looks."""
        return next((by for by in REDUCED if self.across_px > by * NARROWEST_PX), 1)

    def reduced(self, by: int) -> Slit:
        """The same on a picture reduced by as much, which softens it."""
        softened_px2 = SOFTENED_BY * (by**2 - 1)
        along, across = (math.sqrt(px**2 - softened_px2) / by for px in self[:2])
        return Slit(along, across, self.width_px / by)


class Averaged(NamedTuple):
    """A sheet seen through the slit: its darkness, that as it was drawn, and what to tell."""

    darkness: Darkness
    drawn: Darkness
    note: str


def slit_for(grain: float, width_px: float, pitch_mm: float) -> Slit | None:
    """The slit that lines of a grain and width ask for; None without grain, and for too thin lines."""
    if not (grain > LEAST_OF_SOME and width_px > coarse.FEWEST_PX):
        return None
    along_px = max(ALONG_MM / pitch_mm, ALONG_WIDTHS * width_px)
    return Slit(along_px, max(ACROSS_WIDTHS * width_px, 0.5), width_px)


def reach_mm(width_mm: float) -> float:
    """How far from a corner the slit for lines of a width rounds them, mm: two of its standard deviations."""
    return 2 * max(ALONG_MM, ALONG_WIDTHS * width_mm)


def _note(slit: Slit, pitch_mm: float) -> str:
    """What the operator should know of a sheet that is seen through the slit."""
    long_mm = 2 * slit.along_px * pitch_mm
    return (
        f"the lines have grain, as of a pencil: they are averaged over {long_mm:.1f} mm along each line, "
        "and corners may be off by some 0.1 mm; lines that are inked over are followed more exactly"
    )


def notes_of_few_pixels(lines: Within, drawn_grain: float, pitch_mm: float) -> tuple[str, ...]:
    """What the operator should know of lines that are few pixels wide, with grain or without."""
    if lines.seen_px < coarse.SEEN_PX:
        return (coarse.note(lines.seen_px, pitch_mm),)
    if not drawn_grain > LEAST_GRAIN or lines.width_px > coarse.FEWEST_PX:
        return ()
    return (
        f"the lines have grain, as of a pencil, and are fewer than {coarse.FEWEST_PX:g} pixels wide, so that "
        "it is not averaged: the path strays by up to a line's width; scan at "
        f"{coarse.finer_dpi(pitch_mm, ENOUGH_TIMES)} dpi, or ink the lines over",
    )


def behind(slit: Slit, darkness: Darkness) -> Darkness:
    """The darkness of a sheet as the slit sees it, tile by tile; paper without ink stays as it is."""
    seen, by = darkness.copy(), slit.by
    halo = by * math.ceil(slit.halo_px / by)
    rows, columns = darkness.shape
    for top in range(0, rows, TILE_PX):
        for left in range(0, columns, TILE_PX):
            first = max(0, top - halo), max(0, left - halo)
            around = darkness[first[0] : top + TILE_PX + halo, first[1] : left + TILE_PX + halo]
            if cv2.GaussianBlur(around, (0, 0), 1.0).max() > PAPER:
                own = np.s_[top - first[0] :, left - first[1] :]
                part = seen[top : top + TILE_PX, left : left + TILE_PX]
                part[:] = _reduced_tile(slit, around, by)[own][: part.shape[0], : part.shape[1]]
    return seen


def averaged(
    darkness: Kept, drawn_grain: float, width_px: float, pitch_mm: float
) -> Averaged | None:
    """The sheet as seen through the slit, where lines of a grain and width ask for it and it mends them."""
    slit = slit_for(drawn_grain, width_px, pitch_mm)
    if slit is None:
        return None
    drawn = np.asarray(darkness)
    seen = behind(slit, drawn)
    if not mends(drawn, seen, drawn_grain):
        return None
    return Averaged(seen, drawn, _note(slit, pitch_mm))


def mends(before: Darkness, after: Darkness, grain: float) -> bool:
    """Whether the ink of a sheet hangs together as well behind the slit as before; far better, if only some
    of its strokes have grain.

    Grain parts a line, and the slit joins it. Where it parts more than it joins, strokes are pressed harder
    and softer, or bend tighter than the slit is long; that is no grain.
    """
    share = 1.0 if grain > LEAST_GRAIN else JOINED
    return _pieces(after) <= share * _pieces(before)


def _pieces(darkness: Darkness) -> int:
    """How many pieces the ink is in."""
    soft = cv2.GaussianBlur(darkness, (0, 0), SOFTENED_PX)
    return int(cv2.connectedComponents((soft > INK).view(np.uint8), connectivity=8)[0])


def _reduced_tile(slit: Slit, darkness: Darkness, by: int) -> Darkness:
    """The darkness of a tile as the slit sees it at the picture reduced by as much."""
    if by == 1:
        return _tile(slit, darkness)
    down, right = (-size % by for size in darkness.shape)
    whole = cv2.copyMakeBorder(darkness, 0, down, 0, right, cv2.BORDER_REPLICATE)
    size = whole.shape[1] // by, whole.shape[0] // by
    small = cv2.resize(whole, size, interpolation=cv2.INTER_AREA)
    seen = _tile(slit.reduced(by), np.asarray(small, np.float32))
    return np.asarray(cv2.resize(seen, whole.shape[::-1], interpolation=cv2.INTER_LINEAR))


def _tile(slit: Slit, darkness: Darkness) -> Darkness:
    """The darkness of a tile as the slit sees it in the direction that fits best."""
    best = np.full(darkness.shape, -np.inf, np.float32)
    seen = np.zeros_like(darkness)
    near = disc(round(REACH_WIDTHS * slit.width_px))
    for k in range(DIRECTIONS):
        direction = math.pi * k / DIRECTIONS
        through = cv2.filter2D(
            darkness, cv2.CV_32F, _kernel(slit, direction), borderType=cv2.BORDER_REPLICATE
        )
        fit = cv2.dilate(_fit(slit, direction, np.asarray(through, np.float32)), near)
        cv2.copyTo(through, cv2.compare(fit, best, cv2.CMP_GT), seen)
        cv2.max(fit, best, best)
    return seen


def _kernel(slit: Slit, direction: float) -> NDArray[np.float32]:
    """Weights of the slit in a direction (rad from the columns, downwards); their sum is 1."""
    half = math.ceil(SPREADS * slit.along_px) + 1
    down, right = np.mgrid[-half : half + 1, -half : half + 1].astype(float)
    along = right * math.cos(direction) + down * math.sin(direction)
    across = down * math.cos(direction) - right * math.sin(direction)
    weights = np.exp(-0.5 * ((along / slit.along_px) ** 2 + (across / slit.across_px) ** 2))
    return np.asarray(weights / weights.sum(), np.float32)


def _fit(slit: Slit, direction: float, through: Darkness) -> Darkness:
    """How much more the slit sees than its flanks."""
    smooth = np.asarray(
        cv2.GaussianBlur(through, (0, 0), SMOOTH_WIDTHS * slit.width_px), np.float32
    )
    aside = FLANK_WIDTHS * slit.width_px
    right, down = -aside * math.sin(direction), aside * math.cos(direction)
    to_left, to_right = (
        cv2.warpAffine(
            smooth,
            np.array([[1.0, 0.0, side * right], [0.0, 1.0, side * down]]),
            smooth.shape[::-1],
            borderMode=cv2.BORDER_REPLICATE,
        )
        for side in (-1, 1)
    )
    flanks = cv2.add(to_left, to_right)
    return np.asarray(cv2.scaleAdd(flanks, -0.5, smooth), np.float32)
