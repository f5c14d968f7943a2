"""Ink that swells everywhere: a nib's stroke is run once, two lines both; what may be either is told."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.ink import nib
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import Points, inked, loops, together

PEN_MM = 0.4
THIN_MM, BROAD_MM = 0.27, 0.6


def run_mm(found: Trace) -> float:
    """The length of all strokes, mm."""
    return sum(line.length_mm for line in found.lines)


def lissajous(a: int, b: int, apart_mm: float, radius_mm: float = 28.0) -> Points:
    """A Lissajous figure that comes back beside its own way, by no more than so much anywhere."""
    turns = np.linspace(0, 2 * np.pi, 4000)
    phase = np.pi / (2 * b) + 0.5 * apart_mm / radius_mm
    x, y = np.sin(a * turns + phase), np.sin(b * turns)
    return np.column_stack([radius_mm + 7 + radius_mm * x, radius_mm + 7 + radius_mm * y])


def ellipse(across_mm: float, high_mm: float) -> Points:
    """An ellipse about one place."""
    turns = np.linspace(0, 2 * np.pi, 2000)
    return np.column_stack([30 + across_mm * np.cos(turns), 30 + high_mm * np.sin(turns)])


@pytest.mark.parametrize("a, b", [(2, 3), (3, 4), (4, 5)])
def test_a_line_that_comes_back_within_its_own_width_is_run_both_times(a: int, b: int) -> None:
    way = lissajous(a, b, 0.79 * PEN_MM)
    found = trace_ink(inked(way, width_mm=PEN_MM, seed=1))
    assert run_mm(found) == pytest.approx(length_mm(way), rel=0.005)
    # one stroke in the middle of both would be 0.16 mm off, and does not tell it
    places = np.vstack([line.places_mm for line in found.lines])
    assert nearest_mm(way, places).max() < 0.15 * PEN_MM
    assert found.ink is not None and found.ink.followed_share > 0.99


def test_two_rings_nearer_than_a_pen_are_both_run() -> None:
    rings = [ellipse(18.3, 18.0), ellipse(18.0, 18.3)]
    found = trace_ink(inked(*rings, width_mm=PEN_MM, seed=1))
    assert run_mm(found) == pytest.approx(sum(map(length_mm, rings)), rel=0.005)
    places = np.vstack([line.places_mm for line in found.lines])
    for ring in rings:
        assert nearest_mm(ring, places).max() < 0.15 * PEN_MM  # the other is 0.3 mm away


def nib_widths(way: Points, form: str) -> Points:
    """How broad the strokes of some rigid nibs are, 1 rad from the X axis, mm."""
    steps = np.gradient(way, axis=0)
    sine = np.sin(np.arctan2(steps[:, 1], steps[:, 0]) - 1.0)
    if form == "a slit with a round point":
        return np.maximum(THIN_MM, BROAD_MM * np.abs(sine))
    if form == "a slit":
        return THIN_MM + (BROAD_MM - THIN_MM) * np.abs(sine)
    return np.hypot(THIN_MM * np.sqrt(1 - sine**2), BROAD_MM * sine)


@pytest.mark.parametrize("form", ["a slit with a round point", "a slit", "an ellipse"])
@pytest.mark.parametrize("closed", [False, True])
def test_the_stroke_of_a_rigid_nib_is_one_line(form: str, closed: bool) -> None:
    way = ellipse(15.0, 19.0) if closed else loops(4)
    widths, pieces = nib_widths(way, form), range(0, len(way) - 5, 5)
    found = trace_ink(together(*((way[k : k + 6], widths[k]) for k in pieces), seed=1))
    # taken for two lines it would be run along both rims
    assert run_mm(found) < 1.03 * length_mm(way)
    assert found.ink is not None and not found.ink.single


def test_a_slope_ends_at_its_first_maximum() -> None:
    rises = np.array([0.0, 1.0, 2.0, 3.0, 2.9, 2.0, 4.0])
    assert nib._slope(rises, 0.5).tolist() == [0.0, 1.0, 2.0, 3.0]
    assert nib._slope(rises[:5], 0.5).tolist() == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize(("power", "is_straight"), [(1, True), (2, False)])
def test_where_two_lines_cross_ink_grows_broader_evenly_at_once(
    power: int, is_straight: bool
) -> None:
    slope = np.linspace(0.0, 1.0, 101) ** power
    assert nib._is_straight([slope, slope], 0.5) == is_straight
    assert not nib._is_straight([slope, 0.4 * slope], 0.5)  # too low to tell a shape


def test_ink_that_may_be_either_is_run_once_and_told() -> None:
    """A parabola that comes back beside itself: it narrows once, as a stroke begun and ended there would."""
    found = trace_ink(inked(lissajous(1, 2, 0.58 * PEN_MM), width_mm=PEN_MM, seed=1))
    assert len(found.lines) == 1 and found.ink is not None
    assert found.ink.single and found.ink.followed_share < 0.8


def test_a_hand_that_presses_once_as_two_lines_cross_is_run_once() -> None:
    """A ring, and a stroke from side to side that narrows at a slope; taken for two lines it would
    be run twice from end to end.
    """
    turns, along = np.linspace(0, 2 * np.pi, 1500), np.linspace(0, 1, 900)
    ring = np.column_stack([35 + 15 * np.cos(turns), 30 + 15 * np.sin(turns)])
    across = np.column_stack([20 + 30 * along, 30 + np.sin(np.pi * along)])
    pressed = 1.35 + 0.3 * np.sin(turns + 1)
    narrows = 1 + np.minimum(4 * np.abs(along - 0.45), 0.7)
    pieces = [
        (way[k : k + 6], float(PEN_MM * widths[k]))
        for way, widths in ((ring, pressed), (across, narrows))
        for k in range(0, len(way) - 5, 5)
    ]
    found = trace_ink(together(*pieces, seed=1))
    assert run_mm(found) == pytest.approx(length_mm(ring) + length_mm(across), rel=0.02)
    assert found.ink is not None and len(found.ink.single) == 1


def test_only_the_stroke_that_may_be_either_is_told() -> None:
    """A hand pressed beside it: all broad ink of a sheet was told, 362 of 4340 mm of a page."""
    either = lissajous(1, 2, 0.58 * PEN_MM)
    x = np.linspace(8, 62, 2000)
    pressed = np.column_stack([x, 80 + 3 * np.sin(x / 6)])
    widths = PEN_MM * (1.3 - 0.3 * np.cos((x - 8) / 54 * 2 * np.pi))
    pieces = ((pressed[k : k + 6], float(widths[k])) for k in range(0, len(x) - 5, 5))
    found = trace_ink(together((either, PEN_MM), *pieces, seed=1))
    assert found.ink is not None and found.ink.single
    assert all(y_mm < 70 for _, y_mm, _ in found.ink.single)


@pytest.mark.parametrize("swells", [1, 2, 3])
def test_a_brush_beside_a_thin_line_is_run_once(swells: int) -> None:
    """The line as thin as the brush's thinnest ink is no reason to take what is broader for two lines."""
    x = np.linspace(8, 62, 2000)
    way = np.column_stack([x, 20 + 4 * np.sin(x / 9)])
    widths = PEN_MM * (1.4 - 0.4 * np.cos(swells * (x - 8) / 54 * 2 * np.pi))
    pieces = ((way[k : k + 6], float(widths[k])) for k in range(0, len(x) - 5, 5))
    thin = np.array([(8.0, 40.0), (62.0, 40.0)])
    found = trace_ink(together((thin, PEN_MM), *pieces, seed=1))
    # along both rims it would be run twice
    assert run_mm(found) == pytest.approx(54 + length_mm(way), rel=0.01)
    assert found.ink is not None and not found.ink.single


def test_two_lines_from_one_place_whose_other_ends_lie_side_by_side_are_both_run() -> None:
    """Their ink swells from a tip to its end, as that of a brush would that is lifted where it is broad."""
    one, other = (np.array([(8.0, 20.0), (30.0, 20.0 + off)]) for off in (0.0, 1.1 * PEN_MM))
    thin = np.array([(8.0, 40.0), (62.0, 40.0)])
    found = trace_ink(inked(one, other, thin, width_mm=PEN_MM, seed=1))
    assert run_mm(found) == pytest.approx(
        54 + 2 * 22, rel=0.02
    )  # out along one, back along the other
