"""A line of a pencil comes round where it turns on ink that is paler, and is open where paper is left."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import DPI, WIDTH_MM, inked, polyline
from tests.tracer.pencilled import of_pencil

PITCH_MM = MM_PER_INCH / DPI
LINE = polyline((12, 12), (32, 16), (18, 34), (12, 12))


@pytest.mark.parametrize("run", [trace, trace_ink])
@pytest.mark.parametrize(("left", "ending"), [(0.4, "closed"), (0.0, "ended")])
def test_a_line_comes_round_by_a_corner_that_is_paler_and_not_across_paper(
    run: Callable[[Drawing], Trace], left: float, ending: str
) -> None:
    """Of the ink about a corner a part is left, or none over a millimetre."""
    ink = inked(LINE, width_mm=WIDTH_MM).darkness
    rows, columns = np.indices(ink.shape)
    right_mm = (columns + 0.5) * PITCH_MM - 17.8
    up_mm = (len(ink) - rows - 0.5) * PITCH_MM - 33.4
    ink[(np.abs(right_mm) < 0.5) & (np.abs(up_mm) < 0.3 + 0.3 * (left == 0))] *= left
    (line,) = run(of_pencil(ink)).lines
    assert line.ending == ending
    if ending == "closed":
        assert np.hypot(*(line.xy_mm - LINE[2]).T).min() < 0.5 * WIDTH_MM
