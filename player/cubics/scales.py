"""The two-scale measurement: a fine scale that repeats and a coarse one that tells which pitch it is.

Signals: position of the slide in counts; out the code of the position, free of ambiguity. The fine resolver
on the slide gives the position within a pitch; the coarse one on the shaft counts half pitches, so that its
lowest digit has the weight of the fine one's highest:

    fine      0 … 31 | 32 … 63 |  0 … 31 | 32 … 63       highest digit  0 1 0 1
    coarse        0  |    1    |    2    |    3            lowest digit   0 1 0 1, set late by half a digit

A resolver turns its place into the phase of its carrier; a gate is open from the carrier's edge to the
resolver's, once in a reading, and a counter counts the fast pulses of the time base that pass it.

Where the two digits differ (exclusive OR 24), one is added to the coarse count. That is right as long as the
coarse scale is late by 0 … 1 of its digits, so it is set 0.5 late. The digit that both have counts once:

    position = (coarse >> 1) · pitch + fine

Source: patent US 3062995, figure 3 and column 5 (resolvers 5-11 and 10-12, counters 18 and 19), claims 3 to
5. Questions: the patent has 64 counts to a pitch and no length; `--historic` has 64. The usual control has
4096, 2.048 mm at 2000 counts per mm. Noise stands for the jitter of the gates' edges: evenly spread, the same
at any speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.player.cubics.time_base import TimeBase

RIGHT_LAG = 0.5  # of a coarse digit
# a phase that ends with a pulse lets it through; far above the rounding of a double
EDGE_COUNTS = 1e-6


@dataclass(frozen=True, slots=True)
class Scales:
    """Two-scale measurement: lag and misalignment in coarse digits, noise (largest either way)."""

    pitch_counts: int = 4096
    lag_digits: float = RIGHT_LAG
    misaligned_digits: float = 0.0
    fine_noise_counts: float = 0.0
    coarse_noise_digits: float = 0.0

    def __post_init__(self) -> None:
        if self.pitch_counts < 2 or self.pitch_counts & (self.pitch_counts - 1):
            raise ValueError(
                f"a pitch of {self.pitch_counts} counts has no highest digit; give a power of two"
            )

    @property
    def late_digits(self) -> float:
        """The lag of the coarse scale with its misalignment, coarse digits."""
        return self.lag_digits + self.misaligned_digits

    def table(self, base: TimeBase) -> NDArray[np.float64]:
        """The settings as the kernel takes them; the time base gives the carrier and the fast pulses."""
        return np.array(
            [
                self.pitch_counts,
                self.late_digits,
                self.fine_noise_counts,
                self.coarse_noise_digits,
                base.carrier_hz,
                base.fast_hz,
            ]
        )


@njit(cache=True, inline="always")
def gated_pulses(phase_cycles, carrier_hz, fast_hz):  # type: ignore[no-untyped-def]
    """Fast pulses through a gate that a resolver's phase holds open, once: the place in the pitch."""
    open_s = (phase_cycles - np.floor(phase_cycles)) / carrier_hz
    counts = fast_hz / carrier_hz
    return int(min(open_s * fast_hz + EDGE_COUNTS, counts - 1))


@njit(cache=True, inline="always")
def read_scales(position_counts, noise_fine, noise_coarse, scales):  # type: ignore[no-untyped-def]
    """Fine and coarse count at a position; noise from -1 to 1."""
    pitch, late, fine_noise, coarse_noise, carrier_hz, fast_hz = scales
    phase_cycles = (position_counts + noise_fine * fine_noise) / pitch
    fine = gated_pulses(phase_cycles, carrier_hz, fast_hz)
    coarse = int(np.floor(2 * position_counts / pitch - late + noise_coarse * coarse_noise))
    return fine, coarse


@njit(cache=True, inline="always")
def joined(fine, coarse, pitch):  # type: ignore[no-untyped-def]
    """The position code of both counts."""
    highest = 1 if 2 * fine >= pitch else 0
    differ = highest ^ (coarse & 1)  # exclusive OR 24
    return ((coarse + differ) >> 1) * pitch + fine


@njit(cache=True, inline="always")
def measured(position_counts, noise_fine, noise_coarse, scales):  # type: ignore[no-untyped-def]
    """The position code at a position, for the servo's kernel; noise from -1 to 1."""
    fine, coarse = read_scales(position_counts, noise_fine, noise_coarse, scales)
    return joined(fine, coarse, int(scales[0]))
