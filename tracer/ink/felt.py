"""Felt stretches: where the middle of the ink is along a stretch, and where the line there is clean.

Signals: the cells and a guide, places (n, 2) mm about on a line, in; stations a step apart out, each with its
place on the middle of the line (mm), heading (rad), bend (1/mm) and width (mm), and the runs of them between
which the line is not clean: junctions' ink, corners, blots.

Every station is felt twice, across the guide and then across what was felt, so that the guide's own places do
not matter. Then a parabola is laid through the stations about each, as the head does with its drum.

Source: our own (see `sensing.scout`, which feels ahead where nothing is known yet; here the whole stretch is
known before the head goes along it).
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import ROBUST, median
from morfax.motion.plane import left_of_headings
from morfax.motion.polyline import lengths_mm
from morfax.tracer.head.course import SMOOTH
from morfax.tracer.ink.run import LEAST_PLACES, Run, smooth
from morfax.tracer.junctions.rings import CHORD, SKIPPED
from morfax.tracer.limits import AS_WIDE, LONGER_WIDTHS
from morfax.tracer.sensing.leg import LEAST_WIDTHS, TURNS_OFF
from morfax.tracer.sensing.ray import edges
from morfax.tracer.sensing.scout import (
    CLEAN,
    CLEAN_PX,
    LEAP,
    LEAP_PX,
    REACH_PX,
    SPECK_MM,
    SPECK_PX,
)
from morfax.tracer.sensing.view import View

Flags = NDArray[np.bool_]

# All limits below were chosen by trial on drawings of nets.
REACH = 1.0  # widths, with `REACH_PX`, within which the edges are looked for
GUIDED_WIDTHS = 0.75  # to either side of a place: what its heading is taken over
ROUGHER = 2.5  # standard deviations of a rough line's own width: so far a station may differ
MARGIN = 2  # stations at the ends of a run that may have felt what ends it
MEANT = 2.0  # lengths of a leg: a longer line's own width counts, and not its neighbours'
# a part at an end of the ink that is as long is line, however it tapers, if so much of it has two edges
TAPERED_WIDTHS, FELT_SHARE = 1.0, 0.7


Parted = tuple[
    list[Run], list[Array]
]  # clean runs, and places (n, 2) mm felt from each to the next


Ends = tuple[bool, bool]  # whether the ink ends at the first station, and at the last


class Felt(NamedTuple):
    """What was felt along a guide: all stations, and which of them are those of clean line."""

    stations: Run
    clean: Flags

    def runs(self, ends: Ends = (False, False)) -> Parted:
        """The clean runs, cut at corners, and what was felt between them; `ends` says where the ink ends."""
        found, cuts_at = list[Run](), list[tuple[int, int]]()
        for first, last, view in self._parts(ends):
            run = replace(self.stations.part(first, last), view=view)
            cuts = [0, *_corners(run.places_mm), len(run)]
            for k, (begin, end) in enumerate(pairwise(cuts)):
                a = begin + (SKIPPED if k else 0)
                b = end - (SKIPPED if k < len(cuts) - 2 else 0)
                if _is_long_enough(b - a, run.view):
                    found.append(smooth(run.part(a, b)))
                    cuts_at.append((first + a, first + b))
        places = self.stations.places_mm
        parted = [places[b:a] for (_, b), (a, _) in pairwise(cuts_at)]
        return found, parted

    def _parts(self, is_end: Ends) -> list[tuple[int, int, View]]:
        """First station, the one after the last, and the view of each clean part.

        Where a line becomes wider or narrower it is clean at its new width, if it keeps that. Where its ink
        ends it may taper.
        """
        view = self.stations.view
        spans = _runs_of(self.clean, view)
        parts = [(*span, view) for span in spans]
        if not spans:
            return parts
        last_place = len(self.stations)
        ends = [0, *(at for span in spans for at in span), last_place]
        for first, last in zip(ends[::2], ends[1::2], strict=True):
            part = self.stations.part(first, last)
            width_mm = usual_width_mm(part)
            own = replace(view, width_mm=width_mm)
            tip = math.ceil(0.5 * width_mm / view.step_mm) + MARGIN
            if (first == 0 and is_end[0]) or (last == last_place and is_end[1]):
                a, b = (
                    (first + tip, last - MARGIN) if first == 0 else (first + MARGIN, last - tip)
                )
                if (b - a) * view.step_mm > TAPERED_WIDTHS * width_mm and _is_felt(part):
                    parts.append((a, b, own))
            elif last - first > LEAST_PLACES and is_steady(part, width_mm):
                clean = judged(replace(part, view=own), width_mm).clean
                parts += [(first + a, first + b, own) for a, b in _runs_of(clean, own)]
        return sorted(parts, key=lambda part: part[0])


def feel_along(view: View, guide_mm: Array) -> Run:
    """Stations along a guide (n, 2) mm, with NaN for the width where the ink has no two edges."""
    reach_mm = REACH * view.width_mm + REACH_PX * view.pitch_mm
    reach_stations = max(2, round(GUIDED_WIDTHS * view.width_mm / view.step_mm))
    places = _evenly(guide_mm, view.step_mm)
    for _ in range(2):
        headings = _headings(places, reach_stations)
        found = _felt_across(view.cells, places, headings, reach_mm)
        aside, widths = 0.5 * (found[:, 0] + found[:, 1]), found[:, 1] - found[:, 0]
        known = widths[np.isfinite(widths)]
        usual_mm = median(known) if len(known) else view.width_mm
        # where the ink is broader another line may join it; thinner ink is the line's own
        on_it = widths - usual_mm < CLEAN * usual_mm + CLEAN_PX * view.pitch_mm
        on_it &= np.abs(aside) < LEAP * usual_mm + 2 * view.pitch_mm
        aside = np.where(on_it, aside, 0.0)
        normals = left_of_headings(headings)
        places = places + aside[:, None] * normals
    return Run(places, headings, np.zeros(len(places)), widths, view)


def between_rims(run: Run) -> Run:
    """A run whose places lie in the middle between the rims of its ink where that has two, and whose headings
    are those of the way through them: on broad ink `feel_along` keeps them to the guide. Stations that leap
    onto other ink lie between the others.
    """
    view, leaps = run.view, _leaps(run, run.view.width_mm)
    reach_mm = REACH * view.width_mm + REACH_PX * view.pitch_mm
    found = _felt_across(view.cells, run.places_mm, run.headings_rad, reach_mm)
    aside = np.nan_to_num(0.5 * (found[:, 0] + found[:, 1]))
    places = run.places_mm + aside[:, None] * left_of_headings(run.headings_rad)
    known = np.flatnonzero(~(np.r_[False, leaps] & np.r_[leaps, False]))
    at = np.arange(len(run))
    places = np.column_stack([np.interp(at, known, column[known]) for column in places.T])
    reach = max(2, round(GUIDED_WIDTHS * view.width_mm / view.step_mm))
    return replace(run, places_mm=places, headings_rad=_headings(places, reach))


def judged(stations: Run, width_mm: float, *, is_smooth: bool = False) -> Felt:
    """Which stations are those of clean line, if a line is as wide as this; smooth ones all along."""
    view, widths = stations.view, stations.widths_mm
    off = np.abs(widths - width_mm)
    known = np.isfinite(widths)
    within_mm = CLEAN * width_mm + CLEAN_PX * view.pitch_mm
    if stations.length_mm > MEANT * view.leg_mm and known.any() and not is_smooth:
        usual_mm = median(widths[known])
        spread_mm = ROBUST * median(np.abs(widths[known] - usual_mm))
        if abs(usual_mm - width_mm) < within_mm:
            within_mm = max(within_mm, ROUGHER * spread_mm)
    clean = known & (off < within_mm)
    clean[1:] &= ~_leaps(stations, width_mm)
    return Felt(stations, clean)


def _leaps(stations: Run, width_mm: float) -> Flags:
    """Which steps between stations lead onto other ink than that of their line."""
    view, steps = stations.view, np.hypot(*np.diff(stations.places_mm, axis=0).T)
    return np.asarray(np.abs(steps - view.step_mm) > LEAP * width_mm + LEAP_PX * view.pitch_mm)


def _is_felt(run: Run) -> bool:
    """Whether the ink has two edges along most stations."""
    return bool(np.mean(np.isfinite(run.widths_mm)) > FELT_SHARE)


def usual_width_mm(run: Run) -> float:
    """The median width of some stations, mm; what their view says where the ink has no two edges."""
    known = run.widths_mm[np.isfinite(run.widths_mm)]
    return median(known) if len(known) else run.view.width_mm


def is_steady(run: Run, width_mm: float) -> bool:
    """Whether a line is as wide everywhere, but near its ends: ink that two lines share is not."""
    fifth = len(run) // 5
    widths = run.widths_mm[fifth : len(run) - fifth]
    known = widths[np.isfinite(widths)]
    if run.length_mm < LONGER_WIDTHS * width_mm or len(known) < len(widths):
        return False
    narrow_mm, wide_mm = np.percentile(known, (10, 90))
    return bool(wide_mm - narrow_mm < AS_WIDE * wide_mm)


def whole(stations: Run) -> Run:
    """All the stations as one run, though the line is clean nowhere."""
    usual_mm = stations.view.width_mm
    widths = np.where(np.isfinite(stations.widths_mm), stations.widths_mm, usual_mm)
    return smooth(replace(stations, widths_mm=widths))


def _runs_of(clean: Flags, view: View) -> list[tuple[int, int]]:
    """First station, and the one after the last, of each clean run; a speck does not part a run."""
    passed_over = int(max(SPECK_MM, SPECK_PX * view.pitch_mm) / view.step_mm)
    edges_at = np.flatnonzero(np.diff(np.r_[False, clean, False].astype(np.int8)))
    merged: list[list[int]] = []
    for first, last in edges_at.reshape(-1, 2).tolist():
        if merged and first - merged[-1][1] <= passed_over:
            merged[-1][1] = last
        else:
            merged.append([first, last])
    kept = []
    for first, last in merged:
        a = first + (MARGIN if first else 0)
        b = last - (MARGIN if last < len(clean) else 0)
        if _is_long_enough(b - a, view):
            kept.append((a, b))
    return kept


def _is_long_enough(stations: int, view: View) -> bool:
    """Whether so many stations are a run, and no chance."""
    return stations >= max(LEAST_PLACES, LEAST_WIDTHS * view.width_mm / view.step_mm)


def _corners(places: Array) -> list[int]:
    """The stations at which a line that was felt clean turns suddenly."""
    reach = CHORD + SKIPPED
    middle = np.arange(reach, len(places) - reach)
    if not len(middle):
        return []
    before = places[middle - SKIPPED] - places[middle - reach]
    after = places[middle + reach] - places[middle + SKIPPED]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = np.arctan2(cross, np.sum(before * after, axis=1))
    # how the line bends before and behind, each a chord and a half away
    beside = np.pad(turned, 2 * reach, mode="edge")
    bends = 0.5 * (beside[: len(turned)] + beside[4 * reach :][: len(turned)])
    sudden = np.abs(turned - bends)
    found = []
    while len(sudden):
        k = int(np.argmax(sudden))
        if sudden[k] < SMOOTH:
            break
        if abs(turned[k]) > TURNS_OFF:
            found.append(int(middle[k]))
        sudden[max(0, k - 2 * reach) : k + 2 * reach] = 0.0
    return sorted(found)


def _evenly(guide_mm: Array, step_mm: float) -> Array:
    """Places of a guide a step apart, its ends among them, (n, 2) mm."""
    come_mm = lengths_mm(guide_mm)
    steps = max(1, round(float(come_mm[-1]) / step_mm))
    at_mm = np.linspace(0.0, come_mm[-1], steps + 1)
    return np.column_stack([np.interp(at_mm, come_mm, column) for column in guide_mm.T])


def _headings(places: Array, reach: int) -> Array:
    """Headings of a line at its places, each by the chord from so many places before it to as many behind."""
    at = np.arange(len(places))
    chords = places[np.minimum(at + reach, len(places) - 1)] - places[np.maximum(at - reach, 0)]
    return np.arctan2(chords[:, 1], chords[:, 0])


@njit(cache=True)
def _felt_across(cells, places, headings, reach_mm):  # type: ignore[no-untyped-def]
    """Where the ink ends to the right and to the left of each place and heading, (n, 2) mm (see `ray`)."""
    found = np.empty((len(places), 2))
    for n in range(len(places)):
        right, left = edges(cells, places[n, 0], places[n, 1], headings[n], reach_mm)
        found[n, 0], found[n, 1] = right, left
    return found
