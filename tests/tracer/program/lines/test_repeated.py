"""A closed line that was followed from several of its pieces is cut once."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.following.line import Line
from morfax.tracer.program import trace_lines
from morfax.tracer.program.lines import repeated
from morfax.tracer.program.lines.repeated import without_repeats
from morfax.tracer.program.one_of_each import OneOfEach
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import Points, arc, inked

WIDTH_MM, STEP_MM = 0.5, 0.0017  # of the motion: 10 mm/s at 6 kHz


def along(places_mm: Points, ending: str = "closed", number: int = 1) -> Line:
    """A line as if the head had come along some places."""
    whole_mm = length_mm(places_mm)
    positions_mm = at_lengths(places_mm, np.arange(0.0, whole_mm, STEP_MM))
    return Line(positions_mm, ending, WIDTH_MM, whole_mm, number=number)


CIRCLE = along(arc((20, 20), 12))
# begun elsewhere, the other way round, 0.05 mm beside, and out along a spur of 1.5 mm and back
SPUR = np.array([[20, 7.95], [20, 6.5], [20, 7.95]])
AGAIN = along(
    np.vstack([arc((20, 20), 12.05, 250, -90), SPUR, arc((20, 20), 12.05, 270, 250)[1:-1]])
)


def test_of_closed_lines_along_one_way_the_shortest_is_cut() -> None:
    assert without_repeats([AGAIN, CIRCLE]) == [CIRCLE]


@pytest.mark.parametrize(
    "other",
    [
        along(arc((20, 20), 12.5)),  # a width beside it
        along(arc((20, 20), 12, 0, 350), "ended"),
        along(np.vstack([arc((20, 20), 12, 0, 300), [[26, 14]], arc((20, 20), 12)[-1:]])),
        along(arc((50, 20), 12)),
    ],
)
def test_other_lines_stay(other: Line) -> None:
    assert without_repeats([CIRCLE, other]) == [CIRCLE, other]


def test_each_line_of_many_is_looked_through_once(monkeypatch: pytest.MonkeyPatch) -> None:
    holes = [along(arc((10 * k, 10), 3)) for k in range(1, 30)]
    looked_at, box_mm = list[int](), repeated._box_mm

    def counted(line: Line) -> tuple[Points, Points]:
        looked_at.append(line.number)
        return box_mm(line)

    monkeypatch.setattr(repeated, "_box_mm", counted)
    assert without_repeats(holes) == holes
    assert len(looked_at) == len(holes)


def test_contours_have_no_repeats_and_numbers_have(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = [along(arc((20, 20), 12), number=1), along(arc((20, 20), 12), number=2)]
    monkeypatch.setattr(trace_lines, "one_of_each", lambda *_: OneOfEach(lines, [], {}))
    monkeypatch.setattr(trace_lines, "further_lines", lambda *_: ([], 0.0))
    drawing = inked(arc((20, 20), 12, 0, 170), arc((20, 20), 12, 190, 350))
    setup = Setup(drawing.sheet)
    assert len(trace_lines.found_lines(setup, "contours").lines) == 1
    assert len(trace_lines.found_lines(setup, (1, 2)).lines) == 2
