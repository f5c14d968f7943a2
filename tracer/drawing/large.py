"""Large sheets: the paper of a picture that is read by rows is levelled, and tiles with ink are kept.

Signals: rows of a grey picture (0..255, from the top), read more than once, in; the darkness in tiles out,
and where filled shapes are.

1. one look at all rows: means of squares, from which the paper follows; of each tile its lightest and
   darkest pixel
2. tiles in which something is darker than the paper, and their neighbours where it comes near them
3. their contrast against the paper, in grey levels; the ink's is that of the longer strokes

Source: our own. Questions: the paper is that of `paper`, and the ink's contrast that of `drawing`, but for
the noise of softened paper: it is taken for that of white noise.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.motion.median import MIDDLE, ONE_ABOVE
from morfax.tracer.drawing.components import FRINGE_PX, Patches, runs_of
from morfax.tracer.drawing.contrast import (
    ABOVE_NOISE,
    DARKER,
    LEAST_CONTRAST,
    SOFT_PX,
    strokes_of,
)
from morfax.tracer.drawing.levelling import Levelled
from morfax.tracer.drawing.memory import make_sure_of_ink
from morfax.tracer.drawing.paper import Paper
from morfax.tracer.drawing.paper_noise import paper_noise
from morfax.tracer.drawing.polarity import Polarity
from morfax.tracer.drawing.tiles import PAPER, TILE_PX, Tiles
from morfax.tracer.effort import FEW_PX

# pixels: A3 at 600 dpi is the first; smaller sheets are kept as a whole, in floats
LARGE_PX = 1 << 26
SOFTENED = 1 / (2 * math.sqrt(math.pi) * SOFT_PX)  # of white noise, behind that spot
HALO_PX = 8  # rows about a band that a spot sees

Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class _Look:
    """The first look at a picture: means of squares, of each tile the least and the largest level, and some
    of the pixels, every so many rows and columns.
    """

    reduced: NDArray[np.float32]
    least: Bytes
    largest: Bytes
    sample: Bytes
    every: int


def levelled(grey: Any, pitch_mm: float, known: Polarity | None = None) -> Levelled:
    """Darkness of a grey picture whose rows can be read, of a polarity if it is known: paper 0, the strokes
    1; filled shapes; and the noise of the paper.

    Raises DrawingFault if nothing is long and dark enough to be a line, or the ink does not fit into memory.
    """
    by = Paper.by(pitch_mm)
    look = _look(grey, by)
    paper = Paper.of_reduced(look.reduced, by, grey.shape[1], pitch_mm, known)
    sample = _sample(look, paper)
    centre, darker = (float(v) for v in np.percentile(sample, [MIDDLE, ONE_ABOVE]))
    noise = darker - centre  # by the darker ones: scanners clip the white
    marked = _inked(grey, look, paper, max(LEAST_CONTRAST, centre + ABOVE_NOISE * noise))
    inked_px = TILE_PX**2 * int(np.count_nonzero(marked != PAPER))
    make_sure_of_ink(inked_px, grey.shape[0] * grey.shape[1])
    tiles = _kept(grey, paper, marked)
    ink = _ink_contrast(
        tiles, max(LEAST_CONTRAST, centre + ABOVE_NOISE * SOFTENED * noise), pitch_mm
    )
    noise_of_paper = paper_noise(sample / np.float32(ink))
    shapes = paper.shapes(ink)
    kept, has_shapes = replace(tiles, unit=1 / ink), bool(shapes.any())
    return Levelled(kept, shapes, noise_of_paper, has_shapes, paper.polarity)


def _look(grey: Any, by: int) -> _Look:
    """The first look."""
    rows, columns = grey.shape
    across = -(-columns // TILE_PX) * TILE_PX
    reduced = np.empty((-(-rows // by), -(-columns // by)), np.float32)
    least = np.empty((-(-rows // TILE_PX), across // TILE_PX), np.uint8)
    largest, samples = np.empty_like(least), list[Bytes]()
    every = max(1, math.isqrt(rows * columns // FEW_PX))
    height = by * TILE_PX
    for top in range(0, rows, height):
        part = _rows(grey, top, min(rows, top + height))
        _means(part, by, reduced[top // by : -(-(top + len(part)) // by)])
        for up in range(0, len(part), TILE_PX):
            tile, some = (top + up) // TILE_PX, part[up : up + TILE_PX]
            for out, found in ((least, some.min(axis=0)), (largest, some.max(axis=0))):
                wide = np.pad(found, (0, across - columns), mode="edge").reshape(-1, TILE_PX)
                out[tile] = (wide.min if out is least else wide.max)(axis=1)
        samples.append(part[-top % every :: every, every // 2 :: every].copy())
    return _Look(reduced, least, largest, np.concatenate(samples), every)


def _rows(grey: Any, top: int, bottom: int) -> Bytes:
    """Some rows as bytes."""
    part = grey[top:bottom]
    if part.dtype == np.uint8:
        return np.ascontiguousarray(part)
    return np.clip(np.rint(part), 0, 255).astype(np.uint8)


def _sample(look: _Look, paper: Paper) -> NDArray[np.float32]:
    """Contrast of some of the pixels against the paper, grey levels."""
    rows, columns = look.sample.shape
    i = np.arange(rows) * look.every // paper.by_px
    j = (np.arange(columns) * look.every + look.every // 2) // paper.by_px
    away = paper.reduced[np.ix_(i, j)] - look.sample
    return np.asarray(away if paper.is_light else -away, np.float32)


def _inked(grey: Any, look: _Look, paper: Paper, least: float) -> NDArray[np.int32]:
    """Of each tile 0 where something is darker than the paper by this much, or near it; -1 elsewhere."""
    # 1. tiles in which that may be
    ground = _Ground.of(paper)
    levels = look.least if paper.is_light else look.largest
    span = 2 * (TILE_PX // paper.by_px // 2 + 1) + 1
    spread = (cv2.dilate if paper.is_light else cv2.erode)(
        paper.reduced, np.ones((span, span), np.uint8)
    )
    middle = [
        np.minimum((np.arange(n) * TILE_PX + TILE_PX // 2) // paper.by_px, size - 1)
        for n, size in zip(levels.shape, paper.reduced.shape, strict=True)
    ]
    may_be = ground.sign * (spread[np.ix_(*middle)] - levels) > least
    # 2. where it is
    marked = np.full(levels.shape, PAPER, np.int32)
    for up in np.flatnonzero(may_be.any(axis=1)).tolist():
        part = _rows(grey, up * TILE_PX, min(len(grey), (up + 1) * TILE_PX))
        _mark(part, up, ground, least, may_be[up], marked)
    return marked


def _kept(grey: Any, paper: Paper, marked: NDArray[np.int32]) -> Tiles:
    """The contrast of the tiles that are marked, numbered from 0."""
    number = np.where(
        marked == PAPER, PAPER, np.cumsum(marked != PAPER).reshape(marked.shape) - 1
    )
    number = number.astype(np.int32)
    kept = np.zeros((int(number.max()) + 1, TILE_PX, TILE_PX), np.uint8)
    ground = _Ground.of(paper)
    for up in np.flatnonzero((number != PAPER).any(axis=1)).tolist():
        part = _rows(grey, up * TILE_PX, min(len(grey), (up + 1) * TILE_PX))
        _fill(part, up, ground, number[up], kept)
    rows, columns = grey.shape
    return Tiles((rows, columns), number, kept, 1.0)


def softened(tiles: Tiles, spot_px: float) -> Iterator[tuple[int, int, Any]]:
    """The bands with ink behind a spot (standard deviation): first row, first column, and the picture."""
    for top, bottom, columns in tiles.bands():
        yield top, columns.start, soft(tiles, spot_px, (top, bottom), columns)


def soft(tiles: Tiles, spot_px: float, rows: tuple[int, int], columns: slice) -> Any:
    """Some rows of some columns behind a spot (standard deviation)."""
    top, bottom = rows
    above, below = max(0, top - HALO_PX), min(tiles.shape[0], bottom + HALO_PX)
    seen = cv2.GaussianBlur(tiles[above:below, columns], (0, 0), spot_px)
    return seen[top - above : bottom - above]


def runs_darker(tiles: Tiles, spot_px: float, least: float) -> Iterator[tuple[Any, Any, Any]]:
    """The runs of what is darker than this behind a spot, from the top."""
    yield runs_of(np.zeros((1, 1), bool), 0)
    for top, left, seen in softened(tiles, spot_px):
        row, begin, end = runs_of(seen > least, top)
        yield row, begin + np.int32(left), end + np.int32(left)


def _ink_contrast(tiles: Tiles, least: float, pitch_mm: float) -> float:
    """Contrast of the strokes against the paper, grey levels: that of the longer strokes' darker part."""
    patches = Patches.of(runs_darker(tiles, SOFT_PX, least))
    strokes = strokes_of(patches, least, pitch_mm)
    every = max(1, int(patches.areas[strokes].sum()) // FEW_PX)
    inked = []
    for top, bottom, columns in tiles.bands():
        mask = patches.painted(strokes, top, bottom, columns.start, columns.stop).view(bool)
        inked.append(tiles[top:bottom, columns][mask][::every])
    return float(np.percentile(np.concatenate(inked), DARKER))


@njit(cache=True)
def _means(part, by, out):  # type: ignore[no-untyped-def]
    """The mean of each square of `by` pixels, of as many of them as there are."""
    rows, columns = part.shape
    sums = np.empty(columns, np.uint32)
    for i in range(len(out)):
        high = min(by, rows - i * by)
        sums[:] = 0
        for a in range(high):
            for j in range(columns):
                sums[j] += part[i * by + a, j]
        for k in range(out.shape[1]):
            wide = min(by, columns - k * by)
            total = 0
            for b in range(wide):
                total += sums[k * by + b]
            out[i, k] = total / (high * wide)


class _Ground(NamedTuple):
    """The paper's levels in squares of so many pixels, and the sign of what is darker than it."""

    reduced: NDArray[np.float32]
    by_px: int
    sign: float

    @classmethod
    def of(cls, paper: Paper) -> _Ground:
        """That of a paper, dark on light or light on dark."""
        return cls(paper.reduced, paper.by_px, 1.0 if paper.is_light else -1.0)


@njit(cache=True)
def _contrast(ground, row, column, level):  # type: ignore[no-untyped-def]
    """By how much a level is darker than the paper at a pixel, linear between the middles of the squares."""
    reduced, by = ground.reduced, ground.by_px
    y = min(max((row + 0.5) / by - 0.5, 0.0), reduced.shape[0] - 1.0)
    x = min(max((column + 0.5) / by - 0.5, 0.0), reduced.shape[1] - 1.0)
    i, j = min(int(y), reduced.shape[0] - 2), min(int(x), reduced.shape[1] - 2)
    down, along = y - i, x - j
    above = reduced[i, j] * (1 - along) + reduced[i, j + 1] * along
    below = reduced[i + 1, j] * (1 - along) + reduced[i + 1, j + 1] * along
    return ground.sign * (above * (1 - down) + below * down - level)


@njit(cache=True)
def _mark(part, up, ground, least, may_be, marked):  # type: ignore[no-untyped-def]
    """Mark those tiles of a row of tiles that have ink, and their neighbours where it comes near."""
    rows, columns = part.shape
    for along in range(len(may_be)):
        if not may_be[along]:
            continue
        for a in range(rows):
            for column in range(along * TILE_PX, min(columns, (along + 1) * TILE_PX)):
                if _contrast(ground, up * TILE_PX + a, column, part[a, column]) <= least:
                    continue
                b = column - along * TILE_PX
                above = -1 if a < FRINGE_PX else 0
                below = 1 if a >= TILE_PX - FRINGE_PX else 0
                left = -1 if b < FRINGE_PX else 0
                right = 1 if b >= TILE_PX - FRINGE_PX else 0
                for i in range(max(0, up + above), min(marked.shape[0], up + below + 1)):
                    for j in range(max(0, along + left), min(len(may_be), along + right + 1)):
                        marked[i, j] = 0


@njit(cache=True)
def _fill(part, up, ground, number, kept):  # type: ignore[no-untyped-def]
    """Fill the tiles of a row of tiles with their contrast against the paper."""
    rows, columns = part.shape
    for along in range(len(number)):
        tile = number[along]
        if tile < 0:
            continue
        for a in range(rows):
            for column in range(along * TILE_PX, min(columns, (along + 1) * TILE_PX)):
                away = _contrast(ground, up * TILE_PX + a, column, part[a, column])
                level = min(max(away, 0.0), 255.0)
                kept[tile, a, column - along * TILE_PX] = int(level + 0.5)
