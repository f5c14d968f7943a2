"""The subcarrier: what lies beneath the carriers, moved to 0 Hz, and the tape's own clock beside it.

Signals in: the tape's frames in blocks (n, tracks), 16 bit or float32. Signals out: about a thousand points
per second, each a complex number per track (the check signal, its phase against a sixth of the reference's)
and the cycles of the reference since the start of the tape (theta).

    point[m]  = sum of 2 hop frames · hann · exp(-j w n)      hop: a cycle of the subcarrier, 48 frames
    theta[m]  = reference · time + phase of track 1           counted on from point to point

The window has its zeros at every half of 1 / hop from the subcarrier on, and a carrier at standstill lies on
one; it is 55 dB down from 3 kHz beside it, where the carriers begin. As the phase is told against the
reference, the speed of the tape and its flutter fall out. Where the reference fails for a moment, theta goes
on as fast as before, and may be whole cycles off behind it: `slip` puts them right (slips.py finds them).

Source: F. J. Harris, On the Use of Windows, Proc. IEEE 66, 1978 (Hann). Questions: none.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.player.tape.discriminator import turn
from morfax.recorder.tape.carrier import sine
from morfax.recorder.tape.check_signal import CYCLES_PER_SUBCARRIER
from morfax.recorder.tape.tape import Stored

LEVEL_HELD = 0.6  # of its level: below it the reference's phase is not taken
LEVEL_SHARE = 0.05  # of the way to the level found, per point: 20 ms, as for dropouts
LOST_SHARE = 0.002  # the same while it is lost, so that another level is found in the end
RATE_SHARE = 0.2  # of the way to the rate found, per point: five points of wow

ROOM = 4  # times what is held: then what is held is moved for every third block only

Complexes = NDArray[np.complex128]


class Subcarrier:
    """Frames in, points out; points that are no longer needed are dropped by `forget`."""

    def __init__(self, sample_rate_hz: float, reference_hz: float, tracks: int) -> None:
        # of the reference, in a frame of the tape
        self.cycles_per_frame = reference_hz / sample_rate_hz
        self.hop = round(CYCLES_PER_SUBCARRIER / self.cycles_per_frame)
        cycles = self.cycles_per_frame / CYCLES_PER_SUBCARRIER
        # a row of taps is as long as all tracks of a hop, and zero for the others than its own
        taps = np.zeros((tracks + 1, 4, self.hop, tracks), np.float32)
        for track in range(tracks):
            taps[track, :, :, track] = _taps(self.hop, cycles)
        taps[tracks, :, :, 0] = _taps(
            self.hop, self.cycles_per_frame
        )  # the carrier of the reference
        self._rows_of_taps = taps.reshape(4 * (tracks + 1), -1)
        self._tail: Stored = np.zeros((0, tracks), np.float32)  # frames of the next hops
        self._next = 0  # the next point
        # turns, turns per point, level; the first and last point of the last loss of the reference
        self._state = np.array([math.nan, 0.0, 0.0, -1.0, -1.0])
        self.first = 0  # the first point that is held
        self._held = slice(
            0, 0
        )  # of the room for points, which is moved or enlarged where it ends
        self._points: Complexes = np.zeros((0, tracks), complex)
        self._theta: Array = np.zeros(0)
        self._halves = np.zeros((tracks + 1, 4, 0), np.float32)

    @property
    def points(self) -> Complexes:
        """The points that are held (points, tracks)."""
        return self._points[self._held]

    @property
    def theta(self) -> Array:
        """The cycles of the reference at these points."""
        return self._theta[self._held]

    def feed(self, frames: Stored) -> None:
        """Take the next frames of the tape."""
        # 1. hops that end in these frames; only the first ones begin before them
        hops = (len(self._tail) + len(frames)) // self.hop
        if hops < 2:
            self._tail = (
                np.concatenate([self._tail, frames]) if len(self._tail) else frames.copy()
            )
            return
        early = -(-len(self._tail) // self.hop)
        own = early * self.hop - len(self._tail)  # frames that complete them
        scale = np.float32(1 / 32768 if frames.dtype == np.int16 else 1)
        if self._halves.shape[2] < hops:
            self._halves = np.empty((frames.shape[1] + 1, 4, hops), np.float32)
        halves = self._halves
        begun = np.concatenate([self._tail, frames[:own]]) if early else frames[:0]
        rest = frames[own : own + (hops - early) * self.hop]
        parts = tuple([part.reshape(-1, self.hop * frames.shape[1]) for part in (begun, rest)])
        last = own + (hops - 1 - early) * self.hop
        self._tail = frames[last:].copy() if last >= 0 else begun[-self.hop :].copy()
        # 2. a point for each hop and the next
        new = self._room(hops - 1)
        clock = (self._next, self.hop, self.cycles_per_frame)
        at = self._theta[new], self._points[new]
        _make(parts, (scale, self._rows_of_taps), halves, (clock, self._state), at)
        self._held, self._next = slice(self._held.start, new.stop), self._next + hops - 1

    def _room(self, count: int) -> slice:
        """Room for so many further points, behind those that are held."""
        begins, ends = self._held.start, self._held.stop
        if ends + count > len(self._theta):
            held, size = ends - begins, ROOM * (ends - begins + count)
            theta = np.empty(size)
            points = np.empty((size, self._points.shape[1]), complex)
            theta[:held], points[:held] = self.theta, self.points
            self._theta, self._points, self._held = theta, points, slice(0, held)
            ends = held
        return slice(ends, ends + count)

    def theta_at(self, point: float) -> float:
        """The cycles of the reference at a point; before the first that is held, those of that."""
        numbers = self.first + np.arange(len(self.theta))
        return float(np.interp(point, numbers, self.theta))

    def frames_at(self, theta: Array) -> Array:
        """The frames of the tape at some counts of the reference."""
        frames = np.empty(len(theta))
        interpolate(theta, self.theta, (self.first, self.hop, self.cycles_per_frame), frames)
        return frames

    @property
    def lost(self) -> tuple[float, float]:
        """The first and last point at which the reference last failed; -1 where it never did."""
        return float(self._state[3]), float(self._state[4])

    def slip(self, cycles: int) -> None:
        """Count so many cycles of the reference less from its last loss on; the loss takes them up."""
        first, last = self.lost
        numbers = self.first + np.arange(len(self.theta))
        share = np.clip((numbers - first + 1) / (last - first + 2), 0.0, 1.0)
        self.theta[:] -= cycles * share
        turn = np.exp(2j * np.pi * cycles * (numbers > last) / CYCLES_PER_SUBCARRIER)
        self.points[:] *= turn[:, None]
        self._state[0] -= cycles

    def forget(self, theta: float) -> None:
        """Drop the points before a count of the reference."""
        gone = max(int(np.searchsorted(self.theta, theta)) - 2, 0)
        self._held = slice(self._held.start + gone, self._held.stop)
        self.first += gone


def _taps(hop: int, cycles_per_frame: float) -> NDArray[np.float32]:
    """The taps of the window's halves (4, hop): real and imaginary of the first, of the second."""
    n = np.arange(2 * hop)
    window = np.sin(np.pi * (n + 0.5) / (2 * hop)) ** 2 * (2 / hop)
    first, second = np.split(window * np.exp(-2j * np.pi * cycles_per_frame * n), 2)
    return np.array([first.real, first.imag, second.real, second.imag], np.float32)


