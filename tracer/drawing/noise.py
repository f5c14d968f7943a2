"""The noise model of a drawing: how noisy its paper and ink are, how soft its edges, how wide its pen.

Signals: darkness (0 paper, 1 ink) on pixels in; standard deviations of darkness, softness and width (pixels,
mm) out.

Some rows and columns of the sheet are searched for ink. Profiles are taken across the ink, square to its
edges; those with paper on both sides count. A pen of width w and darkness a, seen through a lens of softness
s (standard deviation of its spot), leaves a profile D(u) with

    ∫ D du  = a · w                                                      whatever the softness
    D(0)    = a · erf(w / (√8 s))
    ∫ D² du = a² · (w · erf(w / 2s) - 2s/√π · (1 - exp(-w² / 4s²)))      a box's, less the two edges

from which a, w and s follow. Noise adds its variance to every D², and interpolation between pixels makes an
edge softer by a variance of 1/6 px²; both are taken off. A line that is less than four times as wide as soft
has no flat middle: its width is then true to some ten percent only.

Source: our own; the integrals are those of a box seen through a normal distribution. Questions: the softness
is that of the picture and contains its pixels (variance 1/12 px²); where several pens were used the width is
the median over the length of all lines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median, percentile
from morfax.tracer.drawing.between import between
from morfax.tracer.drawing.blocks import runs_in
from morfax.tracer.drawing.paper import ROBUST
from morfax.tracer.drawing.paper_noise import PAPER, of_sheet
from morfax.tracer.drawing.tiles import Kept, Tiles

INK = 0.5  # darker is ink
SEARCHED = 1 << 18  # pixels of the rows that are searched for ink, and of the columns
MOST_PROFILES = 1000  # their median is 25 times as certain as one profile
FEWEST_PROFILES = 20  # fewer tell nothing: there is hardly a line
STEP_PX = 0.5  # between the samples of a profile: edges are no sharper than a pixel
BESIDE_PX = 6.0  # of paper to each side of a profile, and half a width of the line
SLOPE_PX = 1.5  # to both sides of an edge, for its direction
# darkness per pixel: where many are flatter at both edges, they are lines of a pixel that no lens has
# softened, beyond which both places lie on paper; they are nearer there. A soft line of that width has 0.3
FLAT, THIN_PX = 0.1, 0.75
# of all places: the rows that meet a sloping line of hard pixels are so and the columns are not, or the other
# way about (0.45 to 0.63 of all); on other scans 0.12 at most
HARD_SHARE = 0.25
OBLIQUE = 0.5  # cosine: a row or column that meets a line flatter than 60 degrees is left out
GOLDEN = (math.sqrt(5) - 1) / 2  # its multiples fill the pixel evenly
RIGHT_ON_IT = 25.0  # percentile of how wide lines look: there a pixel lies right on the line
OUTLIERS = 3.0  # robust standard deviations
# darkness, softness and width settle to 1 % where a line is three times as wide as soft
ROUNDS = 20
# linear interpolation, over all places between pixels: variance of its kernel, share of white noise left
INTERPOLATED_PX2, INTERPOLATED_NOISE = 1 / 6, 4 / 9


@dataclass(frozen=True, slots=True)
class Noise:
    """What a drawing's picture is like; darkness is 0 for paper and 1 for ink. NaN without any line.

    `paper` and `ink` are standard deviations from pixel to pixel. `grain` is the standard deviation of the
    ink's darkness along the lines beyond that: pencil has it, ink does not. `softness` is the standard
    deviation of the spot that explains the edges, `width_mm` the pen's width.
    """

    paper: float
    ink: float
    grain: float
    softness_px: float
    softness_mm: float
    width_mm: float


class _Profiles(NamedTuple):
    """Profiles across lines: darkness (n, k) at distances (k,) px from their middles, the middles (n, 2) row
    and column, and the unit vectors (n, 2) across."""

    seen: Array
    at_px: Array
    middles: Array
    across: Array


def measured(darkness: Kept, pitch_mm: float, paper: float | None = None) -> Noise:
    """The noise of a drawing of darkness 0..1 on pixels of a pitch; `paper` is its paper's, where known."""
    paper = of_sheet(darkness) if paper is None else paper
    profiles = _profiles(darkness)
    if profiles is None:
        return Noise(paper, math.nan, math.nan, math.nan, math.nan, math.nan)
    ink, grain = _ink(darkness, profiles)
    softness_px, width_px = _pen(profiles, paper, ink)
    return Noise(paper, ink, grain, softness_px, softness_px * pitch_mm, width_px * pitch_mm)


