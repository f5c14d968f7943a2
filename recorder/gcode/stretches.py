"""Stretches: a path cut into the parts that one kind of block can say.

Signals in: a path in mm over s. Signals out: stretches in the order of the path, each in a plane, upright or
on a slope, with the speed at which most of its length is run, and the dwell before it.

The path is cut where Z begins or ends to move, and at every dwell. An upright stretch is cut again where Z
turns round (a peck) and where Z comes to a stand between two moves (a new feed), so that each of the
operator's moves keeps its depth and its feed:

    Z    \\  clearance                   down | down slower | up | down to the next peck | up
          \\___ surface
              \\    /\\      /
               \\__/  \\    /             speed of a move:  /----\\   between two moves it falls to nearly 0
                      \\__/

Source: none of the patents says how the moves of a program are found in a motion; chosen here. Questions: a
stand of `DWELL_S` or more is a dwell that the operator asked for; the head itself stands for 0.16 s at most
where it swivels by half a turn (at 20 rad/s).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.motion import IN_WORK_BELOW_MM, THINNING_TOLERANCE_MM, Path
from morfax.motion.usual import FASTEST_MM_S, SLOWEST_MM_S

DWELL_S = 0.25  # half as long again as the longest swivel of the head
LEVEL = 0.02  # Z that changes less than this share of the way across stands
NOISE_MM = THINNING_TOLERANCE_MM
# over less on either side of a rest, noise hides whether a step climbs
HIDDEN_MM = 2 * NOISE_MM / LEVEL
STAND = 0.25  # of the speed before and after it: a slower place parts two moves of Z
HALF = 0.5  # of the length: its median speed is the feed of a stretch
# of an upright move, which has hardly left its ramp up when the ramp down begins
UPRIGHT_SHARE = 0.9

Kind = Literal["plane", "slope", "upright"]


@dataclass(frozen=True, slots=True)
class FeedStretch:
    """Points (n, 3) mm of one kind, the speed at which most of their length is run, and the dwell before."""

    points_mm: Array
    kind: Kind
    speed_mm_s: float
    dwell_s: float = 0.0

    @property
    def plunge_mm(self) -> float:
        """How far it goes straight down into the work."""
        z_mm = self.points_mm[:, 2]
        is_plunge = self.kind == "upright" and not self.rapid
        return float(z_mm[0] - z_mm[-1]) if is_plunge else 0.0

    @property
    def rapid(self) -> bool:
        """Whether the stretch is run above the work, or straight up out of it."""
        z_mm = self.points_mm[:, 2]
        above = bool(z_mm.min() > IN_WORK_BELOW_MM)
        goes_out = bool(z_mm[-1] > max(z_mm[0], IN_WORK_BELOW_MM))
        return above or (self.kind == "upright" and goes_out)


@dataclass(frozen=True, slots=True)
class _Steps:
    """The steps of a path that move: which, how far across and up (mm, signed), how long, and the stand
    before.
    """

    index: NDArray[np.int64]
    across_mm: Array
    up_mm: Array
    took_s: Array
    stood_s: Array
    climbs: NDArray[np.bool_]


def stretches(path: Path, tolerance_mm: float) -> Iterator[FeedStretch]:
    """The stretches of a path; a path that stands at one place has none."""
    steps = _moving(path)
    cuts = np.flatnonzero(np.diff(steps.climbs) | (steps.stood_s[1:] > 0)) + 1
    ends = [0, *cuts.tolist(), len(steps.index)]
    for first, last in pairwise(ends):
        for a, b in _moves(steps, first, last):
            yield _stretch(path, steps, slice(a, b), tolerance_mm)


def _moving(path: Path) -> _Steps:
    """The steps of a path without those that stand, each with the dwell before it (0 s: none)."""
    step = np.diff(path.positions_mm, axis=0)
    across_mm = np.hypot(step[:, 0], step[:, 1])
    up_mm = step[:, 2]
    took_s = np.diff(path.t_s)
    climbs = (np.abs(up_mm) > LEVEL * across_mm) & (np.abs(up_mm) > NOISE_MM)
    stands = (took_s >= DWELL_S) & (np.hypot(across_mm, up_mm) <= 2 * NOISE_MM)
    index = np.flatnonzero(~stands & (climbs | (across_mm > NOISE_MM / 10)))
    climbs[index] = _with_rests(climbs[index], across_mm[index])
    begins_s = path.t_s[index]
    ends_s = path.t_s[index] + took_s[index]
    stood_s = begins_s - np.r_[begins_s[:1], ends_s[:-1]]
    dwelt_s = np.where(stood_s >= DWELL_S, stood_s, 0.0)
    return _Steps(index, across_mm[index], up_mm[index], took_s[index], dwelt_s, climbs[index])


def _with_rests(climbs: NDArray[np.bool_], across_mm: Array) -> NDArray[np.bool_]:
    """Which steps climb, with those of a slope that are so short that noise hides it: where it begins from
    rest.
    """
    climbs = climbs.copy()
    edges = np.flatnonzero(np.diff(np.r_[True, climbs, True].astype(np.int8)))
    for first, last in edges.reshape(-1, 2):
        beside = np.r_[across_mm[max(first - 1, 0) : first], across_mm[last : last + 1]]
        is_short = across_mm[first:last].sum() <= HIDDEN_MM
        if is_short and len(beside) and beside.max() > NOISE_MM:
            climbs[first:last] = True
    return climbs


def _moves(steps: _Steps, first: int, last: int) -> list[tuple[int, int]]:
    """Ranges of steps between two cuts: one in a plane, of those that climb one for each move of Z."""
    if first == last or not steps.climbs[first]:
        return [(first, last)] if first < last else []
    up_mm = steps.up_mm[first:last]
    took_s = steps.took_s[first:last]
    turns = np.flatnonzero(np.diff(_senses(up_mm)) != 0) + 1
    found = []
    for a, b in pairwise([0, *turns.tolist(), len(up_mm)]):
        speeds_mm_s = np.abs(up_mm[a:b]) / np.maximum(took_s[a:b], NOT_ZERO)
        stands = [a + k for k in _stands(speeds_mm_s)]
        found += [(first + c, first + d) for c, d in pairwise([a, *stands, b])]
    return found


def _senses(up_mm: Array) -> Array:
    """Whether each step goes up (1) or down (-1); one that goes neither way as the step before it."""
    senses = np.sign(np.where(np.abs(up_mm) > NOISE_MM, up_mm, 0.0))
    known = np.flatnonzero(senses)
    before = np.maximum(np.searchsorted(known, np.arange(len(senses)), "right") - 1, 0)
    return senses[known[before]] if len(known) else senses


def _stands(speeds_mm_s: Array) -> list[int]:
    """Where a motion in one direction slows down nearly to a stand: the slowest step of each such place."""
    fastest_before = np.maximum.accumulate(speeds_mm_s)
    fastest_after = np.maximum.accumulate(speeds_mm_s[::-1])[::-1]
    slow = np.flatnonzero(speeds_mm_s < STAND * np.minimum(fastest_before, fastest_after))
    if not len(slow):
        return []
    places = np.split(slow, np.flatnonzero(np.diff(slow) > 1) + 1)
    return [int(place[np.argmin(speeds_mm_s[place])]) for place in places]


def _stretch(path: Path, steps: _Steps, part: slice, tolerance_mm: float) -> FeedStretch:
    """A stretch of some steps."""
    index = steps.index[part]
    points = path.positions_mm[np.r_[index, index[-1] + 1]]
    kind: Kind = "plane"
    if steps.climbs[part.start]:
        is_upright = np.ptp(points[:, :2], axis=0).max() <= tolerance_mm / 4
        kind = "upright" if is_upright else "slope"
    elif float(np.ptp(points[:, 2])) > tolerance_mm / 2:
        kind = "slope"
    if kind == "upright":
        points[:, :2] = points[
            0, :2
        ]  # a sample may lie in the corner where the tool turns upwards
    lengths_mm = np.hypot(steps.across_mm[part], steps.up_mm[part])
    share = UPRIGHT_SHARE if kind == "upright" else HALF
    speed_mm_s = _speed_mm_s(lengths_mm, steps.took_s[part], share)
    return FeedStretch(points, kind, speed_mm_s, float(steps.stood_s[part.start]))


def _speed_mm_s(lengths_mm: Array, seconds: Array, share_below: float) -> float:
    """The speed below which a share of the length is run."""
    speeds = lengths_mm / np.maximum(seconds, NOT_ZERO)
    order = np.argsort(speeds)
    run_mm = np.cumsum(lengths_mm[order])
    feed_mm_s = speeds[order[np.searchsorted(run_mm, share_below * run_mm[-1])]]
    return float(np.clip(feed_mm_s, SLOWEST_MM_S, FASTEST_MM_S))