@njit(cache=True, nogil=True)
def _make(parts, by, halves, counted, points):  # type: ignore[no-untyped-def]
    """Make theta and points of hops that come in two parts.

    `by`: scale of a sample, and the taps; `counted`: the clock, and the state.
    """
    early = len(parts[0])
    _sum(parts[0], by[0], by[1], halves[:, :, :early])
    _sum(parts[1], by[0], by[1], halves[:, :, early:])
    _turn_back(halves, counted[0], counted[1], points[0], points[1])


# The order of the sum is free (reassoc, contract), so that it runs in vectors. The zeros cost less than
# picking out the samples of each track. Four sums of two hops at a time take samples and taps out of memory
# once for all eight.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _sum(rows, scale, taps, halves):  # type: ignore[no-untyped-def]
    """Fill the sums of both halves of the window (tracks and the reference's carrier, 4, hops)."""
    x, y = np.zeros((2, rows.shape[1]), np.float32)
    for hop in range(0, len(rows), 2):
        other = min(hop + 1, len(rows) - 1)
        for k in range(len(x)):
            x[k] = rows[hop, k]
        for k in range(len(x)):
            y[k] = rows[other, k]
        for track in range(len(halves)):
            a, b = taps[4 * track], taps[4 * track + 1]
            c, d = taps[4 * track + 2], taps[4 * track + 3]
            a_x = b_x = c_x = d_x = a_y = b_y = c_y = d_y = np.float32(0)
            for k in range(len(x)):
                a_x += a[k] * x[k]
                b_x += b[k] * x[k]
                c_x += c[k] * x[k]
                d_x += d[k] * x[k]
                a_y += a[k] * y[k]
                b_y += b[k] * y[k]
                c_y += c[k] * y[k]
                d_y += d[k] * y[k]
            halves[track, 0, other], halves[track, 1, other] = a_y * scale, b_y * scale
            halves[track, 2, other], halves[track, 3, other] = c_y * scale, d_y * scale
            halves[track, 0, hop], halves[track, 1, hop] = a_x * scale, b_x * scale
            halves[track, 2, hop], halves[track, 3, hop] = c_x * scale, d_x * scale


