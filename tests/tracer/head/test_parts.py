"""The parts of the head against their closed forms: fit, sweep, guard cells, home, steering and relay.

Each test calls one kernel on a state made by hand; what they do together is in `test_kernel`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.drive import Drive
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.head import kernel, screws, swinging
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import CHANGED, JUNCTION, MORE, TIGHT, Home, Tuning, at_rest
from morfax.tracer.head.tuning import tune
from morfax.tracer.sensing.leg import leg_of
from morfax.tracer.sensing.photocell import LEVEL, Cells, behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, inked, polyline

PLACE = np.array([12.0, 8.0])
SPEED_MM_S = Settings().speed_mm_s
LEAD_MM = 0.85  # of the precise head on a line of 0.5 mm at 300 dpi


@pytest.fixture(scope="module")
def seen() -> View:
    """A straight line along y = 8 mm."""
    cells = behind_aperture(inked(polyline((4, 8), (24, 8))), 0.15)
    return View(cells, 0.5)


@pytest.fixture(scope="module")
def tuning(seen: View) -> Tuning:
    """The precise head's, on that line."""
    return tune(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)


def moving(heading: float = 0.0) -> Any:
    """A head that moves along a heading at its speed, on its line."""
    state = at_rest(PLACE, LEAD_MM)
    state.heading_rad, state.speed_mm_s, state.guard_ahead = heading, SPEED_MM_S, 1.0
    state.vx_mm_s, state.vy_mm_s = (
        SPEED_MM_S * math.cos(heading),
        SPEED_MM_S * math.sin(heading),
    )
    return state


def remembered(state: Any, along_mm: Array, aside_mm: Array) -> None:
    """Put places on the drum, along and to the left of the head's heading."""
    c, s = math.cos(state.heading_rad), math.sin(state.heading_rad)
    places = np.column_stack([along_mm * c - aside_mm * s, along_mm * s + aside_mm * c]) + PLACE
    state.drum_mm[: len(places)] = places
    state.places = len(places)


def white(darkness: float = 0.0) -> Cells:
    """A sheet of one darkness."""
    return Cells(np.full((300, 300), darkness, np.float32), 0.1, LEVEL)


# the fit


@pytest.mark.parametrize("heading", [0.0, 0.7, 2.5])
@pytest.mark.parametrize("slope", [0.0, 0.3])
@pytest.mark.parametrize("bend_per_mm", [-0.4, 0.0, 0.3])
def test_the_fit_finds_a_parabola_s_place_and_bend(
    tuning: Tuning, heading: float, slope: float, bend_per_mm: float
) -> None:
    """Aside = 0.02 + slope·x + bend/2·x² about the point: its bend there is bend/(1 + slope²)^1.5."""
    state = moving(heading)
    along = np.arange(-1.0, 1.5, 0.04)
    x = along - tuning.point_mm
    remembered(state, along, 0.02 + slope * x + 0.5 * bend_per_mm * x * x)
    kernel._fit(state, tuning)
    point = np.array([state.point_x_mm, state.point_y_mm]) - PLACE
    c, s = math.cos(heading), math.sin(heading)
    assert point @ [c, s] == pytest.approx(tuning.point_mm, abs=1e-6 * UM)
    assert point @ [-s, c] == pytest.approx(0.02, abs=1e-6 * UM)
    bend = bend_per_mm / (1 + slope * slope) ** 1.5
    assert state.bend_per_mm == pytest.approx(bend, abs=1e-9)


def test_places_count_the_less_the_nearer_they_are_to_the_window_s_ends(tuning: Tuning) -> None:
    """The weights 1 - (x/h)², against numpy's weighted fit on places that are no parabola."""
    state, half = moving(), tuning.half_window_mm
    along = np.arange(-1.0, 1.5, 0.04)
    aside = 0.1 * np.sin(3 * along)
    remembered(state, along, aside)
    kernel._fit(state, tuning)
    x = along - tuning.point_mm
    near = np.abs(x) < half
    weights = np.sqrt(1 - (x[near] / half) ** 2)
    p2, p1, p0 = np.polyfit(x[near], aside[near], 2, w=weights)
    assert state.point_y_mm - PLACE[1] == pytest.approx(p0, abs=1e-6 * UM)
    assert state.bend_per_mm == pytest.approx(2 * p2 / (1 + p1 * p1) ** 1.5, abs=1e-9)


