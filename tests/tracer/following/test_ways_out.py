"""Ways out: where a junction is a dot on the line, the line goes straight on through it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.following.ways_out import leads_to_dot
from morfax.tracer.marks.dots import dot_ahead
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View
from tests.tracer.inked import dot, inked, polyline

MIDDLE_MM = 15.0
BESIDE_MM = 2.5  # of the middle, a leg ends: beside the largest dot


@pytest.mark.parametrize("across_mm", [None, 1.2, 1.6])
def test_a_dot_between_two_legs_explains_the_ink(across_mm: float | None) -> None:
    """Without that the path along two of eight closed lines with dots was 2 mm longer, and further off."""
    specks = [] if across_mm is None else [dot((MIDDLE_MM, 5.0), across_mm)]
    drawing = inked(polyline((3, 5), (27, 5)), specks=specks, seed=4)
    view = View(Cells(drawing.darkness, drawing.pitch_mm, 0.5), 0.5)
    incoming, outgoing = (
        _leg(view, MIDDLE_MM - BESIDE_MM, ends=True),
        _leg(view, MIDDLE_MM + BESIDE_MM),
    )
    assert not dot_ahead(view, outgoing)
    assert leads_to_dot(view, incoming, outgoing) is (across_mm is not None)
    assert not leads_to_dot(view, incoming, None)


def _leg(view: View, x_mm: float, *, ends: bool = False) -> Leg:
    """The leg of 3 mm that ends, or begins, at a place of the line."""
    begin_mm = x_mm - 3.0 if ends else x_mm
    return leg_of(view.feel(np.array([begin_mm, 5.0]), 0.0, 3.0), ends, view.leg_mm)
