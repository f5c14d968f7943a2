"""Rings of cells, and the way felt along a line."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell, scout
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline
from tests.tracer.sensing.kernels import (
    COMPILED_AND_PLAIN,
    FINE_MM,
    WIDE_MM,
    kernel,
)

# rings


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("aside_mm", [0.0, 0.1, -0.2])
@pytest.mark.parametrize("radius_mm", [0.8, 1.0, 2.0])
def test_a_ring_on_a_line_sees_two_arcs(
    strip: Drawing, aside_mm: float, radius_mm: float, plain: bool
) -> None:
    long = Drawing(np.repeat(strip.darkness[:, :1], 1200, axis=1), FINE_MM)
    centre = np.array([3.0, 3.0 + aside_mm])
    cells = photocell.Cells(long.darkness, FINE_MM, 0.5)
    arcs = kernel(photocell.ring, plain)(cells, centre, radius_mm)
    low, high = (
        math.asin((-WIDE_MM / 2 - aside_mm) / radius_mm),
        math.asin((WIDE_MM / 2 - aside_mm) / radius_mm),
    )
    told = sorted(
        [
            (low % math.tau, high % math.tau),
            ((math.pi - high) % math.tau, (math.pi - low) % math.tau),
        ]
    )
    found = sorted((begin % math.tau, end % math.tau) for begin, end in arcs)
    assert np.array(found) == pytest.approx(np.array(told), abs=2 * FINE_MM / radius_mm)
    assert np.all(arcs[:, 1] > arcs[:, 0])


@COMPILED_AND_PLAIN
def test_a_ring_s_arcs_end_between_pixels(plain: bool) -> None:
    """Within a twentieth of a pixel, on a soft edge: a half plane under the centre gives half a ring."""
    y = 10.0 - np.arange(200) * 0.1  # the edge of a lens two pixels soft
    rows = 1 / (1 + np.exp((y - 0.55) / 0.1))
    cells = photocell.Cells(np.repeat(rows[:, None], 200, axis=1).astype(np.float32), 0.1, 0.5)
    height = len(rows) * 0.1 - 0.05 - (10.0 - 0.55)
    centre, radius_mm = np.array([10.0, height]), 1.5
    (arc_rad,) = kernel(photocell.ring, plain)(cells, centre, radius_mm)
    assert math.remainder(arc_rad[0] - math.pi, math.tau) == pytest.approx(
        0, abs=0.005 / radius_mm
    )
    assert math.remainder(arc_rad[1], math.tau) == pytest.approx(0, abs=0.005 / radius_mm)


@COMPILED_AND_PLAIN
def test_a_ring_all_dark_or_all_light(plain: bool) -> None:
    go_round = kernel(photocell.ring, plain)
    centre, black = np.array([2.0, 2.0]), np.ones((400, 400), np.float32)
    all_dark, all_light = (photocell.Cells(share * black, 0.01, 0.5) for share in (1, 0))
    assert go_round(all_dark, centre, 1.0).tolist() == [[-math.pi, math.pi]]
    assert len(go_round(all_light, centre, 1.0)) == 0


# scouting


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("radius_mm", [2.0, 5.0, 20.0])
def test_a_circle_is_felt_along_its_middle(radius_mm: float, plain: bool) -> None:
    middle = radius_mm + 2
    cells = photocell.behind_aperture(inked(arc((middle, middle), radius_mm)), 0.15)
    pose = middle + radius_mm, middle, math.pi / 2
    feel = kernel(scout.scout, plain)
    seen = feel(cells, pose, WIDTH_MM + 25 * UM, 0.05, 40)
    assert len(seen) == 40
    radial = np.hypot(*(seen[:, :2] - middle).T) - radius_mm
    assert np.abs(radial).max() < 6 * UM  # between pixels of 85 um, on a clean drawing
    assert abs(radial.mean()) < 1.5 * UM  # over 2 mm of line: two dozen pixels
    assert np.hypot(*np.diff(seen[:, :2], axis=0).T) == pytest.approx(0.05, abs=5 * UM)
    # the softness of lens, aperture and pixel widens a line at half its darkness hardly; the pen draws to 10
    # um
    assert seen[:, 2] == pytest.approx(WIDTH_MM, abs=40 * UM)


@COMPILED_AND_PLAIN
def test_feeling_stops_at_the_end_of_a_line_and_before_a_crossing(plain: bool) -> None:
    drawing = inked(polyline((2, 4), (10, 4)), polyline((6, 2), (6, 6)))
    cells = photocell.behind_aperture(drawing, 0.15)
    feel = kernel(scout.scout, plain)
    to_crossing = feel(cells, (4.0, 4.0, 0.0), WIDTH_MM, 0.05, 200)
    assert to_crossing[-1, 0] == pytest.approx(
        5.7, abs=0.1
    )  # the other line's ink begins at 5.75
    to_end = feel(cells, (7.0, 4.0, 0.0), WIDTH_MM, 0.05, 200)
    assert to_end[-1, 0] == pytest.approx(10.15, abs=0.1)  # the round of the pen ends at 10.25
    assert (
        np.abs(to_end[:-4, 1] - 4).max() < 6 * UM
    )  # a line along the pixels: they do not average out
    nowhere = feel(cells, (3.0, 6.0, 0.0), WIDTH_MM, 0.05, 200)
    assert len(nowhere) == 0


def test_a_speck_is_passed_over() -> None:
    drawing = inked(polyline((2, 4), (10, 4)), specks=[arc((6, 4.3), 0.08)])
    cells = photocell.behind_aperture(drawing, 0.15)
    seen = scout.scout(cells, (4.0, 4.0, 0.0), WIDTH_MM + 25 * UM, 0.05, 80)
    assert seen[-1, 0] > 7.5
    assert (
        np.abs(seen[:, 1] - 4).max() < 0.08
    )  # what is taken of the speck's edge stays below its half width


@settings(max_examples=15)
@given(
    heading=st.floats(-math.pi, math.pi),
    shift=st.tuples(st.floats(0, 0.0847), st.floats(0, 0.0847)),
)
def test_what_is_felt_moves_and_turns_with_the_line(
    heading: float, shift: tuple[float, float]
) -> None:
    way = np.array([math.cos(heading), math.sin(heading)])
    middle = np.array([8.0, 8.0]) + shift
    drawing = inked(np.array([middle - 4 * way, middle + 4 * way]))
    cells = photocell.behind_aperture(drawing, 0.15)
    x, y = middle - way
    seen = scout.scout(cells, (x, y, heading), WIDTH_MM + 25 * UM, 0.05, 40)
    assert len(seen) == 40
    aside = (seen[:, :2] - middle) @ np.array([-way[1], way[0]])
    assert np.abs(aside).max() < 5 * UM  # between pixels of 85 um
