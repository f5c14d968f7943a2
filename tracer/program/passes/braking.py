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

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from morfax.motion import curves, long_array
from morfax.motion.arrays import NOT_ZERO, ROUNDED, Array
from morfax.motion.compiled import njit
from morfax.motion.long_array import LongArray, blocks, released
from morfax.motion.plane import CORNER_RAD, NOTHING_MM
from morfax.motion.polyline import at_lengths, at_places, lengths_mm, steps_mm
from morfax.motion.speed_limits import reachable
from morfax.tracer.effort import LOOKED_MM

BRAKED_ROWS = 600  # looked at first, back from a halt: from 10 mm/s the axis brakes in 120
SLOWEST_MM_S = 0.02  # where the head swivels it stands: its time there is kept


def pieces(
    xy_mm: Array, halts: Sequence[float], acceleration_mm_s2: float, rate_hz: float
) -> list[Array]:
    """The way cut at its halts: one piece more than `halts`, at rest at the cuts; before the first row 0."""
    bounds = [0.0, *np.clip(np.asarray(halts, float), 0, len(xy_mm) - 1), len(xy_mm) - 1.0]
    gain = 2 * acceleration_mm_s2
    return [
        _Piece(xy_mm, (float(a), float(b)), (k > 0, k < len(halts)), gain, rate_hz).timed()
        for k, (a, b) in enumerate(pairwise(bounds))
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
    """Nodes of a way (n, 2) mm: `LOOKED_MM` apart, and each place where the head swivelled."""
    lengths = lengths_mm(way_mm)
    stood = np.unique(np.round(lengths[1:][steps_mm(way_mm) < NOTHING_MM], 6))
    even = np.arange(0.0, lengths[-1], LOOKED_MM)
    if len(stood):
        near = np.abs(even[:, None] - stood).min(axis=1) < 0.5 * LOOKED_MM
        even = even[~near]
    return at_lengths(way_mm, np.unique(np.r_[0.0, even, stood, lengths[-1]]))


def _corners(places: Array) -> list[int]:
    """Places (n, 2) at which a way turns sharply, where the head stops to swivel."""
    steps = np.diff(places, axis=0)
    turned = np.diff(np.arctan2(steps[:, 1], steps[:, 0]))
    turned = np.abs(np.remainder(turned + np.pi, 2 * np.pi) - np.pi)
    # at a corner the head stops to swivel
    return [int(i) + 1 for i in np.flatnonzero(turned > CORNER_RAD)]


def _timed(places: Array, took_s: Array, speeds: Array, rate_hz: float) -> Array:
    """Nodes with the times of their steps, as positions at a uniform rate: first and last exactly."""
    times = np.r_[0.0, np.cumsum(took_s)]
    if times[-1] <= 0 or len(places) < 2:
        return places[:1]
    uniform = np.arange(1, int(np.ceil(times[-1] * rate_hz - ROUNDED))) / rate_hz
    between = _at_times(uniform, times, places, took_s, speeds)
    return np.vstack([places[:1], between, places[-1:]])


def _at_times(
    uniform: Array, times: Array, places: Array, took_s: Array, speeds: Array
) -> Array:
    """Where the axis is at some times, (n, 2) mm: between nodes, of which the times and speeds are known."""
    out = np.empty((len(uniform), 2))
    _placed(uniform, (times, took_s), np.ascontiguousarray(places), speeds, out)
    return out


@njit(cache=True, _nrt=False)
def _placed(uniform, clock, places, speeds, out):  # type: ignore[no-untyped-def]
    """Fill in the places at some times; `clock`: the times of the nodes, and of their steps."""
    (times, took_s), i = clock, 0
    for k in range(len(uniform)):
        # 1. the step, and the share of its time that has passed
        while i < len(took_s) - 1 and times[i + 1] <= uniform[k]:
            i += 1
        share = (uniform[k] - times[i]) / max(took_s[i], NOT_ZERO)
        # 2. the share of its way: at even acceleration, or from rest to rest
        mean = 0.5 * (speeds[i] + speeds[i + 1])
        dx, dy = places[i + 1, 0] - places[i, 0], places[i + 1, 1] - places[i, 1]
        if mean * took_s[i] > 0.5 * math.hypot(dx, dy):
            gain = speeds[i + 1] - speeds[i]
            way = (speeds[i] * share + 0.5 * gain * share**2) / max(mean, NOT_ZERO)
        else:
            way = 2 * share**2 if share < 0.5 else 1 - 2 * (1 - share) ** 2
        out[k, 0], out[k, 1] = places[i, 0] + way * dx, places[i, 1] + way * dy


@njit(cache=True, _nrt=False)
def _longest_mm2(places):  # type: ignore[no-untyped-def]
    """The square of the longest step between places (n, 2) mm."""
    longest_mm2 = 0.0
    for k in range(1, len(places)):
        dx, dy = places[k, 0] - places[k - 1, 0], places[k, 1] - places[k - 1, 1]
        longest_mm2 = max(longest_mm2, dx * dx + dy * dy)
    return longest_mm2


@njit(cache=True, _nrt=False)
def _paced(nodes, rates, begun, arrives, out):  # type: ignore[no-untyped-def]
    """Fill in the speeds at nodes, mm/s, the time of the step to each, and when each is passed, s; give the
    square of the speed that is reached from rest at the last, mm2/s2.

    `nodes`: their numbers among the positions, and their places (n, 2) mm, with one node before them if there
    is one, and one after. `begun`: whether there is one before; the same square and the time at the first.
    `arrives`: squares of speeds from which the axis comes to rest.
    """
    (numbers, places), (gain_mm_s2, rate_hz), (speeds, took_s, times) = nodes, rates, out
    first, reached, time_s = begun
    last_mm_s = last_mm = 0.0
    for k in range(len(speeds)):
        # 1. the former speed at the node: the mean of those of the steps to it and from it
        node, was, to_mm_s, to_mm = first + k, 0.0, last_mm_s, last_mm
        if k == 0 and first > 0:
            to_mm_s, _ = _step(numbers, places, node - 1, rate_hz)
        if node + 1 < len(numbers):
            last_mm_s, last_mm = _step(numbers, places, node, rate_hz)
            was = 0.5 * (last_mm_s + to_mm_s) if node > 0 else last_mm_s
        # 2. no faster than the axis has come from rest, or can come to rest
        took_s[k] = 0.0
        if k > 0:
            reached += gain_mm_s2 * to_mm
        speeds[k] = min(was, math.sqrt(min(reached, arrives[k])))
        # 3. the time of the step to it
        if k > 0:
            mean_mm_s = max(0.5 * (speeds[k] + speeds[k - 1]), SLOWEST_MM_S)
            took_s[k] = max((numbers[node] - numbers[node - 1]) / rate_hz, to_mm / mean_mm_s)
            time_s += took_s[k]
        times[k] = time_s
    return reached


@njit(cache=True, _nrt=False)
def _step(numbers, places, k, rate_hz):  # type: ignore[no-untyped-def]
    """The former speed on the step from a node to the next, mm/s, and its length, mm."""
    dx, dy = places[k + 1, 0] - places[k, 0], places[k + 1, 1] - places[k, 1]
    way_mm = math.hypot(dx, dy)
    return way_mm / max((numbers[k + 1] - numbers[k]) / rate_hz, NOT_ZERO), way_mm


@dataclass(frozen=True, slots=True)
class _Piece:
    """A way (n, 2) mm from one of its positions to another (fractions included), whether the axis is at rest
    there, what the square of its speed may gain in a mm, mm/s2, and the rate of the positions.

    Its nodes are the positions between, and both ends. They are looked at in blocks.
    """

    xy_mm: Array
    ends: tuple[float, float]
    rests: tuple[bool, bool]
    gain_mm_s2: float
    rate_hz: float

    @property
    def _count(self) -> int:
        """How many nodes there are."""
        return math.ceil(self.ends[1]) - math.floor(self.ends[0]) + 1

    def _nodes(self, first: int, end: int) -> tuple[Array, Array]:
        """The numbers of some nodes among the positions, and their places, (n, 2) mm."""
        low = math.floor(self.ends[0])
        numbers = np.arange(low + first, low + end, dtype=float)
        numbers[[0, -1]] = np.clip(numbers[[0, -1]], *self.ends)
        low = math.floor(numbers[0])
        near = self.xy_mm[low : math.ceil(numbers[-1]) + 1]
        at = numbers - low
        is_between = bool((at[[0, -1]] % 1).any())  # only the ends may be
        places = at_places(near, at) if is_between else np.array(near)
        released(near)
        return numbers, places

    def _bounds(self) -> list[tuple[int, int]]:
        """First and last node of each block, which the next begins with."""
        firsts = range(0, self._count - 1, long_array.BLOCK_ROWS)
        return [
            (first, min(first + long_array.BLOCK_ROWS, self._count - 1)) for first in firsts
        ]

    def timed(self) -> Array:
        """The way at a uniform rate, slower where the axis brakes: its ends exactly."""
        begins_mm = self._nodes(0, 1)[1]
        if self.ends[0] == self.ends[1]:
            return begins_mm
        out, bounds, start_s = LongArray(), self._bounds(), 0.0
        out.add(begins_mm)
        reached, arrives = 0.0 if self.rests[0] else math.inf, self._arrives()
        for first, last in bounds:
            # 1. the speeds, and the time of each step, longer where the axis brakes
            before, after = int(first > 0), int(last < self._count - 1)
            numbers, places = self._nodes(first - before, last + 1 + after)
            squares = arrives(first, last)
            speeds, took_s, times = (np.empty(last + 1 - first) for _ in range(3))
            rates, begun = (self.gain_mm_s2, self.rate_hz), (before, reached, start_s)
            reached = _paced((numbers, places), rates, begun, squares, (speeds, took_s, times))
            # 2. the positions up to the last node; the next block has that one
            until = times[-1] * self.rate_hz
            uniform = np.arange(len(out), int(np.ceil(until - ROUNDED))) / self.rate_hz
            if last < self._count - 1:
                uniform = uniform[uniform < times[-1]]
            own = places[before : before + len(speeds)]
            out.add(_at_times(uniform, times, own, took_s[1:], speeds))
            start_s = float(times[-1])
        if start_s > 0:
            out.add(self._nodes(self._count - 1, self._count)[1])
        return out.whole()

    def _fastest_mm2_s2(self) -> float:
        """No less than the square of the highest of the former speeds."""
        own = self.xy_mm[math.floor(self.ends[0]) : math.ceil(self.ends[1]) + 1]
        longest_mm2 = max(_longest_mm2(block) for block in blocks(own, 1))
        return longest_mm2 * self.rate_hz**2 * (1 + ROUNDED)

    def _arrives(self) -> Callable[[int, int], Array]:
        """What gives the squares of speeds from which the axis comes to rest, mm2/s2, at a block's nodes."""
        count, squares = self._count, np.array([0.0 if self.rests[1] else np.inf])
        if self.rests[1]:
            fastest_mm2_s2 = self._fastest_mm2_s2()
            # back from the end, as far as it matters
            rows = BRAKED_ROWS
            while len(squares) < count and squares[-1] <= fastest_mm2_s2:
                end = count - len(squares) + 1
                _, places = self._nodes(max(0, end - rows), end)
                rows = min(2 * rows, long_array.BLOCK_ROWS)
                gains = self.gain_mm_s2 * steps_mm(places)[::-1]
                squares = np.r_[squares, np.cumsum(np.r_[squares[-1], gains])[1:]]
        squares, begin = squares[::-1], count - len(squares)

        def at(first: int, last: int) -> Array:
            out = np.full(last - first + 1, np.inf)
            low, high = max(first, begin), last + 1
            if low < high:
                out[low - first :] = squares[low - begin : high - begin]
            return out

        return at
