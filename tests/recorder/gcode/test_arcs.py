"""Lines and arcs of a stretch, part by part: the curvature at a place, chords, the shortest stretches."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from shapely import LineString, Point

from morfax.motion.arrays import Array
from morfax.recorder.gcode.arcs import _chords, _off_chord_mm, fit
from morfax.recorder.gcode.pieces import curvature_per_mm

TOLERANCE_MM = 0.01


def arc(turn_rad: float, radius_mm: float, middle_mm: tuple[float, float]) -> Array:
    """Places of an arc, 2000 of them, (n, 2) mm."""
    angles = np.linspace(0.3, 0.3 + turn_rad, 2000)
    return np.array(middle_mm) + radius_mm * np.column_stack([np.cos(angles), np.sin(angles)])


@pytest.mark.parametrize("turn_rad", [0.1, 1.0, 3.0, 4.5, 6.2, -0.1, -3.0, -6.2])
@pytest.mark.parametrize("middle_mm", [(0.0, 0.0), (100.0, 60.0)])
def test_the_curvature_of_an_arc_is_told_wherever_it_lies(turn_rad, middle_mm):
    """One over the radius. It is where the fit begins: below a quarter turn within a third."""
    found = curvature_per_mm(arc(turn_rad, 5.0, middle_mm))
    within = 0.33 if abs(turn_rad) < math.pi / 2 else 0.001
    assert found == pytest.approx(math.copysign(0.2, turn_rad), rel=within)


def test_the_distance_from_a_chord_is_the_largest_one_from_its_line():
    half_turn = arc(math.pi, 5.0, (30.0, 40.0))
    assert _off_chord_mm(half_turn) == pytest.approx(5.0, abs=1e-5)  # 2000 places round it


def test_chords_stay_within_the_tolerance_and_are_as_long_as_it_allows():
    places = arc(2.0, 5.0, (30.0, 40.0))
    chain = _chords(places, TOLERANCE_MM)
    begins = np.array([segment.begin_mm for segment in chain.segments])
    assert np.allclose(begins[0], places[0])
    for one, after in pairwise(chain.segments):  # without a gap
        heading = np.array([math.cos(one.heading_rad), math.sin(one.heading_rad)])
        assert np.allclose(one.begin_mm + one.length_mm * heading, after.begin_mm)
    chords = LineString(np.vstack([begins, places[-1:]]))
    off_mm = max(chords.distance(Point(place)) for place in places)
    assert off_mm == pytest.approx(chain.deviation_mm) and off_mm <= TOLERANCE_MM
    longest_mm = 2 * math.sqrt(
        2 * 5.0 * TOLERANCE_MM
    )  # a chord with this much of a circle above it
    spacing_mm = 2.0 * 5.0 / 2000
    for segment in chain.segments[:-1]:
        assert longest_mm - 2 * spacing_mm < segment.length_mm <= longest_mm + 1e-6


@pytest.mark.parametrize("radius_mm", [0.02, 0.05, 0.1])
def test_an_arc_shorter_than_the_spacing_of_places_keeps_its_bend(radius_mm):
    """Half a turn: its chord would be a radius off."""
    places = arc(math.pi, radius_mm, (3.0, 1.0))
    (chain,) = fit(places, 0.1 * radius_mm)
    assert chain.deviation_mm <= 0.1 * radius_mm
    turned = sum(segment.turned_rad for segment in chain.segments)
    assert turned == pytest.approx(math.pi, abs=0.3)


def ragged_round(seed: int) -> Array:
    """A clockwise turn of 0.2 mm radius, ragged by 6 um a wave, after a straight way of 4 um, (121, 2) mm."""
    rng = np.random.default_rng(seed)
    angles = np.linspace(0, -math.tau, 120)
    waves = [
        rng.normal(0, 0.006) * np.cos(k * angles + rng.uniform(0, math.tau))
        for k in range(1, 5)
    ]
    radii_mm = 0.2 + sum(waves)
    places = radii_mm[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    ahead = (places[1] - places[0]) / math.dist(*places[:2])
    return np.vstack([places[0] - 0.004 * ahead, places])


@pytest.mark.parametrize("seed", [7, 23, 49, 78, 94, 98])
def test_no_arc_of_a_small_round_goes_round_more_than_once(seed):
    """One arc of three turns is as near to every place, and a program that holds only its ends loses it."""
    turns = [
        s.turned_rad for chain in fit(ragged_round(seed), TOLERANCE_MM) for s in chain.segments
    ]
    assert max(map(abs, turns)) <= 1.5 * math.pi
    assert sum(turns) == pytest.approx(-math.tau, abs=0.5)  # its ends are ragged, too
