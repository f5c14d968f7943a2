"""Swelling: how the width of the ink goes along a stretch, and how wide the pen of a clean sheet is.

Signals: the stations along a stretch (places mm, widths mm) in; its widths averaged out, mm.

A sheet is clean if its lines have smooth edges and much of the ink is about as narrow as the narrowest. Where
lines run in pairs all over, their ink is paler in its middle, which tells the pen, too.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import left_of_headings
from morfax.tracer.drawing.hollow import Hollow, hollow
from morfax.tracer.ink.felt import Ends
from morfax.tracer.ink.run import Run
from morfax.tracer.limits import CLEAR_WIDTHS

# All limits below were chosen by trial on drawings of nets and on line art.
AVERAGED = 2.0  # widths over which a width is averaged
NARROWEST = 0.02  # of the ink is narrower than the pen's width: junctions, ends
# of the pen's width about it; of the ink, which is as narrow
SO_NARROW = 0.05
MUCH_NARROW = 0.3  # of the ink: that is the pen's width, however rough its edges are
# times as much ink is as narrow as the pen as is a little broader, or more: of 14 nets of one pen 3.9 or more
ONE_WIDTH = 2.0
SMOOTH_EDGES = 0.02  # of the pen's width: deviation of a clean line's from its average
FEWEST = 10  # stations that tell a width
# stretches of broader ink: a pair of lines has less; and of that ink, as broad as a second pen. Of sheets of
# one pen whose lines run together 0.14 to 0.44, of line art of two pens 0.64
MANY, HALF = 10, 0.5
TWO = 2.5  # times the pen's width: ink that is wider is no two lines of it
MUCH_HOLLOW = 0.1  # of the ink: less is a place where the pen left its middle pale
BROADLY = 90.0  # percentile of a stretch's widths: its ink is hardly broader


class Swelling(NamedTuple):
    """A stretch: its stations, where the ink ends, its widths averaged, mm (NaN near its ends), and how they
    differ from that, of a width.
    """

    run: Run
    ends: Ends
    averaged: Array
    rough: float

    @classmethod
    def of(cls, run: Run, ends: Ends) -> Swelling | None:
        """Average the widths of a stretch; None if it is too short."""
        known = np.isfinite(run.widths_mm)
        if known.sum() < FEWEST:
            return None
        usual_mm = median(run.widths_mm[known])
        off = math.ceil(CLEAR_WIDTHS * usual_mm / run.view.step_mm)
        inside = known.copy()
        inside[:off] = inside[len(run) - off :] = False
        if inside.sum() < FEWEST:
            return None
        at = np.arange(len(run))
        filled = np.interp(at, at[inside], run.widths_mm[inside])
        reach = max(1, round(0.5 * AVERAGED * usual_mm / run.view.step_mm))
        padded = np.pad(filled, reach, mode="edge")
        averaged = np.convolve(padded, np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")
        rough = float(np.sqrt(np.mean((run.widths_mm - averaged)[inside] ** 2))) / usual_mm
        return cls(run, ends, np.where(inside, averaged, np.nan), rough)

    @property
    def known(self) -> Array:
        """The averaged widths where they are known, mm."""
        return np.asarray(self.averaged[np.isfinite(self.averaged)])


def pen_of(some: Sequence[Swelling]) -> float:
    """The width of a sheet's pen, the narrowest, mm; NaN if the sheet is not clean."""
    if not some:
        return math.nan
    lengths = np.array([len(each.known) * each.run.view.step_mm for each in some])
    rough = float(np.average([each.rough for each in some], weights=lengths))
    return narrow_of(some, SO_NARROW) if rough < SMOOTH_EDGES else math.nan


def narrow_of(some: Sequence[Swelling], least: float = MUCH_NARROW) -> float:
    """The narrowest width of the ink, mm, if at least so much of it is about as narrow; else NaN."""
    if not some:
        return math.nan
    widths = np.sort(np.concatenate([each.known for each in some]))
    pen_mm = float(widths[round(NARROWEST * (len(widths) - 1))])
    are_narrow = np.abs(widths / pen_mm - 1) < SO_NARROW
    return float(np.median(widths[are_narrow])) if np.mean(are_narrow) > least else math.nan


def second_pen_of(some: Sequence[Array]) -> float:
    """The width of a second pen, mm, by the widths along each stretch of ink broader than the first, if these
    are many and most of it is about as broad; else NaN. Ink that two lines share is of any width.
    """
    if len(some) < MANY:
        return math.nan
    ordered = np.sort(np.concatenate(some))
    first = np.searchsorted(ordered, ordered * (1 - SO_NARROW))
    last = int(np.argmax(np.arange(len(ordered)) - first))
    alike = ordered[first[last] : last + 1]
    return float(np.median(alike)) if len(alike) > HALF * len(ordered) else math.nan


def stands_out(some: Sequence[Swelling], pen_mm: float) -> bool:
    """Whether a pen's width stands out among all widths: a nib's are spread evenly."""
    shares = np.concatenate([each.known for each in some]) / pen_mm
    narrow = float(np.mean(np.abs(shares - 1) < SO_NARROW))
    broader = float(np.mean(np.abs(shares - 1 - 2 * SO_NARROW) < SO_NARROW))
    return narrow > ONE_WIDTH * broader


def pen_of_hollow(some: Sequence[Swelling]) -> float:
    """The width of the pen that drew two lines beside each other, mm, where much of a sheet is that; else
    NaN: the ink's width less what its two dark rows are apart. Between rows that are further apart there
    would be paper: such ink is a band, a sheet's shadow, say.
    """
    hollow_mm, pens_mm = 0.0, list[float]()
    for run in (each.run for each in some):
        if (found := _hollow(run)) is not None:
            near = int(np.argmin(np.hypot(*(run.places_mm - found.place_mm).T)))
            broad_mm = float(run.widths_mm[near])
            if broad_mm < TWO * (broad_mm - found.apart_mm):
                hollow_mm += found.length_mm
                pens_mm.append(broad_mm - found.apart_mm)
    is_much = hollow_mm > MUCH_HOLLOW * sum(each.run.length_mm for each in some)
    return float(np.nanmedian(pens_mm)) if is_much else math.nan


def _hollow(run: Run) -> Hollow | None:
    """The ink along a stretch that is paler in its middle than at its sides; None if it is so nowhere."""
    view = run.view

    def seen(places: Array, headings: Array, across: Array) -> Array:
        left = left_of_headings(headings)
        around = places[:, None] + left[:, None] * across[:, None]
        return view.darkness_along(around.reshape(-1, 2)).reshape(len(places), -1)

    broad_mm = float(np.nanpercentile(run.widths_mm, BROADLY))
    return hollow(seen, run.places_mm, broad_mm, view.pitch_mm)
