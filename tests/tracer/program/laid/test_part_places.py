"""A part of a closed line takes in each position from the one place to the other, and none twice."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.usual import THINNED
from morfax.tracer.program.laid.line_parts import part_of
from tests.tracer.inked import polyline
from tests.tracer.program.laid.ways import run_along

SQUARE = polyline((5, 5), (25, 5), (25, 25), (5, 25), (5, 5))


@pytest.mark.parametrize(("first", "last"), [(0, 1), (200, 600), (1500, 100), (1500, 0)])
def test_a_part_takes_as_many_positions_as_lie_between_its_places(
    first: int, last: int
) -> None:
    """Of two parts that follow each other the second begins a position behind the first."""
    line = run_along(SQUARE)
    count = len(line.xy_mm) // THINNED
    part, rest = part_of(line, first, last), part_of(line, last, first)
    assert len(part.xy_mm) == (last - first) % count * THINNED
    both = np.vstack([part.xy_mm, rest.xy_mm])
    assert np.array_equal(np.roll(both, first * THINNED, axis=0), line.xy_mm)
