"""The two-scale measurement: a fine scale that repeats and a coarse one that tells which pitch it is.

Signals: position of the slide in counts; out the code of the position, free of ambiguity. The fine resolver
on the slide gives the position within a pitch; the coarse one on the shaft counts half pitches, so that its
lowest digit has the weight of the fine one's highest:

    fine      0 … 31 | 32 … 63 |  0 … 31 | 32 … 63       highest digit  0 1 0 1
    coarse        0  |    1    |    2    |    3            lowest digit   0 1 0 1, set late by half a digit

Where the two digits differ (exclusive OR 24), one is added to the coarse count. That is right as long as the
coarse scale is late by 0 … 1 of its digits, so it is set 0.5 late. The digit that both have counts once:

    position = (coarse >> 1) · pitch + fine

Source: patent US 3062995, figure 3 and column 5 (resolvers 5-11 and 10-12, counters 18 and 19). Questions:
the patent gives 64 counts to a pitch and no length. Here a pitch has 4096 counts, 2.048 mm at 2000 counts per
mm. Noise stands for the jitter of the gates' edges: evenly spread, the same at any speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.player.cubics.interpolator import TimeBase

RIGHT_LAG = 0.5  # of a coarse digit
Codes = NDArray[np.int64]


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

    def table(self) -> NDArray[np.float64]:
        """The settings as the kernel takes them."""
        return np.array(
            [
                self.pitch_counts,
                self.late_digits,
                self.fine_noise_counts,
                self.coarse_noise_digits,
            ]
        )


def read_scales(
    position_counts: NDArray[np.float64], scales: Scales, seed: int = 0
) -> tuple[Codes, Codes]:
    """Fine and coarse counts at positions, for claims 3 and 4; the same seed gives the same noise."""
    noise = np.random.default_rng(seed).uniform(-1, 1, (2, len(position_counts)))
    half = scales.pitch_counts / 2
    fine = (
        np.floor(position_counts + noise[0] * scales.fine_noise_counts).astype(np.int64)
        % scales.pitch_counts
    )
    coarse = np.floor(
        position_counts / half - scales.late_digits + noise[1] * scales.coarse_noise_digits
    )
    return fine, coarse.astype(np.int64)


def gated_pulses(phase_cycles: float, base: TimeBase) -> int:
    """Fast pulses through a gate that a resolver's phase holds open, for claim 5: the place in the pitch."""
    open_s = phase_cycles % 1.0 / base.carrier_hz
    return int(open_s * base.fast_hz + 1e-9)


def joined(fine: Codes, coarse: Codes, pitch_counts: int) -> Codes:
    """The position code of both counts, for claims 3 and 4; the servo's kernel has it in `measured`."""
    half_digits = pitch_counts.bit_length() - 2
    differ = (fine >> half_digits & 1) ^ (coarse & 1)  # exclusive OR 24
    return np.asarray(((coarse + differ) >> 1) * pitch_counts + fine)


@njit(cache=True, inline="always")
def measured(position_counts, noise_fine, noise_coarse, scales):  # type: ignore[no-untyped-def]
    """The position code at a position, for the servo's kernel; noise from -1 to 1."""
    pitch = int(scales[0])
    fine = int(np.floor(position_counts + noise_fine * scales[2])) % pitch
    coarse = int(np.floor(2 * position_counts / pitch - scales[1] + noise_coarse * scales[3]))
    highest = 1 if 2 * fine >= pitch else 0
    if highest != coarse & 1:
        coarse += 1
    return (coarse >> 1) * pitch + fine
