"""The parts of the head that look, against their closed forms: fit, sweep, guard cells, trust.

Each test calls one kernel on a state made by hand; what they do together is in `test_kernel`.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from morfax.tracer.head import kernel, swinging
from morfax.tracer.head.state import CHANGED, JUNCTION, MORE, TIGHT, Tuning
from morfax.tracer.sensing.photocell import LEVEL, Cells
from morfax.tracer.sensing.view import View
from tests.tracer.head.heads import PLACE, moving, remembered, white
from tests.tracer.inked import UM

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
