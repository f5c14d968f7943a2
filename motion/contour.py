"""Contour measures: how far two paths are apart, how long one is, whether it closes.

Signals: Path, Motion, (n, 2) arrays of mm, or lists of such polylines in; distances and lengths in mm out. Of
a Path or Motion only what is run with the tool in the work counts.

Each polyline is sampled every 0.01 mm, its own points included. `neighbours` finds the nearest samples of the
other, and the sample is then projected on the straight pieces that meet there, so that equal curves with
different points are zero apart, not half a sample. Figures are weighted with the length that each sample
stands for: many points in a corner count no more than the corner is long.

Questions: where the other path crosses itself within a sample, the nearest piece may not start at the nearest
sample. The four nearest are tried.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion import polyline
from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.faults import MotionFault
from morfax.motion.median import NEARLY_ALL
from morfax.motion.motion import IN_WORK_BELOW_MM, Motion, Path
from morfax.motion.neighbours import Neighbours
from morfax.motion.usual import AT_ONCE

SAMPLE_MM = 0.01
# beyond 10 m of path the samples stand further apart: memory stays below 200 MB
LARGEST_SAMPLES = 1_000_000
NEIGHBOURS = 4  # nearest samples whose pieces are tried, see Questions


Contour = Path | Motion | Array | Sequence[Array]
Tell = Callable[[float], object]


@dataclass(frozen=True, slots=True)
class Summary:
    """Distances of one path from another, mm: root mean square, 95th percentile by length, largest."""

    rms_mm: float
    p95_mm: float
    max_mm: float

    def __str__(self) -> str:
        return f"RMS {self.rms_mm:.4f}, 95 % {self.p95_mm:.4f}, max {self.max_mm:.4f} mm"


@dataclass(frozen=True, slots=True)
class Distances:
    """Distances both ways: where the path is wrong, and where it misses the reference."""

    path_to_reference: Summary
    reference_to_path: Summary

    @property
    def hausdorff_mm(self) -> float:
        """The larger of the two largest distances, mm."""
        return max(self.path_to_reference.max_mm, self.reference_to_path.max_mm)

    def __str__(self) -> str:
        there, back = self.path_to_reference, self.reference_to_path
        return f"path to reference {there}; reference to path {back}; Hausdorff {self.hausdorff_mm:.4f} mm"


def distance(path: Contour, reference: Contour, tell: Tell = lambda share: None) -> Distances:
    """Distances of a path from a reference and back, mm; `tell` is told what share of them is known."""
    ours, theirs = _sampled(path), _sampled(reference)
    there = _Finder(theirs).distances_mm(ours.points_mm, lambda share: tell(0.5 * share))
    back = _Finder(ours).distances_mm(theirs.points_mm, lambda share: tell(0.5 + 0.5 * share))
    return Distances(_summary(there, ours.weights_mm), _summary(back, theirs.weights_mm))


def pointwise(
    path: Contour,
    reference: Contour,
    sample_mm: float = SAMPLE_MM,
    tell: Tell = lambda share: None,
) -> tuple[Array, Array]:
    """Samples (n, 2) along a path, and the distance of each from the reference, mm."""
    ours = _sampled(path, sample_mm)
    return ours.points_mm, _Finder(_sampled(reference)).distances_mm(ours.points_mm, tell)


def distances_mm(points_mm: Array, reference: Contour) -> Array:
    """Distance of each point (n, 2) from a path, mm."""
    return _Finder(_sampled(reference)).distances_mm(points_mm)


def length_mm(path: Contour) -> float:
    """Length of the path in the work, mm."""
    return sum((polyline.length_mm(run) for run in polylines(path)), 0.0)


def polylines(path: Contour) -> list[Array]:
    """The (n, 2) polylines in mm that count; raises MotionFault if none does, ValueError for no contour."""
    if isinstance(path, Motion):
        path = Path(path.times_s, path.positions_mm, path.axes)
    if isinstance(path, Path):
        return _in_work(path)
    runs = [path] if isinstance(path, np.ndarray) else [np.asarray(run) for run in path]
    if not runs:
        raise ValueError("the list of polylines is empty; it must hold at least one")
    for run in runs:
        is_flat = run.ndim == 2 and run.shape[1] == 2 and len(run) > 0
        if not is_flat or not np.isfinite(run).all():
            raise ValueError(
                f"an array of shape {run.shape} is no polyline; it must be (n, 2), n > 0, of finite mm"
            )
    return runs


def _in_work(path: Path) -> list[Array]:
    """The polylines that a path runs with the tool in the work; raises MotionFault if it runs none."""
    runs = path.runs()
    if not runs:
        raise MotionFault(
            "the path never has its tool in the work; z must come down to"
            f" {IN_WORK_BELOW_MM} mm or below somewhere: lower it, or take the column z out"
        )
    return runs


@dataclass(frozen=True, slots=True)
class _Sampled:
    """Points (n, 2) along polylines, the length each stands for, and whether a piece leads on to the next."""

    points_mm: Array
    weights_mm: Array
    leads_on: NDArray[np.bool_]


def _sampled(path: Contour, sample_mm: float = SAMPLE_MM) -> _Sampled:
    """Sample all polylines so densely, their own points included."""
    runs = polylines(path)
    total_mm = sum(polyline.length_mm(run) for run in runs)
    apart_mm = max(sample_mm, total_mm / LARGEST_SAMPLES)
    parts = [_along(run, apart_mm) for run in runs]
    leads_on = np.concatenate([np.arange(len(part)) < len(part) - 1 for part in parts])
    weights_mm = np.concatenate([_shares_mm(part) for part in parts])
    return _Sampled(np.vstack(parts), weights_mm, leads_on)


def _along(run: Array, apart_mm: float) -> Array:
    """The polyline's points and, between them, points at most `apart_mm` from each other."""
    s = polyline.lengths_mm(run)
    keep = np.r_[True, np.diff(s) > 0]
    s, run = s[keep], run[keep]
    between = np.linspace(0.0, s[-1], int(np.ceil(s[-1] / apart_mm)) + 1)
    at = np.union1d(s, between)
    return np.column_stack([np.interp(at, s, run[:, 0]), np.interp(at, s, run[:, 1])])


