"""Ink along which a line was followed: no other line goes on along it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline

FRAME = polyline((20, 10), (60, 10), (60, 40), (20, 40), (20, 10))
# a side of the frame goes on beyond its corner, but for a gap that the head may cross
BESIDE = polyline((5, 10), (19.2, 10))
RING = arc((40, 25), 8)
# at a tangent
ONTO_RING = polyline((26, 17.1), (36.6, 17.1))


@pytest.mark.parametrize("lines", [(FRAME, BESIDE), (RING, ONTO_RING, FRAME)])
def test_a_stroke_that_ends_beside_a_contour_does_not_run_round_it_again(
    lines: tuple[Points, ...],
) -> None:
    """On a woodcut a patch of 15 mm was run for 730 mm, along ink that had been cut before."""
    drawn_mm = sum(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines)
    traced = trace_lines(inked(*lines, seed=2))
    assert sum(line.length_mm for line in traced.lines) < 1.02 * drawn_mm
    assert sum(line.ending == "closed" for line in traced.lines) == len(lines) - 1


def test_a_line_with_gaps_is_one_line_still() -> None:
    dashes = [polyline((x, 20), (x + 9.0, 20)) for x in (5.0, 14.9, 24.8)]
    (line,) = trace_lines(inked(*dashes, seed=2)).lines
    assert line.length_mm == pytest.approx(28.8, abs=0.2)
