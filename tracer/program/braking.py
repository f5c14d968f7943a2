"""Stops on the way: the axis brakes, stands on a place exactly, and goes on.

Signals: positions of the head (n, 2) mm at the motion rate, and the positions to stand on (fractions
included), in; pieces (n, 2) mm out, each of which comes to rest on the place where the next begins.

    speed ─────╮         ╭──────       within the braking distance the speed is the lower of the former speed
                                       and what the brake allows:
                ╲       ╱
                 ╲__●__╱                    v² = 2 · acceleration · distance to the place

The way stays the same, only its timing changes; outside the braking distances the timing stays, too.

Source: patent ES 361967, figure 1: a stop mark stops the follower; X and Y tracks then carry the reference
frequency while the tape runs on. Questions: the patent leaves open how far before a mark the follower brakes.
The cell sees the mark one lead before the axis, which is enough for it at 10 mm/s.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, at_places, lengths_mm, steps_mm
from morfax.motion.speed_limits import reachable

_NOTHING_MM = 1e-9  # a shorter step is the head standing
_NOTHING_S = 1e-12  # so that no time is divided by zero
CORNER = np.radians(
    20
)  # a sharper turn is a corner, at which the head stops to swivel; by trial
RUN_MM = 0.1  # from node to node of a way that is run from memory
SLOWEST_MM_S = 0.02  # where the head swivels it stands: its time there is kept


def pieces(
    xy_mm: Array, halts: Sequence[float], acceleration_mm_s2: float, rate_hz: float
) -> list[Array]:
    """The way cut at its halts: one piece more than `halts`, at rest at the cuts; before the first row 0."""
    # 1. the halts as nodes among the positions
    at = np.clip(np.asarray(halts, float), 0, len(xy_mm) - 1)
    nodes = np.unique(np.r_[np.arange(len(xy_mm), dtype=float), at])
    places = at_places(xy_mm, nodes)
    # 2. the time of each step, longer where the axis brakes
    way_mm, steps_s = steps_mm(places), np.diff(nodes) / rate_hz
    cuts = np.searchsorted(nodes, at)
    speeds = _speeds(way_mm, steps_s, cuts, acceleration_mm_s2)
    mean = np.maximum(0.5 * (speeds[1:] + speeds[:-1]), SLOWEST_MM_S)
    took_s = np.maximum(steps_s, way_mm / mean)
    # 3. the pieces
    return [
        _timed(places[a : b + 1], took_s[a:b], speeds[a : b + 1], rate_hz)
        for a, b in pairwise([0, *cuts, len(nodes) - 1])
    ]


def run(way_mm: Array, speed_mm_s: float, acceleration_mm_s2: float, rate_hz: float) -> Array:
    """Along a way (n, 2) mm from rest to rest, as fast as asked and its bends allow; at a uniform rate."""
    places = _nodes(way_mm)
    # 1. from rest to rest between the corners
    speeds = np.zeros(len(places))
    for a, b in pairwise([0, *_corners(places), len(places) - 1]):
        part = places[a : b + 1]
        allowed = curves.speeds_in_bends(part, speed_mm_s, acceleration_mm_s2)
        allowed[[0, -1]] = 0.0
        speeds[a : b + 1] = reachable(allowed, 2 * acceleration_mm_s2 * steps_mm(part))
    # 2. no step slower than one from rest to rest
    steps = steps_mm(places)
    from_rest_mm_s = 0.5 * np.sqrt(acceleration_mm_s2 * steps)
    mean_mm_s = 0.5 * (speeds[1:] + speeds[:-1])
    took_s = steps / np.maximum(mean_mm_s, from_rest_mm_s + SLOWEST_MM_S)
    return _timed(places, took_s, speeds, rate_hz)


def _nodes(way_mm: Array) -> Array:
    """Nodes of a way (n, 2) mm: `RUN_MM` apart, and each place where the head swivelled."""
    lengths = lengths_mm(way_mm)
    stood = np.unique(np.round(lengths[1:][steps_mm(way_mm) < _NOTHING_MM], 6))
    even = np.arange(0.0, lengths[-1], RUN_MM)
    if len(stood):
        near = np.abs(even[:, None] - stood).min(axis=1) < 0.5 * RUN_MM
        even = even[~near]
    return at_lengths(way_mm, np.unique(np.r_[0.0, even, stood, lengths[-1]]))


def _corners(places: Array) -> list[int]:
    """Places (n, 2) at which a way turns sharply, where the head stops to swivel."""
    steps = np.diff(places, axis=0)
    turned = np.diff(np.arctan2(steps[:, 1], steps[:, 0]))
    turned = np.abs(np.remainder(turned + np.pi, 2 * np.pi) - np.pi)
    return [int(i) + 1 for i in np.flatnonzero(turned > CORNER)]


def _speeds(way_mm: Array, steps_s: Array, cuts: Array, acceleration_mm_s2: float) -> Array:
    """Speed at each node: the former speed, or what braking for the nearest cut allows, mm/s."""
    was = np.r_[way_mm / np.maximum(steps_s, _NOTHING_S), 0.0]
    was[1:-1] = 0.5 * (was[1:-1] + was[:-2])
    braking = np.full(len(was), np.inf)
    braking[cuts] = 0.0
    return np.minimum(was, reachable(braking, 2 * acceleration_mm_s2 * way_mm))


def _timed(places: Array, took_s: Array, speeds: Array, rate_hz: float) -> Array:
    """Nodes with the times of their steps, as positions at a uniform rate: first and last exactly."""
    times = np.r_[0.0, np.cumsum(took_s)]
    if times[-1] <= 0 or len(places) < 2:
        return places[:1]
    # 1. the step at each period, and the share of its time that has passed
    uniform = np.arange(1, int(np.ceil(times[-1] * rate_hz - 1e-6))) / rate_hz
    i = np.clip(np.searchsorted(times, uniform, side="right") - 1, 0, len(took_s) - 1)
    share = (uniform - times[i]) / np.maximum(took_s[i], _NOTHING_S)
    # 2. the share of its way: at even acceleration, or from rest to rest
    gain, mean = speeds[i + 1] - speeds[i], 0.5 * (speeds[i] + speeds[i + 1])
    even = (speeds[i] * share + 0.5 * gain * share**2) / np.maximum(mean, _NOTHING_S)
    from_rest = np.where(share < 0.5, 2 * share**2, 1 - 2 * (1 - share) ** 2)
    moves = mean * took_s[i] > 0.5 * steps_mm(places)[i]
    share = np.where(moves, even, from_rest)
    between = places[i] + share[:, None] * (places[i + 1] - places[i])
    return np.vstack([places[:1], between, places[-1:]])
