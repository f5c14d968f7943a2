"""Fit of lines and arcs: the fewest that stay within a tolerance of a path, tangent where it is smooth.

Signals in: a polyline in the plane, mm. Signals out: chains of segments, each a line or an arc, end to end.

From corner to corner the pieces (pieces.py) are laid anew as one chain, tangent at every joint (spline.py).
Where no chain stays within the tolerance, the pieces are taken for a narrower one.

Source: none of the patents says how the lines and arcs of a program are found; chosen here. Questions: a
closed line without a corner has one tangent at its start and end; there the chain is closed. A stretch
without any chain, such as noise beyond the tolerance, is given as chords.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import SAME_MM
from morfax.motion.polyline import lengths_mm
from morfax.recorder.gcode.pieces import (
    SPACING_MM,
    Piece,
    corners,
    heading_rad,
    longest_pieces,
    resample,
)
from morfax.recorder.gcode.spline import ArcSpline, SegmentChain, rows_of, segments

# of the tolerance, for the pieces of a chain
SHARES = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2)


def fit(points_mm: Array, tolerance_mm: float) -> list[SegmentChain]:
    """The chains of a polyline, from corner to corner, each within the tolerance of it."""
    cuts = [0, *corners(points_mm).tolist(), len(points_mm) - 1]
    chains = [_chain(points_mm[a : b + 1], tolerance_mm) for a, b in pairwise(cuts)]
    return [chain for chain in chains if chain.segments]


def _chain(points_mm: Array, tolerance_mm: float) -> SegmentChain:
    """The chain of a stretch without corners: from the longest pieces, then from shorter ones."""
    s = lengths_mm(points_mm)
    if s[-1] < SAME_MM:
        return SegmentChain([], 0.0)
    places = resample(points_mm, min(SPACING_MM, float(s[-1]) / 4))
    before = 0
    for share in SHARES:
        pieces = longest_pieces(places, share * tolerance_mm)
        if len(pieces) == before:
            continue
        before = len(pieces)
        straight = np.array([is_straight for _, _, is_straight in pieces])
        for curved in (~straight, np.ones(len(pieces), bool)):
            chain = ArcSpline(places, pieces, curved).laid(tolerance_mm)
            if chain is not None:
                return _straightened(chain, places, pieces, tolerance_mm)
    return _chords(places, tolerance_mm)


def _straightened(
    chain: SegmentChain, places: Array, pieces: list[Piece], tolerance_mm: float
) -> SegmentChain:
    """The chain with lines in place of arcs that bend by less than half the tolerance, if that still fits."""
    curved = np.array(
        [abs(s.turned_rad) * s.length_mm / 8 > tolerance_mm / 2 for s in chain.segments]
    )
    if curved.tolist() == [s.curvature_per_mm != 0 for s in chain.segments]:
        return chain
    spline = ArcSpline(places, pieces, curved)
    spline.joints[:-1] = [s.begin_mm for s in chain.segments]
    spline.halves = np.where(curved, [s.turned_rad / 2 for s in chain.segments], 0.0)
    return spline.laid(tolerance_mm) or chain


def _chords(places: Array, tolerance_mm: float) -> SegmentChain:
    """Lines from place to place, each as long as it stays within the tolerance; for where no chain fits."""
    kept, worst_mm, first = [0], 0.0, 0
    while first < len(places) - 1:
        last, off_mm = first + 1, 0.0
        while (
            last + 1 < len(places)
            and (further_mm := _off_chord_mm(places[first : last + 2])) <= tolerance_mm
        ):
            last, off_mm = last + 1, further_mm
        kept.append(last)
        first, worst_mm = last, max(worst_mm, off_mm)
    ends = places[kept]
    table = np.column_stack([ends[:-1], ends[1:], np.zeros(len(ends) - 1)])
    return SegmentChain(segments(rows_of(table)), worst_mm)


def _off_chord_mm(places: Array) -> float:
    """The largest distance from the line between first and last."""
    dx, dy = (places - places[0]).T
    heading = heading_rad(places)
    return float(np.abs(dy * math.cos(heading) - dx * math.sin(heading)).max())
