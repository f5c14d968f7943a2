"""The line that is taken of a net: its longest closed outline, the same at any angle, size and resolution."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import area_mm2, length_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, loops, polyline

PLATE = polyline((8, 8), (40, 8), (44, 26), (26, 38), (8, 30), (8, 8))
BARS = polyline((8, 16), (42, 17)), polyline((22, 8), (22, 36.2))
SPUR = polyline((44, 26), (48, 30))
SMALL, LARGE = arc((22, 24), 9), arc((32, 22), 11)


def taken(*lines: Points, dpi: float = 300, width_mm: float = WIDTH_MM) -> Line:
    """The line that is taken of a sheet."""
    return trace(inked(*lines, dpi=dpi, width_mm=width_mm, seed=3)).lines[0]


def lies_on(line: Line, truth: Points, within_mm: float) -> bool:
    """Whether a line runs all along a true one and nowhere else."""
    way, drawn = shapely.LineString(line.xy_mm[::20]), shapely.LineString(truth)
    return bool(way.hausdorff_distance(drawn) < within_mm)


def test_round_the_outside_and_not_along_bars_or_spurs() -> None:
    line = taken(PLATE, *BARS, SPUR)
    assert line.ending == "closed"
    assert lies_on(line, PLATE, 0.15)  # the pen's corners
    assert len(line.junctions_mm) == 5


def test_of_circles_that_overlap_the_longest_as_the_pen_drew_it() -> None:
    line = taken(SMALL, LARGE)
    assert line.ending == "closed" and lies_on(line, LARGE, 0.05)


def test_a_net_counts_by_its_longest_outline_and_not_by_all_its_ink() -> None:
    """The plate's net has 182 mm of ink, and an outline of 114 mm."""
    longer = arc((70.0, 24.0), 120 / math.tau)
    line = taken(PLATE, *BARS, SPUR, longer)
    assert line.ending == "closed" and lies_on(line, longer, 0.05)


@pytest.mark.parametrize("angle, size, dpi", [(17, 1.0, 300), (63, 0.8, 450), (200, 1.4, 200)])
def test_the_same_line_at_any_angle_size_and_resolution(
    angle: float, size: float, dpi: float
) -> None:
    c, s = size * math.cos(math.radians(angle)), size * math.sin(math.radians(angle))
    every = [line @ np.array([[c, s], [-s, c]]) for line in (PLATE, *BARS, SPUR)]
    moved = np.vstack(every).min(axis=0) - 6
    every = [line - moved for line in every]
    line = taken(*every, dpi=dpi, width_mm=size * WIDTH_MM)
    assert line.ending == "closed" and lies_on(line, every[0], 0.2 * size)


@pytest.mark.parametrize("direction", ["cw", "ccw"])
def test_the_way_round_that_is_asked_for(direction: str) -> None:
    drawing = inked(SMALL, LARGE, seed=3)
    line = trace(drawing, operator=Operator(direction=direction)).lines[0]  # type: ignore[arg-type]
    assert (area_mm2(line.xy_mm) > 0) == (direction == "ccw")


def test_a_longer_line_beside_the_net_goes_before_it() -> None:
    round_all = polyline((3, 3), (50, 3), (50, 45), (3, 45), (3, 3))
    line = taken(round_all, PLATE, *BARS)
    assert lies_on(line, round_all, 0.15)


@pytest.mark.parametrize("apart_mm", [12.0, 7.0])
def test_a_signature_is_run_as_the_stroke_that_it_is_and_not_round_its_longest_loop(
    apart_mm: float,
) -> None:
    way = loops(5, apart_mm)
    line = taken(way)
    assert line.ending == "ended"
    assert line.length_mm == pytest.approx(length_mm(way), rel=0.01)
    assert lies_on(line, way, 0.2 * WIDTH_MM)


def test_an_outline_whose_pen_overshot_its_start_is_still_closed() -> None:
    way = polyline((15, 20), (50, 20), (50, 45), (20, 45), (20, 12), (28, 12), (28, 24))
    assert taken(way).ending == "closed"


def hatched(box: Points, apart_mm: float) -> list[Points]:
    """A rectangle, hatched at 45 degrees."""
    (left, low), (right, high) = box[0], box[2]
    lines = [box]
    for along in np.arange(left - (high - low) + apart_mm, right - 0.1, apart_mm):
        x = max(along, left), min(along + high - low, right)
        lines.append(polyline((x[0], low + x[0] - along), (x[1], low + x[1] - along)))
    return lines


@pytest.mark.parametrize("inside", ["bars", "hatching"])
def test_of_several_contours_too_the_outline_goes_before_a_way_through_its_inside(
    inside: str,
) -> None:
    outline = (
        PLATE if inside == "bars" else polyline((8, 8), (48, 8), (48, 38), (8, 38), (8, 8))
    )
    lines = [PLATE, *BARS] if inside == "bars" else hatched(outline, 4.0)
    found = trace_lines(inked(*lines, seed=3)).lines
    (first,) = [line for line in found if line.number == 1]
    assert first.ending == "closed" and lies_on(first, outline, 0.15)