def test_a_few_places_behind_the_point_tell_a_parabola(tuning: Tuning) -> None:
    """Six in a fifth of a millimetre, half a millimetre behind: seen from the point they differ little."""
    state = moving()
    x = np.linspace(-0.6, -0.4, 6)
    remembered(state, x + tuning.point_mm, 0.01 + 0.15 * x * x)
    kernel._fit(state, tuning)
    assert state.point_y_mm - PLACE[1] == pytest.approx(0.01, abs=1e-3 * UM)
    assert state.bend_per_mm == pytest.approx(0.3, abs=1e-5)


def test_two_places_tell_no_parabola(tuning: Tuning) -> None:
    state = moving()
    state.bend_per_mm = 0.123
    remembered(state, np.array([0.0, 0.04]), np.array([0.0, 0.01]))
    kernel._fit(state, tuning)
    assert state.bend_per_mm == 0.123


# the sweep


def swept(state: Any, seen: View, tuning: Tuning) -> None:
    """One whole sweep of a head that stands."""
    for _ in range(tuning.sweep_periods):
        swinging.swing(seen.cells, state, tuning, swinging.way_of(state))
    swinging.detect(state, tuning)


@pytest.mark.parametrize("off_mm", [-0.04, 0.02, 0.05])
def test_a_sweep_finds_how_far_aside_the_line_is_and_is_centred_on_it(
    seen: View, tuning: Tuning, off_mm: float
) -> None:
    state = moving()
    state.y_mm -= off_mm
    swept(state, seen, tuning)
    # 5 um off, as pixels are along the line, and straight so near to its middle
    assert state.middle_mm == pytest.approx(off_mm, abs=6 * UM)
    assert state.drum_mm[0] == pytest.approx(PLACE + np.array([tuning.lead_mm, 0]), abs=6 * UM)
    assert (state.places, state.sweep_periods) == (1, 0)


def test_a_line_beyond_half_the_amplitude_goes_onto_no_drum(seen: View, tuning: Tuning) -> None:
    """All ink to the left, and a detector of little slope: the line seems to be 0.3 mm aside."""
    flat = tuning._replace(slope_per_mm=2.0)
    state, left = moving(), white()
    left.darkness[: round(300 - 8 / 0.1)] = 1.0
    swept(state, replace(seen, cells=left), flat)
    assert state.places == 0
    assert state.middle_mm == pytest.approx(0.5 * tuning.amplitude_mm)  # it is sought there


def test_a_turning_head_puts_places_where_its_cell_was_in_the_middle_of_the_sweep(
    seen: View, tuning: Tuning
) -> None:
    state, turn_rad_s = moving(), 2.0
    state.turn_rad_s = turn_rad_s
    half = tuning.sweep_periods // 2
    for k in range(tuning.sweep_periods):
        if k in (half - 1, half):
            state.x_mm += (
                1.0  # the axis leaps before and after the middle: its place between counts
            )
        swinging.swing(white(0.5), state, tuning, swinging.way_of(state))
    swinging.detect(state, tuning)
    was = -turn_rad_s * half * tuning.period_s
    place = (
        PLACE + np.array([1.0, 0.0]) + tuning.lead_mm * np.array([math.cos(was), math.sin(was)])
    )
    aside = state.middle_mm * np.array([-math.sin(was), math.cos(was)])
    assert state.drum_mm[0] == pytest.approx(place + aside, abs=1e-6 * UM)


def test_the_ink_follows_a_tenth_of_what_a_sweep_saw_more_or_less(tuning: Tuning) -> None:
    for darkness, ink in (
        (0.5, 0.5 / tuning.mean),
        (0.0, 0.3),
        (1.0, min(1 / tuning.mean, 2.0)),
    ):
        state = moving()
        for _ in range(tuning.sweep_periods):
            swinging.swing(white(darkness), state, tuning, swinging.way_of(state))
        swinging.detect(state, tuning)
        assert state.ink == pytest.approx(1 + 0.1 * (ink - 1), abs=1e-6)


# what the other cells see


