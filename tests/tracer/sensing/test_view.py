"""What a head sees of its line: through larger cells, across a way, and how far it feels."""

from __future__ import annotations

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import LEVEL
from morfax.tracer.sensing.view import View
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline

ALONG_PIXELS_MM = 6 * UM  # a line along pixels of 85 um is seen 5 um off its middle


def view(drawing: Drawing) -> View:
    """As a head sees the drawing that stands on a line of 0.5 mm."""
    return View(photocell.behind_aperture(drawing, 0.15), WIDTH_MM + 25 * UM)


@pytest.mark.parametrize("on_edge", [False, True])
def test_a_line_is_felt_by_steps_for_the_length_that_is_asked_for(on_edge: bool) -> None:
    """Stations at both ends; a step of 50 um or 0.6 px on a line, of 0.35 px on an edge."""
    eyes = replace(view(inked(polyline((4, 5), (16, 5)))), on_edge=on_edge)
    step_mm = eyes.step_mm
    assert step_mm == pytest.approx(0.35 * eyes.pitch_mm if on_edge else 0.6 * eyes.pitch_mm)
    start = np.array([6.0, 5.0 - (0.25 if on_edge else 0)])
    for length_mm in (0.0, 1.0, 2.0):
        seen = eyes.feel(start, 0.0, length_mm)
        count = max(4, round(length_mm / step_mm) + 1)
        assert len(seen) == count
        assert seen[-1, 0] - seen[0, 0] == pytest.approx(
            (count - 1) * step_mm, abs=ALONG_PIXELS_MM
        )
    assert (seen[:, 2] == eyes.width_mm).all() == on_edge
    edge = eyes.feel_edge(np.array([6.0, 4.75]), 0.0, 1.0)
    assert len(edge) == round(1.0 / step_mm) + 1
    assert edge[:, 1] == pytest.approx(4.75, abs=20 * UM)  # a round pen draws to 10 um


def test_a_fine_scan_is_felt_by_50_um_and_a_leg_has_pixels_enough() -> None:
    eyes = view(inked(polyline((4, 5), (8, 5)), dpi=600))
    assert eyes.step_mm == 0.05
    assert eyes.leg_mm == 1.2
    coarse = replace(eyes, cells=eyes.cells._replace(pitch_mm=0.2))
    assert coarse.leg_mm == pytest.approx(12 * 0.2)
    assert replace(coarse, on_edge=True).leg_mm == 1.2
    assert replace(eyes, width_mm=2.0).leg_mm == 3.0


@pytest.mark.parametrize("aside_mm", [0.0, 0.15, -0.2])
def test_a_line_is_seen_across_a_way_beside_it(aside_mm: float) -> None:
    """A way beside a circle gives the circle's own middle and width, one station a step, none at its ends."""
    eyes = view(inked(arc((10, 10), 5.0)))
    angle = np.linspace(0.2, 1.6, 400)
    way = (5.0 + aside_mm) * np.column_stack([np.cos(angle), np.sin(angle)]) + 10
    seen = eyes.feel_along(way)
    radii = np.hypot(*(seen[:, :2] - 10).T)
    assert np.abs(radii - 5.0).max() < ALONG_PIXELS_MM
    assert seen[:, 2] == pytest.approx(WIDTH_MM, abs=40 * UM)
    length_mm = 1.4 * (5.0 + aside_mm)
    assert len(seen) == pytest.approx(length_mm / eyes.step_mm - 2, abs=1)
    assert len(eyes.feel_along(way[:2])) == 0


def test_a_width_that_differs_by_a_fifth_is_not_the_line_across_a_way() -> None:
    eyes = view(inked(polyline((4, 5), (16, 5))))
    way = np.column_stack([np.arange(5, 15, 0.05), np.full(200, 5.0)])
    for width_mm, is_seen in ((0.44, True), (0.60, True), (0.40, False), (0.66, False)):
        assert (len(replace(eyes, width_mm=width_mm).feel_along(way)) > 0) == is_seen


def test_an_edge_is_found_with_the_shape_to_the_left() -> None:
    eyes = view(inked(polyline((16, 16), (16.1, 16)), specks=[arc((10, 10), 4.0)]))
    for angle in np.arange(0, 6, 0.7):
        outward = np.array([math.cos(angle), math.sin(angle)])
        place, heading = eyes.edge_at(10 + 4.05 * outward) or (np.zeros(2), 0.0)
        assert np.hypot(*(place - 10)) == pytest.approx(4.0, abs=0.1 * eyes.pitch_mm)
        turned = math.remainder(heading - (angle + math.pi / 2), math.tau)
        assert abs(turned) < math.radians(3)
    assert eyes.edge_at(np.array([10.0, 10.0])) is None


