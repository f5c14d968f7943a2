"""The historic head: steered straight by its swinging cell, it does what the linear theory says (shared
vectors `mf_steering`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from morfax.motion.drive import Drive
from morfax.tracer.following.start import put_down
from morfax.tracer.head import kernel, swinging
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import HISTORIC, Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import MORE, Home
from morfax.tracer.program.trace import trace
from tests.tracer.inked import inked, polyline

RATE_HZ = 6000.0
QUICK = Drive(1e-5, 1e9)  # the theory has no lag in the drives
NOWHERE = Home(0.0, 0.0, 0.0, from_travel_mm=1e9)


def direct(lead_mm: float, gain: float, lag_s: float, speed_mm_s: float) -> Settings:
    """A head of the historic kind, its sweep so fast that sampling adds little lag to the theory's: 24
    periods of the motion rate.
    """
    return Settings(
        speed_mm_s=speed_mm_s,
        acceleration_mm_s2=1e6,
        sweep_hz=250.0,
        aperture_mm=0.3,
        steering_lag_s=lag_s,
        lead_mm=lead_mm,
        amplitude_mm=1.0,
        look_ahead_mm=lead_mm,
        direct_rad_s_mm=gain,
        drive=QUICK,
    )


def offsets_on_a_straight(settings: Settings, aside_mm: float, way_mm: float) -> np.ndarray:
    """How far off a straight line the head is, put down aside of it; mm, one a period."""
    drawing = inked(polyline((2, 6), (6 + way_mm, 6)), width_mm=0.7)
    stance, _ = next(put_down(drawing, (4, 6), settings))
    east = 0.0 if abs(stance.heading_rad) < 1 else math.pi
    assert math.cos(east - stance.heading_rad) > 0.99
    carriage = Carriage(Stance(np.array([4.0, 6.0]), 0.0, stance.view), settings, RATE_HZ)
    carriage.state.y_mm += aside_mm
    while (
        carriage.travel_mm < way_mm - 4 * settings.lead_mm
        and carriage.follow(stance.view, NOWHERE) == MORE
    ):
        pass
    return carriage.positions_mm[1:, 1] - 6.0


def test_steering_is_stable_just_where_the_theory_says(vectors: Callable[[str], Any]) -> None:
    """s³·lag + s² + k·a·s + k·v: stable for a > v·lag (Routh). Growing or dying: the last fifth against the
    first.
    """
    for row in vectors("mf_steering")["stability"]:
        if row["routh_stable"] not in (True, False):
            # the boundary itself, of which the vectors say so
            assert "do not test" in row["simulated_stable"]
            continue
        assert row["simulated_stable"] == row["routh_stable"]
        settings = direct(row["a_mm"], row["k_rad_s_mm"], row["tau_s"], row["v_mm_s"])
        aside = np.abs(offsets_on_a_straight(settings, 0.02, 60.0))
        fifth = len(aside) // 5
        grows = len(aside) < 1000 or aside[-fifth:].max() > 0.5 * aside[:fifth].max()
        assert grows != row["routh_stable"], row


def test_an_ideal_pursuit_round_a_corner_runs_a_tractrix(vectors: Callable[[str], Any]) -> None:
    """The cell goes along both legs, as with a gain without end; how near the axis comes to the corner."""
    told, lead_mm = vectors("mf_steering")["corner_90deg"], 2.0
    drawing = inked(polyline((2, 6), (20, 6)), width_mm=0.7)
    settings = direct(lead_mm, 1000.0, 0.0, 2.0)
    stance, _ = next(put_down(drawing, (4, 6), settings))
    carriage = Carriage(Stance(np.array([-6.0, 0.0]), 0.0, stance.view), settings, RATE_HZ)
    state, tuning = carriage.state, carriage.tuning._replace(steering_gain=1.0)
    state.speed_mm_s, nearest_mm = 2.0, math.inf
    while state.y_mm < 4.0:
        ahead_x = state.x_mm + lead_mm * math.cos(state.heading_rad)
        ahead_y = state.y_mm + lead_mm * math.sin(state.heading_rad)
        # the line stands at y = 0 up to the corner 0,0, and at x = 0 from there on
        state.aside_mm = -ahead_y if ahead_x < 0 and ahead_y < 0.5 else ahead_x
        kernel._steer(state, tuning, swinging.way_of(state))
        nearest_mm = min(nearest_mm, math.hypot(state.x_mm, state.y_mm))
    assert nearest_mm / lead_mm == pytest.approx(told["closest_over_a"], abs=0.005)


@pytest.mark.parametrize("row", range(6))
def test_the_price_of_the_lead_on_a_circle_is_the_vectors(
    vectors: Callable[[str], Any], row: int
) -> None:
    """The steering itself on each of the vectors' circles, from the place where the theory has it."""
    told = vectors("mf_steering")["circle_cut_in"][row]
    lead_mm, radius_mm = float(told["a"]), float(told["R"])
    drawing = inked(polyline((2, 6), (20, 6)), width_mm=0.7)
    settings = direct(lead_mm, 1000.0, 0.0, 5.0)
    stance, _ = next(put_down(drawing, (4, 6), settings))
    carriage = Carriage(Stance(np.array([radius_mm, 0.0]), 0.0, stance.view), settings, RATE_HZ)
    state, tuning = carriage.state, carriage.tuning._replace(steering_gain=1.0)
    state.heading_rad, state.speed_mm_s = math.pi / 2, 5.0
    for _ in range(round(6 * RATE_HZ)):  # 30 mm, fifteen leads and more
        ahead_x = state.x_mm + lead_mm * math.cos(state.heading_rad)
        ahead_y = state.y_mm + lead_mm * math.sin(state.heading_rad)
        state.aside_mm = math.hypot(ahead_x, ahead_y) - radius_mm
        kernel._steer(state, tuning, swinging.way_of(state))
    run_mm = math.hypot(state.x_mm, state.y_mm)
    assert run_mm == pytest.approx(told["pivot_radius"], abs=0.01 * told["inward_error"])
    assert radius_mm - run_mm == pytest.approx(told["inward_error"], rel=0.01)
    assert told["approx_a2_2R"] == pytest.approx(lead_mm**2 / (2 * radius_mm))


