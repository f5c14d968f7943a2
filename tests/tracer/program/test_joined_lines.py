"""Further lines of a patch of ink: which strokes are lines of their own."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.following.line import Line
from morfax.tracer.program import joined_lines
from tests.tracer.inked import Points


def test_a_stroke_is_held_only_against_lines_that_come_near_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of hundreds of strokes of a net each was held against all others."""
    held = list[int]()

    def nearest_mm(places: Points, others: Points) -> Points:
        held.append(len(others))
        return nearest(places, others)

    nearest = joined_lines.nearest_mm
    rows = [np.column_stack([np.linspace(0, 30, 301), np.full(301, 5.0 * n)]) for n in range(9)]
    lines = [Line(row, "ended", 0.5, 30.0) for row in rows]
    monkeypatch.setattr(joined_lines, "nearest_mm", nearest_mm)
    assert all(
        joined_lines._is_line(line, [o for o in lines if o is not line]) for line in lines
    )
    assert held == []
    again = Line(rows[4] + (0.0, 0.1), "ended", 0.5, 30.0)
    assert not joined_lines._is_line(again, lines)
    assert held == [len(lines[4].places_mm)]
