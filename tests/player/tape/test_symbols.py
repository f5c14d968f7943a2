"""Symbols of the check signal: what noise does to them, and what a phase that swings does."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.player.tape.symbols import PARTS, _across
from morfax.recorder.tape.check_frame import SYMBOLS

PART = SYMBOLS // PARTS
BITS = np.where(np.random.default_rng(0).random(SYMBOLS) < 0.5, -1.0, 1.0)
TURNS = np.linspace(-0.4, 0.3, PARTS)  # the phase of each part, in turns


def parts(seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Real and imaginary parts."""
    return seen.real.copy(), seen.imag.copy()


def across_and_along(
    phases_rad: np.ndarray, noise: np.ndarray | float = 0.0
) -> tuple[float, float]:
    """Power across and noise along of symbols of size 3 whose phase swings about that of their part."""
    turned = np.exp(1j * (2 * math.pi * np.repeat(TURNS, PART) + phases_rad))
    seen = 3.0 * (BITS * turned + noise)
    across, along = _across(*parts(seen), BITS, TURNS, PART)
    return float(across), float(along)


def test_quiet_symbols_have_neither() -> None:
    assert across_and_along(np.zeros(SYMBOLS)) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_a_phase_that_swings_shows_across_and_hardly_along() -> None:
    """By 0.05 rad: half of its square across; along its fourth power over 32."""
    swing = 0.05 * np.sin(2 * math.pi * np.arange(SYMBOLS) / 10)
    across, along = across_and_along(swing)
    assert across == pytest.approx(0.05**2 / 2, rel=0.01)
    assert along == pytest.approx(0.05**4 / 32, rel=0.05)


def test_noise_is_as_strong_along_as_across() -> None:
    """26 dB: 0.05 of the symbol in all, half of its power either way; 120 symbols are true to a third."""
    chance = np.random.default_rng(1)
    noise = (
        0.05 / math.sqrt(2) * (chance.normal(size=SYMBOLS) + 1j * chance.normal(size=SYMBOLS))
    )
    across, along = across_and_along(np.zeros(SYMBOLS), noise)
    assert across == pytest.approx(0.05**2 / 2, rel=0.33)
    assert along == pytest.approx(0.05**2 / 2, rel=0.33)


def test_symbols_below_half_of_the_usual_size_are_left_out() -> None:
    """Ten of a fifth of the size, turned by a quarter: they would be as much across."""
    phases, size = np.zeros(SYMBOLS), np.zeros(SYMBOLS)
    phases[40:50], size[40:50] = math.pi / 2, -0.8
    turned = np.exp(1j * (2 * math.pi * np.repeat(TURNS, PART) + phases))
    across, along = _across(*parts((1 + size) * BITS * turned), BITS, TURNS, PART)
    assert (across, along) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert _across(*parts(np.zeros(SYMBOLS, complex)), BITS, TURNS, PART) == (0.0, 0.0)
