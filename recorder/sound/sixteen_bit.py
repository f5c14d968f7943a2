"""Samples of 16 bit: frames of full scale 1, rounded and clipped.

Signals: frames float32 (n, tracks) in; int16 (n, tracks) out. libsndfile takes six times as long.

Source: our own; full scale as libsndfile writes it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.recorder.sound.source import Stored


def in_16_bit(frames: Stored) -> NDArray[np.int16]:
    """Frames as samples of 16 bit."""
    if frames.dtype == np.int16:
        return frames.view(np.int16)
    samples = np.empty(frames.shape, np.int16)
    _fill(np.ascontiguousarray(frames, np.float32), samples)
    return samples


@njit(cache=True, nogil=True)
def _fill(frames, out):  # type: ignore[no-untyped-def]
    """Make samples of 16 bit of frames."""
    for i in range(frames.shape[0]):
        for j in range(frames.shape[1]):
            out[i, j] = np.int16(rounded(frames[i, j]))


@njit(cache=True, inline="always")
def rounded(sample):  # type: ignore[no-untyped-def]
    """A float32 of full scale 1 in steps of 16 bit: a whole number within their range."""
    value = sample * np.float32(32767)
    return np.rint(min(max(value, np.float32(-32768)), np.float32(32767)))