class Within(NamedTuple):
    """The grain of the ink within single lines, the width of the pen, pixels, and how wide lines look.

    A line that is less wide than two pixels looks as wide as two, but where a pixel lies right on it: there
    `seen_px`, the ink across it over the darkness in its middle, goes on falling.
    """

    grain: float
    width_px: float
    seen_px: float


def within(darkness: Kept, paper: float | None = None) -> Within:
    """How even the ink of single lines is, and how wide they are; `paper` as `measured` has it.

    Other than `Noise.grain` it does not grow where lines of several pens differ: the ink is held against the
    ink of the same line a width farther on. NaN without any line.
    """
    profiles = _profiles(darkness)
    if profiles is None:
        return Within(math.nan, math.nan, math.nan)
    paper = of_sheet(darkness) if paper is None else paper
    middle = np.maximum(_middle(profiles), PAPER)
    looks_px = STEP_PX * profiles.seen.sum(axis=1) / middle
    seen_px = percentile(looks_px, RIGHT_ON_IT)
    width_px = _pen(profiles, paper, _ink(darkness, profiles)[0])[1]
    along = profiles.across[:, ::-1] * [1, -1]
    here = _seen(darkness, profiles.middles.T)
    there = _seen(darkness, (profiles.middles + width_px * along).T)
    on_line = there > PAPER * median(here)
    if np.count_nonzero(on_line) < FEWEST_PROFILES:
        return Within(math.nan, width_px, seen_px)
    differ = _spread((there - here)[on_line]) / math.sqrt(2)
    grain = math.sqrt(max(differ**2 - INTERPOLATED_NOISE * paper**2, 0.0))
    return Within(grain, width_px, seen_px)


def _spread(values: NDArray[Any]) -> float:
    """Standard deviation without outliers, of which there are few."""
    off = np.abs(values - median(values))
    near = values[off <= OUTLIERS * ROBUST * max(median(off), 1e-6)]
    return float(np.std(near, dtype=float))


# the profiles


