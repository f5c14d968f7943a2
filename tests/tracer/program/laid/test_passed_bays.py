"""A bay that the head passed by, or ran out and back in, is laid wherever it lies; what is none is left."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import evenly, lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, WIDTH_MM, Points, inked, polyline
from tests.tracer.program.laid.ways import STEP_MM, run_along, steps_mm

PLATE = shapely.box(4, 4, 34, 20)
BAY = shapely.box(
    18.0, 17.0, 18.0 + 1.1 * WIDTH_MM, 21.0
)  # three mm deep, 1.1 lines from side to side


def outline(shape: shapely.Polygon) -> Points:
    """The outline of a shape."""
    return np.array(shape.exterior.coords)


NOTCHED = outline(PLATE.difference(BAY))
PASSED = outline(PLATE)  # as if there were no bay


def begun(way: Points, begin_mm: float, back: bool = False) -> Points:
    """A closed way begun so far along it, or run the other way round."""
    way = way[::-1] if back else way
    round_mm = lengths_mm(way)[-1]
    twice = evenly(np.vstack([way, way[1:]]), STEP_MM)
    return twice[round(begin_mm / STEP_MM) :][: round(round_mm / STEP_MM) + 1]


def mended(
    drawn: Points, line: Line, *others: Points, operator: Operator | None = None
) -> tuple[Line, list[str]]:
    """A line once its bays are mended, and what it leaves unexplained."""
    setup = Setup(inked(drawn, *others, seed=1).sheet, operator=operator or Operator())
    (new,), left = narrow_bays.explained(setup, [line])
    return new, [place.kind for place in left]


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("begin_mm", [0.0, 10.0, 31.5, 31.73, 60.0])
def test_a_bay_is_laid_wherever_the_line_begins(begin_mm: float, back: bool) -> None:
    """Also in the middle of its mouth; within 60 um, 0.7 of a pixel, and no step is longer by a um."""
    line = run_along(begun(PASSED, begin_mm, back))
    new, left = mended(NOTCHED, line)
    assert off_mm(line, NOTCHED) > 2.9 and off_mm(new, NOTCHED) < 60 * UM
    assert left == [] and new.ending == "closed"
    assert steps_mm(new).max() < STEP_MM + UM
    assert (shapely.LinearRing(new.loop_mm).is_ccw) == (shapely.LinearRing(line.loop_mm).is_ccw)


def test_a_line_that_begins_where_it_was_told_to_begins_there_still() -> None:
    """Its bay is told, and not laid, if it lies on its beginning; another one is laid."""
    told = replace(run_along(begun(PASSED, 31.73)), as_told=True)
    new, left = mended(NOTCHED, told)
    assert new is told and "ink" in left
    told = replace(run_along(begun(PASSED, 60.0)), as_told=True)
    new, left = mended(NOTCHED, told)
    assert np.array_equal(new.xy_mm[0], told.xy_mm[0]) and left == []


def test_lines_of_a_drawn_program_and_marked_ones_are_left() -> None:
    line = run_along(PASSED)
    for other in (replace(line, reference_mm=(4.0, 4.0)), replace(line, on_edge=True)):
        assert mended(NOTCHED, other)[0] is other
    assert mended(NOTCHED, line, operator=Operator(marks="on"))[0] is line


def test_several_bays_of_a_line_are_laid_at_once() -> None:
    shape, count = PLATE, 0
    for x in (8.0, 14.0, 20.0, 26.0):
        shape = shape.difference(shapely.box(x, 17.5, x + 1.1 * WIDTH_MM, 21)).union(
            shapely.box(x, 1.5, x + 1.2 * WIDTH_MM, 5)
        )
        count += 2
    new, left = mended(outline(shape), run_along(PASSED))
    assert off_mm(new, outline(shape)) < 60 * UM and left == []
    assert new.length_mm == pytest.approx(shape.exterior.length, rel=0.005)


def out_and_back(deep_mm: float) -> tuple[Points, Line]:
    """A slit so deep, hardly wider than the line, and a head that ran out and back in its middle."""
    shape = shapely.box(4, 4, 60, 34).difference(shapely.box(30, 34 - deep_mm, 30.6, 35))
    way = polyline(
        (60, 34), (30.32, 34), (30.32, 34.3 - deep_mm), (30.28, 34.3 - deep_mm), (30.28, 34)
    )
    return outline(shape), run_along(np.vstack([way, [(4, 34), (4, 4), (60, 4), (60, 34)]]))


@pytest.mark.parametrize(("deep_mm", "is_laid"), [(6.0, True), (18.0, True), (25.0, False)])
def test_a_slit_is_laid_in_which_the_head_ran_out_and_back(
    deep_mm: float, is_laid: bool
) -> None:
    """If it runs beside itself for no more than 80 widths of the line, 40 mm; longer ones are told."""
    drawn, line = out_and_back(deep_mm)
    new, _ = mended(drawn, line)
    assert (new is not line) == is_laid
    if is_laid:
        assert off_mm(new, drawn) < 80 * UM


@pytest.mark.parametrize(
    "other",
    [
        pytest.param([polyline((18.2, 20), (18.2, 17))], id="a tick"),
        pytest.param([polyline((18.2, 20), (18.2, 4))], id="a bar to the other side"),
        pytest.param([polyline((16, 19.2), (22, 19.2))], id="a line beside it"),
    ],
)  # fmt: skip
def test_what_another_line_leaves_beside_a_line_is_no_bay(other: list[Points]) -> None:
    line = run_along(PASSED)
    new, _ = mended(PASSED, line, *other)
    assert new is line


def test_a_line_along_its_ink_is_the_very_same() -> None:
    line = run_along(NOTCHED)
    new, left = mended(NOTCHED, line)
    assert new is line and left == []


def test_a_bar_that_two_lines_share_is_mended_on_the_one_it_belongs_to() -> None:
    """The other line, a hole 1.5 mm beside the notch's end, stays."""
    hole = outline(shapely.box(10, 10, 28, 15.5))
    lines = [run_along(PASSED), run_along(hole)]
    setup = Setup(inked(NOTCHED, hole, seed=1).sheet)
    (first, second), left = narrow_bays.explained(setup, lines)
    assert off_mm(first, NOTCHED) < 60 * UM and second is lines[1] and left == ()


