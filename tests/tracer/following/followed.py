"""Lines followed for tests."""

from __future__ import annotations

import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM

LINE_MM, END_MM = 25 * UM, 30 * UM
SEEDS = pytest.mark.parametrize("seed", [None, 1, 2])


def followed(
    line: Array,
    drawing: Drawing,
    start_mm: tuple[float, float] | None = None,
    within_mm: float = LINE_MM,
) -> Trace:
    """Trace a drawing, and hold the path to a line: on it everywhere, and all of it, once."""
    run = trace(drawing, start_mm)
    apart = distance(run.xy_mm[::4], line)
    assert run.fault is None
    assert apart.path_to_reference.max_mm < within_mm
    assert apart.reference_to_path.max_mm < max(within_mm, END_MM)
    assert run.length_mm == pytest.approx(length_mm(line), abs=4 * max(within_mm, END_MM))
    return run
