"""Speckled lines: broad chalk or crayon is one line in its middle, and what only looks speckled stays.

Broken on purpose, with `TIMES` of 1 only, the first test fails;
with pixels filled up below the second; with `FILLED` 0 the third.
"""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from morfax.motion.contour import distance
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.speckled import on_larger_pixels
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.drawing.test_grain import opened
from tests.tracer.inked import DPI, Points, arc, inked, polyline

BOARD, CHALK, NOISE = 210.0, 150.0, 5.0  # grey levels of a board, seen as dark on light
RING, BAR = arc((40.0, 45.0), 25.0), polyline((15, 8), (65, 11))


def chalked(*lines: Points, width_mm: float, dpi: float, grain_px: float) -> Drawing:
    """Lines of broad chalk, of which a quarter of the board shows through in specks of a size."""
    random = np.random.default_rng(7)
    ink = inked(*lines, width_mm=width_mm, dpi=dpi).darkness
    wave = cv2.GaussianBlur(random.normal(size=ink.shape), (0, 0), grain_px)
    covered = np.clip(ink * (0.8 + 0.4 * np.clip(wave / wave.std(), -2, 2)), 0, 1)
    return opened(BOARD - CHALK * covered + random.normal(0, NOISE, ink.shape), dpi)


@pytest.mark.parametrize(
    ("width_mm", "dpi", "grain_px"),
    [(3.0, 150.0, 1.0), (1.5, 300.0, 1.0), (3.0, 300.0, 2.0), (5.0, 300.0, 1.0)],
)
def test_broad_chalk_is_one_line_in_its_middle(
    width_mm: float, dpi: float, grain_px: float
) -> None:
    drawing = chalked(RING, BAR, width_mm=width_mm, dpi=dpi, grain_px=grain_px)
    assert any("full of specks and holes" in note for note in drawing.notes)
    ring, bar = sorted(trace_ink(drawing).lines, key=lambda line: -line.length_mm)
    assert ring.ending == "closed" and bar.ending == "ended"
    # the middle of such ink wanders with its specks: by a twentieth of its width
    for line, true in ((ring, RING), (bar, BAR)):
        off = distance(line.xy_mm[::4], true)
        assert off.path_to_reference.rms_mm < width_mm / 20
        assert off.reference_to_path.max_mm < width_mm  # and its ends, half a width at most


def test_larger_pixels_lie_where_the_scan_has_them() -> None:
    """A spot in the lower left corner stays there, whatever is filled up above and to the right."""
    picture = np.zeros((13, 10), np.float32)
    picture[-4:, :4] = 1.0
    larger = on_larger_pixels(picture, 4)
    assert larger.shape == (4, 3)
    assert larger[-1, 0] == 1.0 and larger.sum() == 1.0


def test_a_band_of_hatching_is_no_broad_line() -> None:
    """Strokes of 4 pixels with gaps of 3 from side to side of a ring: on larger pixels they are grey."""
    rows, columns = np.mgrid[:700, :700]
    from_middle_px = np.hypot(rows - 350, columns - 350)
    is_stroke = (np.abs(from_middle_px - 250) < 30) & ((rows + columns) % 10 < 6)
    levels = cv2.GaussianBlur(np.where(is_stroke, 40.0, 245.0), (0, 0), 0.8)
    assert opened(levels).pitch_mm == pytest.approx(MM_PER_INCH / DPI)
