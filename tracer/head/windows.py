"""The slow cell's windows: how wide its parabola is along a way, how far ahead it swings, where it stops.

    way       felt by stations ahead of the head, (n, 2) mm
    windows   for each piece of it the widest over which the way hardly bends: half of it, mm

A parabola over few pixels bends by what the pixels do to the line's edges, by h^-2.5 for half a window of h;
a wide one cuts bends. So each piece of a way has the widest window that its own bend allows, and the lead
that suffices for that. What bends far more than the way was felt to bend is not the line, but something
beside it that draws the cell: there the cell stops.

Signals: the fast cell's tuning and a way in; windows, and the slow cell's tuning for each, out.

Source: our own.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.head.state import Tuning
from morfax.tracer.head.tuning import LEAD_SWEEPS, TIGHTEST_RAD
from morfax.tracer.sensing.leg import turn

# Chosen by trial on the test drawings.
# of the narrowest half window of a fast cell: in an arc, and where the bend changes
WINDOW_STEADY, WINDOW = 1.3, 0.75
STEADY = 0.2  # of the bend: an arc's changes by less from one half of a stretch to the other
SIZES = 5  # of windows, from the fast cell's half window to the narrowest
CHORDS = 4  # places of a way to half a window, between which its headings are taken
# that a way may turn from one half of a window to the other: half as much again as what stops a fast cell,
# for a part of what stations feel on few pixels is noise. Twice as much takes a corner of 30 degrees, which
# stations feel as a turn of 0.45, for a bend: the widest window cuts it by 37 um at 300 dpi
TURNS_RAD = 1.5 * TIGHTEST_RAD
# over the line's width, the bend at which the cell stops, and the tightest to which it may be led on: there
# the inks of both sides touch
BENT_WIDTHS, TOUCHING_WIDTHS = 0.7, 1.0
BENT_FELT = 1.5  # times the bend that was felt, up to which it is led on


class CellWindow(NamedTuple):
    """A piece of a way, mm, and half of the slow cell's window along it, mm."""

    length_mm: float
    half_mm: float


class Ahead(NamedTuple):
    """A way that was felt ahead, (n, 2) mm, the line's width, and how far beyond the way's end nothing leaves
    the line, mm.
    """

    way: Array
    width_mm: float
    clear_mm: float = math.inf


def is_steady(way: Array) -> bool:
    """Whether a way (n, 2) mm is an arc: it bends as much in its second half as in its first."""
    thirds = at_lengths(way, np.linspace(0.0, length_mm(way), 4))
    dx, dy = np.diff(thirds, axis=0).T
    first, second = (turn(*pair) for pair in pairwise(np.arctan2(dy, dx)))
    return abs(second - first) < STEADY * max(abs(first), abs(second))


def narrow_mm(t: Tuning, way: Array) -> float:
    """Half of the window for a tight bend, mm."""
    return (WINDOW_STEADY if is_steady(way) else WINDOW) * t.narrow_mm


def narrowest(t: Tuning, ahead: Ahead) -> list[CellWindow]:
    """One narrow window for all of a way, as for a tight bend."""
    return [CellWindow(length_mm(ahead.way), narrow_mm(t, ahead.way))]


def widest(t: Tuning, ahead: Ahead) -> list[CellWindow]:
    """The widest windows over which a way hardly bends, and whose cell does not see beyond what is clear."""
    long_mm = length_mm(ahead.way)
    pieces = max(1, round(long_mm / t.narrow_mm))
    ends_mm = np.linspace(0.0, long_mm, pieces + 1)
    halves_mm = np.full(pieces, narrow_mm(t, ahead.way))
    for half_mm in np.geomspace(t.half_window_mm, t.narrow_mm, SIZES + 1)[-2::-1].tolist():
        at_mm, turns_rad = bends_rad(ahead.way, half_mm)
        if not len(at_mm):
            continue
        in_sight = ends_mm[1:] + lead_mm(t, half_mm) < long_mm + ahead.clear_mm
        for k, (first, last) in enumerate(pairwise(ends_mm.tolist())):
            # the ends of the way bend as the nearest place whose window lies within it
            near = slice(*np.searchsorted(at_mm, np.clip((first, last), at_mm[0], at_mm[-1])))
            most_rad = turns_rad[near.start : near.stop + 1].max()
            if in_sight[k] and most_rad < TURNS_RAD:
                halves_mm[k] = half_mm
    return _joined(np.diff(ends_mm).tolist(), halves_mm.tolist())


def _joined(lengths_mm: list[float], halves_mm: list[float]) -> list[CellWindow]:
    """Windows along a way, neighbours of one size as one."""
    found = list[CellWindow]()
    for long_mm, half_mm in zip(lengths_mm, halves_mm, strict=True):
        before_mm = found.pop().length_mm if found and found[-1].half_mm == half_mm else 0.0
        found.append(CellWindow(before_mm + long_mm, half_mm))
    return found


def bends_rad(way: Array, half_mm: float) -> tuple[Array, Array]:
    """Places along a way (n, 2) mm, and how far it turns at each from one half of a window to the other."""
    step_mm = half_mm / CHORDS
    places = at_lengths(way, np.arange(0.0, length_mm(way), step_mm))
    if len(places) <= 2 * CHORDS:
        return np.empty(0), np.empty(0)
    dx, dy = (places[CHORDS:] - places[:-CHORDS]).T
    headings = np.unwrap(np.arctan2(dy, dx))
    turns = np.abs(headings[CHORDS:] - headings[:-CHORDS])
    at_mm = step_mm * np.arange(CHORDS, CHORDS + len(turns))
    return np.asarray(at_mm, float), np.asarray(turns, float)


def lead_mm(t: Tuning, half_mm: float) -> float:
    """The lead that suffices for a low speed and half of a window, mm."""
    sweeps_mm = LEAD_SWEEPS * t.slowed * t.speed_mm_s * t.sweep_periods * t.period_s
    return min(t.lead_mm, half_mm + t.point_mm + sweeps_mm)


def shortest_lead_mm(t: Tuning) -> float:
    """The lead that suffices for every narrow window, mm."""
    return lead_mm(t, WINDOW_STEADY * t.narrow_mm)


def most_bend_per_mm(t: Tuning, ahead: Ahead) -> float:
    """The bend at which the slow cell stops on a way, 1/mm."""
    turns_rad = bends_rad(ahead.way, t.narrow_mm)[1]
    felt_per_mm = float(turns_rad.max(initial=0.0)) / t.narrow_mm
    least, most = BENT_WIDTHS / ahead.width_mm, TOUCHING_WIDTHS / ahead.width_mm
    return max(t.narrowest_per_mm, min(max(BENT_FELT * felt_per_mm, least), most))


def slowly(t: Tuning, half_mm: float, most_bend_per_mm: float) -> Tuning:
    """The tuning for a low speed, half of a window, mm, and the bend at which the cell stops, 1/mm."""
    return t._replace(
        speed_mm_s=t.slowed * t.speed_mm_s,
        lead_mm=lead_mm(t, half_mm),
        half_window_mm=half_mm,
        narrow_mm=half_mm,
        square=True,
        narrowest_per_mm=most_bend_per_mm,
    )