@njit(cache=True, nogil=True)
def interpolate(sought, theta, numbers, frames):  # type: ignore[no-untyped-def]
    """Fill the frames of the tape at some counts of the reference, straight from point to point.

    `numbers`: the first point, frames from point to point, cycles of the reference in a frame. Beyond the
    first point and the last the reference runs at its nominal rate.
    """
    first, hop, step = numbers
    last = len(theta) - 1
    for k in range(len(sought)):
        at = min(max(np.searchsorted(theta, sought[k], side="right") - 1, 0), last - 1)
        within = min(max(sought[k], theta[0]), theta[last])
        number = at + (within - theta[at]) / (theta[at + 1] - theta[at])
        frames[k] = hop * (first + number + 1) - 0.5 + (sought[k] - within) / step


@njit(cache=True, nogil=True)
def _turn_back(halves, clock, state, theta, points):  # type: ignore[no-untyped-def]
    """Count the turns of the reference against its nominal frequency; turn the tracks' points back by them.

    `clock`: the first point, frames from point to point, cycles of the reference in a frame.
    """
    first, hop, step = clock
    place, rate, level, first_lost, last_lost = state
    count, tracks = len(theta), points.shape[1]
    # 1. the phase of the reference, and how strong it is
    re, im, strengths, turns = np.empty((4, count))
    for k in range(count):
        re[k] = float(halves[tracks, 0, k]) + halves[tracks, 2, k + 1]
        im[k] = float(halves[tracks, 1, k]) + halves[tracks, 3, k + 1]
        strengths[k] = math.sqrt(re[k] * re[k] + im[k] * im[k])
    turn(re, im, np.ones(count), np.zeros(count), turns)
    # 2. counted on; as fast as before where the reference fails
    for k in range(count):
        nominal = (first + k) * (step * hop)
        strength, seen = strengths[k], turns[k] - nominal
        if math.isnan(place):
            place, rate, level = seen - np.floor(seen), 0.0, strength
        elif not strength >= LEVEL_HELD * level:
            place += rate
            first_lost = first_lost if last_lost == first + k - 1 else first + k
            last_lost = first + k
            if strength >= 0:  # and is a number
                level += LOST_SHARE * (strength - level)
        else:
            off = seen - place - rate
            off -= np.floor(off + 0.5)
            place += rate + off
            rate += RATE_SHARE * off
            level += LEVEL_SHARE * (strength - level)
        # the frame of the tape in the middle of the window
        theta[k] = step * (hop * (first + k + 1) - 0.5) + place
        turns[k] = (nominal + place) / CYCLES_PER_SUBCARRIER
    state[0], state[1], state[2] = place, rate, level
    state[3], state[4] = first_lost, last_lost
    _turn_points_back(halves, turns, points)


@njit(cache=True, nogil=True)
def _turn_points_back(halves, turns, points):  # type: ignore[no-untyped-def]
    """Fill the points of the tracks: their sums, turned back by the turns of the subcarriers."""
    count, tracks = points.shape
    for k in range(count):
        re, im = sine(0.25 + turns[k]), -sine(turns[k])
        for track in range(tracks):
            along = float(halves[track, 0, k]) + halves[track, 2, k + 1]
            across = float(halves[track, 1, k]) + halves[track, 3, k + 1]
            points[k, track] = complex(along * re - across * im, along * im + across * re)
