"""Stalks, slits, keyholes and necks: an outline that nearly touches itself is one line, as it is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.program.laid import bridges
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.laid.ways import run_along

WIDTH_MM = 0.5
UM = 1e-3


def contours(*drawn: Points) -> list[Line]:
    """The contours of a sheet."""
    return list(trace_lines(inked(*drawn, width_mm=WIDTH_MM, dpi=300, seed=1)).lines)


def points_of(shape: shapely.Polygon) -> Points:
    """The outline of a shape."""
    return polyline(*((float(x), float(y)) for x, y in shape.exterior.coords))


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


def bent(radius_mm: float, wide_mm: float) -> shapely.Polygon:
    """A strip of a width along a third of a circle about (20, 12), with round ends."""
    angles = np.linspace(0.6, 2.6, 80)
    middle = np.column_stack([20 + radius_mm * np.cos(angles), 12 + radius_mm * np.sin(angles)])
    return shapely.LineString(middle).buffer(0.5 * wide_mm, quad_segs=16)


def disc(x: float, y: float, radius_mm: float) -> shapely.Polygon:
    """A disc."""
    return shapely.Point(x, y).buffer(radius_mm, quad_segs=90)


def bar(wide_mm: float, x: float, y: float, u: float, v: float) -> shapely.Polygon:
    """A straight strip of a width from place to place."""
    return shapely.LineString([(x, y), (u, v)]).buffer(0.5 * wide_mm, cap_style="flat")


def shapes(wide_mm: float) -> dict[str, shapely.Polygon]:
    """Shapes with two sides so near to each other."""
    plate = shapely.box(5, 5, 40, 25)
    return {
        "bent stalk": disc(31, 18.5, 6).union(bent(12, wide_mm)),
        "bent slit": plate.difference(bent(8, wide_mm)).difference(bar(wide_mm, 26.6, 16.52, 36.5, 2.0)),
        "keyhole": plate.difference(disc(15, 14, 4)).difference(bar(wide_mm, 15, 14, 45, 16)),
        "slit ring": disc(20, 15, 11).difference(disc(20, 15, 8)).difference(bar(wide_mm, 20, 15, 33, 20)),
        "neck": disc(12, 15, 6).union(disc(30, 15, 7)).union(bar(wide_mm, 12, 15, 30, 15)),
    }  # fmt: skip


@pytest.mark.parametrize("widths", [0.5, 0.9, 1.2])
@pytest.mark.parametrize("name", list(shapes(1.0)))
def test_an_outline_that_nearly_touches_itself_is_one_line(name: str, widths: float) -> None:
    """Within 0.1 mm, a pixel and a bit of 300 dpi; without the bar it is off by several mm."""
    truth = points_of(shapes(widths * WIDTH_MM)[name])
    (line,) = contours(truth)
    assert line.ending == "closed" and off_mm(line, truth) < 100 * UM


def test_the_head_follows_the_lines_that_a_bar_joins() -> None:
    """Only the sides of the bar are run from memory: twice 21 mm, and a leg at each of their ends."""
    (line,) = contours(points_of(shapes(0.5 * WIDTH_MM)["keyhole"]))
    redrawn_mm = line.led.lengths_mm(line.xy_mm)[REDRAWN]
    assert 2 * 20 < redrawn_mm < 2 * 26


def test_a_bar_of_one_line_between_two_is_none() -> None:
    ring, hole = points_of(disc(20, 15, 11)), points_of(disc(20, 15, 5))
    lines = contours(ring, hole, polyline((25, 15), (31, 15)))
    assert sorted(round(line.length_mm / math.tau) for line in lines) == [5, 11]


def test_a_bar_of_a_broader_pen_is_none_where_that_pen_has_drawn_a_line() -> None:
    """The bar is 0.7 mm broad, and so is a line that stands alone."""
    broad = (polyline((25, 15), (31, 15)), polyline((5, 28), (35, 28)))
    twice = [
        polyline(*((x, y + side * 0.1) for x, y in way)) for way in broad for side in (1, -1)
    ]
    ring, hole = points_of(disc(20, 15, 11)), points_of(disc(20, 15, 5))
    closed = [line for line in contours(ring, hole, *twice) if line.ending == "closed"]
    assert len(closed) == 2


RING, OTHER = points_of(disc(12, 15, 6)), points_of(disc(30, 15, 7))


def bars_of(*between: Points) -> list[Points]:
    """The places of the bars between two rings, along which no line runs."""
    drawing = inked(RING, OTHER, *between, width_mm=WIDTH_MM, dpi=300, seed=1)
    lines = [run_along(RING), run_along(OTHER)]
    return list(bridges._bars(drawing, lines, lines))


def test_the_ink_between_lines_is_a_bar_and_what_a_line_runs_along_is_none() -> None:
    """From line to line, but for the ink of the lines themselves, and a bit more than that."""
    assert bars_of() == []
    (bar,) = bars_of(polyline((18, 15), (23, 15)))
    assert np.abs(bar[:, 1] - 15).max() < 0.5 * WIDTH_MM + 0.1
    low, high = bar[:, 0].min(), bar[:, 0].max()
    assert low == pytest.approx(18 + 0.65 * WIDTH_MM, abs=0.15)
    assert high == pytest.approx(23 - 0.65 * WIDTH_MM, abs=0.15)


@pytest.mark.parametrize("side_mm", [0.1, 0.25, 0.6])
def test_a_flaw_of_the_ink_is_no_bar(side_mm: float) -> None:
    """Smaller than a third of the line is broad, each way; not one that reaches far."""
    speck = polyline(
        (20, 15), (20 + side_mm, 15), (20 + side_mm, 15 + side_mm), (20, 15 + side_mm)
    )
    drawing = inked(RING, OTHER, width_mm=WIDTH_MM, dpi=300, seed=1, specks=[speck])
    lines = [run_along(RING), run_along(OTHER)]
    assert len(list(bridges._bars(drawing, lines, lines))) == (side_mm > 0.2)


@pytest.mark.parametrize("from_deg", [0, 45, 179, 300])
def test_a_bar_joins_a_line_at_its_mouth_wherever_the_line_begins(from_deg: float) -> None:
    """A bar to the right of a ring that is run counter-clockwise, and of one that is run clockwise; a leg of
    2 mm before and behind it.
    """
    bar = np.column_stack([np.linspace(18.4, 22, 50), np.full(50, 15.0)])
    for turn, is_left in ((1, False), (-1, True)):
        ring = arc((12, 15), 6, from_deg, from_deg + 360)[::turn]
        line = run_along(ring)
        mouth = bridges._mouth(line, bar, 2.0)
        assert mouth is not None and mouth.is_left == is_left
        reach_mm = 2.0 + math.sqrt(WIDTH_MM**2 - 0.4**2)
        for at, side in ((mouth.first, -turn), (mouth.last, turn)):
            angle = math.atan2(*(line.places_mm[at] - [12, 15])[::-1])
            assert angle * 6 * side == pytest.approx(reach_mm, abs=0.12)


def test_a_bar_along_most_of_a_line_and_one_far_off_have_no_mouth() -> None:
    line = run_along(RING)
    assert bridges._mouth(line, arc((12, 15), 6.3, 0, 200), 1.0) is None
    assert bridges._mouth(line, arc((12, 15), 6.3, 0, 60), 1.0) is not None
    assert bridges._mouth(line, polyline((19, 15), (22, 15)), 1.0) is None
    # with legs of a quarter of the ring on either side it is half of it
    assert bridges._mouth(line, polyline((18.4, 15), (22, 15)), 9.6) is None


def test_the_middle_half_of_a_way_has_no_ends() -> None:
    way = np.column_stack([np.arange(40.0), np.zeros(40)])
    assert np.array_equal(bridges._middle_half(way), way[10:30])
