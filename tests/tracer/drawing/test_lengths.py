"""Lengths: what a reader is told of a line that was not followed is true, whatever its angle and its pen.

Broken on purpose, with the width by depths, with whole pixels, or without the round ends of open lines, tests
here fail.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import cv2
import numpy as np
import pytest

from morfax.motion.polyline import length_mm
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing import lengths
from morfax.tracer.drawing.components import INK, runs_of
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.lengths import told as told_of
from morfax.tracer.drawing.reading import Reading
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.strokes import Sheet
from tests.tracer.inked import Points, arc, inked, polyline, together

# slanting, at two angles; steep; round; closed, with corners; along the pixels, where two edges of six pixels
# fall anywhere between two
LINES = (
    polyline((5, 5), (35, 13)),
    polyline((5, 20), (25, 38)),
    polyline((42, 5), (50, 40)),
    arc((65.0, 15.0), 8.0),
    polyline((60, 30), (78, 33), (66, 46), (60, 30)),
    polyline((5.03, 33.4), (14.07, 33.4), (14.07, 39.45), (5.03, 39.45), (5.03, 33.4)),
)


def told(*drawn: tuple[Points, float]) -> list[float]:
    """The lengths that are told of some lines, each of a pen, in their order, mm."""
    return told_on(together(*drawn, seed=3), [line for line, _ in drawn])


def told_on(drawing: Drawing, lines: Sequence[Points]) -> list[float]:
    """The lengths that are told of some lines of a drawing, mm."""
    sheet = Sheet.of(drawing)
    lengths_mm = told_of(sheet).lengths_mm
    return [float(lengths_mm[sheet.patch_at(line[0])]) for line in lines]


@pytest.mark.parametrize("width_mm", [0.35, 0.5, 0.9])
@pytest.mark.parametrize("dpi", [200.0, 300.0, 600.0])
def test_lengths_are_true_at_any_angle_width_and_resolution(
    width_mm: float, dpi: float
) -> None:
    true_mm = [length_mm(line) for line in LINES]
    seen = told_on(inked(*LINES, width_mm=width_mm, dpi=dpi, seed=3), LINES)
    # the ink that both legs of a corner share: 1 % of the pointed one with the broad pen; and noise
    tolerance = 0.015 if width_mm * dpi > 4 * MM_PER_INCH else 0.02
    assert seen == pytest.approx(true_mm, rel=tolerance)


@pytest.mark.parametrize("dpi", [200.0, 300.0, 600.0])
def test_lines_of_one_pen_are_told_alike_wide_at_any_angle(dpi: float) -> None:
    sheet = Sheet.of(inked(*LINES, width_mm=0.5, dpi=dpi, seed=3))
    widths_mm = told_of(sheet).widths_mm[[sheet.patch_at(line[0]) for line in LINES]]
    # by depths they differ by 10 % at 300 dpi
    assert widths_mm == pytest.approx(np.median(widths_mm), rel=0.01)
    assert np.median(widths_mm) == pytest.approx(0.5, abs=0.3 * MM_PER_INCH / dpi)


def test_a_line_of_a_broad_pen_among_others_is_not_told_longer() -> None:
    broad = polyline((5, 52), (75, 55))
    *_, seen_mm = told(*((line, 0.4) for line in LINES), (broad, 0.8))
    assert seen_mm == pytest.approx(length_mm(broad), rel=0.01)


def test_a_dot_is_as_long_as_it_is_wide() -> None:
    dot = polyline((70, 5), (70.1, 5))
    *_, seen_mm = told(*((line, 0.5) for line in LINES), (dot, 0.5))
    assert seen_mm == pytest.approx(0.5, abs=0.1)  # a pixel is 0.085 mm


def test_the_edges_of_filled_shapes_are_as_long_as_they_are() -> None:
    """A disc with a square hole, whose sides lie along the pixels."""
    grey = np.full((700, 700), 240, np.uint8)
    cv2.circle(grey, (350, 350), 280, 40, -1, cv2.LINE_AA)
    cv2.rectangle(grey, (250, 250), (450, 450), 240, -1)
    scan = Scan(Path("made.png"), grey, Stated((300.0, 300.0)))
    sheet = Sheet.of(Drawing.of(scan, Scale(), reading=Reading(edge=True)))
    px_mm = MM_PER_INCH / 300
    true_mm = [math.tau * 280.5 * px_mm, 4 * 201 * px_mm]  # to the middles of the pixels' edges
    assert sorted(told_of(sheet).lengths_mm, reverse=True) == pytest.approx(true_mm, rel=0.005)


@pytest.mark.parametrize("degrees", [0.0, 20.0, 35.0, 90.0])
@pytest.mark.parametrize("kernel", [lengths._move_edges, lengths._move_edges.py_func])
def test_areas_reach_to_edges_between_pixels_at_any_angle(
    kernel: Callable[..., None], degrees: float
) -> None:
    """A band of 4.3 pixels across a whole window, its edges two pixels soft."""
    angle, middle, wide = math.radians(degrees), 30.21, 4.3
    rows, columns = np.mgrid[:61, :61]
    aside = (columns - middle) * math.cos(angle) + (rows - middle) * math.sin(angle)
    seen = np.clip(0.5 - (np.abs(aside) - 0.5 * wide) / 2, 0, 1).astype(np.float32)
    row, begin, end = runs_of(seen > INK, 0)
    areas = np.array([float((end - begin).sum())])
    kernel(seen, row, begin, end, np.zeros(len(row), int), areas)
    # the band leaves the window at two slanting ends, where pixels are whole: one of some 61
    assert areas[0] == pytest.approx(
        wide * 61 / max(math.cos(angle), math.sin(angle)), rel=0.01
    )
