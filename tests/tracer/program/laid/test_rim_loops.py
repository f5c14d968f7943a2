"""The outline of narrow ink, and the way of the pen within its rim."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import area_mm2
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.program.laid.rim_loops import core_within, felt_pen_mm, narrow_outline
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, inked, polyline

PLATE = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))


def about(wide_mm: float, turned_deg: float = 20.0) -> Points:
    """A closed line about an L, half of a width to either side: its sides are so far apart."""
    spine = shapely.LineString([(10, 10), (30, 10), (30, 22)])
    ring = spine.buffer(0.5 * wide_mm, cap_style="flat", join_style="mitre").exterior
    return np.array(shapely.affinity.rotate(ring, turned_deg, origin=(24, 17)).coords)


def of_line(line: Points, width_mm: float = WIDTH_MM) -> tuple[Drawing, Points | None]:
    """A plate with a line in it, and the line's narrow outline."""
    drawing = inked(PLATE, line, width_mm=width_mm, seed=1)
    patch = int(np.argmin(drawing.sheet.lengths_mm))
    return drawing, narrow_outline(drawing.sheet, patch, width_mm)


@pytest.mark.parametrize(
    ("wide_widths", "is_narrow"),
    [(0.4, False), (0.8, True), (1.5, True), (3.0, True), (4.0, False)],
)
def test_two_sides_beside_each_other_are_narrow(wide_widths: float, is_narrow: bool) -> None:
    """With their ink they are a width broader: 1.6 to 4.2 widths of a pen are told."""
    drawing, outline = of_line(about(wide_widths * WIDTH_MM))
    assert (outline is not None) == is_narrow
    if outline is not None:
        assert area_mm2(outline) > 0
        ink = shapely.Polygon(about(wide_widths * WIDTH_MM)).buffer(
            0.5 * WIDTH_MM, join_style="mitre"
        )
        rim = shapely.LinearRing(outline)
        assert rim.distance(ink.exterior) < 1.5 * drawing.pitch_mm
        assert abs(rim.length - ink.exterior.length) < 0.1 * ink.exterior.length


def test_one_line_is_not_narrow() -> None:
    _, outline = of_line(polyline((10, 10), (30, 14), (30, 22)))
    assert outline is None


@pytest.mark.parametrize("wide_widths", [0.9, 1.5])
def test_the_pens_way_is_half_a_width_within_the_rim(wide_widths: float) -> None:
    """Within 60 um of the line that was drawn, 0.7 of a pixel, corners included."""
    line = about(wide_widths * WIDTH_MM)
    drawing, outline = of_line(line)
    view = view_of(drawing.sheet, None, WIDTH_MM)
    assert outline is not None
    core = core_within(view, outline, WIDTH_MM)
    assert core is not None and core.radius_mm == 0 and core.half_mm == 0.5 * WIDTH_MM
    way = shapely.LinearRing(core.points_mm)
    assert way.hausdorff_distance(shapely.LinearRing(line)) < 60 * UM
    apart_mm = np.hypot(*np.diff(core.points_mm, axis=0).T)
    assert apart_mm.min() > 0.1 * view.step_mm


@pytest.mark.parametrize("width_mm", [0.35, 0.5, 0.7])
def test_the_pen_is_felt_on_its_longest_plain_line(width_mm: float) -> None:
    """Within 0.03 mm, by which a cell's aperture makes a line look broader, whatever else is on the sheet."""
    drawing = inked(PLATE, arc((14, 20), 2.0), about(0.5), width_mm=width_mm, seed=1)
    pen_mm = float(np.median(drawing.sheet.widths_mm))
    assert felt_pen_mm(drawing.sheet, None, pen_mm) == pytest.approx(width_mm, abs=0.03)
