"""Numbering: lines in the order of their numbers, the same however large, fine or turned a sheet is scanned.

Signals: lengths and middles of lines (mm), and the sheet's ink, in; their order out.

    the longest first
    of equal lengths      the one nearest to the middle of all the ink
    as near as others     going round that middle anticlockwise, from the side to which the ink is lopsided

A scan measures a line a little longer or shorter at another angle, so lengths and distances that differ by
less than that are equal.

Source: our own. Questions: on a sheet that looks the same when it is turned nothing tells lines apart that
change places; then any order is as good.
"""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import CORNER_RAD

# All limits below were chosen by trial on drawings scanned at 5 sizes, 7 angles and 3 resolutions.
ALIKE = 0.015  # lengths within this share are equal
AS_NEAR = 0.04  # of the ink's reach from its middle: distances within this are equal
LOPSIDED = 0.02  # of the ink's third moment without signs: less shows no side


class InkSpread(NamedTuple):
    """Where the ink is: its middle (X, Y) mm, its reach from there (RMS, mm), and its lopsided side, rad."""

    middle_mm: tuple[float, float]
    reach_mm: float
    side_rad: float

    @classmethod
    def of(cls, places_mm: Array, weights: Array) -> InkSpread:
        """The ink at places (n, 2) mm of which each counts by its weight."""
        z = places_mm[:, 0] + 1j * places_mm[:, 1]
        share = weights / max(float(weights.sum()), NOT_ZERO)
        middle = complex(np.sum(share * z))
        z = z - middle
        square = np.abs(z) ** 2
        third = np.sum(share * z * square)
        without_signs = np.sum(share * np.abs(z) * square)
        side = cmath.phase(third)
        if abs(third) < LOPSIDED * without_signs:
            side = 0.5 * cmath.phase(np.sum(share * z * z))
        reach_mm = math.sqrt(float(np.sum(share * square)))
        return cls((middle.real, middle.imag), reach_mm, side)


def longest_first(lengths_mm: Array, middles_mm: Array, ink: InkSpread) -> NDArray[np.int64]:
    """The order of lines by their lengths, and by their middles (n, 2) mm where these are equal."""
    order = list[int]()
    away = middles_mm - np.array(ink.middle_mm)
    near_mm = np.hypot(away[:, 0], away[:, 1])
    # the way round begins a little before the lopsided side: no line lies on the cut
    turns = np.arctan2(away[:, 1], away[:, 0]) - ink.side_rad + CORNER_RAD
    for alike in _groups(-lengths_mm, ALIKE * lengths_mm):
        within_mm = np.full(len(alike), AS_NEAR * ink.reach_mm)
        for as_near in _groups(near_mm[alike], within_mm):
            some = alike[as_near]
            order += some[np.argsort(np.mod(turns[some], 2 * math.pi))].tolist()
    return np.array(order, np.int64)


def _groups(values: Array, within: Array) -> list[NDArray[np.int64]]:
    """The numbers of some values in rising order, those together that are within reach of a group's first."""
    groups = list[NDArray[np.int64]]()
    order = np.argsort(values, kind="stable")
    begin = 0
    while begin < len(order):
        first = order[begin]
        end = begin + int(
            np.searchsorted(values[order[begin:]], values[first] + within[first], side="right")
        )
        groups.append(order[begin : max(end, begin + 1)])
        begin = max(end, begin + 1)
    return groups