def looked(darkness: float, state: Any, tuning: Tuning) -> int:
    """Why the head stops, with all cells over one darkness."""
    return int(kernel._look(white(darkness), state, tuning))


def test_ink_beside_the_line_is_a_junction_from_two_fifths_on(tuning: Tuning) -> None:
    """A guard cell follows what it sees by half, sweep by sweep."""
    for before, why in ((0.27, MORE), (0.29, JUNCTION)):
        for name in ("guard_left", "guard_right"):
            state = moving()
            state[name] = before  # half of it, and of the ink now, which is 0.52
            assert looked(0.52, state, tuning) == why, (name, before)
            assert state[name] == pytest.approx(0.5 * (before + 0.52))


def test_paper_under_the_cell_on_the_line_is_a_junction_from_half_on(tuning: Tuning) -> None:
    for before, why in ((1.02, MORE), (0.98, JUNCTION)):
        state = moving()
        state.guard_ahead = before
        assert looked(0.0, state, tuning) == why


def test_a_tight_line_and_one_that_swelled_are_told(tuning: Tuning) -> None:
    for share, why in ((0.98, MORE), (1.02, TIGHT)):
        state = moving()
        state.bend_per_mm = -share * tuning.tightest_per_mm
        assert looked(0.3, state, tuning) == why
        state = moving()  # by the sweep: aside = curve · ahead²
        state.middle_mm = 0.5 * share * tuning.tightest_per_mm * tuning.lead_mm**2
        assert looked(0.3, state, tuning) == why
    for ink, why in ((1.19, MORE), (1.21, CHANGED), (0.81, MORE), (0.79, CHANGED)):
        state = moving()
        state.ink = ink
        assert looked(0.3, state, tuning) == why


def test_a_head_without_guard_cells_loses_a_line_of_a_fifth_of_its_ink(tuning: Tuning) -> None:
    direct = tuning._replace(direct_rad_s_mm=5.0)
    for left, why in ((0.21, MORE), (0.19, JUNCTION)):
        state = moving()
        state.swept_ink = left
        assert looked(0.0, state, direct) == why


def test_trust_holds_past_ink_beside_but_not_without_a_line_or_in_the_tightest_bends(
    tuning: Tuning,
) -> None:
    """Guard cells do not stop a head that is trusted; a sweep without ink does, or too tight a bend."""

    def trusted(travel_mm: float, **fields: float) -> int:
        state = moving()
        state.travel_mm, state.trusted_mm = travel_mm, 1.0
        for name, value in fields.items():
            state[name] = value
        return looked(0.52, state, tuning)

    assert trusted(0.9, guard_left=1.0) == MORE
    assert trusted(1.1, guard_left=1.0) == JUNCTION
    assert trusted(0.9, swept_ink=0.19) == JUNCTION
    tight = tuning.narrowest_per_mm / 0.9  # the usual bend keeps nine tenths of what it was
    assert trusted(0.9, usual_bend_per_mm=0.98 * tight) == MORE
    assert trusted(0.9, usual_bend_per_mm=1.02 * tight) == TIGHT


@pytest.mark.parametrize("curve_per_mm", [0.0, 0.25, -0.25])
def test_the_cells_ahead_stand_where_the_sweep_s_curve_leads(
    tuning: Tuning, curve_per_mm: float
) -> None:
    """Aside = curve · ahead²; the guards a constant distance square to that curve, left and right."""
    reach = tuning.guard_lead_mm
    slant = math.hypot(1, 2 * curve_per_mm * reach)
    pixels = np.zeros((800, 800), np.float32)
    spots = {
        "guard_left": (reach, curve_per_mm * reach**2 + tuning.guard_mm * slant),
        "guard_ahead": (reach, curve_per_mm * reach**2),
        "guard_right": (reach, curve_per_mm * reach**2 - tuning.guard_mm * slant),
        "slow_periods": (tuning.look_ahead_mm, curve_per_mm * tuning.look_ahead_mm**2),
    }
    for name, (along, aside) in spots.items():
        pixels[:] = 0
        i, j = round(800 - (8 + aside) / 0.025 - 0.5), round((12 + along) / 0.025 - 0.5)
        pixels[i - 1 : i + 2, j - 1 : j + 2] = 1  # a spot of 75 um
        state = moving()
        state.guard_ahead = 0.0
        state.middle_mm = curve_per_mm * tuning.lead_mm**2
        kernel._look(Cells(pixels, 0.025, LEVEL), state, tuning)
        held = {k: state[k] > 0.4 for k in ("guard_left", "guard_ahead", "guard_right")}
        assert held == {k: k == name for k in held}, name
        assert (state.slow_periods == 0) == (name == "slow_periods")


