"""The cubic recorder: a motion becomes differences of cubics, one set for each equal interval of time.

Signals: a stream of Motion or a Path in, a `.cubic` file out: words (k, 3 axes, 3 differences) in counts with
3·log2(p) binary digits behind the point.

The motion is cut into legs at its corners and rests (`recorder.legs`); a corner is a stop with speed zero at
a sample. Each leg is stretched to a whole number of intervals and a cubic spline laid through it, nearest in
the squares, from rest to rest. Its places x and slopes m at the intervals' ends are rounded to whole counts,
and so the cubic that meets them has exact differences, for steps of 1/n of the interval:

    a = 2(x1 - x2) + m1 + m2     b = 3(x2 - x1) - 2 m1 - m2     c = m1

    A  = a/n³ + b/n² + c/n       A² = 6a/n³ + 2b/n²             A³ = 6a/n³

The interval is the longest of a series of halves with which the path stays within the tolerance, and the
program takes no more than a tenth longer than the motion. What counts as a corner is tried from blunt to
sharp, and taken is the program with the fewest intervals.

Source: patent US 3062995, column 3 and relations (III) to (IX). Questions: the patent leaves places and
slopes to a desk calculator (slopes by a formula that is lost in the print). Rounded slopes cost an eighth of
a count at most between the samples, nothing at them.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, ROUNDED, Array
from morfax.motion.contour import NEIGHBOURS
from morfax.motion.faults import MotionFault
from morfax.motion.motion import Path
from morfax.motion.plane import BEND_RAD
from morfax.motion.segments import Limits, Segment, Source, as_path, segments
from morfax.recorder.cubics.file import (
    STEPS_PER_CONSTANT,
    CubicFormat,
    CubicProgram,
    write_program,
)
from morfax.recorder.report import WrittenIntervals

Words = NDArray[np.int64]

TOLERANCE_MM = 0.002  # four counts
LONGEST_S, SHORTEST_S = 0.512, 0.004  # of the intervals tried, each half of the one before
POINT_RATE_HZ = 4000.0  # nearly, of the interpolated points: the servo is as fast
STRETCH = 1.1  # of the motion's own time
CHECK_EVERY = 64  # intervals from one checked position to the next
LIMITS = Limits(100.0, 500.0, spacing_mm=0.005, window_mm=0.02, corner_rad=BEND_RAD)
CORNER_SHARES = (1.0, 0.5, 0.25)  # of that angle


@dataclass(frozen=True, slots=True)
class CubicReport(WrittenIntervals[CubicFormat]):
    """What was recorded, the stops of the machine, and the largest distance of the cubics from the motion."""

    stops: int

    @property
    def figures(self) -> dict[str, Any]:
        """Further figures for the report."""
        return {
            "intervals": self.intervals,
            "interval_s": self.format.interval_s,
            "stops": self.stops,
            "deviation_mm": self.deviation_mm,
        }


@dataclass(frozen=True, slots=True)
class _Fit:
    """Samples (k + 1, axes, 2) in whole counts, their interval, and their distance from the path."""

    interval_s: float
    samples: Words
    off_mm: float
    stops: int


def record_cubics(
    stream: Source,
    file: str | os.PathLike[str],
    *,
    tolerance_mm: float | None = None,
    fmt: CubicFormat | None = None,
    limits: Limits | None = None,
) -> CubicReport:
    """Record a motion as cubics within a tolerance of it; the recorder sets interval and places in `fmt`.

    Raises MotionFault for a motion that is empty, or cannot be had within the tolerance.
    """
    tolerance_mm = TOLERANCE_MM if tolerance_mm is None else tolerance_mm
    if not tolerance_mm > 0:
        raise ValueError(
            f"a tolerance of {tolerance_mm} mm leaves no room; give one above zero"
        )
    path = as_path(stream)
    fit = _best_fit(path, tolerance_mm, limits or LIMITS, (fmt or CubicFormat()).counts_per_mm)
    fmt = replace(fmt or CubicFormat(points=_points(fit.interval_s)), interval_s=fit.interval_s)
    fmt = replace(
        fmt, modulus_per_s=min(fmt.modulus_per_s, fmt.point_rate_hz / STEPS_PER_CONSTANT)
    )
    words = differences(fit.samples, fmt.points, fmt.linear)
    places = fit.samples[:, :, 0]
    checks = {k: tuple(places[k].tolist()) for k in range(0, len(places), CHECK_EVERY)}
    checks[len(places) - 1] = tuple(places[-1].tolist())
    write_program(CubicProgram(fmt, words, checks), file)
    return CubicReport(FilePath(file), fmt, len(words), fit.off_mm, fit.stops)


def differences(samples: Words, points: int, linear: int = 1) -> Words:
    """Differences A, A², A³ (k, axes, 3) of samples (k + 1, axes, 2), counts and counts per interval.

    The unit of the words is the count divided by points³, in which they are exact; points is a power of two.
    For an interpolator of which only every `linear`-th step is cubic they are those of so many fewer steps,
    over `linear`.
    """
    if points < 2 or points & (points - 1) or points % linear:
        raise ValueError(
            f"{points} points, {linear} to a cubic step, have no whole digits; give powers of two"
        )
    x1, m1, x2, m2 = (
        samples[:-1, :, 0],
        samples[:-1, :, 1],
        samples[1:, :, 0],
        samples[1:, :, 1],
    )
    a = 2 * (x1 - x2) + m1 + m2
    b = 3 * (x2 - x1) - 2 * m1 - m2
    n = points // linear
    first = a + b * n + m1 * n**2
    second = 6 * a + 2 * b * n
    words = np.stack([first, second, 6 * a], axis=-1)
    return np.asarray(words * linear**2)


def _points(interval_s: float) -> int:
    """Points in an interval: the power of two that comes nearest to the usual rate."""
    return int(2 ** round(math.log2(interval_s * POINT_RATE_HZ)))


def hermite(samples: Words, at: Array) -> Array:
    """Places (n, axes) in counts of the cubics at times in intervals from the start; the closed form."""
    k = np.clip(at.astype(np.int64), 0, len(samples) - 2)
    u = (at - k)[:, None]
    x1, m1, x2, m2 = (
        samples[k, :, 0],
        samples[k, :, 1],
        samples[k + 1, :, 0],
        samples[k + 1, :, 1],
    )
    a = 2 * (x1 - x2) + m1 + m2
    b = 3 * (x2 - x1) - 2 * m1 - m2
    return np.asarray(((a * u + b) * u + m1) * u + x1)


def _best_fit(path: Path, tolerance_mm: float, limits: Limits, counts_per_mm: float) -> _Fit:
    """The fit with the fewest intervals; raises MotionFault if none stays within the tolerance."""
    fits = [
        _fitted(
            segments(path, replace(limits, corner_rad=share * limits.corner_rad)),
            path.positions_mm[0],
            counts_per_mm,
            tolerance_mm,
        )
        for share in CORNER_SHARES
    ]
    good = [fit for fit in fits if fit.off_mm <= tolerance_mm]
    if not good:
        raise MotionFault(
            f"the cubics come no nearer to the motion than {min(fit.off_mm for fit in fits):.4f} mm "
            "with intervals of "
            f"{SHORTEST_S:g} s; allowed {tolerance_mm:g} mm: give a larger tolerance, or trace slower"
        )
    return min(good, key=lambda fit: len(fit.samples))


def _fitted(
    parts: list[Segment], start_mm: Array, counts_per_mm: float, tolerance_mm: float
) -> _Fit:
    """The fit with the longest interval that stays within the tolerance, or else with the shortest."""
    interval_s = LONGEST_S
    longest_s = STRETCH * sum(float(leg.times_s[-1]) + leg.rest_s for leg in parts)
    while True:
        samples, off_mm = _samples(parts, start_mm, interval_s, counts_per_mm)
        long = (len(samples) - 1) * interval_s > longest_s
        if (off_mm <= tolerance_mm and not long) or interval_s <= SHORTEST_S:
            return _Fit(interval_s, samples, off_mm, len(parts) + 1)
        interval_s /= 2


def _samples(
    parts: list[Segment], start_mm: Array, interval_s: float, counts_per_mm: float
) -> tuple[Words, float]:
    """Samples (k + 1, axes, 2) of all legs in whole counts, and the largest distance from them, mm."""
    found = [np.stack([_counts(start_mm, counts_per_mm), np.zeros(3, np.int64)], axis=-1)[None]]
    off_mm = 0.0
    for leg in parts:
        rest = np.repeat(found[-1][-1:], round(leg.rest_s / interval_s), axis=0)
        samples = _leg_samples(leg, interval_s, counts_per_mm)
        off_mm = max(off_mm, _off_mm(leg, samples, counts_per_mm))
        found += [rest, samples[1:]]
    return np.concatenate(found), off_mm


def _leg_samples(leg: Segment, interval_s: float, counts_per_mm: float) -> Words:
    """Samples of one leg, from rest to rest in a whole number of intervals."""
    times = leg.times_s
    intervals = max(1, int(np.ceil(times[-1] / interval_s - ROUNDED)))
    values, slopes = _spline(times / times[-1] * intervals, leg.places_mm, intervals)
    return np.stack([_counts(values, counts_per_mm), _counts(slopes, counts_per_mm)], axis=-1)


def _spline(at: Array, places: Array, intervals: int) -> tuple[Array, Array]:
    """Values and slopes at 0 … intervals of the cubic spline nearest to places, at rest on both ends."""
    from scipy.interpolate import BSpline
    from scipy.sparse.linalg import spsolve

    knots = np.r_[[0.0] * 3, np.arange(intervals + 1), [float(intervals)] * 3]
    coefficients = np.empty((intervals + 3, places.shape[1]))
    # the first two alike: slope zero
    coefficients[:2] = places[0]
    coefficients[-2:] = places[-1]
    if intervals > 1:
        basis = BSpline.design_matrix(np.clip(at, 0, intervals), knots, 3).tocsc()
        rest = np.r_[0, 1, intervals + 1, intervals + 2]
        inner = basis[:, 2:-2]
        wanted = inner.T @ (places - basis[:, rest] @ coefficients[rest])
        normal = (inner.T @ inner).tocsc()
        # an interval may hold no place
        normal.setdiag(normal.diagonal() + ROUNDED * max(1.0, normal.diagonal().max()))
        coefficients[2:-2] = spsolve(normal, wanted).reshape(-1, places.shape[1])
    spline = BSpline(knots, coefficients, 3)
    ends = np.arange(intervals + 1.0)
    return np.asarray(spline(ends)), np.asarray(spline.derivative()(ends))


def _off_mm(leg: Segment, samples: Words, counts_per_mm: float) -> float:
    """The largest distance of the cubics from the leg's path, measured across the path, mm."""
    at = np.linspace(0, len(samples) - 1, max(64, 4 * len(leg.places_mm) // 3))
    run_mm = hermite(samples, at) / counts_per_mm
    return float(_nearest_mm(leg.places_mm, run_mm).max())


def _nearest_mm(places: Array, run_mm: Array) -> Array:
    """Distance of each point of a run from the leg's polyline, mm.

    The piece that leads to the nearest place or on from it may be the wrong one where a closed leg ends
    beside its start.
    """
    from scipy.spatial import cKDTree

    _, near = cKDTree(places).query(run_mm, k=min(NEIGHBOURS, len(places)))
    best = np.full(len(run_mm), np.inf)
    for piece in (*(near.T - 1), *near.T):
        first = np.clip(piece, 0, len(places) - 2)
        along = places[first + 1] - places[first]
        squared = np.maximum(np.einsum("ij,ij->i", along, along), NOT_ZERO)
        share = np.clip(np.einsum("ij,ij->i", run_mm - places[first], along) / squared, 0, 1)
        best = np.minimum(
            best, np.sqrt(((run_mm - places[first] - share[:, None] * along) ** 2).sum(axis=1))
        )
    return best


def _counts(mm: Array, counts_per_mm: float) -> Words:
    """A place in whole counts."""
    return np.rint(mm * counts_per_mm).astype(np.int64)
