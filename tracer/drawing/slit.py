"""The slit: what an aperture as long as a line is straight sees of a sheet, turned along the line everywhere.

Signals: darkness of a sheet (0 paper, 1 ink) in; the same behind the slit out, in the direction that fits
best:

    ════▓▓▓▓▓▓▓▓▓═══       slit  s_along = 0.4 mm or 0.8 widths   (standard deviations of a normal weight)
                                 s_across = 0.1 widths
         flanks, a width to each side, tell the line's direction:

    fit(k)  = slit(k) - ½ · (slit(k) one width to the left + one width to the right)
    seen    = slit(k) of the direction k that fits best within 0.6 widths

A slit across the line fits nowhere, as its flanks lie on the line too. Without them the line would get a halo
as wide as the slit is long.

What a slit some pixels wide sees is smooth: it looks at a picture reduced by as much, and what that and the
way back soften is taken off its width. The direction of a finer one, and what paper looks like, is told by a
picture of as few pixels as tell it; about ink the slit looks at the picture itself.

Source: our own; filters matched to a direction are the textbook's way (S. Chaudhuri and others, 1989, blood
vessels in fundus images). Questions: ends of lines stay where they are (half of the slit is on paper there),
and a corner is rounded by some 0.1 mm, which `program.laid.grain_corners` mends.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.discs import disc
from morfax.tracer.effort import FEW_PX
from morfax.tracer.limits import PAPER

Darkness = NDArray[np.float32]

# Chosen by trial on `python -m benchmarks pencil`.
FLANK_WIDTHS = 1.0  # from the slit to each of its flanks
SMOOTH_WIDTHS = 0.3  # over which a fit is averaged
REACH_WIDTHS = 0.6  # so far around a place the best fit counts: just over the line's edge
DIRECTIONS = 16
SPREADS = 2.5  # standard deviations of the slit: its weight beyond that is 1 %
TILE_PX = math.isqrt(FEW_PX)
FINEST_PX = 0.5  # across a slit, standard deviation
# a slit that is as wide on a picture reduced by one of these, standard deviation, looks at that
REDUCED, NARROWEST_PX = (8, 4, 2), 1.0
# px²: variance of means of pixels, 1/12, and of interpolation between them, 1/6
SOFTENED_BY = 1 / 4
# of a line's width tell its direction; a picture that is less than half as fine is not worth the way back,
# and held small rings and zigzags together that the slit takes apart
TELL_PX = 2.2
LEAST_WEIGHT = 0.01  # of the slit's largest: what weighs less is left out, as beyond `SPREADS`


class Slit(NamedTuple):
    """The slit: standard deviations along and across the line, and the line's width, pixels."""

    along_px: float
    across_px: float
    width_px: float

    @property
    def half_px(self) -> int:
        """How far its weights reach."""
        return math.ceil(SPREADS * self.along_px) + 1

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

    def scaled(self, by: float) -> Slit:
        """The same on a picture with as much fewer pixels across."""
        return Slit(*(px / by for px in self))


class BestSeen(NamedTuple):
    """What a slit sees of a tile in the direction that fits best, and the number of that direction."""

    darkness: Darkness
    direction: NDArray[np.uint8]


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
                part[:] = _tile(slit, around)[own][: part.shape[0], : part.shape[1]]
    return seen


def _tile(slit: Slit, darkness: Darkness) -> Darkness:
    """The darkness of a tile as the slit sees it."""
    by, shape = slit.by, darkness.shape
    if by > 1:
        seen = _best(slit.reduced(by), _reduced(darkness, by)).darkness
        whole = _enlarged(seen, (len(seen) * by, seen.shape[1] * by))
        return whole[: shape[0], : shape[1]]
    coarser = slit.width_px / TELL_PX
    if coarser < 2:
        return _best(slit, darkness).darkness
    size = round(shape[1] / coarser), round(shape[0] / coarser)
    small = np.asarray(cv2.resize(darkness, size, interpolation=cv2.INTER_AREA), np.float32)
    return _about_ink(slit, darkness, _best(slit.scaled(coarser), small, shape))


def _best(slit: Slit, darkness: Darkness, shape: tuple[int, ...] | None = None) -> BestSeen:
    """What the slit sees of a picture, which is enlarged to so many rows and columns before directions are
    compared.
    """
    shape = shape or darkness.shape
    best = np.full(shape, -np.inf, np.float32)
    seen = BestSeen(np.zeros(shape, np.float32), np.zeros(shape, np.uint8))
    near = disc(round(REACH_WIDTHS * slit.width_px * shape[0] / len(darkness)))
    for k in range(DIRECTIONS):
        through = np.asarray(
            cv2.filter2D(
                darkness,
                cv2.CV_32F,
                _kernel(slit, _heading(k)),
                borderType=cv2.BORDER_REPLICATE,
            ),
            np.float32,
        )
        fit = cv2.dilate(_enlarged(_fit(slit, _heading(k), through), shape), near)
        _keep_better(k, fit, _enlarged(through, shape), best, *seen)
    return seen