def bent(
    first: tuple[float, float], by: tuple[float, float], last: tuple[float, float]
) -> Points:
    """A parabola from one place to another, towards a third between them."""
    t = np.linspace(0, 1, 60)[:, None]
    return (
        (1 - t) ** 2 * np.array(first) + 2 * t * (1 - t) * np.array(by) + t**2 * np.array(last)
    )


@pytest.mark.parametrize("seed", [1, 2])
def test_a_tip_with_bent_sides_that_was_cut_short_is_laid_within_its_rim(seed: int) -> None:
    """No rule of straight pieces explains it: 0.7 mm were left out, and nothing was told."""
    width_mm, plate = 0.7, [(5.0, 8.0), (5.0, 15.0)]
    up, low = bent((12, 15), (13, 12.3), (16, 12)), bent((16, 12), (13, 11.6), (12, 8))
    drawn = np.vstack([up, low[1:], plate, up[:1]])
    before, behind = up[up[:, 0] < 15], low[low[:, 0] < 15]
    cut = bent(tuple(before[-1]), (15.4, 12), tuple(behind[0]))
    line = run_along(np.vstack([before, cut[1:], behind[1:], plate, up[:1]]))
    setup = Setup(inked(drawn, width_mm=width_mm, seed=seed).sheet)
    (new,), _ = narrow_bays.explained(setup, [replace(line, width_mm=width_mm)])
    assert off_mm(line, drawn) > 0.7 and off_mm(new, drawn) < 60 * UM
