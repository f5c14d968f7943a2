"""Straight on where a line has lost ink: how long it is blank, and whether it is clean but for a speck."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.units import MM_PER_INCH
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.planner import Planner
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import DPI, WIDTH_MM, inked, polyline

PIXEL_MM = MM_PER_INCH / DPI
ENDS_MM = 12.0


def before_a_gap(gap_mm: float) -> tuple[Planner, Leg, Leg]:
    """A head that comes along y = 10 mm, and the legs to either side of a gap from x = 12 mm on."""
    over_mm = ENDS_MM + gap_mm + WIDTH_MM  # ends are round
    drawn = inked(polyline((4, 10), (ENDS_MM, 10)), polyline((over_mm, 10), (24, 10)))
    view = View(behind_aperture(drawn, 0.15), WIDTH_MM)
    incoming = leg_of(view.feel(np.array([6.0, 10.0]), 0.0, 5.0), True, view.leg_mm)
    outgoing = leg_of(view.feel(np.array([over_mm, 10.0]), 0.0, 5.0), False, view.leg_mm)
    trail = Trail(incoming.end_mm, view.step_mm)
    stands = incoming.end_mm, incoming.heading_rad
    return Planner(view, stands, trail, Settings()), incoming, outgoing


@pytest.mark.parametrize("gap_mm", [0.3, 0.6, 1.2])
def test_a_line_is_blank_for_as_long_as_its_gap_is(gap_mm: float) -> None:
    """The cell sees ink from a pixel and its own radius before the gap's end on."""
    planner, incoming, outgoing = before_a_gap(gap_mm)
    blank_mm = planner._blank_mm(incoming, outgoing)
    assert gap_mm - 1.5 * PIXEL_MM < blank_mm <= gap_mm


def test_a_line_without_a_gap_is_nowhere_blank() -> None:
    planner, incoming, outgoing = before_a_gap(-WIDTH_MM)
    assert planner._blank_mm(incoming, outgoing) == 0.0


@pytest.mark.parametrize(("gap_mm", "is_clean"), [(-WIDTH_MM, True), (3 * PIXEL_MM, False)])
def test_a_line_that_is_gone_for_three_pixels_is_not_clean_but_for_a_speck(
    gap_mm: float, is_clean: bool
) -> None:
    planner, incoming, outgoing = before_a_gap(gap_mm)
    plan = planner.through(incoming, outgoing, None)
    assert (planner._past_speck(plan, incoming, outgoing) is not None) is is_clean
