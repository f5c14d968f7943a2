"""A bay where a closed line begins: the line is begun elsewhere, and the bay moves along it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.tangles.folding_rule import Rule

RULE = Rule(np.zeros(2), np.ones(2), np.ones((1, 2)), np.zeros(1, bool), 0.0, 0.25)


@pytest.mark.parametrize("by_mm", [-95.0, -3.0, 0.0, 40.0, 250.0])
def test_a_bay_that_is_moved_along_a_closed_way_stays_as_long(by_mm: float) -> None:
    """It begins on the way, once round at the most, and ends as far on as before."""
    moved = Bay(90.0, 108.0, RULE, 1.0).moved(by_mm, 100.0)
    assert 0.0 <= moved.first_mm < 100.0
    assert (moved.first_mm - 90.0 - by_mm) / 100.0 == pytest.approx(
        round((moved.first_mm - 90.0 - by_mm) / 100.0), abs=1e-9
    )
    assert moved.last_mm - moved.first_mm == pytest.approx(18.0)