@pytest.mark.parametrize("short_mm", [0.1, 0.7])
def test_ink_goes_on_to_its_end_from_wherever_it_is_asked(short_mm: float) -> None:
    """The round of the pen ends half a width beyond where it was lifted."""
    eyes = view(inked(polyline((4, 5), (10, 5))))
    place = np.array([10.25 - short_mm, 5.0])
    assert eyes.ink_along(place, 0.0, 2.0) == pytest.approx(short_mm, abs=20 * UM)
    assert math.isnan(eyes.ink_along(place, math.pi, 2.0))  # farther than that


def test_the_usual_width_follows_by_a_tenth_of_how_far_the_width_differs() -> None:
    eyes = view(inked(polyline((4, 5), (16, 5)), width_mm=0.62))
    found = eyes.like(np.array([9.0, 5.0]), 0.0)
    told = eyes.width_mm + 0.1 * (found.width_mm - eyes.width_mm)
    assert found.usual_mm == pytest.approx(told, abs=1e-9)


def test_larger_cells_about_a_place_see_as_far_as_is_asked() -> None:
    """Every pixel within that is what it is of the whole sheet; so are those at the sheet's own edges."""
    drawing = inked(polyline((1, 1), (12, 12)), polyline((1, 12), (12, 1)))
    cells = photocell.behind_aperture(drawing, 0.15)
    whole = cv2.GaussianBlur(cells.darkness, (0, 0), 2.0)
    rows, columns = whole.shape
    for place in (
        [6.0, 6.0],
        [0.2, 0.2],
        [columns * cells.pitch_mm - 0.2, rows * cells.pitch_mm - 0.2],
    ):
        seen = cells.wider(2.0, np.array([place]), 1.5).window(0, rows, 0, columns)
        x, y = np.meshgrid(np.arange(columns) + 0.5, rows - np.arange(rows) - 0.5)
        near = np.hypot(x * cells.pitch_mm - place[0], y * cells.pitch_mm - place[1]) < 1.5
        # the same but for how a spot is cut off at the end of its skirts
        assert seen[near] == pytest.approx(whole[near], abs=2e-3)


def test_larger_cells_average_the_grain_of_a_pencil() -> None:
    """Half of the line's pixels are bare: point cells lose its edges, larger ones have width and level."""
    clean = inked(polyline((4, 5), (16, 5)))
    bare = np.random.default_rng(2).uniform(size=clean.darkness.shape) < 0.5
    grainy = view(Drawing(np.where(bare, 0, clean.darkness).astype(np.float32), clean.pitch_mm))
    places = np.column_stack([np.arange(6, 9, 0.05), np.full(60, 5.0), np.full(60, WIDTH_MM)])
    larger = grainy.through_larger(places, 0.0, lambda _: 3.0)
    # a cell of 0.4 widths, the aperture and the lens together; half of the ink is bare
    spread_mm = math.hypot(0.4 * grainy.width_mm, 0.15 / 4, 0.05)
    middle = math.erf(WIDTH_MM / 2 / spread_mm / math.sqrt(2))
    assert larger.level == pytest.approx(0.3 * 0.5 * middle, rel=0.1)
    # the soft line is as dark as 0.3 of its middle 0.416 mm to either side
    assert larger.width_mm == pytest.approx(2 * 0.416, rel=0.05)
    seen = larger.feel(np.array([9.0, 5.0]), 0.0, 1.5)
    assert len(seen) > 25
    assert np.abs(seen[:, 1] - 5).max() < 0.1 * WIDTH_MM
    paper = grainy.through_larger(places + np.array([0, 2.5, 0]), 0.0, lambda _: 3.0)
    assert paper is grainy


def test_lines_swell_and_fade() -> None:
    """The width and darkness of a line are taken anew where it is met again, but only if it is like the line
    followed.
    """
    wider = inked(polyline((4, 5), (16, 5)), width_mm=0.62)
    found = view(wider).like(np.array([9.0, 5.0]), 0.0)
    assert found.width_mm == pytest.approx(0.62, abs=40 * UM)
    faint = Drawing(0.6 * inked(polyline((4, 5), (16, 5))).darkness, wider.pitch_mm)
    assert view(faint).like(np.array([9.0, 5.0]), 0.0).level >= LEVEL * 0.5
    other = view(inked(polyline((4, 6), (16, 6)), width_mm=1.5))
    assert other.like(np.array([9.0, 6.0]), 0.0) is other
