"""Cut corners: teeth whose sides are two pens wide have the corners that were drawn."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import nearest_mm, with_places
from morfax.tracer.program.laid.cut_corners import with_corners
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from tests.tracer.inked import arc, inked, polyline

TEETH = 6
PITCH_MM, HIGH_MM = (
    2.4,
    1.6,
)  # of teeth that are 1 mm broad at their tips, and as broad at their roots
# two thirds of a pixel; where the head rounds the corners of such teeth it is 0.085 mm off
OFF_MM = 0.05


def rack(turned_rad: float) -> np.ndarray:
    """A rack with teeth, (n, 2) mm."""
    rise = np.array([0.1, 0.3, 0.7, 0.9]) * PITCH_MM
    along = (np.arange(TEETH)[:, None] * PITCH_MM + rise).ravel()
    up = 4.0 + HIGH_MM * np.tile([0, 1, 1, 0], TEETH)
    places = np.vstack([[0, 0], np.column_stack([along, up]), [TEETH * PITCH_MM, 0], [0, 0]])
    cosine, sine = np.cos(turned_rad), np.sin(turned_rad)
    turned = places @ np.array([[cosine, sine], [-sine, cosine]])
    return np.asarray(turned - turned.min(axis=0) + 4)


@pytest.mark.parametrize("turned_rad", [1.7, 2.4, 3.1])
def test_teeth_as_broad_as_two_lines_have_their_corners(turned_rad: float) -> None:
    drawn = polyline(*map(tuple, rack(turned_rad)))
    (line,) = trace(inked(drawn, seed=3)).lines
    assert line.ending == "closed"
    truth = with_places(drawn, 0.01)
    assert nearest_mm(truth, line.places_mm).max() < OFF_MM
    assert nearest_mm(line.places_mm, truth).max() < OFF_MM


def test_a_line_on_its_ink_stays_as_the_head_ran() -> None:
    drawing = inked(arc((16, 16), 10), seed=4)
    lines = list(trace(drawing).lines)
    assert with_corners(Setup(drawing.sheet), lines) == lines
