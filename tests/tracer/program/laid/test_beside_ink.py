"""Where the head ran from memory beside its ink it is bent onto it, wherever that is on the line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import lengths_mm
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL, MEMORY, REDRAWN, Led
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.laid.bent import bent
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, WIDTH_MM, Points, inked, polyline, together
from tests.tracer.program.laid.ways import STEP_MM, run_along, steps_mm

RADIUS_MM = 0.9  # of the reliefs, 1.8 widths


def slotted(*at_mm: float) -> Points:
    """A plate with slots of 5 mm in its upper side, and a relief about each inner corner; a little turned."""
    plate = shapely.box(4, 4, 44, 20)
    for left in at_mm:
        plate = plate.difference(shapely.box(left, 16, left + 5, 21))
        for x in (left, left + 5):
            plate = plate.difference(shapely.Point(x, 16).buffer(RADIUS_MM, quad_segs=32))
    return np.array(shapely.affinity.rotate(plate, 7).exterior.coords)


def as_run(
    drawn: Points, begin: float = 0.0, leader: int = MEMORY, over_mm: float = 0.35
) -> Line:
    """The line of a head that felt averages of its line, as it does at bends, where memory led it."""
    line = run_along(drawn)
    way = np.roll(line.xy_mm, -round(begin * len(line.xy_mm)), axis=0)
    over = round(over_mm / STEP_MM)
    ones = np.ones(2 * over + 1) / (2 * over + 1)
    around = np.vstack([way[-over:], way, way[:over]])
    felt = np.column_stack([np.convolve(column, ones, "valid") for column in around.T])
    off = np.hypot(*(felt - way).T) > 5 * UM
    about = round(1.5 / STEP_MM)
    off = (
        np.convolve(np.r_[off[-about:], off, off[:about]], np.ones(2 * about + 1), "valid") > 0
    )
    leaders = np.where(off, leader, CELL).astype(np.int8)
    return replace(line, xy_mm=felt, led=Led.along(leaders))


def onto_ink(drawn: Points, *lines: Line, operator: Operator | None = None) -> list[Line]:
    """Some lines of a sheet as they are bent."""
    drawing = inked(drawn, width_mm=WIDTH_MM, seed=1)
    return bent(Setup(drawing.sheet, operator=operator or Operator()), lines)


def off_mm(line: Line, truth: Points) -> float:
    """How far the line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


@pytest.mark.parametrize("begin", [0.0, 0.3, 0.58, 0.62, 0.7])
def test_reliefs_are_followed_wherever_the_line_begins(begin: float) -> None:
    """Within 40 um, half a pixel, without a jump; the head's own way is 70 um off and more."""
    drawn = slotted(8.0, 20.0)
    own = as_run(drawn, begin)
    (line,) = onto_ink(drawn, own)
    assert off_mm(line, drawn) < 40 * UM < 70 * UM < off_mm(own, drawn)
    assert steps_mm(line).max() < 1.05 * STEP_MM + UM
    assert line.led.lengths_mm(line.xy_mm)[REDRAWN] > 8.0


def test_where_the_cell_led_the_line_stays_as_it_was() -> None:
    drawn = slotted(8.0)
    own = as_run(drawn, leader=CELL)
    assert onto_ink(drawn, own) == [own]


def test_lines_of_programs_and_marked_ones_stay() -> None:
    drawn = slotted(8.0)
    own = as_run(drawn)
    for other in (replace(own, reference_mm=(4.0, 4.0)), replace(own, as_told=True)):
        assert onto_ink(drawn, other)[0] is other
    assert onto_ink(drawn, own, operator=Operator(marks="on"))[0] is own


def test_a_line_that_is_too_short_for_its_legs_stays() -> None:
    """Four legs of a width and a half are 3 mm round."""
    drawn = polyline((5, 5), (5.7, 5), (5.7, 5.7), (5, 5.7), (5, 5))
    long = slotted(8.0) + np.array((0.0, 8.0))
    small, other = as_run(drawn), as_run(long)
    assert small.length_mm < 3.0
    drawing = inked(drawn, long, seed=1)
    assert bent(Setup(drawing.sheet), [small, other])[0] is small


