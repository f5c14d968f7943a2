"""Stops on the way: the axis brakes, stands on a place exactly, and goes on.

Signals: positions of the head (n, 2) mm at the motion rate, and which of them to stand on (fractions
included), in; pieces (n, 2) mm out, each of which comes to rest on the place where the next begins.

    speed ─────╮         ╭──────       within the braking distance the speed is the lower of what it was and of what the brake allows:
                ╲       ╱
                 ╲__●__╱                    v² = 2 · acceleration · distance to the place

The way stays the same, only its timing changes; outside the braking distances that too stays as it was.

Source: patent ES 361967, figure 1: a stop mark stops the follower; X and Y tracks then carry the reference
frequency while the tape runs on. Questions: how far before a mark the follower brakes the patent leaves open.
The cell sees the mark one lead before the axis, which is enough for it at 10 mm/s.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from morfax.motion import curves
from morfax.motion.arrays import Array
from morfax.motion.speed_limits import reachable

_NOTHING_MM = 1e-9
CORNER = np.radians(20)
RUN_MM = 0.1  # nodes of a way that is run from memory
SLOWEST_MM_S = 0.02  # where the head swivels it stands: its time there is kept


def pieces(
    xy_mm: Array, halts: Sequence[float], acceleration_mm_s2: float, rate_hz: float
) -> list[Array]:
    """The way cut where it is to stand, in order: one piece more than `halts`, each at rest at the cuts;
    positions before the first are row 0.
    """
    rows = np.arange(len(xy_mm), dtype=float)
    at = np.clip(np.asarray(halts, float), 0, len(xy_mm) - 1)
    nodes = np.unique(np.r_[rows, at])
    places = np.column_stack([np.interp(nodes, rows, xy_mm[:, k]) for k in (0, 1)])
    steps_mm, steps_s = np.hypot(*np.diff(places, axis=0).T), np.diff(nodes) / rate_hz
    cuts = np.searchsorted(nodes, at)
    speeds = _speeds(steps_mm, steps_s, cuts, acceleration_mm_s2)
    mean = np.maximum(0.5 * (speeds[1:] + speeds[:-1]), SLOWEST_MM_S)
    took_s = np.maximum(steps_s, steps_mm / mean)
    ends = [0, *cuts, len(nodes) - 1]
    return [
        _timed(places[a : b + 1], took_s[a:b], steps_mm[a:b], speeds[a : b + 1], rate_hz)
        for a, b in pairwise(ends)
    ]


def run(way_mm: Array, speed_mm_s: float, acceleration_mm_s2: float, rate_hz: float) -> Array:
    """Along a way (n, 2) mm from rest to rest, as fast as its bends allow and no faster than asked; at a
    uniform rate.
    """
    steps_mm = np.hypot(*np.diff(way_mm, axis=0).T)
    lengths = np.r_[0.0, np.cumsum(steps_mm)]
    stood = np.unique(
        np.round(lengths[1:][steps_mm < _NOTHING_MM], 6)
    )  # where the head swivelled
    even = np.arange(0.0, lengths[-1], RUN_MM)
    even = (
        even[[not np.any(np.abs(stood - mm) < 0.5 * RUN_MM) for mm in even]]
        if len(stood)
        else even
    )
    some = np.unique(np.r_[0.0, even, stood, lengths[-1]])
    places = np.column_stack([np.interp(some, lengths, way_mm[:, k]) for k in (0, 1)])
    corners = [0, *_corners(places), len(places) - 1]
    speeds = np.zeros(len(places))
    for a, b in pairwise(corners):
        part = places[a : b + 1]
        allowed = curves.speeds_in_bends(part, speed_mm_s, acceleration_mm_s2)
        allowed[[0, -1]] = 0.0
        gains = 2 * acceleration_mm_s2 * np.hypot(*np.diff(part, axis=0).T)
        speeds[a : b + 1] = reachable(allowed, gains)
    steps_mm = np.hypot(*np.diff(places, axis=0).T)
    from_rest_mm_s = 0.5 * np.sqrt(
        acceleration_mm_s2 * steps_mm
    )  # mean of a step from rest to rest
    took_s = steps_mm / np.maximum(
        0.5 * (speeds[1:] + speeds[:-1]), from_rest_mm_s + SLOWEST_MM_S
    )
    return _timed(places, took_s, steps_mm, speeds, rate_hz)


def _corners(places: Array) -> list[int]:
    """Places (n, 2) at which a way turns sharply, where the head stops to swivel."""
    steps = np.diff(places, axis=0)
    turned = np.diff(np.arctan2(steps[:, 1], steps[:, 0]))
    return [
        int(i) + 1
        for i in np.flatnonzero(
            np.abs(np.remainder(turned + np.pi, 2 * np.pi) - np.pi) > CORNER
        )
    ]


def _speeds(steps_mm: Array, steps_s: Array, cuts: Array, acceleration_mm_s2: float) -> Array:
    """Speed at each node: what it was, or what braking for the nearest cut allows, mm/s."""
    was = np.r_[steps_mm / np.maximum(steps_s, 1e-12), 0.0]
    was[1:-1] = 0.5 * (was[1:-1] + was[:-2])
    braking = np.full(len(was), np.inf)
    braking[cuts] = 0.0
    return np.minimum(was, reachable(braking, 2 * acceleration_mm_s2 * steps_mm))


def _timed(
    places: Array, took_s: Array, steps_mm: Array, speeds: Array, rate_hz: float
) -> Array:
    """Nodes with the times that their steps take, as positions at a uniform rate: first and last exactly, the
    last one perhaps a part of a period late.
    """
    times = np.r_[0.0, np.cumsum(took_s)]
    if times[-1] <= 0 or len(places) < 2:
        return places[:1]
    uniform = np.arange(1, int(np.ceil(times[-1] * rate_hz - 1e-6))) / rate_hz
    i = np.clip(np.searchsorted(times, uniform, side="right") - 1, 0, len(took_s) - 1)
    tau = uniform - times[i]
    share = tau / np.maximum(took_s[i], 1e-12)
    mean = 0.5 * (speeds[i] + speeds[i + 1])
    even = (speeds[i] * share + 0.5 * (speeds[i + 1] - speeds[i]) * share**2) / np.maximum(
        mean, 1e-12
    )
    from_rest = np.where(share < 0.5, 2 * share**2, 1 - 2 * (1 - share) ** 2)
    share = np.where(mean * took_s[i] > 0.5 * steps_mm[i], even, from_rest)
    between = places[i] + share[:, None] * (places[i + 1] - places[i])
    return np.vstack([places[:1], between, places[-1:]])