@pytest.mark.parametrize("radius_mm", [10.0, 25.0])
def test_a_stiff_pursuit_runs_inside_a_circle_by_the_price_of_its_lead(
    vectors: Callable[[str], Any], radius_mm: float
) -> None:
    """The axis stands where the circle's radius and the lead make a right angle; with k = 2v/a² it stands on
    the circle.
    """
    row = next(
        r
        for r in vectors("mf_steering")["circle_cut_in"]
        if r["R"] == radius_mm and r["a"] == 2
    )
    t = np.linspace(0, 2 * math.pi, 721)
    circle = np.column_stack(
        [radius_mm + 3 + radius_mm * np.cos(t), radius_mm + 3 + radius_mm * np.sin(t)]
    )
    drawing = inked(circle, width_mm=0.7)
    for gain, inward_mm in ((20.0, row["inward_error"]), (2 * 2.0 / 2.0**2, 0.0)):
        run = trace(drawing, (2 * radius_mm + 3, radius_mm + 3), direct(2.0, gain, 0.0, 2.0))
        settled = run.xy_mm[len(run.xy_mm) // 3 : -len(run.xy_mm) // 10]
        inside = radius_mm - np.hypot(*(settled - radius_mm - 3).T)
        held = 2.0 / radius_mm / gain  # what the cell must see aside to turn at all: v/(R·k)
        wanted_mm = inward_mm - (held if inward_mm else 0.0)
        assert (
            abs(inside.mean() - wanted_mm) < 0.06 * row["inward_error"]
        )  # the cell is linear to this so far aside


def test_the_historic_head_goes_round_a_gentle_cam() -> None:
    """Lead 2 mm, sweep 50 Hz, servo 30 ms: within a tenth of a mm on bends of 10 mm and more."""
    t = np.linspace(0, 2 * math.pi, 721)
    r = 16 + 0.5 * np.cos(2 * t)
    run = trace(
        inked(np.column_stack([19 + r * np.cos(t), 19 + r * np.sin(t)]), width_mm=0.7),
        settings=HISTORIC,
    )
    assert run.ending == "closed"
    polar = run.xy_mm - 19
    off = np.hypot(*polar.T) - 16 - 0.5 * np.cos(2 * np.arctan2(polar[:, 1], polar[:, 0]))
    assert np.abs(off).max() < 0.1


def test_the_historic_head_loses_the_line_where_it_cannot_turn() -> None:
    """A hairpin, or an end, is more than a head without guard cells can find round; it says where it lost the
    line.
    """
    run = trace(inked(polyline((4, 6), (30, 6), (6, 12)), width_mm=0.7), (10, 6), HISTORIC)
    assert run.ending == "lost" and run.fault is not None
    assert str(run.fault).endswith(
        "go slower there with --speed, or follow with --head precise"
    )
    assert (
        run.fault.x_mm is not None and min(abs(run.fault.x_mm - x) for x in (4, 30)) < 4
    )  # two leads from the place
