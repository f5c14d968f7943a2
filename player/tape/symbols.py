"""The symbols of the check signal: 120 to a frame, read early, on time and late.

Signals in: points of the subcarrier with the cycles of the reference beside them, and where a frame begins.
Signals out, track by track: +1 or -1 of each symbol and how strong it is, how late they are, and the phase of
the subcarrier in each part of the frame; and, for the search, how like the sync word what follows each place
is.

    early  on  late          a quarter of a symbol to either side of where a symbol is due
       ╲    |    ╱
        ╲_-~~~-_╱            late = (late - early) / 2 (2 on - early - late),   the top of a parabola
         ╱     ╲

Source: R. E. Ziemer and W. H. Tranter, Principles of Communications (coherent detection, early and late
gates). Questions: none.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.player.tape.subcarrier import Complexes, Subcarrier
from morfax.recorder.tape.check_frame import SYMBOLS, SYNC, SYNC_SYMBOLS, Bits
from morfax.recorder.tape.check_signal import CYCLES_PER_SUBCARRIER, CYCLES_PER_SYMBOL

QUARTER = CYCLES_PER_SYMBOL / 4  # of a symbol, in cycles of the reference
GATES = 3  # of a symbol: early, on, late
# of the full strength, a quarter of a symbol beside one that passes over to the other sign: cos pi/4
PASSING = math.sqrt(0.5)
PARTS = 4  # of a frame, each with its own phase
# of a track's times: the phase of each part; how late it is, its swing, its error
FIGURES = PARTS + 3
WORD = SYNC.astype(np.float64)


class Gates(NamedTuple):
    """Symbols of a frame, +1 or -1, and how strong they are; how late, in cycles; phases of the parts, in
    turns, how far the phase swings about them, RMS, beyond what noise does, and their standard errors by what
    lies across in each symbol (noise, or a tone).

    `strengths` are along the sync word and grow with it; `sizes` are the largest of
    the three gates of each symbol alone, whatever its phase, and wherever it begins. `shares` (tracks, gates,
    symbols): how strong each gate is for what its symbol and the next one to it let expect; early, on, late.
    """

    bits: Bits
    strengths: Array
    sizes: Array
    shares: Array
    late: Array
    turns: Array
    swings: Array
    errors: Array


def likeness(seen: Complexes) -> tuple[Complexes, Array]:
    """How like the sync word each quarter of a symbol and those after it are: sum, and share of the power."""
    starts = max(len(seen) - 4 * SYMBOLS, 0)
    alike, power = np.zeros(starts, complex), np.zeros(starts)
    strength = np.abs(seen) ** 2
    for symbol, sign in enumerate(SYNC.tolist()):
        alike += sign * seen[4 * symbol : 4 * symbol + starts]
        power += strength[4 * symbol : 4 * symbol + starts]
    return alike, np.abs(alike) ** 2 / np.maximum(power * SYNC_SYMBOLS, NOT_ZERO)


def read_symbols(points: Subcarrier, begins: float) -> Gates:
    """Read the symbols of the frame of all tracks that begins at a count of the reference."""
    gates = gates_of(points.points.shape[1])
    read_gates(points.points, points.theta, begins, WORD, gates)
    return gates


def gates_of(tracks: int) -> Gates:
    """Room for the symbols of a frame of so many tracks."""
    return Gates(
        np.empty((tracks, SYMBOLS), np.int8),
        np.empty((tracks, SYMBOLS)),
        np.empty((tracks, SYMBOLS)),
        np.empty((tracks, GATES, SYMBOLS)),
        np.empty(tracks),
        np.empty((tracks, PARTS)),
        np.empty(tracks),
        np.empty(tracks),
    )


# The order of the sums is free (reassoc, contract), so that they run in vectors; nan keeps its meaning.
@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def read_gates(points, theta, begins, word, frame):  # type: ignore[no-untyped-def]
    """Read one frame of all tracks, whose symbols are 24 cycles of theta apart; see `Gates`."""
    bits, strengths, sizes, shares, late, turns, swings, errors = frame
    symbols = bits.shape[1]
    part = symbols // turns.shape[1]
    seen = np.empty((2, len(bits), GATES, symbols))  # along and across
    _gates(points, theta, begins, seen[0], seen[1])
    signs = np.empty(symbols)
    for track in range(len(bits)):
        # 1. the sync word tells the phase, and so the sign of each symbol
        re, im = seen[0, track], seen[1, track]
        alike_re = alike_im = 0.0
        for symbol in range(len(word)):
            alike_re += re[1, symbol] * word[symbol]
            alike_im += im[1, symbol] * word[symbol]
        along = re * alike_re + im * alike_im
        _signs((re, im), along[1], signs, strengths[track], sizes[track])
        for symbol in range(symbols):
            bits[track, symbol] = signs[symbol]
        _share(along, signs, shares[track])
        # 2. with the signs known: how late, by a parabola through three gates; and the phase, part by part
        late[track] = _lateness(re, im, signs)
        for number in range(turns.shape[1]):
            whole_re, whole_im = _sum(re[1], im[1], signs, number * part, (number + 1) * part)
            turns[track, number] = math.atan2(whole_im, whole_re) / (2 * math.pi)
        # 3. noise moves a symbol along and across alike; what is across beyond that is a swing of the phase
        across, noise = _across(re[1], im[1], signs, turns[track], part)
        swings[track] = math.sqrt(max(across - noise, 0.0)) / (2 * math.pi)
        errors[track] = math.sqrt(across / part) / (2 * math.pi)


@njit(cache=True, nogil=True)
def _gates(points, theta, begins, re, im):  # type: ignore[no-untyped-def]
    """Early, on and late of each symbol of all tracks, between the two points beside it."""
    for gate in range(GATES):
        at = 0
        for symbol in range(re.shape[2]):
            place = begins + symbol * CYCLES_PER_SYMBOL + (gate - 1) * QUARTER
            while at < len(theta) - 2 and theta[at + 1] < place:
                at += 1
            share = (place - theta[at]) / (theta[at + 1] - theta[at])
            share = min(max(share, 0.0), 1.0)
            for track in range(len(re)):
                before, after = points[at, track], points[at + 1, track]
                re[track, gate, symbol] = before.real + share * (after.real - before.real)
                im[track, gate, symbol] = before.imag + share * (after.imag - before.imag)


@njit(cache=True, nogil=True)
def _signs(seen, along, signs, strengths, sizes):  # type: ignore[no-untyped-def]
    """The sign of each symbol of a track along its phase, how strong it is there, and its largest size."""
    re, im = seen
    for symbol in range(len(signs)):
        signs[symbol] = 1.0 if along[symbol] >= 0 else -1.0
        strengths[symbol] = abs(along[symbol])
        largest = 0.0
        for gate in range(GATES):
            largest = max(largest, re[gate, symbol] ** 2 + im[gate, symbol] ** 2)
        sizes[symbol] = math.sqrt(largest)


@njit(cache=True, nogil=True, inline="always")
def _sum(re, im, signs, first, last):  # type: ignore[no-untyped-def]
    """The sum of some symbols with their signs known."""
    whole_re = whole_im = 0.0
    for symbol in range(first, last):
        whole_re += re[symbol] * signs[symbol]
        whole_im += im[symbol] * signs[symbol]
    return whole_re, whole_im


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _lateness(re, im, signs):  # type: ignore[no-untyped-def]
    """How late a track is, by a parabola through the strengths of its three gates."""
    sums = np.zeros(GATES)
    for gate in range(GATES):
        whole_re, whole_im = _sum(re[gate], im[gate], signs, 0, len(signs))
        sums[gate] = math.sqrt(whole_re * whole_re + whole_im * whole_im)
    bend = 2 * sums[1] - sums[0] - sums[2]
    return QUARTER * (sums[2] - sums[0]) / (2 * bend) if bend > 0 else 0.0


@njit(cache=True, nogil=True)
def _share(along, signs, shares):  # type: ignore[no-untyped-def]
    """How strong each gate is along its phase, for what the symbols on both sides of it let expect."""
    symbols = len(signs)
    for symbol in range(symbols):
        shares[0, symbol] = along[0, symbol] * signs[symbol] / PASSING
        shares[1, symbol] = along[1, symbol] * signs[symbol]
        shares[2, symbol] = along[2, symbol] * signs[symbol] / PASSING
    # between two that are the same it does not pass over
    for symbol in range(symbols - 1):
        same = PASSING if signs[symbol] == signs[symbol + 1] else 1.0
        shares[2, symbol] *= same
        shares[0, symbol + 1] *= same


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
def _across(re, im, signs, turns, part):  # type: ignore[no-untyped-def]
    """Power across and noise along of the symbols about the phases of their parts; no weak symbols."""
    powers, usual = np.empty(len(re)), 0.0
    for symbol in range(len(re)):
        powers[symbol] = re[symbol] * re[symbol] + im[symbol] * im[symbol]
        usual += math.sqrt(powers[symbol])
    usual /= len(re)
    if not usual > 0:
        return 0.0, 0.0
    count = along = alongs = acrosses = 0.0
    for number in range(len(turns)):
        turn = 2 * math.pi * turns[number]
        cosine, sine = math.cos(turn) / usual, math.sin(turn) / usual
        for symbol in range(number * part, (number + 1) * part):
            strong = 1.0 if powers[symbol] >= 0.25 * usual * usual else 0.0
            straight = (re[symbol] * cosine + im[symbol] * sine) * signs[symbol] * strong
            aside = (im[symbol] * cosine - re[symbol] * sine) * strong
            count += strong
            along += straight
            alongs += straight * straight
            acrosses += aside * aside
    if not count:
        return 0.0, 0.0
    return acrosses / count, alongs / count - (along / count) ** 2


@njit(cache=True, nogil=True)
def count_on(gates, is_read, held, cycle_s, figures):  # type: ignore[no-untyped-def]
    """Count the turns of each track's parts on from its last frame, and tell its times, s.

    `is_read`: whether each track was read; no more where its phase is no number. `held`: turns of the last
    part so far, and at a delay of zero. `figures` (tracks, 7): how late; the delay of each part against track
    1; the standard error of a delay; the swing. nan where a track is not read.
    """
    turns, late, (last, zero) = gates.turns, gates.late, held
    turn_s = CYCLES_PER_SUBCARRIER * cycle_s
    for track in range(len(turns)):
        is_read[track] &= np.isfinite(turns[track]).all()
        if not is_read[track]:
            late[track] = np.nan
            turns[track] = np.nan
            continue
        turns[track] -= np.rint(turns[track] - last[track])
        last[track] = turns[track, -1]
    for track in range(len(turns)):
        turns[track] -= zero[track]
        figures[track, 0] = late[track] * cycle_s
        for part in range(turns.shape[1]):
            first = turns[0, part] if track else 0.0
            figures[track, 1 + part] = (first - turns[track, part]) * turn_s
        figures[track, -2] = math.hypot(gates.errors[track], gates.errors[0]) * turn_s
        figures[track, -1] = gates.swings[track] * turn_s
