"""A smooth way goes on from leg to leg as an arc or a straight line; the ink tells which leg is whose."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.program.laid.smooth_ways import smooth_ways
from morfax.tracer.sensing.view import STEP_WIDTHS
from tests.tracer.inked import UM, WIDTH_MM

STEP_MM = STEP_WIDTHS * WIDTH_MM
LEG = 2.0  # widths


def of_arc(degrees: float, radius_mm: float) -> Array:
    """An arc about (0, 0), over its highest place, a step from place to place."""
    half = 0.5 * math.radians(degrees)
    angles = np.linspace(-half, half, round(2 * half * radius_mm / STEP_MM))
    return radius_mm * np.column_stack([np.sin(angles), np.cos(angles)])


@pytest.mark.parametrize(("degrees", "um_per_mm"), [(60, 0.1), (120, 2.0)])
def test_from_the_legs_of_an_arc_the_way_is_the_arc(degrees: float, um_per_mm: float) -> None:
    """But for so much of its radius; whatever the head did between its legs."""
    true = of_arc(degrees, 8.0)
    strayed = true.copy()
    middle = slice(len(true) // 3, -(len(true) // 3))
    strayed[middle] += (0.0, 0.3)
    both = smooth_ways(strayed, true, LEG, WIDTH_MM, lambda *_: 0.0, may_exchange=False)
    leg = round(LEG / STEP_WIDTHS)
    for way in (both.one.way, both.other.way):
        assert np.array_equal(way[[0, -1]], true[[leg, -leg - 1]])
        assert np.abs(np.hypot(*way.T) - 8.0).max() < um_per_mm * 8.0 * UM


def test_each_leg_goes_on_to_the_one_that_leaves_less() -> None:
    """Two lines that cross at 6 degrees; the head has gone over from each to the other."""
    x = np.arange(-8.0, 8.0, STEP_MM)
    slope = math.tan(math.radians(3))
    up, down = np.column_stack([x, slope * x]), np.column_stack([x, -slope * x])
    one, other = np.where(x[:, None] < 0, (up, down), (down, up))

    def left(first: Array, second: Array) -> float:
        off_mm = (first, slope), (second, -slope)
        return sum(float(np.abs(way[:, 1] - rise * way[:, 0]).max()) for way, rise in off_mm)

    both = smooth_ways(one, other, LEG, WIDTH_MM, left, may_exchange=True)
    assert both.is_exchanged and both.left < UM
    own = smooth_ways(one, other, LEG, WIDTH_MM, left, may_exchange=False)
    assert not own.is_exchanged and own.left > 100 * UM
