"""What makes a net, which way along it counts, and when its junctions may be asked at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm
from morfax.tracer.corrections.corrections import Correction, Corrections, Place
from morfax.tracer.drawing.corrected import corrected
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.lines.selection import Contour
from morfax.tracer.program.nets.net_lines import or_outline
from morfax.tracer.program.nets.net_outline import are_nets, may_solve, of_net
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline

BOX = polyline((8, 8), (40, 8), (40, 34), (8, 34), (8, 8))
BAR = polyline((8, 20), (40, 20))
EIGHT = polyline(
    (8, 8), (40, 8), (40, 24), (24, 24), (24, 16), (32, 16), (32, 34), (8, 34), (8, 8)
)


def pierced(line: Points, place_mm: tuple[float, float], side_mm: float) -> Drawing:
    """A sheet with a square blot of 2 mm on a line, and in the blot a square of bare paper."""
    drawing = inked(line, seed=3)
    pitch_mm, darkness = drawing.pitch_mm, np.array(drawing.darkness)
    column, row = place_mm[0] / pitch_mm, len(darkness) - place_mm[1] / pitch_mm
    for half_mm, dark in ((1.0, darkness.max()), (side_mm / 2, 0.0)):
        half = half_mm / pitch_mm
        rows, columns = (slice(round(at - half), round(at + half)) for at in (row, column))
        darkness[rows, columns] = dark
    return Drawing(darkness, pitch_mm)


@pytest.mark.parametrize("widths, is_net", [(0.85, False), (1.6, True)])
def test_paper_that_is_smaller_than_the_line_is_wide_is_a_flaw_and_no_area(
    widths: float, is_net: bool
) -> None:
    """A line round one area, with a blot on it; paper in the blot makes a second area or is a flaw."""
    drawing = pierced(BOX, (24, 8), widths * WIDTH_MM)
    assert are_nets(drawing.sheet).tolist() == [is_net]


def test_an_outline_that_is_all_of_the_ink_leaves_nothing_out() -> None:
    found = of_net(Setup(inked(EIGHT, seed=3).sheet))
    assert found.line is not None
    assert found.line.length_mm == pytest.approx(length_mm(EIGHT), abs=0.5)
    assert not found.leaves_out


def on_ink(ink_mm: float, line_mm: float, ending: str = "closed") -> Line:
    """A line that was followed on a patch with so much ink."""
    way = arc((16, 14), 5)
    return Line(way, ending, WIDTH_MM, line_mm, ink_mm=ink_mm)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "share, ending, gives_way",
    [(0.3, "closed", True), (0.55, "closed", False), (0.55, "ended", True)],
)
def test_a_line_that_is_a_smaller_part_of_a_net_or_ends_gives_way_to_its_outline(
    share: float, ending: str, gives_way: bool
) -> None:
    setup = Setup(inked(BOX, BAR, seed=3).sheet)
    ink_mm = float(setup.sheet.lengths_mm[0])
    line = on_ink(ink_mm, share * ink_mm, ending)
    found = or_outline(setup, Contour(7, setup.sheet.stroke(0), 32.0), line)
    assert found is not None
    if gives_way:
        assert found.length_mm == pytest.approx(length_mm(BOX), abs=0.5) and found.number == 7
    else:
        assert found is line


def test_of_two_smaller_parts_of_a_net_the_longer_one_is_taken() -> None:
    """Bars make the outline less than half of the ink: a closed line may be longer, and still be less."""
    bars = [polyline((8, y), (40, y)) for y in (12, 16, 20, 24, 28, 31)]
    setup = Setup(inked(BOX, *bars, seed=3).sheet)
    ink_mm = float(setup.sheet.lengths_mm[0])
    contour = Contour(1, setup.sheet.stroke(0), 32.0)
    longer = on_ink(ink_mm, length_mm(BOX) + 20)
    assert longer.length_mm < 0.5 * ink_mm
    assert or_outline(setup, contour, longer) is longer
    assert or_outline(setup, contour, on_ink(ink_mm, 40.0)) is not longer


def told(kind: str) -> Drawing:
    """The sheet, with something that an operator has told of its line."""
    correction = Correction(kind, (Place(24.0, 8.0, "mm"),))  # type: ignore[arg-type]
    return corrected(inked(BOX, BAR, seed=3), Corrections((correction,)))


@pytest.mark.parametrize("kind", ["left", "stop"])
def test_where_a_turn_or_a_stop_is_told_the_sheet_is_a_program_and_no_net(kind: str) -> None:
    assert not may_solve(Setup(told(kind).sheet))


@pytest.mark.parametrize(
    "operator, may",
    [
        (Operator(), True),
        (Operator(direction="ccw"), True),
        (Operator(direction="left"), False),
        (Operator(marks="on"), False),
        (Operator(reference_mm=(8.0, 8.0)), False),
        (replace(Operator(), card=Card(turns=("left",))), False),
    ],
)
def test_where_an_operator_says_where_the_line_is_its_junctions_are_not_asked(
    operator: Operator, may: bool
) -> None:
    assert may_solve(Setup(inked(BOX, BAR, seed=3).sheet, operator=operator)) == may


def test_a_sheet_of_filled_areas_has_no_net() -> None:
    filled: Array = arc((20, 20), 8)
    assert not are_nets(inked(BOX, seed=3, specks=[filled]).sheet).any()
