"""The carriage: courses, swivels and what it is set to on a leg, against geometry and the clock."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import APART_MM
from morfax.tracer.head import slow_cell, swinging
from morfax.tracer.head.carriage import SETTLE_LAGS, Carriage
from morfax.tracer.head.course import ONTO_MM, along_leg, onto
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.slow_cell import TunedPiece
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Home, at_rest
from morfax.tracer.head.tuning import LEAD_SWEEPS, tune
from morfax.tracer.head.watched import watching
from morfax.tracer.head.windows import bends_rad, lead_mm
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.photocell import LEVEL, Cells, behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

PLACE = np.array([12.0, 8.0])
NO_STATIONS = np.empty((0, 3))
NEVER_HOME = Home(0.0, 0.0, 0.0, 1e9)


@pytest.fixture(scope="module")
def seen() -> View:
    """A straight line along y = 8 mm."""
    return View(behind_aperture(inked(polyline((4, 8), (24, 8))), 0.15), WIDTH_MM)


def carriage(seen: View) -> Carriage:
    """A head that stands on the line."""
    return Carriage(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)


def line(*points: tuple[float, float]) -> Array:
    """A course from the head's place by some steps, in places 0.02 mm apart."""
    corners = PLACE + np.array(points)
    along = [
        np.linspace(a, b, max(2, int(math.dist(a, b) / 0.02))) for a, b in pairwise(corners)
    ]
    return np.vstack(along)


class Heard:
    """A watcher that keeps the head's words."""

    def __init__(self) -> None:
        self.words = list[str]()

    def put_down(self, carriage: Any) -> None:
        pass

    def moved(self, carriage: Any, positions: Array) -> None:
        pass

    def says(self, what: str) -> None:
        self.words.append(what)


@pytest.mark.parametrize("deflection_deg", [90.0, -120.0, 180.0])
def test_between_two_stretches_the_head_stands_and_turns_to_the_second(
    seen: View, deflection_deg: float
) -> None:
    """It stands for the lags of its drives and for the swivel's time, and whoever watches is told."""
    a = math.radians(deflection_deg)
    heard = Heard()
    with watching(heard):
        head = carriage(seen)
        head.run([line((0, 0), (1, 0)), line((1, 0), (1 + math.cos(a), math.sin(a)))])
    path = head.positions_mm
    corner = PLACE + np.array([1, 0])
    stands = np.count_nonzero(np.hypot(*(path - corner).T) < 1 * UM)
    settings = head.settings
    time_s = SETTLE_LAGS * settings.drive.lag_s + abs(a) / settings.swivel_rad_s
    # it comes within 1 um of the corner, and leaves it, in 5 ms of braking and starting at 500 mm/s2
    assert stands / MOTION_RATE_HZ == pytest.approx(time_s, abs=0.01)
    assert heard.words == ["turning at a corner"]
    assert math.remainder(head.heading_rad - a, math.tau) == pytest.approx(0.0, abs=1e-9)
    assert path[-1] == pytest.approx(corner + np.array([math.cos(a), math.sin(a)]), abs=1 * UM)


@pytest.mark.parametrize("length_mm", [0.002, 0.02, 0.3, 3.0])
def test_a_course_of_any_length_is_run_to_its_end(seen: View, length_mm: float) -> None:
    head = carriage(seen)
    head.run([line((0, 0), (0, length_mm))])
    assert head.positions_mm[-1] == pytest.approx(PLACE + np.array([0, length_mm]), abs=1 * UM)
    assert head.travel_mm == pytest.approx(length_mm, abs=1 * UM)


def test_a_head_that_is_set_to_follow_begins_its_sweep_anew(seen: View) -> None:
    head = carriage(seen)
    for name, value in (
        ("first_sum", 3.0),
        ("mean_sum", 5.0),
        ("sweep_periods", 7),
        ("ink", 0.4),
    ):
        setattr(head.state, name, value)
    head.aim(seen, Leg(PLACE, 0.3, 0.1, WIDTH_MM, NO_STATIONS))
    state = head.state
    assert (state.first_sum, state.mean_sum, state.sweep_periods) == (0.0, 0.0, 0)
    assert (state.ink, state.swept_ink, state.guard_ahead) == (1.0, 1.0, 1.0)
    # it steers for the leg's own place
    point = head.tuning.point_mm
    told = Leg(PLACE, 0.3, 0.1, WIDTH_MM, NO_STATIONS).at(point)
    assert (state.point_x_mm, state.point_y_mm) == pytest.approx(tuple(told), abs=1e-9)


