"""The check signal: a weak subcarrier beneath each track, which says which track it is and where its axis is.

Signals in: the bare frames of the carriers (n, tracks) and the displacements of the axes in cycles, at the
motion rate; out: the same frames with the check signal, a second and a half later.

    subcarrier   a sixth of the reference (1 kHz), 14 dB below the carrier, in phase with it at the start
    symbol       24 cycles of the reference (4 ms), +1 or -1, passing over as a raised cosine
    frame        120 symbols (0.48 s), one after another from the first frame of the tape on

    theta     = reference frequency · time                  cycles of the reference;   theta / 24 = k + u
    signal    = share · level · sin(2 pi theta / 6) · (b[k] cos² + b[k+1] sin²)(pi u / 2)

    -1 ____                 ____ +1
           ╲_            _╱              all tracks change over at the same moments
             ╲__________╱

What a frame tells of the time to come (check_frame.py) is known up to three frames later, so the frames of
the tape wait for that. Symbols and subcarrier are counted in cycles of the reference, the tape's own clock.

Source: our own; others of that time put time codes on tape the same way (IRIG B: a modulated carrier of 1
kHz, 1960). Questions: 2 kHz would pass the player's band filter only 24 dB down and turn the phase by 2e-3
cycle; 1 kHz passes 82 dB down (docs/reference/tape-format.md).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.polyline import at_places
from morfax.recorder.tape.carrier import Frames, _sine
from morfax.recorder.tape.check_frame import SYMBOLS, SYNC, CheckFrame, to_bits
from morfax.recorder.tape.format import CHECK_SHARE, TapeFormat
from morfax.recorder.tape.told_figures import Stated, frame_of

CYCLES_PER_SUBCARRIER = 6.0  # of the reference
CYCLES_PER_SYMBOL = 24.0
CYCLES_PER_FRAME = SYMBOLS * CYCLES_PER_SYMBOL
# a speed is told from change to change over this, as long as the player's filter
GAUGE_S = 0.002


class CheckWriter:
    """Lays the check signal on the frames of one tape."""

    def __init__(self, fmt: TapeFormat) -> None:
        pick_up = fmt.carrier
        self._stated = Stated(fmt.cycles_per_mm, fmt.axes, fmt.start_mm)
        self._tracks, self._amplitude = fmt.tracks, CHECK_SHARE * fmt.level
        self._step = fmt.reference_hz / fmt.sample_rate_hz  # cycles of the reference in a frame
        self._rows_per_frame = CYCLES_PER_FRAME / pick_up.reference_cycles
        self._frames_per_row, self._rate_hz = fmt.samples_per_motion, fmt.motion_rate_hz
        self._gauge = max(round(GAUGE_S * fmt.motion_rate_hz), 1)  # rows
        self._cycles = np.zeros((0, len(fmt.axes)))
        self._first_row = 0  # of those that are held
        self._held: list[Frames] = []
        self._held_frames, self._done = 0, 0  # frames of the tape
        self._number = 0  # the next frame of the check signal
        self._wave = _Wave(-1.0, 0, self._step, self._amplitude)

    def positions(self, cycles: Array) -> None:
        """Take the next displacements (n, axes), in cycles from the start."""
        self._cycles = np.concatenate([self._cycles, cycles])

    def frames(self, frames: Frames) -> Iterator[Frames]:
        """Take the next bare frames; those that can be finished by now."""
        self._held.append(frames)
        self._held_frames += len(frames)
        while True:
            known = self._first_row + len(self._cycles)
            ready = self._frame_at(self._number + 1) - self._done
            if (
                known < self._row(self._number + 3) + 2 * self._gauge
                or self._held_frames < ready
            ):
                return
            yield from self._finished(ready, last=False)

    def rest(self) -> Iterator[Frames]:
        """The last frames; the last two whole frames of the check signal say that the tape ends."""
        while self._held_frames:
            ready = min(self._frame_at(self._number + 1) - self._done, self._held_frames)
            after = self._frame_at(self._number + 3) - self._done
            yield from self._finished(ready, last=after > self._held_frames)

    def _row(self, number: int) -> int:
        """The first row at or after the start of a frame of the check signal."""
        return int(np.ceil(number * self._rows_per_frame))

    def _frame_at(self, number: int) -> int:
        """The first frame of the tape at or after that start."""
        return int(np.ceil(number * self._rows_per_frame * self._frames_per_row))

    def _finished(self, count: int, *, last: bool) -> Iterator[Frames]:
        """So many held frames, which are those of one frame of the check signal, with it."""
        bits = np.empty((SYMBOLS + 1, self._tracks))
        for track, said in enumerate(self._said(last)):
            bits[:SYMBOLS, track], bits[SYMBOLS, track] = to_bits(said), SYNC[0]
        first = self._done * self._step - self._number * CYCLES_PER_FRAME
        if not self._wave.serves(first, count):
            self._wave = _Wave(first, count, self._step, self._amplitude)
        done = 0
        for piece in self._taken(count):
            _add(piece, done, self._wave.table, bits)
            done += len(piece)
            yield piece
        self._done, self._held_frames = self._done + count, self._held_frames - count
        self._number += 1
        gone = max(self._row(self._number) - 1 - self._first_row, 0)
        self._cycles, self._first_row = self._cycles[gone:], self._first_row + gone

    def _taken(self, count: int) -> Iterator[Frames]:
        """The first held frames, so many, in the pieces in which they came."""
        while count:
            piece = self._held.pop(0)
            if len(piece) > count:
                self._held.insert(0, piece[count:])
                piece = piece[:count]
            count -= len(piece)
            yield piece

    def _said(self, last: bool) -> Iterator[CheckFrame]:
        """What each track says in the next frame."""
        yield frame_of(self._stated, self._number, last)
        first = self._row(self._number) - self._first_row
        ends = self._row(self._number + 2) - self._first_row + 2 * self._gauge
        rows = self._cycles[max(first - self._gauge, 0) : ends]
        # its first instant, and its middle
        ats = (self._number + np.array([0, 0.5])) * self._rows_per_frame - self._first_row
        places = at_places(self._cycles, ats)
        fastest, hardest = np.zeros((2, self._tracks - 1))
        _gauged(rows, (self._rate_hz, self._gauge), fastest, hardest)
        for axis in range(self._tracks - 1):
            yield CheckFrame(
                axis + 1,
                self._number,
                float(places[0, axis]),
                float(fastest[axis]),
                float(hardest[axis]),
                last,
                middle_cycles=float(places[1, axis]),
            )


# No place is nan: so the largest of many speeds is found in vectors.
@njit(cache=True, nogil=True, fastmath={"nnan", "nsz"})
def _gauged(rows, how, fastest, hardest):  # type: ignore[no-untyped-def]
    """Raise each track's largest speed, cycles/s, and change of it over so many rows, cycles/s², to those of
    its rows.
    """
    (rate_hz, gauge), moves = how, len(rows) - 1
    speeds = np.empty(max(moves, 0))
    for axis in range(rows.shape[1]):
        fast, hard = fastest[axis], hardest[axis]
        for k in range(moves):
            speeds[k] = (rows[k + 1, axis] - rows[k, axis]) * rate_hz
        for k in range(moves):
            fast = max(fast, abs(speeds[k]))
        for k in range(gauge, moves):
            hard = max(hard, abs((speeds[k] - speeds[k - gauge]) * (rate_hz / gauge)))
        fastest[axis], hardest[axis] = fast, hard


class _Wave:
    """The subcarrier over one check frame, which is the same in each that begins as far before its frames.

    `table`: the subcarrier, the share of the next symbol, and the number of the symbol, of each frame.
    """

    def __init__(self, first: float, count: int, step: float, amplitude: float) -> None:
        self._first, self._count = first, count
        self.table = np.empty(count), np.empty(count), np.empty(count, np.int64)
        _fill((first, step, amplitude), *self.table)

    def serves(self, first: float, count: int) -> bool:
        """Whether it serves frames whose first is so far behind the start, cycles of the reference."""
        return first == self._first and count <= self._count


@njit(cache=True, nogil=True)
def _fill(how, waves, shares, symbols):  # type: ignore[no-untyped-def]
    """Fill a table; `how`: cycles of the reference since the check frame's start, those of a frame of the
    tape, and the amplitude.
    """
    first, step, amplitude = how
    for i in range(len(waves)):
        theta = first + i * step
        place = max(theta, 0.0) / CYCLES_PER_SYMBOL
        symbols[i] = min(int(place), SYMBOLS - 1)
        # sin² of a quarter turn
        shares[i] = 0.5 - 0.5 * _sine(0.25 + 0.5 * (place - symbols[i]))
        waves[i] = amplitude * _sine(theta / CYCLES_PER_SUBCARRIER)


@njit(cache=True, nogil=True)
def _add(frames, at, table, bits):  # type: ignore[no-untyped-def]
    """Add the subcarrier of all tracks (n, tracks) to frames of which the first is `at` in the table."""
    waves, shares, symbols = table
    for i in range(len(frames)):
        wave, share, symbol = waves[at + i], shares[at + i], symbols[at + i]
        for track in range(frames.shape[1]):
            now, then = bits[symbol, track], bits[symbol + 1, track]
            frames[i, track] += wave * (now + (then - now) * share)
