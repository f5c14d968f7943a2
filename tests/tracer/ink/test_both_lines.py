"""Both lines of ink in which two run together: where they cross, touch, or come to others."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.both_lines import strands
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.stretches import FeltSheet
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline

STRAIGHT = polyline((5, 20), (55, 20))
ARC_MM = 24.0  # of a circle, to either side of its lowest place
BEYOND_MM = 2.0  # from where two lines cross, they are apart
# a line that has another's partner is 150 um off and more, mostly millimetres
OFF_MM = 60 * UM


@pytest.mark.parametrize(
    ("radius_mm", "angle_deg"),
    [(25.0, 7.0), (35.0, 5.0), (35.0, 7.0), (45.0, 7.0), (60.0, 5.0)],
)
def test_a_circle_that_crosses_a_line_twice_at_a_flat_angle_keeps_its_partners(
    radius_mm: float, angle_deg: float
) -> None:
    high_mm = radius_mm * math.cos(math.radians(angle_deg))
    reach_deg = math.degrees(ARC_MM / radius_mm)
    bent = arc((30, 20 + high_mm), radius_mm, -90 - reach_deg, -90 + reach_deg)
    strokes = [shapely.LineString(line.xy_mm[::5]) for line in _traced(bent)]
    assert len(strokes) == 2
    for true in (STRAIGHT, bent):
        off_mm = [
            shapely.hausdorff_distance(shapely.LineString(true), each) for each in strokes
        ]
        assert min(off_mm) < OFF_MM


@pytest.mark.parametrize("angle_deg", [2.0, 3.0])
def test_two_lines_cross_though_others_cross_them_nearby(angle_deg: float) -> None:
    """They run in one ink, and no more than 4 mm of it to either side are theirs alone."""
    lines = [
        polyline((4, 20 - high_mm), (56, 20 + high_mm))
        for high_mm in (26 * math.tan(math.radians(side * angle_deg / 2)) for side in (1, -1))
    ]
    others = polyline((18, 10), (34, 30)), polyline((40, 10), (28, 30))
    found = trace_ink(inked(*lines, *others, seed=4)).lines
    for true in lines:
        off_mm = [nearest_mm(evenly(true, 0.1), line.places_mm).max() for line in found]
        assert min(off_mm) < OFF_MM


def _traced(bent: Array):  # type: ignore[no-untyped-def]
    return trace_ink(inked(STRAIGHT, bent, seed=1)).lines


def _felt_with(apart_mm: Array) -> Run:
    """A straight stretch along which two lines run so far apart, mm, as if it were felt."""
    left = ink_left(inked(STRAIGHT, seed=1).sheet)
    run = FeltSheet.of(left.drawing, Settings(), left.ink).felt[0].part(10, 10 + len(apart_mm))
    return replace(run, widths_mm=WIDTH_MM + apart_mm)


def _along(stations: int) -> Array:
    """How far so many stations are from their middle, mm."""
    run = _felt_with(np.zeros(stations))
    return (np.arange(stations) - stations // 2) * run.view.step_mm


@pytest.mark.parametrize("radius_mm", [45.0, 50.0, 1000.0])
def test_a_line_crosses_another_as_well_if_one_of_them_is_bent(radius_mm: float) -> None:
    """To one side they part ever faster, to the other they come together again."""
    x = _along(240)
    apart_mm = math.tan(math.radians(3.0)) * x + x**2 / (2 * radius_mm)
    one, other = strands(_felt_with(np.abs(apart_mm)), WIDTH_MM, (True, True))
    above_mm = (one.places_mm - other.places_mm)[:, 1]
    before, behind = (np.searchsorted(x, side * BEYOND_MM) for side in (-1, 1))
    assert above_mm[before] * above_mm[behind] < 0


@pytest.mark.parametrize("stations", [80, 240])
@pytest.mark.parametrize("radius_mm", [50.0, 150.0])
def test_a_bent_line_that_only_touches_another_does_not_cross_it(
    radius_mm: float, stations: int
) -> None:
    x = _along(stations)
    one, other = strands(_felt_with(x**2 / (2 * radius_mm)), WIDTH_MM, (True, True))
    sides = np.sign((one.places_mm - other.places_mm)[:, 1])
    assert (sides[np.abs(x) > 0.4 * x[-1]] == sides[0]).all()


def test_two_lines_are_told_from_where_they_are_apart_but_to_the_end_of_their_ink() -> None:
    """They cross near one end of the stretch: how they go on there their own ink tells, further off."""
    x = _along(200)
    felt = _felt_with(0.1 * np.abs(x - x[20]))
    from_junction, _ = strands(felt, WIDTH_MM, (False, True))
    from_end, _ = strands(felt, WIDTH_MM, (True, True))
    assert len(from_end) == len(felt)
    assert from_junction.places_mm[0, 0] > felt.places_mm[20, 0] + WIDTH_MM
    nowhere_apart = strands(_felt_with(np.zeros(200)), WIDTH_MM, (True, True))
    assert len(nowhere_apart[0]) == 200


def test_ink_of_two_lines_may_flare_at_both_its_ends() -> None:
    """Within a flare its width stands still for a moment, as noise has it: it was taken for a letter's."""
    x = _along(200)
    apart_mm = np.maximum(0.25 * (np.abs(x) - 2.0), 0.0)
    for still in (20, 40, 160, 180):
        apart_mm[still - 6 : still + 6] = apart_mm[still]
    assert strands(_felt_with(apart_mm), WIDTH_MM)


def test_stations_beside_the_middle_of_both_lines_do_not_take_these_along() -> None:
    """On broad ink stations keep to the thinned ink's middle, and one may leap onto one of the lines: both
    lines were 56 um off, and turned by 14 degrees, where their ink parts.
    """
    felt = _felt_with(np.full(200, 0.4 * WIDTH_MM))
    off_mm = np.r_[np.zeros(160), np.linspace(0.0, 60 * UM, 40)]
    off_mm[-15] = 250 * UM
    beside = replace(felt, places_mm=felt.places_mm + off_mm[:, None] * (0.0, 1.0))
    two = strands(beside, WIDTH_MM, (True, True))
    for strand in two:
        assert np.abs(np.abs(strand.places_mm[:, 1] - 20) - 0.2 * WIDTH_MM).max() < 15 * UM


def test_both_lines_go_straight_on_into_the_ink_of_a_junction() -> None:
    """Half a width before it begins the ink of what meets there, which moves stations aside."""
    felt = _felt_with(np.full(200, 0.4 * WIDTH_MM))
    x = felt.places_mm[:, 0]
    aside_mm = np.maximum(x - (x[-1] - 0.5 * WIDTH_MM), 0.0)
    drawn_aside = replace(felt, places_mm=felt.places_mm + aside_mm[:, None] * (0.0, 1.0))
    two = strands(drawn_aside, WIDTH_MM, (True, False))
    assert len(two) == 2
    for strand in two:
        assert np.abs(np.abs(strand.places_mm[:, 1] - 20) - 0.2 * WIDTH_MM).max() < 15 * UM
