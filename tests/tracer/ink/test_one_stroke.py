"""A net that is one stroke from a free end is told from strokes that begin and end on their own ink."""

from __future__ import annotations

import pytest

from morfax.motion.polyline import length_mm
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.outlines import one_stroke
from morfax.tracer.ink.solving import solved
from morfax.tracer.ink.stretches import FeltSheet
from tests.tracer.inked import Points, inked, polyline

SIX = polyline((20, 30), (10, 30), (10, 12), (22, 12), (22, 20), (10, 20))
BOTH_ENDS_ON_IT = polyline(
    (20, 12), (20, 20), (10, 20), (10, 12), (30, 12), (30, 4), (24, 4), (24, 12)
)
RING = polyline((10, 10), (30, 10), (30, 24), (10, 24), (10, 10))


@pytest.mark.parametrize(
    ("strokes", "is_one"),
    [
        pytest.param([SIX], True, id="a six"),
        pytest.param([BOTH_ENDS_ON_IT], False, id="both ends on its own line"),
        pytest.param([RING], False, id="a ring"),
        pytest.param([SIX, polyline((16, 12), (16, 4))], False, id="a six and another line"),
    ],
)
def test_one_stroke_begins_at_a_free_end_and_runs_along_all_lines(
    strokes: list[Points], is_one: bool
) -> None:
    drawing = inked(*strokes, seed=1)
    stroke = one_stroke(solved(FeltSheet.of(drawing, Settings(), ink_left(drawing.sheet).ink)))
    assert (stroke is not None) == is_one
    if stroke is not None:
        assert stroke.length_mm == pytest.approx(length_mm(strokes[0]), abs=2.0)
