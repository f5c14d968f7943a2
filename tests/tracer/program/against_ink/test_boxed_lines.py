"""Lines near a place are found without the others, and no more of them than is near."""

from __future__ import annotations

import numpy as np

from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from tests.tracer.inked import polyline
from tests.tracer.program.laid.ways import run_along


def test_of_lines_that_reach_into_a_box_the_parts_within_it_are_found() -> None:
    """A line that leaves the box and comes back has two; one that only passes has none."""
    bay = run_along(polyline((0, 5), (10, 5), (10, 20), (12, 20), (12, 5), (30, 5)), "ended")
    far, passing = (
        run_along(polyline((0, y), (x, 9), (30, y)), "ended") for x, y in ((15, 40), (4, 9.5))
    )
    lines = BoxedLines.of([bay, far, passing])
    low, high = np.array([8.0, 3.0]), np.array([14.0, 9.05])
    found = list(lines.parts(low, high))
    assert [line is bay for line, _ in found] == [True, True]
    for _, part in found:
        assert (part > low).all() and (part < high).all()
    inside = (bay.places_mm > low) & (bay.places_mm < high)
    assert sum(len(part) for _, part in found) == np.count_nonzero(inside.all(axis=1))
    assert not list(lines.parts(low, high, but=bay))
    # around the box the same line has more of its way
    around = [part for line, part in lines.parts(low, high, around_mm=1.0) if line is bay]
    about = (bay.places_mm > low - 1.0) & (bay.places_mm < high + 1.0)
    assert sum(map(len, around)) == np.count_nonzero(about.all(axis=1))