def test_a_head_that_is_tuned_anew_takes_the_ink_as_it_is_there(seen: View) -> None:
    head = carriage(seen)
    head.state.ink = 0.4
    head.retune(seen)
    assert head.state.ink == 1.0


# courses


@pytest.mark.parametrize("before_mm", [1.0, ONTO_MM, 0.1, -0.3])
@pytest.mark.parametrize("limit_mm", [5.0, 0.15])
def test_the_way_onto_a_leg_s_line_is_long_enough_and_ends_before_its_limit(
    before_mm: float, limit_mm: float
) -> None:
    """At the leg's clean end, or 0.2 mm on, or half the way to the limit."""
    leg = Leg(PLACE, 0.5, 0.1, WIDTH_MM, NO_STATIONS)
    t = np.array([math.cos(0.5), math.sin(0.5)])
    way, along = onto(PLACE - before_mm * t, 0.5, leg, limit_mm)
    if before_mm > ONTO_MM:
        assert along == 0.0
    else:
        room_mm = limit_mm - before_mm
        assert along == pytest.approx(min(ONTO_MM - before_mm, 0.5 * room_mm, limit_mm))
    assert along <= limit_mm
    assert way[-1] == pytest.approx(leg.at(along), abs=1e-9)


@pytest.mark.parametrize("length_mm", [0.001, 0.5, 2.0])
def test_places_on_a_leg_are_as_far_apart_as_on_a_curve_at_the_most(length_mm: float) -> None:
    leg = Leg(PLACE, 0.5, 0.0, WIDTH_MM, NO_STATIONS)
    for start_mm, end_mm in ((-0.3, length_mm - 0.3), (length_mm, 0.0)):
        places = along_leg(leg, start_mm, end_mm)
        steps = np.hypot(*np.diff(places, axis=0).T)
        assert steps.max() <= APART_MM + 1e-12
        assert len(places) == max(2, math.ceil(length_mm / APART_MM - 1e-9) + 1)


# cells


def test_a_sweep_that_stands_square_looks_across_the_arc_that_touches_its_heading(
    seen: View,
) -> None:
    """On a sheet whose darkness rises evenly each look tells its own place."""
    x, y = np.meshgrid(np.arange(300) + 0.5, 300 - np.arange(300) - 0.5)
    cells = Cells(((0.1 * x + 0.037 * y) * 0.01).astype(np.float32), 0.1, LEVEL)
    head = carriage(seen)
    t, state = head.tuning._replace(square=True), head.state
    state.heading_rad, state.middle_mm = 0.4, 0.2
    lead, heading = state.lead_mm, 0.4
    # the arc from the axis along the heading through the middle of the sweep turns by twice the angle to it
    turned = 2 * math.atan2(0.2, lead)
    before = 0.0
    for k in range(t.sweep_periods):
        swinging.swing(cells, state, t, swinging.way_of(state))
        sine, cosine = t.pin[k]
        across, along = t.amplitude_mm * sine, t.along_mm * cosine
        s, c = math.sin(turned), math.cos(turned)
        ahead, aside = lead + along * c - across * s, 0.2 + across * c + along * s
        at_x = PLACE[0] + ahead * math.cos(heading) - aside * math.sin(heading)
        at_y = PLACE[1] + ahead * math.sin(heading) + aside * math.cos(heading)
        told = t.cell_gain * (0.1 * at_x + 0.037 * at_y) * 0.1
        assert state.mean_sum - before == pytest.approx(told, abs=1e-6)  # float32 darkness
        before = state.mean_sum


@pytest.mark.parametrize(("ink", "followed"), [(0.8, 0.8), (0.1, 0.3), (3.0, 2.0)])
def test_a_sweep_counts_as_a_third_to_twice_of_the_line_s_ink(
    seen: View, ink: float, followed: float
) -> None:
    """By a tenth of the difference; the line's place is told by that ink."""
    head = carriage(seen)
    t, state = head.tuning, head.state
    state.mean_sum, state.first_sum = ink * t.mean * t.sweep_periods, 0.02 * t.sweep_periods / 2
    swinging.detect(state, t)
    assert state.swept_ink == pytest.approx(ink)
    assert state.ink == pytest.approx(1 + 0.1 * (followed - 1))
    assert state.middle_mm == pytest.approx(0.02 / (t.slope_per_mm * state.ink))


