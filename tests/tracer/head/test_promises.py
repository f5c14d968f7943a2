"""What parts of the head promise one another, in closed form: places along a way, who led, the heading."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.start import put_down
from morfax.tracer.head import kernel, loop, slow_cell, swinging
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.course import FELT_LEGS
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.slow_cell import HEADS_RAD, Tried
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import MORE, Home, Tuning
from morfax.tracer.head.tuning import _placed, tune
from morfax.tracer.sensing.photocell import behind_aperture
from morfax.tracer.sensing.view import View
from tests.tracer.head.heads import PLACE, moving, white
from tests.tracer.inked import arc, inked, polyline

NEVER_HOME = Home(0.0, 0.0, 0.0, 1e9)


def test_places_of_a_run_are_counted_from_its_first_position() -> None:
    """One every `STEP_MM`, the first and the last of the way among them."""
    run = np.column_stack([np.arange(0.0, 5.0, 0.002), np.zeros(2500)])
    at = loop._index_every(run)
    assert at[0] == 0
    assert np.diff(run[at, 0]) == pytest.approx(loop.STEP_MM, abs=0.002)
    assert run[at[-1], 0] == pytest.approx(run[-1, 0], abs=loop.STEP_MM)


def test_a_head_at_the_end_of_a_way_heads_as_the_way_ends() -> None:
    """The last place of a way counts: its last piece is long, and turns."""
    way = np.array([[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.2, 4.0]])
    for off_rad, along in ((0.5 * HEADS_RAD, True), (2 * HEADS_RAD, False)):
        state = moving(math.atan2(4.0, 0.2) - off_rad)
        assert slow_cell.heads_along(Tried(way[2:3], state, MORE), way) is along


def test_a_mount_that_turns_with_the_head_only_has_nothing_on_the_drum(tuning: Tuning) -> None:
    """However little it turns for a mm."""
    state = moving()
    state.mean_sum = tuning.mean * tuning.sweep_periods
    before = int(state.places)
    swinging.detect(state, tuning._replace(direct_rad_s_mm=0.5))
    assert state.places == before and state.middle_mm == 0.0


def test_the_cell_has_led_as_far_as_the_head_has_come() -> None:
    """But for what was felt before it set out, and however often it has reported meanwhile."""
    stance, _ = next(iter(put_down(inked(arc((14, 14), 10)), settings=Settings())))
    head = Follower(stance, Settings(), MOTION_RATE_HZ).carriage
    felt_mm = list[float]()
    for _ in range(3):
        assert head.follow(stance.view, NEVER_HOME, 1200) == MORE
        felt_mm.append(head.travel_mm - head.cell_led_mm)
    assert felt_mm == pytest.approx([felt_mm[0]] * 3, abs=1e-9)
    assert head.travel_mm > 5.0 > 1.0 > felt_mm[0]


@pytest.mark.parametrize("lag_s", [0.001, 0.01])
def test_the_steering_turns_all_but_1_e_of_what_is_left_in_its_lag(
    seen: View, lag_s: float
) -> None:
    gain = tune(
        Stance(PLACE, 0.0, seen), Settings(steering_lag_s=lag_s), MOTION_RATE_HZ
    ).steering_gain
    assert (1 - gain) ** (lag_s * MOTION_RATE_HZ) == pytest.approx(math.exp(-1))


def test_a_steering_without_lag_turns_at_once(seen: View) -> None:
    no_lag = tune(Stance(PLACE, 0.0, seen), Settings(steering_lag_s=0.0), MOTION_RATE_HZ)
    assert no_lag.steering_gain == 1.0


def test_after_a_course_the_head_heads_as_its_last_piece(seen: View) -> None:
    head = Carriage(Stance(PLACE, 0.0, seen), Settings(), MOTION_RATE_HZ)
    way = PLACE + np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.1], [2.05, 0.12]])
    head.run([way])
    assert head.heading_rad == pytest.approx(math.atan2(0.02, 0.05), abs=1e-9)


def test_a_guard_cell_follows_half_of_what_it_sees(tuning: Tuning) -> None:
    """On a line and on an edge: it never shows more than there is."""
    for balance_per_mm in (0.0, -1.0):
        state = moving()
        state.guard_ahead = state.guard_left = state.guard_right = 0.0
        look = kernel._look if balance_per_mm == 0.0 else kernel._look_at_edge
        look(white(0.8), state, tuning._replace(balance_per_mm=balance_per_mm))
        assert (state.guard_ahead, state.guard_left) == pytest.approx((0.4, 0.4), abs=1e-3)


def test_a_head_on_an_edge_swings_by_a_pixel_or_two_where_a_scan_is_coarse() -> None:
    """The edge is as soft as a pixel or two: a longer swing sees no more of it, and more noise."""
    pitch_mm = 25.4 / 50
    on_edge = View(behind_aperture(inked(polyline((4, 8), (24, 8))), 0.15), 0.3, on_edge=True)
    coarse = replace(on_edge, cells=on_edge.cells._replace(pitch_mm=pitch_mm))
    assert pitch_mm < _placed(coarse, Settings()).amplitude_mm < 2 * pitch_mm


def test_a_parabola_is_asked_for_less_than_half_a_radian_within_its_narrowest_window(
    seen: View,
) -> None:
    """A cosine's parabola is 1 % off there."""
    for view in (seen, replace(seen, on_edge=True)):
        tuned = tune(Stance(PLACE, 0.0, view), Settings(), MOTION_RATE_HZ)
        assert 0.3 < tuned.narrowest_per_mm * FELT_LEGS * view.leg_mm < 0.5
