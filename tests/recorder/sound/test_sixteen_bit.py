"""Samples of 16 bit: rounded to the nearest, clipped at full scale, and left alone where they are such."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.recorder.sound import sixteen_bit
from morfax.recorder.sound.sixteen_bit import in_16_bit


@pytest.mark.parametrize("plain", [False, True])
def test_frames_are_rounded_and_clipped(monkeypatch: pytest.MonkeyPatch, plain: bool) -> None:
    if plain:
        for name in ("_fill", "rounded"):
            monkeypatch.setattr(sixteen_bit, name, getattr(sixteen_bit, name).py_func)
    steps = np.array([0.0, 0.4, 0.6, -0.6, 32766.6, -32767.4])
    frames = np.array([steps / 32767, [1.0, -1.0, 2.0, -2.0, 1.00002, -1.00004]], np.float32)
    wanted = [[0, 0, 1, -1, 32767, -32767], [32767, -32767, 32767, -32768, 32767, -32768]]
    assert in_16_bit(frames).tolist() == wanted


def test_samples_of_16_bit_stay_as_they_are() -> None:
    samples = np.array([[1, -2], [3, -32768]], np.int16)
    assert np.array_equal(in_16_bit(samples), samples)
