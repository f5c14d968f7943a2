"""The drives of all axes: where their phases are counted from, and their kernel."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.drive import SOUND, Condition
from morfax.player.tape import drives as organ
from morfax.player.tape.drives import Drives
from tests.player.carriers import MOTION_RATE_HZ, circle

Q_MM = 0.05
ZERO_CYCLES, REST_MM = np.array([0.25, -3.0, 0.0]), np.array([40.0, 12.0, 2.0])


def phases(rows: int) -> np.ndarray:
    """A circle at 40 mm/s from the place at rest on, as a tape of another zero has it, cycles."""
    t_s = np.maximum(np.arange(rows) - 100, 0) / MOTION_RATE_HZ
    return circle(3.0, 40.0)(t_s) / Q_MM - ZERO_CYCLES


def drives(steps: int) -> Drives:
    """Drives of three axes, the second one weak."""
    found = Drives(3, Q_MM, MOTION_RATE_HZ, steps=steps)
    found.conditions = [SOUND, Condition(gain_share=0.9), SOUND]
    return found


@pytest.mark.parametrize("steps", [1, 3])
def test_phases_count_from_the_zero_and_places_from_where_the_screws_stood(steps: int) -> None:
    told, moved, plain = phases(1200), drives(steps), drives(steps)
    for block in (told[:500], told[500:]):
        places_mm, demands_mm = moved.run(block, ZERO_CYCLES, REST_MM)
        cycles = block + ZERO_CYCLES
        assert np.array_equal(places_mm, plain.follow(cycles) + REST_MM)
        assert np.array_equal(demands_mm, cycles * Q_MM + REST_MM)


def test_out_of_range_places_and_demands_end_with_the_row_before() -> None:
    told = phases(400)
    told[300:, 2] += 9.0
    places_mm, demands_mm = drives(2).run(told, ZERO_CYCLES, REST_MM)
    assert len(places_mm) == len(demands_mm) == 300


@pytest.mark.parametrize("steps", [1, 2])
def test_the_compiled_kernel_is_the_plain_one(
    steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = phases(300)
    compiled = drives(steps).run(told, ZERO_CYCLES, REST_MM)
    monkeypatch.setattr(organ, "_follow", organ._follow.py_func)
    assert np.array_equal(drives(steps).run(told, ZERO_CYCLES, REST_MM), compiled)
