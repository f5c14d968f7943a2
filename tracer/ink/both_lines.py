"""Both lines: the two lines of a pen whose ink runs together along a stretch.

Signals: the stations along a stretch of doubled ink (see `doubled`; places mm, widths mm) and the pen's width
in; out the stations of both lines, half a pen's width within the rims of their ink.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import left_of_headings
from morfax.tracer.drawing.thinning import Indices
from morfax.tracer.ink.felt import Ends, between_rims
from morfax.tracer.ink.run import LEAST_PLACES, Run, smooth

# All limits below were chosen by trial on drawings of nets and on line art.
# of its way: ink of two lines that becomes wider by more has come to others that cross it
FLARE = 0.15
TOUCHING = 0.05  # widths between the middles of two lines, halved: there they are one
# widths: narrow places that are nearer to each other are one; so far from it the ink's width is looked at
CROSSED = 3.0, 6.0
# widths from the middle of their ink: two lines that are further apart are told from each other
APART = 0.1
# of the stations where ink lies still: of two lines more lie together, between flares. Ink that swells and
# shrinks on the way is a line that is broader at its bends, as a printed letter's (0.2 to 0.7; a pen's loop
# 0.83); by trial
STILL = 0.75


def strands(stations: Run, width_mm: float, ends: Ends = (False, False)) -> list[Run]:
    """The two lines of a width whose ink runs together along some stations: half a width within its rims;
    `ends` says where their ink ends.

    None where the ink swells on the way. Of a leg or more their middle lies between the rims of the ink, and
    goes straight on over half a width before a junction, where the ink of what meets there begins. Where the
    ink is as narrow as one line they touch, or change sides:

        width │ ╲  ╱  crosses: it comes and goes at a slope     ╲_  _╱  touches: the slope fades
              │  ╲╱                                               ╲╱
    """
    known = np.flatnonzero(np.isfinite(stations.widths_mm))
    if len(known) < LEAST_PLACES:
        return []
    at = np.arange(len(stations))
    widths = np.interp(at, known, stations.widths_mm[known])
    reach = max(1, round(0.5 * width_mm / stations.view.step_mm))
    part_of = _without_flares(widths, known, reach, FLARE * reach * stations.view.step_mm)
    if part_of is None:
        return []
    stations, widths = stations.part(*part_of), widths[slice(*part_of)]
    near, far = (round(share * width_mm / stations.view.step_mm) for share in CROSSED)
    part = _told_apart(0.5 * (widths / width_mm - 1), ends, near, far)
    own = stations.part(part.start, part.stop)
    clear = slice(0 if ends[0] else reach, len(own) - (0 if ends[1] else reach))
    if (clear.stop - clear.start) * stations.view.step_mm > stations.view.leg_mm:
        own = _drawn_out(between_rims(own.part(clear.start, clear.stop)), own, clear)
    return within_rims(own, widths[part], width_mm)


def _drawn_out(clear: Run, whole: Run, part: slice) -> Run:
    """A run with stations straight ahead of its ends, for those of a whole of which it is a part."""
    steps = np.arange(len(whole)) - part.start
    within = np.clip(steps, 0, len(clear) - 1)
    headings = clear.headings_rad[within]
    ahead_mm = (steps - within) * whole.view.step_mm
    ways = np.column_stack([np.cos(headings), np.sin(headings)])
    places = clear.places_mm[within] + ahead_mm[:, None] * ways
    return replace(whole, places_mm=places, headings_rad=headings)


def within_rims(part: Run, widths: Array, width_mm: float) -> list[Run]:
    """The two lines of a width along stations of ink of some widths, mm: half a width within its rims."""
    aside = 0.5 * np.maximum(widths - width_mm, 0.0)
    aside *= _sides(aside, width_mm, part.view.step_mm)
    normals = left_of_headings(part.headings_rad)
    own = replace(part, widths_mm=np.full(len(part), width_mm), is_strand=True)
    return [
        smooth(replace(own, places_mm=part.places_mm + side * aside[:, None] * normals))
        for side in (1, -1)
    ]


def _told_apart(aside: Array, ends: Ends, near: int, far: int) -> slice:
    """The stations from where two lines are told apart, by how far both are from their ink's middle, widths.

    Where they are together within so `far` of a junction they cross or meet at it, and which of them is on
    which side is told from beyond that. Not where their ink ends.
    """
    together, count = np.flatnonzero(aside < APART), len(aside)
    parts = np.split(together, np.flatnonzero(np.diff(together) > near) + 1)
    parts = [part for part in parts if len(part)]
    before = [part[-1] + 1 for part in parts if part[0] < far and not ends[0]]
    behind = [part[0] for part in parts if part[-1] + far >= count and not ends[1]]
    begin, end = int(max(before, default=0)), int(min(behind, default=count))
    return slice(begin, end) if end - begin > LEAST_PLACES else slice(0, count)


def _sides(aside: Array, width_mm: float, step_mm: float) -> Array:
    """On which side one of two lines is at each station, 1 or -1: it changes where they cross."""
    near, far = (round(share * width_mm / step_mm) for share in CROSSED)
    sides = np.ones(len(aside))
    narrow = np.flatnonzero(aside < TOUCHING * width_mm)
    for some in np.split(narrow, np.flatnonzero(np.diff(narrow) > near) + 1):
        if not len(some) or some[0] == 0 or some[-1] == len(aside) - 1:
            continue
        at = round(float(some.mean()))
        reach = min(max(far, len(some)), at, len(aside) - 1 - at)
        off = np.arange(1, reach + 1) / reach
        # by how much both are aside on either side: a * off + b * off²
        both = aside[at - reach : at][::-1] + aside[at + 1 : at + reach + 1]
        slope, rise = np.linalg.lstsq(np.column_stack([off, off**2]), both)[0]
        if slope > rise:
            sides[at:] *= -1
    return sides


def _without_flares(
    widths: Array, known: Indices, reach: int, most_mm: float
) -> tuple[int, int] | None:
    """The first station and the one after the last between which ink of two lines does not flare out into
    what crosses it, by more than a width over some stations; all that are known where it never lies still;
    None where it swells and shrinks on the way.
    """
    first, last = int(known[0]), int(known[-1]) + 1
    if last - first <= reach:
        return first, last
    steps = widths[first + reach : last] - widths[first : last - reach]
    quiet = np.flatnonzero(np.abs(steps) < most_mm)
    if len(quiet) < LEAST_PLACES:
        return first, last
    # a flare is still for a moment where it is broadest
    parts = np.split(quiet, np.flatnonzero(np.diff(quiet) > reach) + 1)
    longest = max(parts, key=lambda part: int(part[-1] - part[0]))
    before, behind = steps[quiet[0] : longest[0]], steps[longest[-1] : quiet[-1]]
    among = steps[quiet[0] : quiet[-1]]
    is_both = among.max() > most_mm and among.min() < -most_mm
    # it may become narrower as it comes from one flare, and broader as it goes into the other
    swells = before.max(initial=0.0) > most_mm or behind.min(initial=0.0) < -most_mm
    if len(longest) < STILL * len(quiet) and is_both and swells:
        return None
    return first + int(longest[0]), first + int(longest[-1]) + reach + 1