def _about_ink(slit: Slit, darkness: Darkness, rough: BestSeen) -> Darkness:
    """The darkness that was seen roughly, and about its ink what the slit sees in the same directions."""
    ink = (rough.darkness > PAPER).view(np.uint8)
    row, column = np.nonzero(cv2.dilate(ink, disc(math.ceil(slit.width_px))))
    padded = cv2.copyMakeBorder(darkness, *(slit.half_px,) * 4, cv2.BORDER_REPLICATE)
    exact = np.empty(len(row), np.float32)
    _see(padded, row, column, rough.direction[row, column], *_weights(slit), exact)
    seen = rough.darkness
    seen[row, column] = exact
    return seen


def _reduced(darkness: Darkness, by: int) -> Darkness:
    """A picture whose pixels are the means of so many times so many; the last ones may go on beyond it."""
    down, right = (-size % by for size in darkness.shape)
    whole = cv2.copyMakeBorder(darkness, 0, down, 0, right, cv2.BORDER_REPLICATE)
    size = whole.shape[1] // by, whole.shape[0] // by
    return np.asarray(cv2.resize(whole, size, interpolation=cv2.INTER_AREA), np.float32)


def _enlarged(darkness: Darkness, shape: tuple[int, ...]) -> Darkness:
    """A reduced picture as large as it was: so many rows and columns."""
    if darkness.shape == shape:
        return darkness
    return np.asarray(cv2.resize(darkness, shape[::-1], interpolation=cv2.INTER_LINEAR))


def _heading(k: int) -> float:
    """One of the directions, rad from the columns, downwards."""
    return math.pi * k / DIRECTIONS


@lru_cache(
    maxsize=2 * DIRECTIONS
)  # of the slit and of its coarser one; all tiles take the same
def _kernel(slit: Slit, direction: float) -> NDArray[np.float32]:
    """Weights of the slit in a direction (rad from the columns, downwards); their sum is 1."""
    half = slit.half_px
    down, right = np.mgrid[-half : half + 1, -half : half + 1].astype(float)
    along = right * math.cos(direction) + down * math.sin(direction)
    across = down * math.cos(direction) - right * math.sin(direction)
    weights = np.exp(-0.5 * ((along / slit.along_px) ** 2 + (across / slit.across_px) ** 2))
    return np.asarray(weights / weights.sum(), np.float32)


@lru_cache(maxsize=1)
def _weights(slit: Slit) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]]:
    """The weights of each direction that count, (directions, m), and where they are in its kernel: down and
    to the right; the last ones of a direction with fewer weigh nothing.
    """
    kernels = np.array([_kernel(slit, _heading(k)) for k in range(DIRECTIONS)])
    kernels[kernels < LEAST_WEIGHT * kernels.max(axis=(1, 2), keepdims=True)] = 0.0
    kernels /= kernels.sum(axis=(1, 2), keepdims=True)
    flat = kernels.reshape(DIRECTIONS, -1)
    most = int(np.count_nonzero(flat, axis=1).max())
    heaviest = np.sort(np.argsort(-flat, axis=1, kind="stable")[:, :most], axis=1)
    down, right = np.divmod(heaviest, kernels.shape[2])
    return down, right, np.take_along_axis(flat, heaviest, axis=1)


@njit(cache=True, nogil=True, _nrt=False)
def _keep_better(k, fit, through, best, seen, direction):  # type: ignore[no-untyped-def]
    """Take what is seen in direction k where that fits better than the best before it."""
    for i in range(fit.shape[0]):
        for j in range(fit.shape[1]):
            if fit[i, j] > best[i, j]:
                best[i, j], seen[i, j], direction[i, j] = fit[i, j], through[i, j], k


@njit(cache=True, nogil=True, _nrt=False)
def _see(padded, row, column, direction, down, right, weights, seen):  # type: ignore[no-untyped-def]
    """Fill in the weighted sums about pixels (n,) of a picture with a margin as wide as the weights reach."""
    for n in range(len(row)):
        k, total = direction[n], np.float32(0.0)
        for m in range(weights.shape[1]):
            total += weights[k, m] * padded[row[n] + down[k, m], column[n] + right[k, m]]
        seen[n] = total


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
