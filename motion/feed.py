"""Feed: a way run at a speed, slower where bends and corners ask for it, from rest to rest; as positions at
the motion rate.

Signals: a polyline (n, 2) mm, a feed in mm/s and one acceleration in mm/s² in; positions (m, 2) mm at the
motion rate out.

    v <= feed      v² · bend <= a/3      v · dv/ds <= 0.7 a      v = 0 at a corner (`BEND_RAD`)

A way is made of straight pieces, so at each of its places the velocity would jump by v · turn. The positions
are averaged over `SMOOTHED_S`: in that time the jump is made at a third of the acceleration; the way moves
inward by no more than a · SMOOTHED_S² / 24: 0.1 um. Across and along together stay within a.

Source: the two passes that are usual in controls (see `motion.speed_limits`); the averaging is our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.plane import BEND_RAD, NOTHING_MM
from morfax.motion.polyline import at_lengths, lengths_mm, steps_mm
from morfax.motion.segments import SHARE
from morfax.motion.speed_limits import reachable

ACROSS = (
    1 / 3
)  # of the acceleration: in the way's bend, and again in its turns from piece to piece
SMOOTHED_S = 0.002
BEND_WITHIN_MM = 0.1  # the bend at a place is that within this to either side; by trial
STANDS_S = 2 * SMOOTHED_S  # at either end, so that the average comes to rest


def run_along(
    way_mm: Array, feed_mm_s: float, acceleration_mm_s2: float, rate_hz: float = MOTION_RATE_HZ
) -> Array:
    """Positions (m, 2) mm along a way, from rest at its first place to rest at its last."""
    # 1. the speed at each place of the way
    way_mm = _with_halves(way_mm)
    steps = steps_mm(way_mm)
    allowed = _allowed(way_mm, steps, feed_mm_s, acceleration_mm_s2)
    speeds = reachable(allowed, 2 * SHARE * acceleration_mm_s2 * steps)
    # 2. how far the tool has come at each period
    mean_mm_s = (speeds[1:] + speeds[:-1]) / 2
    t_s = np.r_[0.0, np.cumsum(steps / mean_mm_s)]
    s_mm = lengths_mm(way_mm)
    at_s = np.arange(0.0, t_s[-1], 1 / rate_hz)
    k = np.clip(np.searchsorted(t_s, at_s, side="right") - 1, 0, len(steps) - 1)
    since = at_s - t_s[k]
    whole = t_s[k + 1] - t_s[k]
    gained = 0.5 * (speeds[k + 1] - speeds[k]) * since / whole
    along = s_mm[k] + since * (speeds[k] + gained)
    # 3. standing at both ends, and averaged
    stands = round(STANDS_S * rate_hz)
    along = np.r_[np.zeros(stands), along, np.full(stands, s_mm[-1])]
    return _averaged(at_lengths(way_mm, along), rate_hz)


def _with_halves(way_mm: Array) -> Array:
    """The way without repeated places, its pieces halved, so that it moves between two stops."""
    way_mm = way_mm[np.r_[True, steps_mm(way_mm) > NOTHING_MM]]
    middles = 0.5 * (way_mm[1:] + way_mm[:-1])
    both = np.empty((2 * len(way_mm) - 1, 2))
    both[::2], both[1::2] = way_mm, middles
    return both


def _allowed(way_mm: Array, steps: Array, feed_mm_s: float, acceleration_mm_s2: float) -> Array:
    """Highest speed at each place, mm/s, by the turn there and the bend about it; 0 at corners and ends."""
    # 1. the turn at each place; both ends count as corners
    ways = np.diff(way_mm, axis=0)
    coming, going = ways[:-1], ways[1:]
    across = coming[:, 0] * going[:, 1] - coming[:, 1] * going[:, 0]
    along = np.einsum("ij,ij->i", coming, going)
    turns = np.abs(np.arctan2(across, along))
    turns = np.r_[math.pi, turns, math.pi]
    # 2. the bend about each place: the larger of those before and after it
    s = np.r_[0.0, np.cumsum(steps)]
    turned = np.r_[0.0, np.cumsum(np.where(turns > BEND_RAD, 0.0, turns))]
    low = np.searchsorted(s, s - BEND_WITHIN_MM)
    high = np.searchsorted(s, s + BEND_WITHIN_MM, side="right")
    turned_about = np.maximum(turned[high] - turned[:-1], turned[1:] - turned[low])
    bend = turned_about / np.minimum(BEND_WITHIN_MM, s[-1])
    # 3. the speeds that they allow
    across_mm_s2 = ACROSS * acceleration_mm_s2
    by_bend = np.sqrt(across_mm_s2 / np.maximum(bend, NOT_ZERO))
    by_turn = across_mm_s2 * SMOOTHED_S / np.maximum(turns, NOT_ZERO)
    return np.where(turns > BEND_RAD, 0.0, np.minimum(feed_mm_s, np.minimum(by_bend, by_turn)))


def _averaged(positions_mm: Array, rate_hz: float) -> Array:
    """Running mean over `SMOOTHED_S`; both ends stand for longer, and stay where they are."""
    window = 2 * round(SMOOTHED_S * rate_hz / 2) + 1
    padded = np.pad(positions_mm, ((window // 2, window // 2), (0, 0)), mode="edge")
    total = np.cumsum(np.vstack([np.zeros((1, 2)), padded - positions_mm[0]]), axis=0)
    smooth = positions_mm[0] + (total[window:] - total[:-window]) / window
    smooth[0] = positions_mm[0]
    smooth[-1] = positions_mm[-1]
    return np.asarray(smooth)
