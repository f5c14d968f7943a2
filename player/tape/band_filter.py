"""The filter of the discriminator: a low-pass that moves the reference to 0 Hz, for decimation.

Signals: none; taps in float32 out, for a sample rate and a reference in Hz and a decimation.

    taps(n) = h(n) · exp(-j w n)        h: windowed sinc (Kaiser), w: the reference

The low-pass is 0.6 dB down at 2 kHz from the carrier, 6 dB at 3 kHz and 80 dB from 5 kHz on, which keeps out
what the decimation would fold upon the carrier: its own mirror (12 kHz away), a DC offset and the second
harmonic (6 kHz away). With a lower reference it is as much narrower and longer.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO

STOP_BAND_BETA = 8.0  # Kaiser: stop band 80 dB down

Float32s = NDArray[np.float32]
Float64s = NDArray[np.float64]
Complexes = NDArray[np.complex128]


def translating_taps(
    sample_rate_hz: float, reference_hz: float, decimation: int
) -> tuple[Float32s, Float32s]:
    """Real and imaginary taps of the filter that moves the reference to 0 Hz and keeps its neighbourhood."""
    low_pass, turns = _low_pass(sample_rate_hz, reference_hz, decimation)
    return _taps((low_pass * turns).real), _taps((low_pass * turns).imag)


def _low_pass(
    sample_rate_hz: float, reference_hz: float, decimation: int
) -> tuple[Float64s, Complexes]:
    """Taps h of the low-pass, and the turn of each, exp(-j w n)."""
    cut_hz = min(sample_rate_hz / decimation, reference_hz) / 2
    half = round(2 * sample_rate_hz / cut_hz)
    n = np.arange(-half, half + 1)
    low_pass = np.sinc(2 * cut_hz / sample_rate_hz * n) * np.kaiser(
        2 * half + 1, STOP_BAND_BETA
    )
    return low_pass / low_pass.sum(), np.exp(-2j * np.pi * reference_hz / sample_rate_hz * n)


def _taps(values: Float64s) -> Float32s:
    """The taps that are not negligible."""
    return np.where(np.abs(values) < NOT_ZERO, 0.0, values).astype(np.float32)


def branches(
    sample_rate_hz: float, reference_hz: float, decimation: int, group: int
) -> tuple[Float32s, Float32s, Float32s]:
    """The filter as real sums down the columns of a row, turned once: taps (branches, columns, rows), turns.

    With a whole number of reference cycles to a row, as most tapes have, all taps of a column turn alike and
    one real branch is enough; else there is one for the real and one for the imaginary taps. The rows are
    filled up to groups of so many.
    """
    low_pass, turns = _low_pass(sample_rate_hz, reference_hz, decimation)
    if (reference_hz * decimation / sample_rate_hz).is_integer():
        taps, turned = [low_pass], turns[None, :decimation]
    else:
        taps = [(low_pass * turns).real, (low_pass * turns).imag]
        turned = np.repeat([[1], [1j]], decimation, axis=1)
    rows = np.stack(
        [
            np.pad(one, (0, -len(one) % decimation)).reshape(-1, decimation).T
            for one in map(_taps, taps)
        ]
    )
    used = (
        int(np.flatnonzero(rows.any(axis=(0, 1)))[-1]) + 1
    )  # the window is nothing at its ends
    filled_up = (0, -used % group)
    rows = np.pad(rows[:, :, :used], ((0, 0), (0, 0), filled_up))
    return rows, turned.real.astype(np.float32), turned.imag.astype(np.float32)
