"""The scout: feels along a line ahead of the head, station by station, as far as the line is clean.

Signals: a pose on the line in; stations of the line (n, 3: centre x, y and width, mm) out.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from morfax.tracer.sensing.ray import edges

# widths and pixels from where a line is expected, within which its edges are
REACH, REACH_PX = 0.8, 3.0
CLEAN = 0.2  # of the width, by which a clean line's may differ
# a line that is felt may swell: its width follows what was felt, by so much of the difference
FOLLOWS_PER_MM = 0.2


@njit(cache=True)
def scout(cells, pose, width_mm, step_mm, stations):  # type: ignore[no-untyped-def]
    """Feel along a line from a pose (x mm, y mm, heading rad) on it: (n, 3) centre x, y and width, mm, where the line is seen clean
    between two edges.

    At each station the edges are found across the way that the last stations point. A station is not clean
    where an edge is missing, where the width leaves what the line has had by a fifth, or where the centre
    leaps aside by a sixth of the width. A speck may spoil a few stations: they are passed over if the line is
    clean for longer behind them; else the clean line ends before them.
    """
    seen, pitch_mm = np.empty((stations, 3)), cells.pitch_mm
    reach = REACH * width_mm + REACH_PX * pitch_mm
    passed_over = int(max(0.16, 2.5 * pitch_mm) / step_mm)
    x, y, heading = pose
    count = spoilt = 0
    before_speck, since_speck = 0, passed_over + 1
    for _ in range(stations):
        right, left = edges(cells, x, y, heading, reach)
        width, aside = left - right, 0.5 * (left + right)
        slack = CLEAN * width_mm + 0.5 * pitch_mm
        if abs(width - width_mm) < slack and (
            count == 0 or abs(aside) < width_mm / 6 + 0.4 * pitch_mm
        ):
            seen[count, 0], seen[count, 1] = (
                x - aside * math.sin(heading),
                y + aside * math.cos(heading),
            )
            seen[count, 2] = width
            width_mm += FOLLOWS_PER_MM * step_mm * (width - width_mm)
            count += 1
            since_speck += 1
            spoilt = 0
            x, y = seen[count - 1, 0], seen[count - 1, 1]
            if count >= 3:
                heading = onward(seen, count)
        else:
            if since_speck > passed_over:
                before_speck = count
            since_speck = 0
            spoilt += 1
            if spoilt > passed_over or count == 0:
                break
        x, y = x + step_mm * math.cos(heading), y + step_mm * math.sin(heading)
    return seen[: count if since_speck > passed_over else before_speck].copy()


@njit(cache=True)
def onward(seen, count):  # type: ignore[no-untyped-def]
    """Heading from the newest of some stations to the next: that of the last stations' chord, and on by what
    the chords have turned.
    """
    last, back = count - 1, max(0, count - 5)
    chord = math.atan2(seen[last, 1] - seen[back, 1], seen[last, 0] - seen[back, 0])
    if count < 9:
        return chord
    before = math.atan2(seen[back, 1] - seen[back - 4, 1], seen[back, 0] - seen[back - 4, 0])
    turned = math.atan2(math.sin(chord - before), math.cos(chord - before))
    return chord + 0.625 * turned  # from the chord's middle to half a step beyond its end
