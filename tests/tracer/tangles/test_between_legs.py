"""A tangle between legs that are known: its ink, and when it is none."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.plane import direction
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.between_legs import tangle_between
from tests.tracer.inked import DPI, WIDTH_MM, Points, inked, polyline

MIDDLE = np.array([15.0, 15.0])
REACH_MM = 1.5  # from the middle to the legs' clean ends
CROSS = polyline((5, 15), (25, 15)), polyline((15, 5), (15, 25))


def _leg(come_rad: float) -> Leg:
    """A leg that comes in to the middle along a heading."""
    end_mm = MIDDLE - REACH_MM * direction(come_rad)
    return Leg(end_mm, come_rad, 0.0, WIDTH_MM, np.empty((0, 3)))


def _view(*lines: Points) -> View:
    """How the head sees some lines."""
    return View(photocell.behind_aperture(inked(*lines, seed=1), 0.1), WIDTH_MM)


LEGS = [_leg(0.5 * math.pi * quarter) for quarter in range(4)]


def test_its_ink_is_that_between_the_clean_ends() -> None:
    """Of two lines that cross: the first comes in, and the others lead out."""
    tangle = tangle_between(_view(*CROSS), LEGS)
    assert tangle is not None and tangle.whole
    inked_mm = tangle.places_mm[tangle.darkness > 0.5] - MIDDLE
    pixel_mm = 25.4 / DPI
    assert np.abs(inked_mm).max() < REACH_MM + pixel_mm
    assert np.abs(inked_mm).max() > REACH_MM - pixel_mm
    outward = [direction(leg.heading_rad) @ (leg.end_mm - MIDDLE) for leg in tangle.legs]
    assert outward[0] < 0 and min(outward[1:]) > 0


def test_ink_that_leads_on_elsewhere_is_no_tangle_of_these_legs() -> None:
    """A fifth line leaves between them."""
    fifth = polyline((15, 15), (22, 22))
    assert tangle_between(_view(*CROSS, fifth), LEGS) is None


def test_legs_that_do_not_hang_together_have_none() -> None:
    """The one line stops before the other."""
    lines = CROSS[0], polyline((15, 5), (15, 13.8)), polyline((15, 16.2), (15, 25))
    assert tangle_between(_view(*lines), LEGS) is None