def test_lines_of_two_pens_are_each_held_against_their_own() -> None:
    """0.35 and 0.5 mm broad; both lines come onto their ink."""
    first, second = slotted(8.0), slotted(20.0) + np.array((0.0, 25.0))
    drawing = together((first, 0.35), (second, 0.5), seed=1)
    lines = [replace(as_run(first), width_mm=0.35), as_run(second)]
    for line, drawn in zip(bent(Setup(drawing.sheet), lines), (first, second), strict=True):
        assert off_mm(line, drawn) < 45 * UM


def test_a_line_that_runs_beside_it_is_no_ink_of_its_own() -> None:
    """It is drawn there anyway, 0.75 mm beside a relief: what it leaves does not draw the line over to it."""
    drawn = slotted(8.0)
    at = int(np.argmin(drawn[:, 1] + drawn[:, 0]))
    beside = drawn[at] - np.array([(0.9, 0.75), (0.9, -8.0)])
    drawing = inked(drawn, beside, seed=1)
    lines = [as_run(drawn), run_along(beside, "ended")]
    line, other = bent(Setup(drawing.sheet), lines)
    assert off_mm(line, drawn) < 45 * UM and other is lines[1]


def bent_stroke(at_mm: float, about_mm: float = 2.0) -> tuple[Points, Line]:
    """A stroke of 24 mm with a step of 0.6 mm so far from its beginning, and a head that averaged it: memory
    led it so far about the step.
    """
    truth = polyline((5, 12), (5 + at_mm, 12), (5 + at_mm, 12.6), (29, 12.6))
    line = run_along(truth, "ended")
    come_mm = lengths_mm(line.xy_mm)
    over = round(0.35 / STEP_MM)
    ones = np.ones(2 * over + 1) / (2 * over + 1)
    padded = np.pad(line.xy_mm, ((over, over), (0, 0)), mode="reflect", reflect_type="odd")
    felt = np.column_stack([np.convolve(column, ones, "valid") for column in padded.T])
    leaders = np.where(np.abs(come_mm - at_mm - 0.3) < about_mm, MEMORY, CELL).astype(np.int8)
    return truth, replace(line, xy_mm=felt, led=Led.along(leaders))


@pytest.mark.parametrize(
    ("at_mm", "is_bent"), [(0.7, False), (1.0, False), (2.5, True), (12.0, True)]
)
def test_a_step_of_an_open_line_is_followed_if_it_has_clean_line_on_either_side(
    at_mm: float, is_bent: bool
) -> None:
    """A step less than a leg and a half from the end, 1.1 mm, is left as the head ran; others are followed
    within 70 um, less than a pixel.
    """
    truth, own = bent_stroke(at_mm)
    (line,) = onto_ink(truth, own)
    assert (line is not own) == is_bent
    assert np.array_equal(line.xy_mm[[0, -1]], own.xy_mm[[0, -1]])
    if is_bent:
        inner = shapely.box(5.5, 0, 28, 30)
        true, way, before = (
            shapely.LineString(each).intersection(inner)
            for each in (truth, line.xy_mm, own.xy_mm)
        )
        assert true.hausdorff_distance(way) < 70 * UM < true.hausdorff_distance(before)


@pytest.mark.parametrize(("at_mm", "about_mm"), [(2.4, 2.9), (2.6, 3.4), (2.8, 3.3)])
def test_a_step_near_an_end_is_followed_whatever_the_end_leaves(
    at_mm: float, about_mm: float
) -> None:
    """The head was led from memory from the beginning on; the ink about that is no stretch's."""
    truth, own = bent_stroke(at_mm, about_mm)
    (line,) = onto_ink(truth, own)
    assert line is not own and np.array_equal(line.xy_mm[0], own.xy_mm[0])
