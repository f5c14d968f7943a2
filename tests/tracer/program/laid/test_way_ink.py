"""The ink about a stretch of a way: what other lines draw there is known, each as broad as it was felt."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.laid.way_ink import WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SURE
from tests.tracer.inked import WIDTH_MM, polyline, together
from tests.tracer.program.against_ink.test_own_ink import closed


def test_a_way_that_crosses_a_broader_line_leaves_no_ink() -> None:
    edge, cross = polyline((4, 14), (44, 14)), polyline((24, 4), (24, 24))
    setup = Setup(together((edge, 1.1), (cross, WIDTH_MM), seed=1).sheet)
    thin = closed(cross, "ended")
    lines = BoxedLines.of([replace(closed(edge, "ended"), width_mm=1.1), thin])
    of_thin = WayInk(setup, thin, lines)
    middle = len(of_thin.way) // 2
    seen = of_thin.about(middle - 20, middle + 20, np.empty((0, 2)))
    assert seen is not None
    assert seen.ink.misfit_along(seen.own) < SURE * STEP_WIDTHS * len(seen.own)
