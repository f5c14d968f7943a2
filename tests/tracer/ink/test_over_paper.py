"""No line goes on over bare paper through a crossing."""

from __future__ import annotations

import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.crossing_ink import WaysOn
from morfax.tracer.ink.felt_lines import FeltLine, end_leg
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.net import net_of
from morfax.tracer.ink.over_paper import without_paper
from morfax.tracer.ink.stretches import FeltSheet
from tests.tracer.inked import WIDTH_MM, inked, polyline

ACROSS = ((0, 1),)


def crossing_across(bare_mm: float) -> Crossing:
    """Two lines that face each other across so much paper; the first ends on a third."""
    lines = [
        polyline((5, 20), (15, 20)),
        polyline((15 + bare_mm + WIDTH_MM, 20), (30, 20)),
        polyline((15, 30), (15, 8)),
    ]
    left = ink_left(inked(*lines, seed=1).sheet)
    net = net_of(FeltSheet.of(left.drawing, Settings(), left.ink), set())

    def nearest_to(x_mm: float, y_mm: float) -> tuple[FeltLine, bool]:
        """The end of a line that is nearest to a place."""
        ends = [(line, last) for line in net.lines for last in (False, True)]
        return min(
            ends,
            key=lambda end: abs(end_leg(*end).end_mm - (x_mm, y_mm)).sum(),
        )

    ends = [nearest_to(14.0, 20), nearest_to(15 + bare_mm + WIDTH_MM, 20), nearest_to(15, 19)]
    views = [line.runs[0].view for line, _ in ends]
    return Crossing([end_leg(*end) for end in ends], views, Settings())


@pytest.mark.parametrize(("bare_mm", "goes_on"), [(2.0, False), (0.5 * WIDTH_MM, True)])
def test_a_way_over_paper_for_longer_than_a_width_is_no_line(
    bare_mm: float, goes_on: bool
) -> None:
    crossing = crossing_across(bare_mm)
    found = without_paper(crossing, WaysOn(ACROSS, {}))
    assert (found.pairs == ACROSS) == goes_on
    if not goes_on:
        assert found.pairs == ((0, 2),)  # the corner of the two that meet in ink