# home


@pytest.mark.parametrize(
    ("home", "there"),
    [
        ((0.5, 0.0, 0.0, 0.0), True),
        ((-0.05, 0.0, 0.0, 0.0), False),  # behind
        ((0.9, 0.0, 0.0, 0.0), True),
        ((1.2, 0.0, 0.0, 0.0), False),  # further than a lead
        ((0.5, 0.22, 0.0, 0.0), True),
        ((0.5, 0.35, 0.0, 0.0), False),  # aside
        ((0.5, 0.0, 0.6, 0.0), True),
        ((0.5, 0.0, 0.7, 0.0), False),  # on another heading
        ((0.5, 0.0, math.pi, 0.0), False),
        ((0.5, 0.0, 0.0, 5.1), False),  # too soon
    ],
)
@pytest.mark.parametrize("goes_rad", [0.0, 2.0])
def test_home_is_just_ahead_on_the_line(
    tuning: Tuning, home: tuple[float, float, float, float], there: bool, goes_rad: float
) -> None:
    """Within a lead, three tenths of it aside, and 37 degrees of its heading; a lead of 1 mm here."""
    state, (along, aside, heading, travel) = moving(), home
    state.travel_mm, state.heading_rad = 5.0, goes_rad
    c, s = math.cos(goes_rad), math.sin(goes_rad)
    x_mm, y_mm = PLACE + np.array([along * c - aside * s, along * s + aside * c])
    at = Home(x_mm, y_mm, goes_rad + heading, travel)
    assert bool(kernel._at_home(state, tuning._replace(lead_mm=1.0), at)) is there


# steering


def test_the_axis_steers_on_the_circle_that_touches_its_heading(tuning: Tuning) -> None:
    """Turn rate = v · 2e / (l² + e²), from where the screws will be when the drives have come after."""
    quick = tuning._replace(steering_gain=1.0)
    state = moving()
    owed = Drive().lag_s * SPEED_MM_S
    ahead = screws.owed_s(tuning.drive_gain, tuning.period_s) * SPEED_MM_S
    assert ahead == pytest.approx(owed, rel=0.1)  # a lag of 1 ms, stepped in periods of 0.17 ms
    state.point_x_mm, state.point_y_mm = PLACE + np.array([0.1 + ahead, 0.02])
    kernel._steer(state, quick, swinging.way_of(state))
    assert state.turn_rad_s == pytest.approx(SPEED_MM_S * 0.04 / (0.1**2 + 0.02**2), rel=1e-9)
    assert state.heading_rad == pytest.approx(state.turn_rad_s * tuning.period_s)


def test_a_point_that_is_passed_is_steered_for_as_if_a_fifth_were_left(tuning: Tuning) -> None:
    quick, state = tuning._replace(steering_gain=1.0), moving()
    state.point_x_mm, state.point_y_mm = PLACE + np.array([-1.0, 0.01])
    kernel._steer(state, quick, swinging.way_of(state))
    left = 0.2 * tuning.point_mm
    assert state.turn_rad_s == pytest.approx(SPEED_MM_S * 0.02 / (left**2 + 0.01**2), rel=1e-9)


def test_the_relay_holds_for_its_time_and_the_speed_changes_by_the_acceleration(
    tuning: Tuning,
) -> None:
    state = moving()
    state.slow_periods, state.point_x_mm, state.point_y_mm = 10.0, 1e3, PLACE[1]
    step = tuning.acceleration_mm_s2 * tuning.period_s
    for n in range(1, 10):
        kernel._steer(state, tuning, swinging.way_of(state))
        assert state.speed_mm_s == pytest.approx(SPEED_MM_S - n * step)
    kernel._steer(state, tuning, swinging.way_of(state))  # it lets go
    assert state.speed_mm_s == pytest.approx(SPEED_MM_S - 8 * step)


