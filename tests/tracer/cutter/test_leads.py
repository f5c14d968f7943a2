"""Leads: their shapes in closed form, and where the scrap holds one."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.offset import DriveCurve
from morfax.motion.polyline import APART_MM, Nearest, lengths_mm, with_places
from morfax.tracer.cutter.contouring import Lead
from morfax.tracer.cutter.leads import Scrap, depth_mm, shaped
from tests.tracer.inked import UM

RIGHT, DOWN = np.array([1.0, 0.0]), np.array([0.0, -1.0])
PLACE = np.array([10.0, 0.0])
ARC, STRAIGHT = Lead(3.0), Lead(3.0, "line")


@pytest.mark.parametrize("size_mm", [0.2, 3.0, 20.0])
def test_an_arc_is_a_quarter_of_a_circle_that_touches_the_path(size_mm: float) -> None:
    made = shaped(PLACE, RIGHT, DOWN, ARC, size_mm)
    centre = PLACE + size_mm * DOWN
    assert np.hypot(*(made - centre).T) == pytest.approx(size_mm, abs=1e-9)
    assert made[0] == pytest.approx(PLACE) and made[-1] == pytest.approx(
        PLACE + size_mm * (RIGHT + DOWN)
    )
    # between two places the chord is off the circle by s²/8r: 0.3 um at 0.2 mm
    steps_mm = np.diff(lengths_mm(made))
    assert steps_mm.max() < 1.01 * max(APART_MM, size_mm * math.pi / 16)
    assert steps_mm.max() ** 2 / (8 * size_mm) < 1 * UM
    begins = made[1] - made[0]
    assert math.atan2(-begins[1], begins[0]) == pytest.approx(
        0.5 * math.pi / 2 / (len(made) - 1)
    )


def test_a_straight_lead_leaves_at_45_degrees() -> None:
    made = shaped(PLACE, RIGHT, DOWN, STRAIGHT, 3.0)
    assert made[0] == pytest.approx(PLACE)
    assert made[-1] - PLACE == pytest.approx(3.0 * math.sqrt(0.5) * (RIGHT + DOWN))
    assert np.diff(lengths_mm(made)).max() < 1.01 * APART_MM


@pytest.mark.parametrize("lead", [ARC, STRAIGHT])
def test_a_lead_begins_as_deep_as_its_last_place_is_off_the_path(lead: Lead) -> None:
    made = shaped(PLACE, RIGHT, DOWN, lead, lead.size_mm)
    assert depth_mm(lead, lead.size_mm) == pytest.approx(-made[-1, 1])


def box(left: float, low: float, right: float, high: float) -> Array:
    """A rectangle, counter-clockwise, its first corner not repeated."""
    return np.array([[left, low], [right, low], [right, high], [left, high]])


PART = box(-20, 0, 40, 30)  # its lower side runs along y = 0, the scrap is below it


def held(lead: Lead, *others: Array, own: Array = PART, inside: bool = False) -> bool:
    """Whether the scrap below a part holds a lead that leaves at (10, 0), without a cutter."""
    curves = [DriveCurve(line, True, True) for line in (own, *others)]
    made = shaped(PLACE, RIGHT, DOWN, lead, lead.size_mm)
    path = with_places(np.vstack([own, own[:1]]), APART_MM)
    return Scrap(curves).holds(made, path, 0, depth_mm(lead, lead.size_mm), inside)


def test_without_a_cutter_a_lead_stays_a_quarter_of_a_millimetre_off_other_lines() -> None:
    """A straight lead of 3 mm passes (11.06, -1.06); another part's corner is aside of that."""
    aside = math.sqrt(0.5) * np.array([1.0, 1.0])  # square to the lead
    middle = PLACE + 1.5 * math.sqrt(0.5) * (RIGHT + DOWN)
    for away_mm, is_held in ((0.2, False), (0.3, True)):
        x, y = middle - away_mm * aside
        tip = np.array([[x, y], [x - 3, y - 1], [x - 1, y - 3]])
        assert held(STRAIGHT, tip) == is_held
    assert held(ARC) and held(STRAIGHT)


@pytest.mark.parametrize(("away_mm", "is_held"), [(1.49, False), (1.51, True)])
def test_the_tool_goes_down_half_the_depth_off_every_cut(away_mm: float, is_held: bool) -> None:
    """An arc of 3 mm ends 3 mm deep, at (13, -3)."""
    low = -3 - away_mm
    assert held(ARC, box(0, low - 5, 40, low)) == is_held


def test_a_lead_on_the_wrong_side_of_its_own_line_is_not_held() -> None:
    assert not held(ARC, inside=True)
    hole = box(-20, -30, 40, 0)  # its upper side runs along y = 0, the scrap is within
    assert held(ARC, own=hole, inside=True) and not held(ARC, own=hole)


@pytest.mark.parametrize(("thin_mm", "is_held"), [(0.3, False), (0.0, True)])
def test_a_lead_does_not_cross_a_tongue_of_its_own_part(thin_mm: float, is_held: bool) -> None:
    """The tongue hangs down before the lead, which would end in the scrap beyond it."""
    tongue = [[11.0, 0.0], [11.0, -20.0], [11.0 + thin_mm, -20.0], [11.0 + thin_mm, 0.0]]
    own = np.array(
        [[-20.0, 0.0], *(tongue if thin_mm else []), [40.0, 0.0], [40.0, 30.0], [-20.0, 30.0]]
    )
    assert held(ARC, own=own) == is_held


@pytest.mark.parametrize(
    ("below_mm", "is_held"),
    [(5.5, True), (5.4, False)],  # at its end the tool is 1 + 1.5 mm off: 3 mm of arc, and 2.5
)
def test_a_cutter_goes_down_its_radius_and_half_the_depth_off_every_line(
    below_mm: float, is_held: bool
) -> None:
    other = box(0, -below_mm - 5.001, 40, -below_mm - 0.001)
    lines = [np.vstack([line, line[:1]]) for line in (box(-20, 1, 40, 30), other)]
    scrap = Scrap([], 1.0, Nearest(lines, 1.0))
    made = shaped(PLACE, RIGHT, DOWN, ARC, 3.0)
    assert scrap.holds(made, made, 0, 3.0, False) == is_held


@pytest.mark.parametrize(("aside_mm", "is_held"), [(1.0, True), (0.99, False)])
def test_a_cutter_comes_no_nearer_to_a_line_on_its_lead_than_its_radius(
    aside_mm: float, is_held: bool
) -> None:
    """A corner stands below the middle of a straight lead of 3 mm."""
    middle = PLACE + 1.5 * math.sqrt(0.5) * (RIGHT + DOWN)
    x, y = middle - aside_mm * math.sqrt(0.5) * np.array([1.0, 1.0])
    corner = np.array([[x - 3, y - 1], [x, y], [x - 1, y - 3]])
    scrap = Scrap([], 1.0, Nearest([corner], 1.0))
    made = shaped(PLACE, RIGHT, DOWN, STRAIGHT, 3.0)
    assert scrap.holds(made, made, 0, 0.5, False) == is_held
