"""How systems are measured against each other: the speed that is held, and what is a corner."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.jobs.systems import corner_places, held
from morfax.motion.motion import IN_WORK_BELOW_MM, Path

TRACING_MM_S = 10.0


def at_speed(speed_mm_s: float, z_mm: float = 0.0) -> Path:
    """Ten seconds along X at a speed."""
    t_s = np.linspace(0, 10, 1001)
    along = speed_mm_s * t_s
    return Path(t_s, np.column_stack([along, np.zeros_like(along), np.full_like(along, z_mm)]))


@pytest.mark.parametrize(
    ("speed_mm_s", "share"), [(9.4, 0.0), (9.6, 1.0), (10.4, 1.0), (10.6, 0.0)]
)
def test_a_speed_is_held_within_5_percent_either_way(speed_mm_s: float, share: float) -> None:
    told = held(at_speed(speed_mm_s), TRACING_MM_S)
    assert told["mean_speed_mm_s"] == pytest.approx(speed_mm_s)
    assert told["speed_held_share"] == pytest.approx(share)


def test_a_way_above_the_work_is_no_speed_of_the_tool() -> None:
    told = held(at_speed(10.0, IN_WORK_BELOW_MM + 1.0), TRACING_MM_S)
    assert told == {"mean_speed_mm_s": None, "speed_held_share": 0.0}


@pytest.mark.parametrize(("turn_rad", "count"), [(0.45, 0), (0.55, 1)])
def test_a_turn_of_half_a_radian_within_50_um_is_a_corner(turn_rad: float, count: int) -> None:
    legs = np.array([[-5.0, 0.0], [0.0, 0.0], [5 * math.cos(turn_rad), 5 * math.sin(turn_rad)]])
    s = np.linspace(0, 2, 1001)
    xy = np.column_stack([np.interp(s, [0, 1, 2], column) for column in legs.T])
    path = Path(s, np.column_stack([xy, np.zeros(len(s))]))
    found = corner_places(path)
    assert len(found) == count
    assert found == pytest.approx(np.zeros((count, 2)), abs=0.01)
