"""The noise model of a drawing: how noisy its paper and ink are, how soft its edges, how wide its pen.

Signals: darkness (0 paper, 1 ink) on pixels in; standard deviations of darkness, softness and width (pixels,
mm) out.

Profiles are taken across single lines (see `profiles`). A pen of width w and darkness a, seen through a lens
of softness s (standard deviation of its spot), leaves a profile D(u) with

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

from morfax.motion.median import OUTLIERS, ROBUST, median, percentile
from morfax.tracer.drawing.paper_noise import of_sheet
from morfax.tracer.drawing.profiles import (
    FEWEST_PROFILES,
    INK,
    STEP_PX,
    Profiles,
    middle_of,
    profiles_of,
    seen_across,
    seen_at,
)
from morfax.tracer.drawing.tiles import Kept
from morfax.tracer.limits import PAPER

RIGHT_ON_IT = 25.0  # percentile of how wide lines look: there a pixel lies right on the line
# of the grain is left in profiles that are put over each other, or more: pencils of 10 to 45 % grain have 0.6
# to 1.1 of it, two lines beside each other 0.15 to 0.3
LEFT_OF_GRAIN = 0.5
ASIDE_PX = 1.5  # to both sides profiles are put, as a line bends and its pixels lie
LEAST_AHEAD_PX = 4.0  # a lens leaves nothing alike of two places so far apart
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


class InPixels(NamedTuple):
    """The same in pixels, whatever their pitch is."""

    paper: float
    ink: float = math.nan
    grain: float = math.nan
    softness_px: float = math.nan
    width_px: float = math.nan

    @classmethod
    def of(cls, darkness: Kept, profiles: Profiles | None, paper: float | None) -> InPixels:
        """The noise that the profiles of a drawing show; `paper` is its paper's, where known."""
        paper = of_sheet(darkness) if paper is None else paper
        if profiles is None:
            return cls(paper)
        ink, grain = _ink(darkness, profiles)
        return cls(paper, ink, grain, *_pen(profiles, paper, ink))

    def noise(self, pitch_mm: float) -> Noise:
        """The same on pixels of a pitch."""
        soft, wide = self.softness_px, self.width_px
        return Noise(*self[:4], soft * pitch_mm, wide * pitch_mm)


def measured(darkness: Kept, pitch_mm: float, paper: float | None = None) -> Noise:
    """The noise of a drawing of darkness 0..1 on pixels of a pitch; `paper` is its paper's, where known."""
    return InPixels.of(darkness, profiles_of(darkness), paper).noise(pitch_mm)


class Within(NamedTuple):
    """The grain of the ink within single lines, how wide lines look, and the noise that they show.

    A line that is less wide than two pixels looks as wide as two, but where a pixel lies right on it: there
    `seen_px`, the ink across it over the darkness in its middle, goes on falling. `single` is the share of
    places on ink at which there is a single line.
    """

    grain: float
    seen_px: float
    found: InPixels
    single: float = 0.0

    @property
    def width_px(self) -> float:
        """The width of the pen."""
        return self.found.width_px


def within(darkness: Kept, paper: float | None = None) -> Within:
    """How even the ink of single lines is, and how wide they are; `paper` as `measured` has it.

    Other than `Noise.grain` it does not grow where lines of several pens differ: the ink is held against the
    ink of the same line a width farther on. Nor does it grow where two lines run beside each other, though a
    place is pale between them and dark on one of them: whole profiles are held against each other, too. NaN
    without any line.
    """
    profiles = profiles_of(darkness)
    found = InPixels.of(darkness, profiles, paper)
    if profiles is None:
        return Within(math.nan, math.nan, found)
    paper, width_px = found.paper, found.width_px
    middle = np.maximum(middle_of(profiles), PAPER)
    looks_px = STEP_PX * profiles.seen.sum(axis=1) / middle
    # beside a filled shape in colour it is lighter than paper: there is no line
    looks_px = looks_px[looks_px > 0]
    seen_px = percentile(looks_px, RIGHT_ON_IT) if len(looks_px) else math.nan
    along = profiles.across[:, ::-1] * [1, -1]
    here = seen_at(darkness, profiles.middles.T)
    there = seen_at(darkness, (profiles.middles + width_px * along).T)
    on_line = there > PAPER * median(here)
    if np.count_nonzero(on_line) < FEWEST_PROFILES:
        return Within(math.nan, seen_px, found, profiles.single)
    differ = _spread((there - here)[on_line]) / math.sqrt(2)
    profiles_differ = _along(darkness, profiles)
    grain, of_profiles = (
        math.sqrt(max(some**2 - INTERPOLATED_NOISE * paper**2, 0.0))
        for some in (differ, profiles_differ)
    )
    grain = min(grain, of_profiles / LEFT_OF_GRAIN)
    return Within(grain, seen_px, found, profiles.single)


def _along(darkness: Kept, profiles: Profiles) -> float:
    """By how much a profile differs from that of its line a width farther on, put over it: RMS, median."""
    # 1. the profile's ink, and a wider stretch farther on
    ahead_px = max(profiles.width_px, LEAST_AHEAD_PX)
    along = ahead_px * profiles.across[:, ::-1] * [1, -1]
    reach = round(ASIDE_PX / STEP_PX)
    count = 2 * math.ceil(0.5 * profiles.width_px / STEP_PX) + 1
    at_px = STEP_PX * (np.arange(float(count + 2 * reach)) - (count + 2 * reach - 1) / 2)
    across, middles = profiles.across, profiles.middles
    here = seen_across(darkness, middles, across, at_px)[:, reach : reach + count]
    there = seen_across(darkness, middles + along, across, at_px)
    # 2. put over each other as they fit best, where the line goes on
    apart = np.array(
        [np.mean((there[:, k : k + count] - here) ** 2, axis=1) for k in range(2 * reach + 1)]
    )
    on_line = there.max(axis=1) > INK * median(here.max(axis=1))
    return math.sqrt(median(apart.min(axis=0)[on_line]) / 2) if on_line.any() else 0.0


def _spread(values: NDArray[Any]) -> float:
    """Standard deviation without outliers, of which there are few."""
    off = np.abs(values - median(values))
    near = values[off <= OUTLIERS * ROBUST * max(median(off), 1e-6)]
    return float(np.std(near, dtype=float))


def _ink(darkness: Kept, profiles: Profiles) -> tuple[float, float]:
    """Standard deviations of the ink: from pixel to pixel, and along the lines beyond that."""
    # 1. neighbouring pixels along the line differ by the noise of two
    pixel = np.round(profiles.middles).astype(int)
    along = np.round(profiles.across[:, ::-1] * [1, -1]).astype(int)
    neighbour = np.clip(pixel + along, 0, np.array(darkness.shape) - 1)
    here, there = darkness[tuple(pixel.T)], darkness[tuple(neighbour.T)]
    ink = _spread((here - there).astype(float)) / math.sqrt(2)
    # 2. the middles of the lines, all over the sheet, differ by the grain and by what interpolation leaves
    middle = middle_of(profiles)
    grain = math.sqrt(max(_spread(middle) ** 2 - INTERPOLATED_NOISE * ink**2, 0.0))
    return ink, grain


def _pen(profiles: Profiles, paper: float, ink: float) -> tuple[float, float]:
    """Softness and width, pixels."""
    seen, span_px = profiles.seen - profiles.paper, STEP_PX * len(profiles.at_px)
    area, square = STEP_PX * seen.sum(axis=1), STEP_PX * (seen**2).sum(axis=1)
    peak = median(middle_of(profiles)) - profiles.paper
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
