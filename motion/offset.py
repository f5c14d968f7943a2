"""Offset paths: the way of a round tool's middle along lines, a radius away from them and nowhere nearer.

Signals: drive curves in: polylines in mm, each with the side on which the tool runs; out the offset paths of
the tool's middle, closed where the drive curve is.

    swung      the way of the end of an arm as long as the radius, across the heading (see `arm`)
    trimmed    of that, what is nearer than the radius to any line is taken out, and one way goes on into the
               other where they cross (see `trimming`)

A path never changes the side: a place a radius away along the normal, and not nearer to any line, has no line
between.

Source: our own, from first principles (patent ES 361967 has the draughtsman allow for the cutter). Questions:
the end of an open line has no cap: the tool does not go round it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from morfax.motion.arm import PLAIN, sagitta_rad, swung
from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import BEND_RAD
from morfax.motion.polyline import (
    APART_MM,
    Nearest,
    area_mm2,
    closed_up,
    length_mm,
    plain,
    steps_mm,
)
from morfax.motion.trimming import FREE, NEARER, SAME_MM, OffsetPiece, chains, trimmed

LEAST_MM = 0.05  # a shorter path is dropped, ...
# ... and one from crossing to crossing shorter than this share of the radius; by trial
BROKEN = 0.1
ROUND_RADII = 6.0  # a path clockwise round a line is longer than this: 2 pi radii round a point


@dataclass(frozen=True, slots=True)
class DriveCurve:
    """A line (n, 2) mm along which the tool is driven, on its left or its right."""

    points_mm: Array
    closed: bool
    left: bool


@dataclass(frozen=True, slots=True)
class OffsetPath:
    """A path of the tool's middle (n, 2) mm, closed up if closed, and the drive curve it runs along most."""

    points_mm: Array
    closed: bool
    guide: int


def offset(curves: Sequence[DriveCurve], radius_mm: float) -> list[OffsetPath]:
    """Paths of a tool of this radius along drive curves, in their direction; none where it does not fit."""
    lines = [guided(curve, radius_mm) for curve in curves]
    closed = [curve.closed for curve in curves]
    whole = [
        closed_up(a) if is_closed else a for a, is_closed in zip(lines, closed, strict=True)
    ]
    near = Nearest(whole, radius_mm)
    ways = [swung(a, is_closed, radius_mm) for a, is_closed in zip(lines, closed, strict=True)]
    paths = list[OffsetPath]()
    for chain in chains(trimmed(ways, closed, near, radius_mm)):
        points = np.vstack([piece.points_mm for piece in chain])
        points = points[np.r_[True, steps_mm(points) > SAME_MM]]
        comes_round = chain[0].start == chain[-1].end != FREE
        if not _is_kept(chain, points, comes_round, radius_mm):
            continue
        guide = max(chain, key=lambda piece: piece.length_mm).guide
        if comes_round:
            points = _begun(points, ways[guide][0])
        along = points if curves[guide].left else points[::-1]
        paths.append(OffsetPath(along, comes_round, guide))
    return paths


def _is_kept(
    chain: list[OffsetPiece], points: Array, comes_round: bool, radius_mm: float
) -> bool:
    """Whether a path is long enough, and goes round something if it comes round."""
    broken = not comes_round and FREE not in (chain[0].start, chain[-1].end)
    least_mm = BROKEN * radius_mm if broken else LEAST_MM
    if length_mm(points) < least_mm:
        return False
    return not (comes_round and _goes_round_nothing(points, radius_mm))


def guided(curve: DriveCurve, radius_mm: float) -> Array:
    """The places of a drive curve that a tool can touch, the tool on its left; a closed one is left open."""
    points = curve.points_mm if curve.left else curve.points_mm[::-1]
    points = plain(np.ascontiguousarray(points, float), PLAIN)
    points = points[np.r_[True, steps_mm(points) > PLAIN]]
    if curve.closed and len(points) > 1 and np.hypot(*(points[-1] - points[0])) <= APART_MM:
        points = points[:-1]
    return points[_within_reach(points, radius_mm * sagitta_rad(radius_mm))]


@njit(cache=True)
def _within_reach(points, wide_mm):  # type: ignore[no-untyped-def]
    """Which places of a line the tool on its left may touch.

    Not one that is set back between two places so near each other that the tool does not sink in between.
    """
    kept, count = np.empty(len(points), np.int64), 0
    for k in range(len(points)):
        while count > 1:
            a = points[kept[count - 2]]
            b = points[kept[count - 1]]
            ux = b[0] - a[0]
            uy = b[1] - a[1]
            wx = points[k, 0] - a[0]
            wy = points[k, 1] - a[1]
            if ux * wy - uy * wx <= 0 or wx * wx + wy * wy > wide_mm * wide_mm:
                break
            count -= 1
        kept[count] = k
        count += 1
    return kept[:count].copy()


def _goes_round_nothing(points: Array, radius_mm: float) -> bool:
    """Whether a closed path encloses nothing; one that goes round to the right must go round a line."""
    length, area = length_mm(points), area_mm2(points)
    round_a_line = area < 0 and length > ROUND_RADII * radius_mm
    return not round_a_line and 2 * area < NEARER * length


def _begun(points: Array, start_mm: Array) -> Array:
    """A closed path begun at the place of the curve's own start, or furthest from where it turns sharply."""
    points = points[:-1]
    away = np.hypot(*(points - start_mm).T)
    first = int(np.argmin(away))
    if away[first] > SAME_MM:
        ways = np.diff(closed_up(points), axis=0)
        headings = np.arctan2(ways[:, 1], ways[:, 0])
        turns = np.abs(np.angle(np.exp(1j * np.diff(np.r_[0, headings]))))
        sharp = np.flatnonzero(turns > BEND_RAD)
        gaps = np.diff(np.r_[sharp, sharp[:1] + len(points)])
        first = int(sharp[np.argmax(gaps)] + gaps.max() // 2) % len(points) if len(sharp) else 0
    return closed_up(np.roll(points, -first, axis=0))
