"""The lacing: the carriers of all tracks, with the check signal beneath them, become the frames of the tape.

Signals in: columns float32 (tracks, steps, periods), full scale 1: of each track the samples at the same step
of many periods of the motion side by side, so that the compiler makes several at once; the subcarrier of the
check signal and what each track says by it. Signals out: frames (periods · steps, tracks), float32 of full
scale 1 or samples of 16 bit.

    sample  = carrier + wave · (symbol now + (next symbol - symbol now) · share)   of 16 bit: rounded, clipped

All of it is single: the sum is then 2e-8 of full scale off, and a step of 16 bit is 3e-5.

    column  x x x x …  ┐
    column  y y y y …  ├──►  frames  r x y z  r x y z  …      four tracks of 16 bit are one word of 64
    column  z z z z …  ┘

Source: our own.
"""

from __future__ import annotations

import sys
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import keeps_kinds, njit
from morfax.recorder.sound.sixteen_bit import rounded
from morfax.recorder.sound.source import Frames, Stored

CHUNK_PERIODS = 128  # made at a time: they stay in the processor's first cache


class _Subcarrier(NamedTuple):
    waves: Frames
    shares: Frames
    symbols: NDArray[np.int64]


@keeps_kinds
class Beneath(_Subcarrier):
    """The check signal's subcarrier beneath some periods; `waves` is empty on a bare tape.

    `waves`, `shares`: the subcarrier, and the share of the next symbol, at each step of each period (steps,
    periods). `symbols`: the number of the symbol there; one row of them where all steps of a period have the
    same.
    """


class _Fields(NamedTuple):
    columns: Frames
    finished: Frames
    said: Frames
    packed: NDArray[np.int64]
    cubics: Array
    turned: Array
    stands: NDArray[np.bool_]


@keeps_kinds
class LacingRoom(_Fields):
    """Memory for what is between positions and frames, of so many periods.

    `columns`: carriers; `finished`: the same with check signal and in 16 bit; `said`: what a track says, and
    how far its next symbol is from that; `packed`: frames of 64 bit. `cubics`: the phase of a track in each
    period; `turned`: that of the reference; `stands`: whether an axis did so in the periods before.
    """

    @classmethod
    def of(cls, tracks: int, steps: int) -> LacingRoom:
        """Room for so many tracks, and steps of a period."""
        shape = tracks, steps, CHUNK_PERIODS
        return cls(
            np.empty(shape, np.float32),
            np.empty(shape, np.float32),
            np.empty((2, CHUNK_PERIODS), np.float32),
            np.empty(CHUNK_PERIODS, np.int64),
            np.empty((4, CHUNK_PERIODS)),
            np.empty(CHUNK_PERIODS),
            np.empty(tracks - 1, np.bool_),
        )


_NO_WAVES = np.empty((0, 0), np.float32)
BARE = Beneath(_NO_WAVES, _NO_WAVES, np.empty((0, 0), np.int64))


def words_of(frames: Stored) -> NDArray[np.int64]:
    """The frames as words of 64 bit, (n,), where each is one; none where they are not."""
    if frames.dtype == np.int16 and frames.shape[1] == 4 and sys.byteorder == "little":
        return frames.view(np.int64).ravel()
    return np.empty(0, np.int64)


# Here and in carrier.py: without counts of references to pieces of arrays, which take a quarter of the time.
@njit(cache=True, nogil=True, _nrt=False)
def finish(room, first, count, beneath, bits, in_16_bit):  # type: ignore[no-untyped-def]
    """Lay the check signal beneath so many periods, of which the first is so far on in it, and make whole
    numbers of them for samples of 16 bit. `bits`: what each track says (symbols, tracks).
    """
    columns, finished = room.columns, room.finished
    now, turns = room.said[0], room.said[1]
    waves, shares, symbols = beneath
    for track in range(columns.shape[0]):
        for k in range(columns.shape[1]):
            column, out = columns[track, k, :count], finished[track, k, :count]
            if len(waves) == 0:
                _in_16_bit(column, out)
                continue
            if k < len(symbols):
                _said(symbols[k, first : first + count], bits[:, track], now, turns)
            wave, share = waves[k, first : first + count], shares[k, first : first + count]
            if in_16_bit:
                _add_in_16_bit(column, wave, share, now, turns, out)
            else:
                _add(column, wave, share, now, turns, out)


@njit(cache=True, nogil=True, _nrt=False)
def _said(symbols, bits, now, turns):  # type: ignore[no-untyped-def]
    """Fill what a track says in each period, and how far its next symbol is from that."""
    for i in range(len(symbols)):
        now[i] = bits[symbols[i]]
        turns[i] = bits[symbols[i] + 1] - now[i]


@njit(cache=True, nogil=True, _nrt=False, fastmath={"contract"})
def _add(column, wave, share, now, turns, out):  # type: ignore[no-untyped-def]
    """A column with the check signal, full scale 1."""
    for i in range(len(column)):
        out[i] = column[i] + wave[i] * (now[i] + turns[i] * share[i])


@njit(cache=True, nogil=True, _nrt=False, fastmath={"contract"})
def _add_in_16_bit(column, wave, share, now, turns, out):  # type: ignore[no-untyped-def]
    """A column with the check signal, in steps of 16 bit."""
    for i in range(len(column)):
        out[i] = rounded(column[i] + wave[i] * (now[i] + turns[i] * share[i]))


@njit(cache=True, nogil=True, _nrt=False)
def _in_16_bit(column, out):  # type: ignore[no-untyped-def]
    """A column in steps of 16 bit."""
    for i in range(len(column)):
        out[i] = rounded(column[i])


@njit(cache=True, nogil=True, _nrt=False)
def lace(columns, packed, frames, words):  # type: ignore[no-untyped-def]
    """Put columns beside each other as frames."""
    tracks, steps, count = columns.shape[0], columns.shape[1], len(frames) // columns.shape[1]
    if len(words):
        _pack(columns, packed, words)
        return
    for track in range(tracks):
        for k in range(steps):
            column = columns[track, k]
            for i in range(count):
                frames[i * steps + k, track] = column[i]


@njit(cache=True, nogil=True, _nrt=False)
def _pack(columns, packed, words):  # type: ignore[no-untyped-def]
    """Put four columns of whole numbers beside each other, the first in the lowest 16 bits of each word."""
    steps = columns.shape[1]
    for k in range(steps):
        for i in range(len(packed)):
            word = np.int64(0)
            for track in range(4):
                word |= (np.int64(np.int32(columns[track, k, i])) & 0xFFFF) << 16 * track
            packed[i] = word
        for i in range(len(words) // steps):
            words[i * steps + k] = packed[i]
