"""The check signal: a weak subcarrier beneath each track, which says which track it is and where its axis is.

Signals in: the carriers of a tape, with the displacements of the axes in cycles, at the motion rate; out: the
frames of the tape with the check signal beneath them, a second and a half later.

    subcarrier   a sixth of the reference (1 kHz), 14 dB below the carrier, in phase with it at the start
    symbol       24 cycles of the reference (4 ms), +1 or -1, passing over as a raised cosine
    frame        120 symbols (0.48 s), one after another from the first frame of the tape on

    theta     = reference frequency · time                  cycles of the reference;   theta / 24 = k + u
    signal    = share · level · sin(2 pi theta / 6) · (b[k] cos² + b[k+1] sin²)(pi u / 2)

    -1 ____                 ____ +1
           ╲_            _╱              all tracks change over at the same moments
             ╲__________╱

What a frame tells of the time to come (check_frame.py) is known up to three frames later, so the rows of the
tape wait for that (waiting_rows.py), and its frames are made with the check signal beneath them (lacing.py).
Symbols and subcarrier are counted in cycles of the reference, the tape's own clock.

Source: our own; others of that time put time codes on tape the same way (IRIG B: a modulated carrier of 1
kHz, 1960). Questions: 2 kHz would pass the player's band filter only 24 dB down and turn the phase by 2e-3
cycle; 1 kHz passes 82 dB down (docs/reference/tape-format.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import keeps_kinds, njit
from morfax.recorder.sound.source import Stored
from morfax.recorder.tape.carrier import Carrier, sine
from morfax.recorder.tape.check_frame import (
    COUNTS_PER_CYCLE,
    SENT_BY,
    SYMBOLS,
    VERSION,
    middle_bits,
    send,
    word_of,
)
from morfax.recorder.tape.format import CHECK_SHARE, TapeFormat
from morfax.recorder.tape.lacing import BARE, Beneath
from morfax.recorder.tape.speed_gauge import widest_moves
from morfax.recorder.tape.told_figures import StatedFigures, frame_of
from morfax.recorder.tape.waiting_rows import ROWS_AT_ONCE

CYCLES_PER_SUBCARRIER = 6.0  # of the reference
CYCLES_PER_SYMBOL = 24.0
CYCLES_PER_FRAME = SYMBOLS * CYCLES_PER_SYMBOL
# a speed is told from change to change over this, as long as the player's filter
GAUGE_S = 0.002


class CheckWriter:
    """Has the carriers of one tape made with the check signal beneath them."""

    def __init__(self, fmt: TapeFormat, carrier: Carrier) -> None:
        self._carrier, self._tracks = carrier, fmt.tracks
        self._rows_per_frame = CYCLES_PER_FRAME / fmt.carrier.reference_cycles
        self._frames_per_row = fmt.samples_per_motion
        self._gauge = max(round(GAUGE_S * fmt.motion_rate_hz), 1)  # rows
        self._teller = _teller(fmt, self._rows_per_frame, self._gauge)
        self._number = 0  # the next frame of the check signal
        self._amplitude = CHECK_SHARE * fmt.level
        self._step = fmt.reference_hz / fmt.sample_rate_hz  # cycles of the reference in a frame
        self._begun, self._table = (0.0, 0), BARE  # how the table of the subcarrier begins

    def frames(self) -> Iterator[Stored]:
        """The frames of the tape that can be finished by now."""
        while self._carrier.rows.end >= self._row(self._number + 3) + 2 * self._gauge:
            yield self._finished(self._frame_at(self._number + 1), last=False)

    def rest(self) -> Iterator[Stored]:
        """The last frames; the last two whole frames of the check signal say that the tape ends."""
        whole = self._carrier.whole
        while self._carrier.done < whole:
            is_last = self._frame_at(self._number + 3) > whole
            yield self._finished(min(self._frame_at(self._number + 1), whole), last=is_last)

    def _row(self, number: int) -> int:
        """The first row at or after the start of a frame of the check signal."""
        return math.ceil(number * self._rows_per_frame)

    def _frame_at(self, number: int) -> int:
        """The first frame of the tape at or after that start."""
        return math.ceil(number * self._rows_per_frame * self._frames_per_row)

    def _finished(self, end: int, *, last: bool) -> Stored:
        """The frames of one frame of the check signal, up to one, with it."""
        beneath, bits = self._beneath(end), self._symbols(last)
        self._number += 1
        return self._carrier.until(end, beneath, bits)

    def _beneath(self, end: int) -> Beneath:
        """The subcarrier beneath the periods of the next frames up to one; it is the same in each check frame
        that begins as far before its frames.
        """
        done, steps = self._carrier.done, self._frames_per_row
        skip = done % steps  # frames of the first period that were made before
        begun = done * self._step - self._number * CYCLES_PER_FRAME, skip
        periods = -(-end // steps) - done // steps
        if begun != self._begun or periods > self._table.waves.shape[1]:
            waves, shares = np.empty((2, steps, periods), np.float32)
            symbols = np.empty((steps, periods), np.int64)
            _fill(begun, (self._step, self._amplitude), waves, shares, symbols)
            same = (symbols == symbols[0]).all()
            self._begun = begun
            self._table = Beneath(waves, shares, symbols[:1] if same else symbols)
        return self._table

    def _symbols(self, last: bool) -> Array:
        """What the tracks say in the next frame (symbols, tracks), and the first symbol of the one after."""
        first = max(self._row(self._number) - 1, 0)
        rows = self._carrier.rows.rows(first, self._row(self._number + 2) + 2 * self._gauge)
        symbols = np.empty((SYMBOLS + 1, self._tracks))
        _tell(rows, first, self._number, last, self._teller, SENT_BY, symbols)
        return symbols


class _Fields(NamedTuple):
    version: int
    middle_bits: int  # of an axis
    counts_per_cycle: int
    of_reference: tuple[int, float, float]
    rows_per_frame: float
    rate_hz: float  # of the rows
    gauge: int  # rows


@keeps_kinds
class _Teller(_Fields):
    """What the frames of one tape have in common; `of_reference`: counts, and what stands for speed and
    acceleration; `gauge`: a change of speed is told over so many rows.
    """


def _teller(fmt: TapeFormat, rows_per_frame: float, gauge: int) -> _Teller:
    """That of a tape."""
    said = frame_of(StatedFigures(fmt.cycles_per_mm, fmt.axes, fmt.start_mm), 0)
    of_reference = said.counts, said.speed, said.acceleration
    per_cycle, rate_hz = COUNTS_PER_CYCLE[VERSION], fmt.motion_rate_hz
    told = middle_bits(VERSION, 1)
    return _Teller(VERSION, told, per_cycle, of_reference, rows_per_frame, rate_hz, gauge)


@njit(cache=True, nogil=True)
def _tell(rows, first, number, last, teller, sent_by, symbols):  # type: ignore[no-untyped-def]
    """Fill in the symbols of all tracks in a frame of this number, of rows from one on."""
    axes = rows.shape[1]
    counts, most = np.zeros((2, axes)), np.zeros((2, axes))
    # its first instant, and its middle
    _count(rows, number * teller.rows_per_frame - first, teller.counts_per_cycle, counts[0])
    _count(
        rows, (number + 0.5) * teller.rows_per_frame - first, teller.counts_per_cycle, counts[1]
    )
    _gauged(rows, (teller.rate_hz, teller.gauge), most[0], most[1])
    words, (of_reference, fast, hard) = np.empty(axes + 1, np.int64), teller.of_reference
    state = teller.version, last
    words[0] = word_of((0, number), (*state, 0), (of_reference, 0), (fast, hard))
    for axis in range(axes):
        where = int(counts[0, axis]), int(counts[1, axis])
        most_of_axis = most[0, axis], most[1, axis]
        words[axis + 1] = word_of(
            (axis + 1, number), (*state, teller.middle_bits), where, most_of_axis
        )
    send(words, sent_by, symbols)


@njit(cache=True, nogil=True)
def _count(rows, at, per_cycle, counts):  # type: ignore[no-untyped-def]
    """Fill in the counts of the axes at a row with shares."""
    last = len(rows) - 1
    at = min(max(at, 0.0), float(last))
    before = int(at)
    after, share = min(before + 1, last), at - before
    for axis in range(rows.shape[1]):
        come = (rows[after, axis] - rows[before, axis]) * share
        counts[axis] = np.rint((come + rows[before, axis]) * per_cycle)


@njit(cache=True, nogil=True)
def _gauged(rows, how, fastest, hardest):  # type: ignore[no-untyped-def]
    """Raise each track's largest speed, cycles/s, and change of it over so many rows, cycles/s², to those of
    its rows.
    """
    (rate_hz, gauge), axes = how, rows.shape[1]
    along, moves = rows.ravel(), np.zeros(ROWS_AT_ONCE * axes)
    changes = np.zeros_like(moves)
    widest_moves(along, axes, moves)
    _widest_changes(along, (axes, gauge * axes), rate_hz, changes)
    for k in range(len(moves)):
        fastest[k % axes] = max(fastest[k % axes], moves[k] * rate_hz)
        hardest[k % axes] = max(hardest[k % axes], changes[k] * (rate_hz / gauge))


@njit(cache=True, nogil=True, _nrt=False)
def _widest_changes(along, apart, rate_hz, widest):  # type: ignore[no-untyped-def]
    """Make the widest changes of speed so far those of places, too; `apart`: from each to that which it goes
    to, and to that whose speed its own is held against.
    """
    move, gauge = apart
    count = max(len(along) - gauge - move, 0)
    for begin in range(0, count, len(widest)):
        end = min(begin + len(widest), count)
        come, gone = along[begin:end], along[begin + move : end + move]
        then_come = along[begin + gauge : end + gauge]
        then_gone = along[begin + gauge + move : end + gauge + move]
        for k in range(len(come)):
            speed, then = (gone[k] - come[k]) * rate_hz, (then_gone[k] - then_come[k]) * rate_hz
            widest[k] = max(widest[k], abs(then - speed))


@njit(cache=True, nogil=True)
def _fill(begun, how, waves, shares, symbols):  # type: ignore[no-untyped-def]
    """Fill a table; `begun`: cycles of the reference from the check frame's start to its first frame of the
    tape, and the frames of the period before that; `how`: the cycles of a frame, and the amplitude.
    """
    (first, skip), (step, amplitude) = begun, how
    for k in range(waves.shape[0]):
        for period in range(waves.shape[1]):
            theta = first + (period * waves.shape[0] + k - skip) * step
            place = max(theta, 0.0) / CYCLES_PER_SYMBOL
            symbol = min(int(place), SYMBOLS - 1)
            symbols[k, period] = symbol
            # sin² of a quarter turn
            shares[k, period] = 0.5 - 0.5 * sine(0.25 + 0.5 * (place - symbol))
            waves[k, period] = amplitude * sine(theta / CYCLES_PER_SUBCARRIER)