def test_the_relay_holds_for_a_tenth_of_a_second(tuning: Tuning) -> None:
    """From where cell 102 has lost the line to the first period in which the speed grows again."""
    state, periods = moving(), 0
    state.slow_periods, state.point_x_mm, state.point_y_mm = tuning.slow_periods, 1e3, PLACE[1]
    before = math.inf
    while state.speed_mm_s <= before:
        before, periods = state.speed_mm_s, periods + 1
        kernel._steer(state, tuning, swinging.way_of(state))
    assert periods / MOTION_RATE_HZ == pytest.approx(0.1, abs=2 / MOTION_RATE_HZ)


# the screws


def test_a_course_is_begun_and_braked_by_the_acceleration(tuning: Tuning) -> None:
    """Speed² = 2·a·distance to the end, and no less than a fiftieth of the tracing speed."""
    state = at_rest(PLACE, LEAD_MM)
    way = PLACE + np.array([[0.0, 0.0], [1.0, 0.0]])
    speeds, places, out = [], [], np.empty((1, 2))
    while screws.run(state, tuning, np.vstack([_demand(state, tuning), way[1]]),
                     np.array([SPEED_MM_S, 0.0]), out):  # fmt: skip
        speeds.append(float(state.speed_mm_s))
        places.append(float(_demand(state, tuning)[0]))
        if places[-1] >= way[1, 0] - 1e-9:
            break
    a, period_s = tuning.acceleration_mm_s2, tuning.period_s
    assert speeds[0] == pytest.approx(0.02 * SPEED_MM_S, rel=1e-9) or speeds[
        0
    ] == pytest.approx(a * period_s)
    assert np.diff(speeds).max() <= a * period_s * (1 + 1e-9)
    left = way[1, 0] - np.r_[PLACE[0], places[:-1]]
    braking = np.maximum(np.sqrt(2 * a * np.maximum(left, 0)), 0.02 * SPEED_MM_S)
    assert np.all(np.array(speeds) <= braking * (1 + 1e-6))
    assert np.mean(np.array(speeds[-40:-5]) > 0.97 * braking[-40:-5]) > 0.9  # and no slower


def _demand(state: Any, tuning: Tuning) -> Array:
    """Where the drives' demand stands."""
    owed = screws.owed_s(tuning.drive_gain, tuning.period_s)
    return np.array([state.x_mm + owed * state.vx_mm_s, state.y_mm + owed * state.vy_mm_s])


def test_a_course_is_run_slowly_while_the_relay_holds(tuning: Tuning) -> None:
    state = at_rest(PLACE, LEAD_MM)
    state.slow_periods = 1e6
    out = np.empty((300, 2))
    way, speeds = PLACE + np.array([[0.0, 0.0], [9.0, 0.0]]), np.full(2, SPEED_MM_S)
    screws.run(state, tuning, way, speeds, out)
    assert state.speed_mm_s == pytest.approx(Settings().slowed * SPEED_MM_S)


def test_the_screws_of_a_moving_head_come_onto_a_course_without_a_leap(tuning: Tuning) -> None:
    """The demand goes on from where the screws will be when the drives have made good what they owe."""
    state, out = moving(), np.empty((30, 2))
    begin = _demand(state, tuning)
    way = np.vstack([begin, begin + np.array([2.0, 0.0])])
    screws.run(state, tuning, way, np.full(2, SPEED_MM_S), out)
    steps = np.diff(np.vstack([PLACE, out])[:, 0])
    assert steps == pytest.approx(SPEED_MM_S * tuning.period_s, rel=1e-9)


def test_following_that_comes_nowhere_leaves_the_next_as_it_was(seen: View) -> None:
    """The cell may stop before the first position: on the drum is still what was felt."""
    carriage = Carriage(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)
    carriage.aim(seen, leg_of(seen.feel(PLACE, 0.0, seen.leg_mm), False, seen.leg_mm))
    nowhere = Home(0.0, 0.0, 0.0, from_travel_mm=1e9)
    carriage.follow(seen, nowhere, samples=0)
    carriage.follow(seen, nowhere, samples=100)
    assert carriage.count == 101
