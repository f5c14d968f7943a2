"""Stops on the way: the brake by its closed form, v² = 2 a d; the stand exactly on its place; the way itself
unchanged.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.contour import distance
from morfax.tracer.program.passes import braking as stops
from tests.tracer.inked import UM, arc, polyline

RATE_HZ = 6000.0
BRAKE_MM_S2 = 500.0
SPEED_MM_S = 10.0
STEP_MM = SPEED_MM_S / RATE_HZ  # in a period
BRAKING_MM = SPEED_MM_S**2 / (2 * BRAKE_MM_S2)  # 0.1 mm


def straight(length_mm: float = 6.0) -> np.ndarray:
    """A way along X at speed."""
    x = np.arange(0, length_mm, STEP_MM)
    return np.column_stack([x, np.full(len(x), 3.0)])


def speeds(way: np.ndarray) -> np.ndarray:
    """Speed in each period, mm/s."""
    return np.asarray(np.hypot(*np.diff(way, axis=0).T) * RATE_HZ)


def test_the_brake_is_the_closed_form() -> None:
    before, after = stops.pieces(straight(), [1800.0], BRAKE_MM_S2, RATE_HZ)
    for way in (before[:, 0], after[::-1, 0]):  # braking, and back to speed, mirrored in time
        to_go = np.abs(way[-1] - way)
        half_way = 0.5 * (to_go[1:] + to_go[:-1])
        v = np.abs(np.diff(way)) * RATE_HZ
        allowed = np.sqrt(2 * BRAKE_MM_S2 * half_way)
        near = (half_way < BRAKING_MM) & (half_way > 3 * STEP_MM)
        # nodes are a period's travel apart, 1.7 um: the law is stepped by that much
        assert v[near] == pytest.approx(allowed[near], rel=0.03)
        assert v[(half_way > 2 * BRAKING_MM) & (half_way < 2.5)] == pytest.approx(
            SPEED_MM_S, rel=1e-6
        )


@settings(max_examples=60)
@given(at=st.lists(st.floats(5, 3500), min_size=1, max_size=6).map(sorted))
def test_each_piece_ends_exactly_on_its_place_and_the_next_begins_there(
    at: list[float],
) -> None:
    way = straight()
    pieces = stops.pieces(way, at, BRAKE_MM_S2, RATE_HZ)
    assert len(pieces) == len(at) + 1
    for piece, following, row in zip(pieces, pieces[1:], at, strict=False):
        x = min(row * STEP_MM, way[-1, 0])
        assert piece[-1] == pytest.approx([x, 3.0], abs=1e-9) and following[0] == pytest.approx(
            [x, 3.0], abs=1e-9
        )
    whole = np.vstack(pieces)
    assert np.all(np.diff(whole[:, 0]) >= -1e-12)  # never back
    v = speeds(whole)[:-3]  # where a way ends it is at rest, whatever it was
    assert v.max() <= SPEED_MM_S * (1 + 1e-6)
    # sampled, the brake's last period is cut short where it arrives: one period's worth more
    assert np.abs(np.diff(v)).max() * RATE_HZ <= 4.5 * BRAKE_MM_S2


@settings(max_examples=30, deadline=None)
@given(radius_mm=st.floats(2, 30), at=st.floats(0.05, 0.95))
def test_a_stop_changes_the_timing_and_not_the_way(radius_mm: float, at: float) -> None:
    turns = np.arange(0, 2 * np.pi, STEP_MM / radius_mm)
    way = radius_mm * np.column_stack([np.cos(turns), np.sin(turns)])
    stopped = np.vstack(stops.pieces(way, [at * len(way)], BRAKE_MM_S2, RATE_HZ))
    assert distance(stopped, way).hausdorff_mm < 0.1 * UM  # chords of 1.7 um
    assert len(stopped) > len(way)


def test_the_way_back_goes_from_rest_to_rest_within_speed_and_acceleration() -> None:
    way = np.vstack(
        [polyline((0, 0), (20, 0)), arc((20, 5), 5, -90, 0)[1:], polyline((25, 25))]
    )
    run = stops.run(way, 50.0, BRAKE_MM_S2, RATE_HZ)
    assert run[0] == pytest.approx(way[0]) and run[-1] == pytest.approx(way[-1])
    assert (
        distance(run, way).hausdorff_mm < 1 * UM
    )  # nodes every 0.1 mm on a radius of 5 mm: 0.25 um
    v = np.r_[0.0, speeds(run), 0.0]
    assert 45 < v.max() <= 50 * (1 + 1e-6)
    assert np.abs(np.diff(v)).max() * RATE_HZ <= 2.1 * BRAKE_MM_S2


def test_the_way_back_stands_where_it_turns_sharply() -> None:
    run = stops.run(polyline((0, 0), (8, 0), (8, 8)), 50.0, BRAKE_MM_S2, RATE_HZ)
    at = int(np.argmin(np.hypot(*(run - [8, 0]).T)))
    assert run[at] == pytest.approx([8, 0], abs=2 * UM)
    assert (
        speeds(run)[at - 2 : at + 2].max() < 1.0
    )  # of 50 mm/s; a corner at speed would need no end of acceleration


def test_a_way_that_begins_with_a_swivel_begins_without_a_leap() -> None:
    stood = (
        np.tile([4.0, 4.0], (50, 1)) + 1e-11 * np.arange(50)[:, None]
    )  # a swivel, with its rounding
    way = np.vstack(
        [stood, np.column_stack([np.arange(4.0, 8.0, STEP_MM), np.full(2400, 4.0)])]
    )
    v = np.r_[0.0, speeds(stops.run(way, 50.0, BRAKE_MM_S2, RATE_HZ))]
    assert np.abs(np.diff(v)).max() * RATE_HZ <= 2.1 * BRAKE_MM_S2


@pytest.mark.parametrize("length_mm", [0.005, 0.1, 1.0])
def test_a_short_way_back_is_made_from_rest_to_rest(length_mm: float) -> None:
    v = np.r_[
        0.0,
        speeds(stops.run(polyline((0, 0), (length_mm, 0)), 50.0, BRAKE_MM_S2, RATE_HZ)),
        0.0,
    ]
    assert np.abs(np.diff(v)).max() * RATE_HZ <= 2.1 * BRAKE_MM_S2
    assert v.max() == pytest.approx(
        np.sqrt(BRAKE_MM_S2 * length_mm), rel=0.1
    )  # half way to speed, half way to rest
