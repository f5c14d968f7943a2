"""The outlines of a patch of ink take in all of it: they run through the middles of its outermost pixels."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.program.laid.rim_loops import outlines_of
from tests.tracer.inked import arc, inked, polyline

FRAME = polyline((4, 4), (30, 4), (30, 22), (4, 22), (4, 4))


@pytest.mark.parametrize("dpi", [150.0, 300.0])
@pytest.mark.parametrize("line", [arc((17, 13), 5), polyline((10, 9), (22, 12), (14, 18))])
def test_an_outline_reaches_to_the_patch_s_last_pixels_on_each_side(
    line: np.ndarray, dpi: float
) -> None:
    sheet = inked(FRAME, line, dpi=dpi, seed=1).sheet
    for patch in range(sheet.patches.count):
        outer = outlines_of(sheet, patch)[0] / sheet.drawing.pitch_mm
        top, bottom, left, right = sheet.patches.boxes[patch].tolist()
        rows = len(sheet.drawing.darkness)
        assert outer.min(axis=0) == pytest.approx([left + 0.5, rows - bottom + 0.5])
        assert outer.max(axis=0) == pytest.approx([right - 0.5, rows - top - 0.5])


def test_the_outline_of_a_closed_line_has_its_paper_to_the_other_side() -> None:
    """Ink to the left: the outer one runs counter-clockwise, that of the paper within clockwise."""
    sheet = inked(arc((17, 13), 5), seed=1).sheet
    outer, inner = outlines_of(sheet, 0)
    assert _turns(outer) > 0 > _turns(inner)
    assert np.ptp(outer, axis=0) - np.ptp(inner, axis=0) == pytest.approx([1.0, 1.0], abs=0.2)


def _turns(way: np.ndarray) -> float:
    """Twice the area on the left of a closed way, mm²."""
    x, y = way.T
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
