"""Profiles across the lines of a drawing: how dark the sheet is square to single lines, all over it.

Signals: darkness (0 paper, 1 ink) on pixels in; profiles (n, k) at distances (k,) px from the middles of
lines out.

Some rows and columns of the sheet are searched for ink. Profiles are taken across the ink, square to its
edges; those with paper on both sides count.

Source: our own.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import median
from morfax.motion.plane import left_of, unit
from morfax.tracer.drawing.between import between, between_at
from morfax.tracer.drawing.blocks import runs_in
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.tiles import Kept, Tiles
from morfax.tracer.limits import DETAIL_PX, PAPER

SEARCHED = 1 << 18  # pixels of the rows that are searched for ink, and of the columns
MOST_PROFILES = 1000  # their median is 25 times as certain as one profile
FEWEST_PROFILES = 20  # fewer tell nothing: there is hardly a line
STEP_PX = 0.5  # between the samples of a profile: edges are no sharper than a pixel
SLOPE_PX = 1.5  # to both sides of an edge, for its direction
# darkness per pixel: where many are flatter at both edges, they are lines of a pixel that no lens has
# softened, beyond which both places lie on paper; they are nearer there. A soft line of that width has 0.3
FLAT, THIN_PX = 0.1, 0.75
# of all places: the rows that meet a sloping line of hard pixels are so and the columns are not, or the other
# way about (0.45 to 0.63 of all); on other scans 0.12 at most
HARD_SHARE = 0.25
OBLIQUE = 0.5  # cosine: a row or column that meets a line flatter than 60 degrees is left out
GOLDEN = (math.sqrt(5) - 1) / 2  # its multiples fill the pixel evenly


class Profiles(NamedTuple):
    """Profiles across lines: darkness (n, k) at distances (k,) px from their middles, the middles (n, 2) row
    and column, the unit vectors (n, 2) across, and how dark the paper beside them is in the mean: its 0 is
    the level of its lighter pixels (see `levelling`). `single` is the share of the places looked at that
    have a single line.
    """

    seen: Array
    at_px: Array
    middles: Array
    across: Array
    paper: float
    single: float

    @property
    def width_px(self) -> float:
        """How wide the lines usually look where a row or column meets them."""
        return float(-self.at_px[0]) - DETAIL_PX


def profiles_of(darkness: Kept) -> Profiles | None:
    """Profiles across the lines; None if there are too few."""
    crossings = [_runs(darkness, across) for across in (False, True)]
    # (n, row or column, begin or end)
    places = np.vstack([crossings[0], crossings[1][:, ::-1, :]])
    places = places[_even(len(places))]
    if len(places) < FEWEST_PROFILES:
        return None
    # 1. square to the edges that the row or column has met
    ends = [_slope(darkness, places[:, :, k]) for k in (0, 1)]
    thin = np.hypot(*(ends[0] - ends[1]).T) < FLAT
    if np.mean(thin) > HARD_SHARE:
        for k in (0, 1):
            ends[k][thin] = _slope(darkness, places[thin, :, k], THIN_PX)
    across = unit(ends[0] - ends[1])
    met = places[:, :, 1] - places[:, :, 0]
    length_px = np.hypot(*met.T)
    facing = np.abs(np.sum(met * across, axis=1)) / length_px
    # 2. as long as the usual width asks for
    widths_px = length_px * facing
    steep = facing > OBLIQUE
    if np.count_nonzero(steep) < FEWEST_PROFILES:
        return None
    half_px = median(widths_px[steep]) + DETAIL_PX
    at_px = np.arange(-half_px, half_px, STEP_PX)
    # a place anywhere between two pixels of the line, not always on a row: so noise is averaged alike
    share = np.arange(len(places)) * GOLDEN % 1.0 - 0.5
    middles = places.mean(axis=2) - share[:, None] * left_of(across)
    seen = seen_across(darkness, middles, across, at_px)
    # 3. with one line in the middle and paper beside it
    outside = np.abs(at_px) > 0.75 * half_px
    alone = np.all(_smooth(seen)[:, outside] < PAPER, axis=1) & (seen[:, len(at_px) // 2] > INK)
    good = steep & alone
    if np.count_nonzero(good) < FEWEST_PROFILES:
        return None
    seen = seen[good]
    paper = median(seen[:, outside].ravel())
    single = float(np.mean(good))
    found = Profiles(_own(seen, paper), at_px, middles[good], across[good], paper, single)
    # of a pattern or a damaged picture: what is dark in them is not in their middle
    is_line = median(middle_of(found)) > 0 and median(seen.sum(axis=1)) > 0
    return found if is_line else None


def _runs(darkness: Kept, across: bool) -> Array:
    """Runs of ink in some of the rows, (n, 2, 2): row and column of their first and last edges; or in some of
    the columns, which then stand for rows.
    """
    every = max(1, darkness.size // SEARCHED)
    long, wide = darkness.shape[::-1] if across else darkness.shape
    some, inner = slice(every // 2, long, every), slice(1, wide - 1)
    lines = _part(darkness, inner, some).T if across else _part(darkness, some, inner)
    row, begin, end = runs_in(lines, INK)
    rows = np.arange(every // 2, long, every)
    edges = [np.column_stack([rows[row], at + 0.5]) for at in (begin, end)]
    return np.stack(edges, axis=2)


def _part(darkness: Kept, rows: slice, columns: slice) -> Any:
    """Some rows and columns of the sheet, a step apart."""
    if not isinstance(darkness, Tiles):
        return darkness[rows, columns]
    down, along = (
        np.arange(*part.indices(side))
        for part, side in zip((rows, columns), darkness.shape, strict=True)
    )
    return darkness.at(*np.ix_(down, along))


def _even(count: int) -> NDArray[np.int64]:
    """Numbers of at most `MOST_PROFILES` of so many, all over them."""
    numbers = np.linspace(0, max(count - 1, 0), min(count, MOST_PROFILES)).astype(int)
    return numbers[np.diff(numbers, prepend=-1) > 0]


def _slope(darkness: Kept, places: Array, reach_px: float = SLOPE_PX) -> Array:
    """How much darker it gets per pixel down and to the right at places (n, 2), felt so far to both sides."""
    sides = reach_px * np.eye(2)
    steps = [
        seen_at(darkness, (places + d).T) - seen_at(darkness, (places - d).T) for d in sides
    ]
    return np.column_stack(steps) / (2 * reach_px)


def seen_at(darkness: Kept, places: Array) -> Array:
    """Darkness between pixels: places (2, n) or (n, 2, k), rows and columns."""
    return between(darkness, *np.moveaxis(places, -2, 0), edge_goes_on=True)


def seen_across(darkness: Kept, middles: Array, across: Array, at_px: Array) -> Array:
    """The same at distances (k,) px from places (n, 2) along unit vectors (n, 2); (n, k)."""
    if isinstance(darkness, Tiles):
        return seen_at(darkness, middles[:, :, None] + across[:, :, None] * at_px)
    places = np.empty((len(middles), len(at_px), 2))
    _spread_out(middles, across, at_px, places)
    return between_at(darkness, places, edge_goes_on=True)


@njit(cache=True)
def _spread_out(middles, across, at_px, places):  # type: ignore[no-untyped-def]
    """Fill in the places at some distances from others along unit vectors."""
    for n in range(len(middles)):
        for k in range(len(at_px)):
            for axis in range(2):
                places[n, k, axis] = middles[n, axis] + across[n, axis] * at_px[k]


def _own(seen: Array, paper: float) -> Array:
    """Profiles without the ink of a line that runs close beside: paper beyond the palest place between."""
    middle, own = seen.shape[1] // 2, seen.copy()
    for side in (own[:, middle:], own[:, middle::-1]):  # from the middle outwards
        left = np.maximum.accumulate(side < INK, axis=1)  # the own line
        again = left & (side > INK)
        for k in np.flatnonzero(again.any(axis=1)):
            first, next_line = int(np.argmax(left[k])), int(np.argmax(again[k]))
            side[k, first + int(np.argmin(side[k, first:next_line])) :] = paper
    return own


def _smooth(seen: Array) -> Array:
    """Profiles averaged over two pixels: noise is no ink beside the line."""
    kernel = round(2 / STEP_PX)
    sums = np.cumsum(np.pad(seen, ((0, 0), (kernel, 0)), mode="edge"), axis=1)
    return (sums[:, kernel:] - sums[:, :-kernel]) / kernel


def middle_of(profiles: Profiles) -> Array:
    """Darkness in the middle of each profile's own ink, (n,)."""
    dark = np.maximum(profiles.seen, 0.0)
    middle_px = dark @ profiles.at_px / dark.sum(axis=1)
    index = np.round((middle_px - profiles.at_px[0]) / STEP_PX).astype(int)
    return np.asarray(profiles.seen[np.arange(len(index)), index])