def test_on_an_edge_the_sweep_is_balanced_and_the_fundamental_tells_the_ink(seen: View) -> None:
    head = carriage(seen)
    t, state = head.tuning._replace(balance_per_mm=-0.8, mean=0.5), head.state
    state.mean_sum, state.first_sum = 0.54 * t.sweep_periods, -0.3 * t.sweep_periods / 2
    swinging.detect(state, t)
    assert state.swept_ink == pytest.approx(0.3 / 0.5)
    assert state.middle_mm == pytest.approx((0.54 - 0.5) / -0.8)
    assert state.ink == 1.0


@pytest.mark.parametrize("at", [0, 100, -1])
def test_a_leg_comes_back_where_it_is_against_the_trail(seen: View, at: int) -> None:
    """At the trail's beginning, in its course and at its very end."""
    head = carriage(seen)
    head.run([line((0, 0), (6, 0))])
    place = head.positions_mm[at]
    for heading, comes_back in ((0.0, False), (math.pi, True)):
        leg = Leg(place, heading, 0.0, WIDTH_MM, NO_STATIONS)
        assert head.trail.comes_back(leg) == comes_back


@pytest.mark.parametrize(("share", "drawn_in"), [(0.6, True), (1.4, False)])
def test_the_mount_is_drawn_in_at_once_and_slides_out_by_itself(
    seen: View, share: float, drawn_in: bool
) -> None:
    head = carriage(seen)
    head.aim(seen, Leg(PLACE, 0.0, 0.0, WIDTH_MM, NO_STATIONS))
    t, was_mm = head.tuning, head.state.lead_mm
    piece = TunedPiece(0.02, t._replace(lead_mm=share * was_mm))
    went = slow_cell._through(seen.cells, head.state, [piece], NEVER_HOME)
    if drawn_in:
        assert went.state.lead_mm == pytest.approx(share * was_mm)
    else:
        # out by no more than the head has gone
        assert was_mm <= went.state.lead_mm < was_mm + 0.1
    assert head.state.lead_mm == was_mm


def test_how_far_a_place_is_from_a_piece_of_a_way() -> None:
    """Against many places of that piece, 1 um apart."""
    chance = np.random.default_rng(3)
    for _ in range(50):
        way, place = chance.uniform(-1, 1, (3, 2)), chance.uniform(-1, 1, 2)
        piece = way[1] + np.linspace(0, 1, 3000)[:, None] * (way[2] - way[1])
        told = np.hypot(*(piece - place).T).min()
        assert slow_cell._from_piece(place, way, 1) == pytest.approx(told, abs=1 * UM)
    still = np.zeros((2, 2))
    assert slow_cell._from_piece(np.array([3.0, 4.0]), still, 0) == 5.0


def test_the_slow_cell_s_lead_is_half_its_window_the_point_and_its_sweeps(seen: View) -> None:
    t = tune(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)
    sweep_s = t.sweep_periods / MOTION_RATE_HZ
    told = 0.2 + t.point_mm + LEAD_SWEEPS * t.slowed * t.speed_mm_s * sweep_s
    assert lead_mm(t, 0.2) == pytest.approx(told)
    assert lead_mm(t, 5.0) == t.lead_mm
    assert [len(of) for of in bends_rad(line((0, 0), (0.5, 0)), 0.4)] == [0, 0]


def test_on_a_coarse_scan_the_head_s_sizes_are_pixels(seen: View) -> None:
    """Of a line and of an edge, at 0.3 mm a pixel."""
    coarse = seen.cells._replace(pitch_mm=0.3)
    for on_edge, point_px, window_px in ((False, 1.2, 7), (True, 0.6, 2)):
        view = View(coarse, 0.3, on_edge=on_edge)
        t = tune(Stance(PLACE, 0.0, view), Settings(), MOTION_RATE_HZ)
        assert t.point_mm == pytest.approx(max(0.1, point_px * 0.3))
        assert t.half_window_mm == pytest.approx(window_px * 0.3)
        sweeps_mm = LEAD_SWEEPS * 10.0 / 250.0
        assert t.lead_mm == pytest.approx(t.half_window_mm + t.point_mm + sweeps_mm)


def test_the_cell_s_noise_is_normal() -> None:
    """Mean 0 and standard deviation 1 within three standard errors; twelve numbers sum to 6 at most."""
    state = at_rest(PLACE, 0.8)
    hiss = np.array([swinging._hiss(state) for _ in range(5000)])
    assert abs(hiss.mean()) < 3 / math.sqrt(5000)
    assert hiss.std() == pytest.approx(1.0, abs=3 / math.sqrt(2 * 5000))
    assert np.abs(hiss).max() < 6.0
    # each is independent of the one before
    assert abs(np.corrcoef(hiss[1:], hiss[:-1])[0, 1]) < 3 / math.sqrt(5000)
