"""Lead parts: what a closed run has before it comes onto its contour and after it leaves it.

Signals: a Path in; the same Path out, its leads raised above the work, so that its runs are the contours.

A run is closed if a place of its first half comes back in its second half; what lies before the one and
after the other is its lead-in and lead-out. A line with an open stem is raised there as well.

Source: our own. `tracer.head.loop` finds where a run goes along its own way for a while, at the head's width;
here the two meet in one place.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import ROUNDED, Array
from morfax.motion.motion import Path
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import evenly, lengths_mm

MEET_MM = 0.02  # two places as near are one: a contour closes within some um
EVERY_MM = 0.005  # between the places that are looked at, ...
TIES_MM = 0.004  # ... so that of the nearest pairs the one furthest apart along the run is the contour's
HALF = 0.45  # of a run: before this its contour begins, and it ends in as much at the end
LEAST_MM = 0.2  # a shorter lead is how the head closes a line
RAISED_MM = 1.0  # above the work


def without_leads(path: Path) -> Path:
    """The path with the leads of its closed runs above the work."""
    edges = np.flatnonzero(np.diff(np.r_[False, path.tool, False].astype(np.int8)))
    rows, at = np.column_stack([path.t_s, path.positions_mm]), 0
    parts = list[Array]()
    for a, b in edges.reshape(-1, 2):
        parts += [rows[at:a], _raised(rows[a:b])]
        at = int(b)
    whole = np.vstack([*parts, rows[at:]])
    return replace(path, t_s=whole[:, 0], positions_mm=whole[:, 1:])


def _raised(run: Array) -> Array:
    """Rows (t, x, y, z …) of a run, its leads raised."""
    if len(run) < 2:
        return run
    s = lengths_mm(run[:, 1:3])
    begin_mm, end_mm = _contour(run[:, 1:3], float(s[-1]))
    moving = np.r_[True, np.diff(s) > 0]
    for cut_mm, is_lead_in in ((begin_mm, True), (end_mm, False)):
        if min(cut_mm, s[-1] - cut_mm) < LEAST_MM:
            continue
        split = np.array([np.interp(cut_mm, s[moving], column[moving]) for column in run.T])
        k = int(np.searchsorted(s, cut_mm))
        before = np.vstack([run[:k], split])
        after = np.vstack([split, run[k:]])
        (before if is_lead_in else after)[:, 3] = RAISED_MM
        run = np.vstack([before, after])
        s = lengths_mm(run[:, 1:3])
        moving = np.r_[True, np.diff(s) > 0]
    return run


def _contour(line_mm: Array, long_mm: float) -> tuple[float, float]:
    """From where to where along a line (n, 2) mm it is closed, mm; the whole if it is not."""
    if long_mm < 10 * LEAST_MM:
        return 0.0, long_mm
    places = np.vstack([evenly(line_mm, EVERY_MM), line_mm[-1:]])
    count = int(HALF * len(places))
    # most places have no other near: to find how far the nearest is would take ten times as long
    near_mm = (MEET_MM + TIES_MM) * (1 + ROUNDED)
    gaps, other = Neighbours(places[-count:]).nearest(places[:count], within=near_mm)
    if gaps.min() > MEET_MM:
        return 0.0, long_mm
    near = np.flatnonzero(gaps <= gaps.min() + TIES_MM)
    first = int(near[np.argmax(other[near] - near)])
    last = len(places) - count + int(other[first])
    return first * EVERY_MM, min(last * EVERY_MM, long_mm)