def _profiles(darkness: Kept) -> _Profiles | None:
    """Profiles across the lines; None if there are too few."""
    crossings = [_runs(darkness, across) for across in (False, True)]
    places = np.vstack(
        [crossings[0], crossings[1][:, ::-1, :]]
    )  # (n, row or column, begin or end)
    places = places[_even(len(places))]
    if len(places) < FEWEST_PROFILES:
        return None
    # 1. square to the edges that the row or column has met
    ends = [_slope(darkness, places[:, :, k]) for k in (0, 1)]
    thin = np.hypot(*(ends[0] - ends[1]).T) < FLAT
    if np.mean(thin) > HARD_SHARE:
        for k in (0, 1):
            ends[k][thin] = _slope(darkness, places[thin, :, k], THIN_PX)
    across = ends[0] - ends[1]
    across /= np.maximum(np.hypot(*across.T), 1e-9)[:, None]
    met = places[:, :, 1] - places[:, :, 0]
    length_px = np.hypot(*met.T)
    facing = np.abs(np.sum(met * across, axis=1)) / length_px
    # 2. as long as the usual width asks for
    widths_px = length_px * facing
    steep = facing > OBLIQUE
    if np.count_nonzero(steep) < FEWEST_PROFILES:
        return None
    half_px = median(widths_px[steep]) + BESIDE_PX
    at_px = np.arange(-half_px, half_px, STEP_PX)
    # a place anywhere between two pixels of the line, not always on a row: so noise is averaged alike
    share = np.arange(len(places)) * GOLDEN % 1.0 - 0.5
    middles = places.mean(axis=2) + share[:, None] * across[:, ::-1] * [1, -1]
    seen = _seen(darkness, middles[:, :, None] + across[:, :, None] * at_px)
    # 3. with one line in the middle and paper beside it
    outside = np.abs(at_px) > 0.75 * half_px
    alone = np.all(_smooth(seen)[:, outside] < PAPER, axis=1) & (seen[:, len(at_px) // 2] > INK)
    good = steep & alone
    if np.count_nonzero(good) < FEWEST_PROFILES:
        return None
    found = _Profiles(seen[good], at_px, middles[good], across[good])
    # of a pattern or a damaged picture: what is dark in them is not in their middle
    is_line = median(_middle(found)) > 0 and median(seen[good].sum(axis=1)) > 0
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
    steps = [_seen(darkness, (places + d).T) - _seen(darkness, (places - d).T) for d in sides]
    return np.column_stack(steps) / (2 * reach_px)


def _seen(darkness: Kept, places: Array) -> Array:
    """Darkness between pixels: places (2, n) or (n, 2, k), rows and columns."""
    return between(darkness, *np.moveaxis(places, -2, 0), edge_goes_on=True)


def _smooth(seen: Array) -> Array:
    """Profiles averaged over two pixels: noise is no ink beside the line."""
    kernel = round(2 / STEP_PX)
    sums = np.cumsum(np.pad(seen, ((0, 0), (kernel, 0)), mode="edge"), axis=1)
    return (sums[:, kernel:] - sums[:, :-kernel]) / kernel


# what they say


def _ink(darkness: Kept, profiles: _Profiles) -> tuple[float, float]:
    """Standard deviations of the ink: from pixel to pixel, and along the lines beyond that."""
    # 1. neighbouring pixels along the line differ by the noise of two
    pixel = np.round(profiles.middles).astype(int)
    along = np.round(profiles.across[:, ::-1] * [1, -1]).astype(int)
    neighbour = np.clip(pixel + along, 0, np.array(darkness.shape) - 1)
    here, there = darkness[tuple(pixel.T)], darkness[tuple(neighbour.T)]
    ink = _spread((here - there).astype(float)) / math.sqrt(2)
    # 2. the middles of the lines, all over the sheet, differ by the grain and by what interpolation leaves
    middle = _middle(profiles)
    grain = math.sqrt(max(_spread(middle) ** 2 - INTERPOLATED_NOISE * ink**2, 0.0))
    return ink, grain


def _middle(profiles: _Profiles) -> Array:
    """Darkness in the middle of each profile's own ink, (n,)."""
    dark = np.maximum(profiles.seen, 0.0)
    middle_px = dark @ profiles.at_px / dark.sum(axis=1)
    index = np.round((middle_px - profiles.at_px[0]) / STEP_PX).astype(int)
    return np.asarray(profiles.seen[np.arange(len(index)), index])


def _pen(profiles: _Profiles, paper: float, ink: float) -> tuple[float, float]:
    """Softness and width, pixels."""
    seen, span_px = profiles.seen, STEP_PX * len(profiles.at_px)
    area, square = STEP_PX * seen.sum(axis=1), STEP_PX * (seen**2).sum(axis=1)
    peak = median(_middle(profiles))
    area_px, darkness = median(area), peak
    softness_px = width_px = 0.0
    for _ in range(ROUNDS):
        width_px = area_px / darkness
        in_noise = ink**2 * width_px + paper**2 * (span_px - width_px)
        lost = darkness * area - square + INTERPOLATED_NOISE * in_noise
        softness_px = _softness(median(lost) / darkness**2, width_px)
        darkness = peak / math.erf(width_px / (math.sqrt(8) * max(softness_px, 1e-3)))
    return math.sqrt(max(softness_px**2 - INTERPOLATED_PX2, 0.0)), width_px


def _softness(lost_px: float, width_px: float) -> float:
    """Softness (px) at which a line loses this part of ∫ D² to its edges: Newton's steps from a wide line."""
    softness = max(0.5 * math.sqrt(math.pi) * lost_px, 1e-3)
    for _ in range(8):
        x = width_px / (2 * softness)
        lost = width_px * (1 - math.erf(x)) + 2 * softness / math.sqrt(math.pi) * (
            1 - math.exp(-x * x)
        )
        slope = 2 / math.sqrt(math.pi) * (1 - math.exp(-x * x))
        softness = max(softness - (lost - lost_px) / max(slope, 0.1), 1e-3)
    return softness
