"""The scout: feels along a line ahead of the head, station by station, as far as the line is clean.

Signals: a pose on the line in; stations of the line (n, 3: centre x, y and width, mm) out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit
from morfax.motion.plane import heading_between
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.ray import edges_beside

# widths and pixels from where a line is expected, within which its edges are
REACH, REACH_PX = 0.8, 3.0
# of the width, and pixels: by less than this a clean line's width differs, and its centre leaps aside
CLEAN, CLEAN_PX = 0.2, 0.5
LEAP, LEAP_PX = 1 / 6, 0.4
FOLLOWS_PER_MM = 0.2  # of the difference: a line may swell, and the expected width follows it
LEG_MM = 1.2  # how much of a leg is felt for its direction, at a line of 0.5 mm
LEG_PX = 12  # and at least so many pixels
FEWEST = 4  # stations that a line is felt along at the least
# along the line, that a speck spoils: two pixels through the aperture
SPECK_MM, SPECK_PX = 0.16, 2.5


@njit(cache=True)
def scout(cells, pose, width_mm, step_mm, stations):  # type: ignore[no-untyped-def]
    """Feel along a line from a pose (x mm, y mm, heading rad) on it: (n, 3) centre x, y and width, mm.

    At each station the edges are found across the way that the last stations point. A station is not clean
    where an edge is missing, where the width differs by a fifth from that of the line so far, or where the
    centre leaps aside by a sixth of the width. A speck may spoil a few stations: the scout passes over them
    if the line is clean for longer behind them; else the clean line ends before them.
    """
    seen, pitch_mm = np.empty((stations, 3)), cells.pitch_mm
    reach = REACH * width_mm + REACH_PX * pitch_mm
    passed_over = int(max(SPECK_MM, SPECK_PX * pitch_mm) / step_mm)
    x, y, heading = pose
    c, s = math.cos(heading), math.sin(heading)
    count = spoilt = 0
    before_speck, since_speck = 0, passed_over + 1
    for _ in range(stations):
        right, left = edges_beside(cells, (x, y), (c, s), reach)
        width, aside = left - right, 0.5 * (left + right)
        is_wide = abs(width - width_mm) < CLEAN * width_mm + CLEAN_PX * pitch_mm
        is_beside = abs(aside) < LEAP * width_mm + LEAP_PX * pitch_mm
        if is_wide and (count == 0 or is_beside):
            seen[count, 0] = x - aside * s
            seen[count, 1] = y + aside * c
            seen[count, 2] = width
            width_mm += FOLLOWS_PER_MM * step_mm * (width - width_mm)
            count += 1
            since_speck += 1
            spoilt = 0
            x = seen[count - 1, 0]
            y = seen[count - 1, 1]
            if count >= 3:
                heading = onward(seen, count)
                c, s = math.cos(heading), math.sin(heading)
        else:
            if since_speck > passed_over:
                before_speck = count
            since_speck = 0
            spoilt += 1
            if spoilt > passed_over or count == 0:
                break
        x += step_mm * c
        y += step_mm * s
    return seen[: count if since_speck > passed_over else before_speck].copy()


@njit(cache=True)
def leg_mm(width_mm, pitch_mm):  # type: ignore[no-untyped-def]
    """How much of a leg is felt for its direction, for kernels (see `View.leg_mm`)."""
    return max(LEG_MM, LEG_PX * pitch_mm, CLEAR_WIDTHS * width_mm)


@njit(cache=True)
def felt(cells, pose, width_mm, along_mm):  # type: ignore[no-untyped-def]
    """Stations (n, 3) from a pose, by the step and for the length of `along_mm` (see `View.feel`)."""
    step_mm, length_mm = along_mm
    return scout(cells, pose, width_mm, step_mm, stations_of(step_mm, length_mm))


@njit(cache=True)
def stations_of(step_mm, length_mm):  # type: ignore[no-untyped-def]
    """How many stations a line is felt at for a length."""
    return max(FEWEST, round(length_mm / step_mm) + 1)


@njit(cache=True)
def onward(seen, count):  # type: ignore[no-untyped-def]
    """Heading from the newest station to the next: the last chord's, turned on as the chords have turned."""
    last, back = count - 1, max(0, count - 5)
    chord = heading_between(seen, back, last)
    if count < 9:
        return chord
    before = heading_between(seen, back - 4, back)
    turned = chord - before
    turned -= math.tau * round(turned / math.tau)
    return chord + 0.625 * turned  # from the chord's middle to half a step beyond its end
