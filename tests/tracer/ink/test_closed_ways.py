"""Closed ways: which lines at a junction are one pen's."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.chains import Junction, Side
from morfax.tracer.ink.closed_ways import _are_of_two_pens
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.sensing.leg import Leg


@pytest.mark.parametrize(
    ("widths_mm", "are_two"),
    [
        ((0.27, 0.42, 0.28, 0.41), True),  # a thin line through a thick one
        ((0.27, 0.30, 0.28, 0.29), False),
        ((0.5, 0.8, 0.5), False),  # where two lines become one ink
    ],
)
def test_lines_of_two_pens_are_told_from_ink_that_two_lines_share(
    widths_mm: tuple[float, ...], are_two: bool
) -> None:
    sides = [Side(n, False) for n in range(len(widths_mm))]
    legs = [
        Leg(np.zeros(2), float(n), 0.0, mm, np.empty((0, 3))) for n, mm in enumerate(widths_mm)
    ]
    there = Junction(sides, False, Crossing(legs, [], Settings()))
    assert _are_of_two_pens(there, sides[0], sides[1]) == are_two
    assert not _are_of_two_pens(there, sides[0], sides[2])