def _shares_mm(points: Array) -> Array:
    """The length that each point of a polyline stands for: half of the pieces on both its sides, mm."""
    steps = polyline.steps_mm(points)
    return (np.r_[0.0, steps] + np.r_[steps, 0.0]) / 2


class _Finder:
    """Finds the nearest place on sampled polylines."""

    def __init__(self, sampled: _Sampled) -> None:
        self._sampled = sampled
        self._neighbours = Neighbours(sampled.points_mm)

    def distances_mm(self, points: Array, tell: Tell = lambda share: None) -> Array:
        """Distance of each point (n, 2) from the nearest straight piece, mm; `tell` hears how far it is."""
        parts = list[Array]()
        for first in range(0, len(points), AT_ONCE):
            tell(first / len(points))
            parts.append(self._some(points[first : first + AT_ONCE]))
        return np.concatenate(parts)

    def _some(self, points: Array) -> Array:
        """The same for a few points, so that memory stays small."""
        k = min(NEIGHBOURS, len(self._sampled.points_mm))
        near = self._neighbours.several(points, k)
        best = np.hypot(*(points - self._sampled.points_mm[near[:, 0]]).T)
        _to_pieces(points, near, (self._sampled.points_mm, self._sampled.leads_on), best)
        return best


@njit(cache=True, nogil=True)
def _to_pieces(points, near, sampled, best):  # type: ignore[no-untyped-def]
    """Lower the distance of each point to that from the pieces on both sides of the samples near it, mm."""
    at, leads_on = sampled
    for n in range(len(points)):
        for k in range(near.shape[1]):
            for first in range(max(near[n, k] - 1, 0), near[n, k] + 1):
                if not leads_on[first]:
                    continue
                x = points[n, 0] - at[first, 0]
                y = points[n, 1] - at[first, 1]
                along_x = at[first + 1, 0] - at[first, 0]
                along_y = at[first + 1, 1] - at[first, 1]
                squared = along_x * along_x + along_y * along_y
                share = (x * along_x + y * along_y) / squared if squared > 0.0 else 0.0
                share = min(max(share, 0.0), 1.0)
                away = math.hypot(x - share * along_x, y - share * along_y)
                best[n] = min(best[n], away)


def _summary(distances_mm: Array, weights_mm: Array) -> Summary:
    """Weighted figures; a path of single points weighs each the same."""
    weights = weights_mm if weights_mm.sum() > 0 else np.ones_like(weights_mm)
    order = np.argsort(distances_mm)
    share = np.cumsum(weights[order])
    at = np.searchsorted(share, NEARLY_ALL / 100 * share[-1]).clip(max=len(order) - 1)
    p95 = distances_mm[order[at]]
    rms = np.sqrt(np.average(distances_mm**2, weights=weights))
    return Summary(float(rms), float(p95), float(distances_mm.max()))
