"""What lies inside ink that is not cut: a plate with two holes, an island, and a part beside it.

┌─ plate ──────────────┐
│ ( hole )  ( ring (o) │  ( beside )
└──────────────────────┘
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.faults import LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.lines.around import Around, around
from tests.tracer.inked import Points, inked


def circle(x: float, y: float, radius: float) -> Points:
    turn = np.linspace(0, 2 * np.pi, 200)
    return np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)])


PLATE = np.array([(4.0, 4.0), (40.0, 4.0), (40.0, 24.0), (4.0, 24.0), (4.0, 4.0)])
HOLE, RING, ISLAND = circle(11, 14, 4), circle(28, 14, 8), circle(28, 14, 3)
BESIDE = circle(50, 14, 5)
# numbered as on the sheet, the longest first
LINES = {
    number: Line(places, "closed", 0.5, 1.0, number=number)
    for number, places in enumerate((PLATE, RING, BESIDE, HOLE, ISLAND), 1)
}


@pytest.fixture(scope="module")
def drawing() -> Drawing:
    return inked(PLATE, HOLE, RING, ISLAND, BESIDE)


def of(drawing: Drawing, *numbers: int) -> list[Around]:
    return around(drawing, [LINES[number] for number in numbers])


def test_ink_round_a_line_that_is_not_asked_for_is_named(drawing: Drawing) -> None:
    assert of(drawing, 4) == [Around(4, 1, False)]
    assert of(drawing, 2, 4) == [Around(2, 1, False), Around(4, 1, False)]
    # the ring is asked for: the nearest that is not is the plate
    assert of(drawing, 2, 5) == [Around(2, 1, False), Around(5, 1, False)]
    assert of(drawing, 5) == [Around(5, 2, False)]
    assert of(drawing, 1, 5) == [Around(5, 2, False)]


def test_lines_that_lie_in_nothing_else_are_not_named(drawing: Drawing) -> None:
    assert of(drawing, 1) == of(drawing, 3) == of(drawing, 1, 3) == []
    assert of(drawing, 1, 2, 3, 4, 5) == []


def test_all_in_the_hull_of_a_lost_line_may_be_its_holes(drawing: Drawing) -> None:
    lost = replace(
        LINES[1], xy_mm=PLATE[:2], ending="lost", fault=LineFault("line lost at 40,4 mm")
    )
    others = [LINES[number] for number in (2, 3, 4, 5)]
    assert around(drawing, [lost, *others]) == [Around(k, 1, True) for k in (2, 4, 5)]


def test_a_sheet_without_a_closed_line_needs_no_look(drawing: Drawing) -> None:
    is_open = replace(LINES[1], ending="ended", xy_mm=PLATE[:3])
    assert around(drawing, [is_open]) == []
