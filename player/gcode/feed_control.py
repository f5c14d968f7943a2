"""Feed control: an up/down counter decides how often the error gates of the interpolator open.

Signals in: the feed number and the override as binary fractions of the clock, and the command pulses of the
axes. Signals out: whether the error gates are open for a recirculation (16 clocks).

    clock ──► rate multiplier: feed ──► rate multiplier: override ──► f_p ──► counter 81 up, 7 eighths each
    command pulses ──► gate 88: G 20, M 8, S 6 eighths ─────────────────────► counter 81 down
    counter 81, stages 1 … 8 (1/8 … 16):  stage 7 or 8 ──► every recirculation
                                          stage 6      ──► every fourth
                                          5 to 8 all ones ──► no more feed pulses

A binary rate multiplier of n stages passes F of every 2^n clocks, evenly: the clock at which its counter's
bit k turns to 1 is passed where bit n - 1 - k of F is set. The counter comes to rest where feed pulses and
command pulses balance:

    7/8 f_p = 2.5 V,    2.5 V = 2.5 G + M + 0.75 S (three axes), 2.5 V = 2.5 G + M (two)   pulses per second

so that V is the resultant speed within -10.6 … +1.9 % (three axes), -7.2 … +1.0 % (two). With a true norm
each axis weighs 2.5 times its direction cosine instead.

Source: patent from US application 631 214 of 1967, figures 4 and 17, equations II and III, claims 4 to 6 and
15. Questions: feed pulses enter stages 1, 2 and 3, so they weigh 7 eighths. Stage 7 stands in both the gate
for every and the one for every second recirculation; the first includes the second. Three pulses at once take
34 eighths from the 32 with which the gates first open, so the counter has a sign; feed pulses that come
within one recirculation are counted one by one. The patent gives neither the length of the feed number, here
20 bits, nor that of the override, 10 bits. The true norm is ours; for it the counter holds 1/1024 of an
eighth.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit

CLOCKS = 16  # of a recirculation
FEED_BITS = 20  # of the feed number; chosen here
OVERRIDE_BITS = 10  # of the override; chosen here
FEED_EIGHTHS = 7  # a feed pulse enters stages 1, 2 and 3
GREATEST, MIDDLE, SMALLEST = 20, 8, 6  # eighths
EIGHTH = 1024  # units of the counter
# from here on stages 5 to 8 are set; 7 or 8; 6
BLOCKED, EVERY, FOURTH = 240 * EIGHTH, 64 * EIGHTH, 32 * EIGHTH


def feed_number(pulses_per_s: float, recirculations_hz: float) -> int:
    """The feed number for a resultant speed; raises ValueError for a speed without one."""
    feed_pulses_hz = pulses_per_s * GREATEST / FEED_EIGHTHS
    clocks_hz = CLOCKS * recirculations_hz
    number = (
        round(feed_pulses_hz / clocks_hz * 2**FEED_BITS) if math.isfinite(feed_pulses_hz) else 0
    )
    if number <= 0 or pulses_per_s > recirculations_hz:
        smallest = clocks_hz * FEED_EIGHTHS / GREATEST / 2**FEED_BITS
        allowed = f"{smallest:.3g} to {recirculations_hz:g} pulses/s"
        raise ValueError(
            f"a speed of {pulses_per_s:g} pulses/s has no feed number; give {allowed}"
        )
    return number


def override_number(share: float) -> int:
    """The override as a number of 10 bits; 1.0 passes every pulse."""
    if not 0 <= share <= 1:
        raise ValueError(f"the override is {share:g}; give a share of 0 to 1")
    return round(share * 2**OVERRIDE_BITS)


def resultant_weights(errors: NDArray[np.int64], *, true_norm: bool) -> NDArray[np.int64]:
    """Counter units that a command pulse of each axis takes off, on a line with these errors."""
    size = np.abs(errors).astype(np.float64)
    if true_norm:
        return np.rint(
            GREATEST * EIGHTH * size / max(math.sqrt(float(size @ size)), 1.0)
        ).astype(np.int64)
    weights = np.empty(len(errors), np.int64)
    weights[np.argsort(-size, kind="stable")] = [
        GREATEST * EIGHTH,
        MIDDLE * EIGHTH,
        SMALLEST * EIGHTH,
    ][: len(errors)]
    return weights


@njit(cache=True, inline="always")
def passes(count, number, bits):  # type: ignore[no-untyped-def]
    """Whether a rate multiplier passes the clock that takes its counter to `count` (1 … 2^bits)."""
    if number >> bits:
        return 1
    stage = bits - 1
    while stage >= 0 and count & 1 == 0:
        count >>= 1
        stage -= 1
    return (number >> stage) & 1 if stage >= 0 else 0


@njit(cache=True, inline="always")
def feed_pulses(recirculation, number):  # type: ignore[no-untyped-def]
    """Feed pulses within a recirculation, 1 and on: the four fast stages, and perhaps one of a slow stage."""
    fast = number >> (FEED_BITS - 4)
    slow = number & ((1 << (FEED_BITS - 4)) - 1)
    return fast + passes(recirculation, slow, FEED_BITS - 4)


@njit(cache=True, inline="always")
def gate_opens(counter, recirculation):  # type: ignore[no-untyped-def]
    """Whether counter 81 opens the error gates for this recirculation."""
    return counter >= EVERY or (counter >= FOURTH and recirculation & 3 == 0)


@njit(cache=True)
def count_feed(recirculations, number, override):  # type: ignore[no-untyped-def]
    """Feed pulses f_p in this many recirculations, after both rate multipliers; for claim 4 and its tests."""
    through, before = 0, 0
    for recirculation in range(1, recirculations + 1):
        for _ in range(feed_pulses(recirculation, number)):
            before += 1
            through += passes(before, override, OVERRIDE_BITS)
    return through
