"""The pick-ups of the machine: the edges of their cells, and what wheels that are wrong do to a path."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.player.tape.comparator import compared, track_edges
from morfax.player.tape.drives import Drives, ReferenceTrack
from morfax.player.tape.sector_wheel import (
    SectorWheel,
    Wheels,
    edges_since,
    last_edge,
    screw_for,
)

UM = 1e-3
Q_MM, PITCH_MM, RADIUS_MM = 0.05, 5.0, 30.0
SHARE_MM = 1e-6 * Q_MM  # of the motors' answer: a millionth of a cycle


def edges_of(places_mm: np.ndarray, wheels: Wheels) -> np.ndarray:
    """Edges that a cell has given, with the share since the last; a cycle of the reference a row."""
    before, count, told = wheels.sectors - 1, -1, []
    for row, place_mm in enumerate(places_mm.tolist()):
        sector, share = last_edge(place_mm, row % wheels.sectors / wheels.sectors, 0, wheels)
        count += edges_since(sector, before, wheels.sectors)
        before = sector
        told.append(count + share)
    return np.array(told)


@pytest.mark.parametrize("speed_mm_s", [0.0, 10.0, -10.0, 95.0, -95.0])
def test_the_cell_sees_the_reference_and_the_screw_s_speed(speed_mm_s: float) -> None:
    seconds = np.arange(3001) / MOTION_RATE_HZ
    told = edges_of(speed_mm_s * seconds, SectorWheel().wheels(1, Q_MM))
    # half a second of 6 kHz, and a cycle for each q of travel
    assert told[-1] == pytest.approx(3000 + speed_mm_s * 0.5 / Q_MM, abs=1e-9)
    assert np.all(np.diff(told) > 0)


@settings(max_examples=30, deadline=None)
@given(
    speed_mm_s=st.floats(-95, 95),
    division_mm=st.floats(0, 0.18),
    eccentricity_mm=st.floats(0, 3),
)
def test_no_edge_is_lost_or_counted_twice_on_a_wheel_that_is_wrong(
    speed_mm_s: float, division_mm: float, eccentricity_mm: float
) -> None:
    wheel = SectorWheel(eccentricity_mm, division_mm)
    seconds = np.arange(1000) / MOTION_RATE_HZ
    true = np.arange(1000) + speed_mm_s * seconds / Q_MM
    off = edges_of(speed_mm_s * seconds, wheel.wheels(1, Q_MM)) - true
    width_mm = 2 * np.pi * RADIUS_MM / 100
    # an edge off its place by as much (less their mean), and the arm off the axis by e at r
    most = 1.2 * division_mm / width_mm + 100 * eccentricity_mm / (2 * np.pi * RADIUS_MM)
    assert np.abs(off).max() <= most + 1e-9


@pytest.mark.parametrize("q_mm", [0.05, 0.1, 0.125, 1 / 7.3, 1.0, 2.0])
def test_the_wheel_has_whole_sectors_for_any_travel_of_a_cycle(q_mm: float) -> None:
    screw = screw_for(q_mm)
    assert screw.mm_per_cycle == pytest.approx(q_mm, rel=1e-12) and screw.sectors >= 10


def test_comparator_and_decoder_take_the_time_between_edges_and_the_cycles() -> None:
    tape = track_edges(1000.25, 0.5)
    assert tape == (1000, 0.75)
    assert compared(tape, (1000, 0.5)) == pytest.approx(0.25)
    assert compared(tape, (1001, 0.25)) == pytest.approx(-0.5)  # it tells which is ahead
    assert compared(tape, (997, 0.75)) == pytest.approx(3.0)  # over several cycles


def followed(x_mm: np.ndarray, wheel: SectorWheel) -> np.ndarray:
    """One screw under the drives' loop, for a tape's places; without what the loop itself leaves."""
    wrong, right = (
        Drives(1, Q_MM, MOTION_RATE_HZ, reference=ReferenceTrack(1.0, one)).follow(
            x_mm[:, None] / Q_MM
        )
        for one in (wheel, SectorWheel())
    )
    return (wrong - right)[:, 0]


def test_an_arm_off_the_wheel_s_axis_bends_the_path_once_in_a_turn_of_the_screw() -> None:
    x_mm = 2.0 * np.arange(30_000) / MOTION_RATE_HZ  # two turns
    off_mm = followed(x_mm, SectorWheel(eccentricity_mm=0.03))
    # the cell is early by e / r · sin, so the screw stands back by that share of a turn
    expected = -PITCH_MM / (2 * np.pi) * 0.03 / RADIUS_MM * np.sin(2 * np.pi * x_mm / PITCH_MM)
    # 0.8 um; the loop of 250 Hz follows a turn of 0.4 Hz
    assert np.abs(off_mm[600:] - expected[600:]).max() < 0.01 * UM


def test_edges_off_their_places_shake_the_screw_where_it_stands() -> None:
    """Sector after sector comes by at 6 kHz, the whole wheel 60 times a second."""
    off_mm = followed(np.zeros(12_000), SectorWheel(division_mm=0.005))
    turns = off_mm[6000:].reshape(-1, 100)
    assert np.abs(turns - turns[0]).max() < SHARE_MM  # again and again the same
    at_edges_mm = Q_MM * 0.005 / (2 * np.pi * RADIUS_MM / 100)  # 0.13 um, the most of an edge
    # the loop's band lets a part through
    assert 0.1 * at_edges_mm < turns[0].std() < at_edges_mm
    assert abs(turns[0].mean()) < 0.05 * at_edges_mm


def test_a_lamp_that_is_too_weak_costs_the_lock_within_the_decoder_s_range() -> None:
    cycles = np.zeros((600, 1))
    # nothing moves, yet the reference goes on: a cycle in each row, and four are allowed
    for light, rows in ((0.09, 4), (0.11, 600)):
        drives = Drives(
            1, Q_MM, MOTION_RATE_HZ, reference=ReferenceTrack(1.0, SectorWheel(light=light))
        )
        assert len(drives.follow(cycles)) == rows


def test_the_reference_sets_how_fast_the_cells_edges_come() -> None:
    for cycles_per_row in (0.5, 1.0, 400 / 6000):
        drives = Drives(2, Q_MM, MOTION_RATE_HZ, reference=ReferenceTrack(cycles_per_row))
        cycles = np.linspace(0, 100, 6000)[:, None] * [1, -1]
        drives.follow(np.vstack([cycles, np.repeat(cycles[-1:], 1200, axis=0)]))
        expected = 7199 * cycles_per_row + np.array([100, -100])
        assert np.abs(drives.cell_edges - expected).max() <= 1  # whole edges


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"eccentricity_mm": 4.0}, "4 mm off its axis is broken; give 0 to 3 mm"),
        ({"eccentricity_mm": float("nan")}, "broken"),
        ({"light": 1.5}, "the lamp has 150% of its light; give 0% to 100%"),
        ({"division_mm": 0.3}, "edges stand 0.3 mm off their places make no wheel"),
    ],
)
def test_a_wheel_that_is_none_is_refused(wrong: dict[str, float], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        SectorWheel(**wrong).wheels(3, Q_MM)
