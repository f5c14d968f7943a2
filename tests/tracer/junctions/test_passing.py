"""Lines that pass at a junction: two legs are one line if they lie on one, and are left to it then."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.plane import direction, left_of
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.choice import STRAIGHTEST, WayIn, _Survey
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.edge_following import Walk, _along_edge, to_vertex
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, inked, polyline

WIDTH_MM = 0.5
CLEAR_MM = 0.6  # from the middle of a junction to where a leg is clean
PASSES = math.radians(60)


def _comes_in() -> tuple[View, Leg]:
    """A line along Y = 10 mm to x = 16 mm, and the leg at x = 14 mm."""
    view = View(behind_aperture(inked(polyline((4, 10), (16, 10))), 0.15), WIDTH_MM)
    return view, leg_of(view.feel(np.array([10.0, 10.0]), 0.0, 4.0), True, view.leg_mm)


@pytest.mark.parametrize(
    ("aside_widths", "bent_deg", "passes"),
    [
        (0.0, 0.0, True),
        (0.3, 0.0, True),
        (0.4, 0.0, False),
        (0.0, 13.0, True),
        (0.0, 15.0, False),
    ],
)
def test_two_legs_pass_if_they_are_on_one_line(
    aside_widths: float, bent_deg: float, passes: bool
) -> None:
    """A pen put down anew goes on up to a third of its width beside the line, and 14 degrees off it."""
    view, incoming = _comes_in()
    aside_mm = aside_widths * WIDTH_MM * left_of(direction(PASSES))
    middle = np.array([16.0, 10.0])
    back = PASSES + math.pi + math.radians(bent_deg)
    one, other, own = (
        replace(incoming, end_mm=middle + off + CLEAR_MM * direction(way), heading_rad=way)
        for way, off in ((PASSES, aside_mm), (back, 0.0), (math.radians(100), 0.0))
    )
    survey = _Survey(WayIn(view, incoming, Trail(incoming.end_mm, view.step_mm)), STRAIGHTEST)
    left = survey._without_passing([one, other, own], [one, other, own])
    assert [leg is own for leg in left] == ([True] if passes else [False, False, True])


def test_a_tip_ends_where_its_ink_does_though_its_legs_meet_far_beyond() -> None:
    """Legs nearly in line meet 5 mm ahead; the pen turned on the middle of its last ink, 2 mm ahead."""
    view, incoming = _comes_in()
    outgoing = replace(incoming.turned_round(), heading_rad=math.radians(175))
    tip = to_vertex(view, Corner(incoming, outgoing, beyond_mm=5.0, before_mm=5.2))
    # 20 um: a round end of 0.25 mm radius through a cell of 0.15 mm, r²/4R off, and the softness of the scan
    assert tip.beyond_mm == pytest.approx(16.0 - incoming.end_mm[0], abs=20 * UM)
    assert tip.before_mm - tip.beyond_mm == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("right_deg", "left_deg", "taken_deg"), [(-80.0, 95.0, 95.0), (-70.0, 100.0, -70.0)]
)
def test_square_to_another_line_the_head_turns_left_and_else_to_the_straighter_leg(
    right_deg: float, left_deg: float, taken_deg: float
) -> None:
    """Square is within 20 degrees of it, by both legs together."""
    view, incoming = _comes_in()
    middle = np.array([16.0, 10.0])
    legs = [
        replace(
            incoming,
            end_mm=middle + CLEAR_MM * direction(math.radians(deg)),
            heading_rad=math.radians(deg),
        )
        for deg in (right_deg, left_deg)
    ]
    survey = _Survey(WayIn(view, incoming, Trail(incoming.end_mm, view.step_mm)), STRAIGHTEST)
    taken = survey._chosen(legs, legs)
    assert math.degrees(taken.heading_rad) == pytest.approx(taken_deg)


def test_a_mark_is_no_way_on_where_a_line_leads_on() -> None:
    """The line turns up at x = 16 mm; a tick of 2 mm goes down from there."""
    lines = polyline((4, 10), (16, 10), (16, 22)), polyline((16, 10), (16, 8))
    view = View(behind_aperture(inked(*lines), 0.15), WIDTH_MM)
    incoming = leg_of(view.feel(np.array([10.0, 10.0]), 0.0, 4.0), True, view.leg_mm)
    up, down = (
        replace(
            incoming,
            end_mm=np.array([16.0, 10 + way * CLEAR_MM]),
            heading_rad=way * math.pi / 2,
        )
        for way in (1, -1)
    )
    survey = _Survey(WayIn(view, incoming, Trail(incoming.end_mm, view.step_mm)), STRAIGHTEST)
    (kept,) = survey._without_marks([up, down])
    assert kept is up
    assert survey._without_marks([down]) == [down]  # better than none


def test_past_ink_beside_it_an_edge_is_left_as_soon_as_the_line_is_by_itself() -> None:
    """Ink lies below the line from 9 to 10 mm; it is felt along its upper edge, in steps of 0.05 mm."""
    beside = polyline((9.0, 9.6), (10.0, 9.6))
    view = View(behind_aperture(inked(polyline((4, 10), (24, 10)), beside), 0.15), WIDTH_MM)
    walk = Walk(0.05, stations=400, regained=10)
    felt = _along_edge(view.cells, (8.3, 10.0, 0.0), 1.0, WIDTH_MM, walk)
    wide = np.flatnonzero(~(felt[:, 2] < 0.62 * WIDTH_MM))
    assert len(wide) and len(felt) - 1 - wide[-1] == 11  # one more than ten
    assert 10.0 < felt[-1, 0] < 11.2
