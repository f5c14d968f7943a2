"""The felt pen is the one that drew: its width, softness, darkness and noise, from pixels beside a line."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.tangles.felt_pen import FeltPen
from morfax.tracer.tangles.seen_ink import SeenInk

HALF_MM, SOFT_MM, PAPER, INK, NOISE = 0.2, 0.055, 0.02, 0.95, 0.04
FELT_HALF_MM, FELT_SOFT_MM = (
    0.19,
    0.085,
)  # as the cells felt it: narrower, and half as soft again


def beside(count: int) -> Array:
    """How far some pixels are from a line, at all distances alike, mm."""
    return np.linspace(0.0, 0.5, count)


def seen(away_mm: Array, noise: float) -> SeenInk:
    """The ink beside a line, with so much noise."""
    fades = [math.erfc((d - HALF_MM) / (math.sqrt(2) * SOFT_MM)) / 2 for d in away_mm]
    dark = PAPER + (INK - PAPER) * (np.array(fades))
    dark += np.random.default_rng(1).normal(0, noise, len(dark))
    places = np.column_stack([away_mm, away_mm])
    return SeenInk(
        places, dark, np.full(len(dark), 9.0), FELT_HALF_MM, FELT_SOFT_MM, 0.007, 0.0
    )


@pytest.mark.parametrize(("noise", "within"), [(0.0, 1e-5), (NOISE, 0.02)])
def test_the_pen_is_the_one_that_drew(noise: float, within: float) -> None:
    """Within 2 percent of its width, softness and ink of 2000 pixels with noise."""
    away_mm = beside(2000)
    pen = FeltPen.of(away_mm, seen(away_mm, noise))
    assert pen.half_mm == pytest.approx(HALF_MM, rel=within)
    assert pen.softness_mm == pytest.approx(SOFT_MM, rel=2 * within)
    assert pen.ink == pytest.approx(INK, rel=within)
    assert pen.paper == pytest.approx(PAPER, abs=within)
    assert pen.noise == pytest.approx(noise / (INK - PAPER), rel=0.1, abs=1e-5)


def test_the_pen_sees_its_paper_as_nothing_and_its_ink_as_one() -> None:
    away_mm = beside(500)
    ink = seen(away_mm, 0.0)
    pen = FeltPen.of(away_mm, ink)
    same = pen.sees(ink)
    assert same.darkness[0] == pytest.approx(1.0, abs=1e-3)
    assert same.darkness[-1] == pytest.approx(0.0, abs=1e-3)
    assert (same.half_mm, same.softness_mm) == (pen.half_mm, pen.softness_mm)
