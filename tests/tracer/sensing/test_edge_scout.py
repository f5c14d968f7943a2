"""The scout along the edges of filled shapes, against their outlines."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.sensing import edge_scout, photocell
from morfax.tracer.sensing.photocell import Cells
from tests.tracer.inked import OVERSAMPLE, arc, inked, polyline

PITCH_MM = 25.4 / 300
STEP_MM = 0.35 * PITCH_MM
CENTRE = (8.0, 8.0)
# a filled outline is inked half a fine pixel beyond itself
SCAN_NOISE = 0.01  # of the darkness of a usual scan
BEYOND_MM = PITCH_MM / OVERSAMPLE / 2
EDGE_MM = 0.1 * PITCH_MM  # of a clean drawing, straight between pixels

COMPILED_AND_PLAIN = pytest.mark.parametrize("plain", [False, True], ids=["compiled", "plain"])


def kernel(function: Any, plain: bool) -> Callable[..., Any]:
    return function.py_func if plain else function


def filled(outline: Array) -> Cells:
    """What point cells see of a filled shape."""
    drawing = inked(polyline((12.0, 12.0), (12.1, 12.0)), width_mm=0.05, specks=[outline])
    return photocell.Cells(drawing.darkness, drawing.pitch_mm, 0.5)


def place_on(radius_mm: float, angle: float) -> tuple[float, float]:
    return CENTRE[0] + radius_mm * math.cos(angle), CENTRE[1] + radius_mm * math.sin(angle)


@COMPILED_AND_PLAIN
def test_the_mean_and_fundamental_of_a_circle_on_a_ramp_are_its_closed_form(
    plain: bool,
) -> None:
    """Darkness a + b·x + c·y: the mean is that of the middle, the fundamental r·(b, c)."""
    columns = np.arange(40) + 0.5
    ramp = (0.2 + 0.01 * columns[None, :] + 0.005 * (40 - columns[:, None])).astype(np.float32)
    cells = Cells(ramp, PITCH_MM, 0.5)
    found = kernel(edge_scout.circle, plain)(cells, 20 * PITCH_MM, 12 * PITCH_MM)
    radius_px = edge_scout.CIRCLE_PX
    told = 0.2 + 0.01 * 20 + 0.005 * 12, 0.01 * radius_px, 0.005 * radius_px
    assert found == pytest.approx(told, abs=1e-6)  # float32 darkness


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("off_px", [-0.8, -0.3, 0.0, 0.4, 0.8])
def test_the_nearest_place_of_an_edge_is_found_with_the_way_into_the_shape(
    off_px: float, plain: bool
) -> None:
    cells = filled(arc(CENTRE, 3.0 - BEYOND_MM))
    for angle in np.arange(0, 6.28, 0.4):
        x, y = place_on(3.0 + off_px * PITCH_MM, angle)
        found_x, found_y, inward_x, inward_y, size = kernel(edge_scout.onto_edge, plain)(
            cells, x, y
        )
        assert math.hypot(found_x - CENTRE[0], found_y - CENTRE[1]) == pytest.approx(
            3.0, abs=EDGE_MM
        )
        # a circle of 0.8 px sees the way within 3 degrees
        assert inward_x * -math.cos(angle) + inward_y * -math.sin(angle) > math.cos(
            math.radians(3)
        )
        assert size > edge_scout.CERTAIN


def test_there_is_no_edge_on_paper_within_ink_or_where_it_is_as_faint_as_noise() -> None:
    cells = filled(arc(CENTRE, 3.0 - BEYOND_MM))
    for place in (CENTRE, (1.0, 1.0)):
        assert math.isnan(edge_scout.onto_edge(cells, *place)[0])
    for contrast, is_seen in ((1.3, True), (0.7, False)):
        # a ramp whose fundamental is so many times four standard deviations of a scan's noise
        slope = contrast * 4 * SCAN_NOISE / edge_scout.CIRCLE_PX
        ramp = 0.5 + slope * (np.arange(40) - 19.5)
        faint = Cells(np.repeat(ramp[None, :], 40, axis=0).astype(np.float32), PITCH_MM, 0.5)
        assert (
            math.isfinite(edge_scout.onto_edge(faint, 20 * PITCH_MM, 20 * PITCH_MM)[0])
            == is_seen
        )


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("way", [1, -1])
def test_a_disc_is_gone_round_on_its_edge_step_by_step(way: int, plain: bool) -> None:
    """With the shape to the left, or to the right."""
    cells = filled(arc(CENTRE, 3.0 - BEYOND_MM))
    x, y = place_on(3.0, 0.5)
    count = int(math.tau * 3.0 / STEP_MM) // 2
    seen = kernel(edge_scout.along_edge, plain)(
        cells, (x, y, 0.5 + way * math.pi / 2), STEP_MM, count
    )
    assert len(seen) == count
    radii = np.hypot(*(seen[:, :2] - CENTRE).T)
    assert np.abs(radii - 3.0).max() < EDGE_MM
    steps = np.hypot(*np.diff(seen[:, :2], axis=0).T)
    assert steps == pytest.approx(STEP_MM, rel=0.05)
    turned = np.unwrap(np.arctan2(*(seen[:, :2] - CENTRE).T[::-1]))
    assert np.all(np.diff(turned) * way > 0)
    assert turned[-1] - turned[0] == pytest.approx(way * (count - 1) * STEP_MM / 3.0, rel=0.01)


@pytest.mark.parametrize("corner_deg", [90.0, 60.0, 25.0, 12.0])
def test_the_scout_goes_round_tips_as_sharp_as_the_lens_shows_them(corner_deg: float) -> None:
    """Along one side of a wedge, round its tip and back along the other side, always on the edge."""
    half = math.radians(corner_deg / 2)
    tip = np.array([9.0, 8.0])
    sides = [tip + 5 * np.array([-math.cos(half), s * math.sin(half)]) for s in (-1, 1)]
    cells = filled(np.array([sides[0], tip, sides[1]]))
    start, way = tip - 2.5 * np.array([math.cos(half), math.sin(half)]), half
    seen = edge_scout.along_edge(cells, (*start, way), STEP_MM, int(5.5 / STEP_MM))
    beyond = [_aside(place, tip, half) for place in seen[:, :2]]
    # the lens rounds the tip: beyond 1 mm of it nothing is off by more than an edge's own error
    far = np.hypot(*(seen[:, :2] - tip).T) > 1.0
    assert np.abs(np.array(beyond)[far]).max() < EDGE_MM
    assert seen[0, 1] < tip[1] - 0.1 and seen[-1, 1] > tip[1] + 0.1
    assert np.hypot(*np.diff(seen[:, :2], axis=0).T).max() < edge_scout.LONGEST * STEP_MM + 1e-9


def _aside(place: Array, tip: Array, half: float) -> float:
    """How far a place is from the nearer side of a wedge that opens to the left."""
    x, y = tip - place
    return abs(x * math.sin(half) - abs(y) * math.cos(half) + BEYOND_MM)


def test_where_an_edge_ends_the_scout_stops() -> None:
    """A shape that fades to paper along its edge."""
    darkness = np.zeros((60, 80), np.float32)
    darkness[:30] = np.clip((60 - np.arange(80)) / 20, 0, 1)
    cells = Cells(cv2.GaussianBlur(darkness, (0, 0), 0.6), PITCH_MM, 0.5)
    pose = 5 * PITCH_MM, 30 * PITCH_MM, 0.0
    seen = edge_scout.along_edge(cells, pose, STEP_MM, 400)
    assert 40 * PITCH_MM < seen[:, 0].max() < 60 * PITCH_MM


@COMPILED_AND_PLAIN
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("off_deg", [-4.0, 1.0, 3.0])
def test_round_about_a_place_the_edge_goes_on_where_the_circle_meets_it(
    side: int, off_deg: float, plain: bool
) -> None:
    """On a ramp of darkness whose level of a half runs at 30 degrees, whatever the heading to begin with."""
    along = math.radians(30)
    into = along + side * math.pi / 2
    x = np.arange(40) + 0.5
    y = 40 - x[:, None]
    ramp = 0.5 + 0.02 * ((x - 20) * math.cos(into) + (y - 20) * math.sin(into))
    cells = Cells(ramp.astype(np.float32), PITCH_MM, 0.5)
    here, step_mm = 20 * PITCH_MM, 5 * PITCH_MM
    pose = here, here, along + math.radians(off_deg)
    found = kernel(edge_scout._round_about, plain)(cells, pose, side, step_mm)
    told = here + step_mm * math.cos(along), here + step_mm * math.sin(along)
    # the sine of a turn of ten degrees is straight within 4e-4 of it
    assert found == pytest.approx(told, abs=4e-4 * step_mm)
