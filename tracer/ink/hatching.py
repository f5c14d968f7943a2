"""Hatching: families of straight strokes that run side by side at even distances.

Signals: the ways of strokes (n, 2) mm in; the families out, each with the numbers of its strokes.

    ╱ ╱ ╱ ╱ ╱      each is the next one's neighbour: nearly the same heading, side by side for a part of
   ╱ ╱ ╱ ╱ ╱       their length, and no stroke nearer; as far apart as the others of the family

Source: our own; hatching is drawn at even distances (ISO 128-50). Questions: the bars of a fence are hatching
by this too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.long_array import one_in
from morfax.motion.plane import direction, left_of
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.components import grouped
from morfax.tracer.drawing.thinning import Indices

# All limits below were chosen by trial on drawings of parts with cut faces.
STRAIGHT = 0.995  # its ends are as far apart, of its length
LEAST_MM = 1.5  # a shorter stroke is no hatching
ALIKE = math.radians(4)  # headings that differ by less are one family's
APART_MM = 4.0  # from stroke to stroke, at most
BESIDE = 0.3  # of the shorter stroke runs beside the other
EVEN = 0.4  # of the family's usual distance: a distance that differs by less is even
EVENLY = 0.8  # of the distances are even
FEWEST = 6  # strokes


class Hatching(NamedTuple):
    """A family of strokes: their numbers, how long they are in all, how far apart, and their heading."""

    strokes: tuple[int, ...]
    length_mm: float
    apart_mm: float
    heading_rad: float
    place_mm: tuple[float, float]


def hatching(ways: Sequence[Array], fewest: int = FEWEST) -> list[Hatching]:
    """The families of hatching among some strokes, of so many at the least, the longest first."""
    long_mm = np.array([length_mm(one_in(way, max(1, len(way) // 200))) for way in ways])
    begins, ends = np.array([way[0] for way in ways]), np.array([way[-1] for way in ways])
    chords = ends - begins
    straight_mm = np.hypot(chords[:, 0], chords[:, 1])
    own = np.flatnonzero((straight_mm > STRAIGHT * long_mm) & (long_mm > LEAST_MM))
    if len(own) < fewest:
        return []
    headings = np.mod(np.arctan2(chords[own, 1], chords[own, 0]), math.pi)
    pairs, apart_mm = _neighbours(0.5 * (begins + ends)[own], headings, long_mm[own])
    a, _ = pairs.T
    family = grouped(pairs, len(own))
    found = list[Hatching]()
    for k in np.flatnonzero(np.bincount(family) >= fewest):
        members, distances_mm = own[family == k], apart_mm[family[a] == k]
        usual_mm = float(np.median(distances_mm))
        if np.mean(np.abs(distances_mm / usual_mm - 1) < EVEN) < EVENLY:
            continue
        x, y = 0.5 * (begins + ends)[members].mean(axis=0)
        heading = float(headings[family == k][0])
        found.append(
            Hatching(
                tuple(members.tolist()),
                float(long_mm[members].sum()),
                usual_mm,
                heading,
                (float(x), float(y)),
            )
        )
    return sorted(found, key=lambda each: -each.length_mm)


def _neighbours(middles_mm: Array, headings: Array, long_mm: Array) -> tuple[Indices, Array]:
    """Pairs of strokes (n, 2) each of which is the other's nearest on that side; their distances, mm."""
    nearest = dict[tuple[int, bool], tuple[float, int]]()
    for k, heading in enumerate(headings):
        turned = np.remainder(headings - heading + 0.5 * math.pi, math.pi) - 0.5 * math.pi
        away = middles_mm - middles_mm[k]
        along = away @ direction(heading)
        aside = away @ left_of(direction(heading))
        shorter = np.minimum(long_mm, long_mm[k])
        beside = 0.5 * (long_mm + long_mm[k]) - np.abs(along)
        fits = (
            (np.abs(turned) < ALIKE) & (np.abs(aside) < APART_MM) & (beside > BESIDE * shorter)
        )
        fits[k] = False
        for left in (False, True):
            some = np.flatnonzero(fits & ((aside > 0) == left))
            if len(some):
                other = int(some[np.argmin(np.abs(aside[some]))])
                nearest[k, left] = float(abs(aside[other])), other
    pairs, apart = list[tuple[int, int]](), list[float]()
    for (k, _), (apart_mm, other) in nearest.items():
        mutual = any(nearest.get((other, left), (0, -1))[1] == k for left in (False, True))
        if k < other and mutual:
            pairs.append((k, other))
            apart.append(apart_mm)
    return np.array(pairs, np.int64).reshape(-1, 2), np.array(apart)
