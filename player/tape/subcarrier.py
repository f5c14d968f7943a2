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
from morfax.recorder.tape.check_signal import CYCLES_PER_SUBCARRIER
from morfax.recorder.tape.tape import Stored

LEVEL_HELD = 0.6  # of its level: below it the reference's phase is not taken
LEVEL_SHARE = 0.05  # of the way to the level found, per point: 20 ms, as for dropouts
LOST_SHARE = 0.002  # the same while it is lost, so that another level is found in the end
RATE_SHARE = 0.2  # of the way to the rate found, per point: five points of wow

Complexes = NDArray[np.complex128]


class Subcarrier:
    """Frames in, points out; points that are no longer needed are dropped by `forget`."""

    def __init__(self, sample_rate_hz: float, reference_hz: float, tracks: int) -> None:
        self._step = reference_hz / sample_rate_hz  # cycles of the reference in a frame
        self.hop = round(CYCLES_PER_SUBCARRIER / self._step)
        cycles = self._step / CYCLES_PER_SUBCARRIER
        # a row of taps is as long as all tracks of a hop, and zero for the others than its own
        taps = np.zeros((tracks + 1, 4, self.hop, tracks), np.float32)
        for track in range(tracks):
            taps[track, :, :, track] = _taps(self.hop, cycles)
        taps[tracks, :, :, 0] = _taps(self.hop, self._step)  # the carrier of the reference
        self._rows_of_taps = taps.reshape(4 * (tracks + 1), -1)
        self._tail: Stored = np.zeros((0, tracks), np.float32)  # frames of the next hops
        self._next = 0  # the next point
        # turns, turns per point, level; the first and last point of the last loss of the reference
        self._state = np.array([math.nan, 0.0, 0.0, -1.0, -1.0])
        self.first = 0  # the first point that is held
        self.points: Complexes = np.zeros((tracks, 0), complex)
        self.theta: Array = np.zeros(0)

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
        halves = np.empty((frames.shape[1] + 1, 4, hops), np.float32)
        begun = np.concatenate([self._tail, frames[:own]]) if early else frames[:0]
        rest = frames[own : own + (hops - early) * self.hop]
        for part, at in ((begun, slice(early)), (rest, slice(early, None))):
            rows = part.reshape(-1, self.hop * frames.shape[1])
            _sum(rows, scale, self._rows_of_taps, halves[:, :, at])
        last = own + (hops - 1 - early) * self.hop
        self._tail = frames[last:].copy() if last >= 0 else begun[-self.hop :].copy()
        # 2. a point for each hop and the next
        points, turns = np.empty((frames.shape[1], hops - 1), complex), np.empty(hops - 1)
        per_point = np.array([self._step * self.hop, CYCLES_PER_SUBCARRIER])
        _turn_back(halves, self._next, per_point, self._state, turns, points)
        numbers = self._next + np.arange(hops - 1)
        theta = self._step * self.frame_of(numbers) + turns
        self.theta = np.concatenate([self.theta, theta])
        self.points = np.concatenate([self.points, points], axis=1)
        self._next += hops - 1

    def frame_of(self, points: Array | NDArray[np.int64]) -> Array:
        """The frame of the tape in the middle of a point's window."""
        return np.asarray(self.hop * (points + 1) - 0.5, np.float64)

    def theta_at(self, point: float) -> float:
        """The cycles of the reference at a point; before the first that is held, those of that."""
        numbers = self.first + np.arange(len(self.theta))
        return float(np.interp(point, numbers, self.theta))

    def frames_at(self, theta: Array) -> Array:
        """The frames of the tape at some counts of the reference."""
        frames = np.empty(len(theta))
        _interpolate(theta, self.theta, (self.first, self.hop, self._step), frames)
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
        self.theta = self.theta - cycles * share
        turn = np.exp(2j * np.pi * cycles * (numbers > last) / CYCLES_PER_SUBCARRIER)
        self.points = self.points * turn
        self._state[0] -= cycles

    def forget(self, theta: float) -> None:
        """Drop the points before a count of the reference."""
        gone = max(int(np.searchsorted(self.theta, theta)) - 2, 0)
        self.points, self.theta = self.points[:, gone:].copy(), self.theta[gone:].copy()
        self.first += gone


def _taps(hop: int, cycles_per_frame: float) -> NDArray[np.float32]:
    """The taps of the window's halves (4, hop): real and imaginary of the first, of the second."""
    n = np.arange(2 * hop)
    window = np.sin(np.pi * (n + 0.5) / (2 * hop)) ** 2 * (2 / hop)
    first, second = np.split(window * np.exp(-2j * np.pi * cycles_per_frame * n), 2)
    return np.array([first.real, first.imag, second.real, second.imag], np.float32)


# The order of the sum is free (reassoc, contract), so that it runs in vectors. The zeros cost less than
# picking out the samples of each track.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _sum(rows, scale, taps, halves):  # type: ignore[no-untyped-def]
    """Fill the sums of both halves of the window (tracks and the reference's carrier, 4, hops)."""
    samples = np.empty(rows.shape[1], np.float32)
    for hop in range(len(rows)):
        for k in range(len(samples)):
            samples[k] = rows[hop, k]
        for tap in range(len(taps)):
            total = np.float32(0)
            for k in range(len(samples)):
                total += taps[tap, k] * samples[k]
            halves[tap // 4, tap % 4, hop] = total * scale


@njit(cache=True, nogil=True)
def _interpolate(sought, theta, numbers, frames):  # type: ignore[no-untyped-def]
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
def _turn_back(halves, first, per_point, state, turns, points):  # type: ignore[no-untyped-def]
    """Count the turns of the reference against its nominal frequency; turn the tracks' points back by them.

    `per_point`: cycles of the reference from point to point, and to one of the subcarrier.
    """
    place, rate, level, first_lost, last_lost = state
    tracks = len(points)
    for k in range(len(turns)):
        nominal = (first + k) * per_point[0]
        # 1. the phase of the reference
        re = float(halves[tracks, 0, k]) + halves[tracks, 2, k + 1]
        im = float(halves[tracks, 1, k]) + halves[tracks, 3, k + 1]
        strength, turn = math.hypot(re, im), math.atan2(im, re) / (2 * math.pi) - nominal
        # 2. counted on; as fast as before where the reference fails
        if math.isnan(place):
            place, rate, level = turn - np.floor(turn), 0.0, strength
        elif not strength >= LEVEL_HELD * level:
            place += rate
            first_lost = first_lost if last_lost == first + k - 1 else first + k
            last_lost = first + k
            if strength >= 0:  # and is a number
                level += LOST_SHARE * (strength - level)
        else:
            off = turn - place - rate
            off -= np.rint(off)
            place += rate + off
            rate += RATE_SHARE * off
            level += LEVEL_SHARE * (strength - level)
        turns[k] = place
        # 3. the subcarriers, turned back by a sixth of it
        back = (nominal + place) / per_point[1]
        back = -2 * math.pi * (back - np.floor(back))
        turned = complex(math.cos(back), math.sin(back))
        for track in range(tracks):
            re = float(halves[track, 0, k]) + halves[track, 2, k + 1]
            im = float(halves[track, 1, k]) + halves[track, 3, k + 1]
            points[track, k] = complex(re, im) * turned
    state[0], state[1], state[2] = place, rate, level
    state[3], state[4] = first_lost, last_lost
