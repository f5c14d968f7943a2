"""What is left of a patch's ink: its places beside which no way has come, by their length."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.program.against_ink.left_ink import LeftInk

WIDTH_MM, LONG_MM = 0.5, 20.0


def line(y_mm: float, first_mm: float, last_mm: float) -> Array:
    x = np.arange(first_mm, last_mm - 0.05, 0.1)
    return np.column_stack([x, np.full(len(x), y_mm)])


def ink() -> LeftInk:
    """A line of 20 mm, whose left half has two middle places abreast, as a line along the rows."""
    abreast = line(0.05, 0.0, LONG_MM / 2)
    middles = np.vstack([line(0.0, 0.0, LONG_MM), abreast])
    stroke = Stroke(LONG_MM, WIDTH_MM, middles, np.arange(len(middles), dtype=float), 0)
    return LeftInk(stroke, 1.5 * WIDTH_MM)


def test_ink_far_from_all_ways_is_left_with_what_is_filled_about_it() -> None:
    some = ink()
    assert some.left().length_mm == pytest.approx(LONG_MM)
    some.pass_by(line(0.3, 0.0, 5.0))
    some.pass_by(line(-0.3, 15.0, LONG_MM))
    left = some.left()
    # the ways reach three quarters of a millimetre beside them, aslant: 0.69 mm further on
    x = left.middles_mm[:, 0]
    assert (x.min(), x.max()) == pytest.approx((5.6, 14.3), abs=0.11)
    assert np.array_equal(left.middles_mm, some.stroke.middles_mm[left.filled.astype(int)])


def test_places_abreast_count_for_one() -> None:
    """Not the two thirds of the length that its places are; those at an end count for a little more."""
    some = ink()
    some.pass_by(line(0.0, LONG_MM / 2, LONG_MM))
    assert some.left().length_mm == pytest.approx(LONG_MM / 2 - 0.75, abs=0.6)


def test_others_may_have_come_by_that_are_not_taken_in() -> None:
    some, others = ink(), ink()
    some.pass_by(line(0.0, 0.0, 10.0))
    others.pass_by(line(0.0, 10.0, LONG_MM))
    assert some.left(others.away_mm).length_mm == 0
    assert len(some.left(others.away_mm).middles_mm) == 0
    assert some.left().length_mm > 8.0  # mm: the others are not kept
