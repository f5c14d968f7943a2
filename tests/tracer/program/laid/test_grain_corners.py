"""Corners of a pencil's lines are where their sides meet, though the slit through which its grain is seen
rounds them.

Drawn at 300 dpi a third as dark as ink, with grain of 35 % behind a spot of 1.2 pixels. That leaves a side of
some millimetres uncertain by 20 um, and so a corner of two by 40 as a rule, and three times that at the most.
"""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.laid import narrow_bays
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, Points, arc, inked, polyline
from tests.tracer.pencilled import pencilled

CORNERS_MM = [(14.0, 14.0), (34.0, 17.0), (37.0, 33.0), (17.0, 36.0)]


def path_of(drawing: Drawing) -> Points:
    """The path (n, 2) mm of the drawing's only line."""
    run = trace(drawing).lines[0]
    assert run.ending == "closed"
    return run.xy_mm


def test_a_corner_is_where_its_sides_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    """32 corners; as the head alone takes them they are cut by up to 0.34 mm."""
    corners = np.array(CORNERS_MM)
    sheets = [pencilled(polyline(*CORNERS_MM, CORNERS_MM[0]), seed=seed) for seed in range(8)]
    off_mm = np.concatenate([nearest_mm(corners, path_of(sheet)) for sheet in sheets])
    assert np.median(off_mm) < 40 * UM
    assert off_mm.max() < 130 * UM
    monkeypatch.setattr(narrow_bays, "with_grain_corners", lambda _, own: own)
    before_mm = np.concatenate([nearest_mm(corners, path_of(sheet)) for sheet in sheets])
    assert np.median(before_mm) > 1.5 * np.median(off_mm)
    assert before_mm.max() > 250 * UM


def test_a_dark_grain_at_a_corner_is_no_way_out_and_back() -> None:
    """Drawn over its legs twice more, the corner would be 0.7 mm longer; grain leaves 0.2 mm to chance."""
    square = polyline(*CORNERS_MM, CORNERS_MM[0])
    run = trace(pencilled(square, seed=7)).lines[0]
    assert run.length_mm == pytest.approx(length_mm(square), abs=0.3)


@pytest.mark.parametrize("radius_mm", [0.8, 1.6])
def test_a_round_stays_a_round(radius_mm: float) -> None:
    """Of a radius of four widths, and of two, from which the sharp corner is 0.3 mm away."""
    low, high = 14.0 + radius_mm, 34.0 - radius_mm
    rounds = [((low, low), 180), ((high, low), 270), ((high, high), 0), ((low, high), 90)]
    arcs = [arc(centre, radius_mm, deg, deg + 90) for centre, deg in rounds]
    drawn = np.vstack([*arcs, arcs[0][:1]])
    assert nearest_mm(drawn, path_of(pencilled(drawn, seed=3))).max() < 80 * UM


def test_a_small_hole_is_no_polygon() -> None:
    hole = arc((24.0, 24.0), 1.8)
    assert nearest_mm(hole, path_of(pencilled(hole))).max() < 80 * UM


def test_lines_that_are_seen_without_a_slit_are_as_they_were() -> None:
    drawing = inked(polyline(*CORNERS_MM, CORNERS_MM[0]), seed=1)
    assert drawing.drawn is None
    assert drawing.as_drawn is drawing
