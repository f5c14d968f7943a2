"""Rubber and pen on drawings whose geometry is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.faults import CardFault
from morfax.tracer.corrections.corrections import (
    Correction,
    Corrections,
    PictureFile,
    Place,
    Span,
)
from morfax.tracer.corrections.on_sheet import SheetSize
from morfax.tracer.drawing.corrected import corrected
from morfax.tracer.drawing.drawing import Drawing
from tests.tracer.inked import NOISE, UM, arc, inked, polyline


def mm(x: float, y: float) -> Place:
    """A place on the sheet."""
    return Place(x, y, "mm")


def with_ink(drawing: Drawing, *each: Correction) -> Drawing:
    """A drawing with corrections."""
    return corrected(drawing, Corrections(each))


def changed(drawing: Drawing) -> frozenset[int]:
    """The numbers of the corrections that changed ink."""
    assert drawing.corrected is not None
    return drawing.corrected.ink_changed


def test_under_the_rubber_is_paper_without_noise_and_elsewhere_nothing_changes() -> None:
    drawing = inked(polyline((4, 10), (30, 10)), seed=1)
    rubbed = with_ink(drawing, Correction("rub", (mm(12, 10), mm(14, 10)), Span(3, "mm")))
    assert changed(rubbed) == {1}
    rows, columns = np.mgrid[: len(drawing.darkness), : drawing.darkness.shape[1]]
    x = (columns + 0.5) * drawing.pitch_mm
    y = drawing.height_mm - (rows + 0.5) * drawing.pitch_mm
    away = np.hypot(x - np.clip(x, 12, 14), y - 10)
    assert np.all(rubbed.darkness[away < 1.5 - drawing.pitch_mm] == 0)
    outside = away > 1.5 + drawing.pitch_mm
    assert np.array_equal(rubbed.darkness[outside], drawing.darkness[outside])


def test_an_area_is_rubbed_out_to_its_edges() -> None:
    drawing = inked(polyline((4, 10), (30, 10)), polyline((4, 14), (30, 14)))
    corners = (mm(10, 8), mm(20, 8), mm(20, 12), mm(10, 12))
    rubbed = with_ink(drawing, Correction("rub-area", corners))
    gone_mm2 = (drawing.darkness - rubbed.darkness).sum() * drawing.pitch_mm**2
    # two lines: half of a column's ink is the lower one's
    across_mm = drawing.darkness[:, round(8 / drawing.pitch_mm)].sum() * drawing.pitch_mm / 2
    a_pixel_mm2 = float(drawing.pitch_mm * across_mm)
    assert gone_mm2 == pytest.approx(10 * across_mm, abs=2 * a_pixel_mm2)  # one at each edge


def test_a_filled_shape_is_gone_where_it_is_rubbed_out() -> None:
    """Where shapes are is known on a picture of pixels four times as large."""
    blank = np.zeros((200, 300), np.float32)
    drawing = Drawing(blank, 0.1, shapes=np.ones((50, 75), bool))
    corners = (mm(4, 4), mm(12, 4), mm(12, 8), mm(4, 8))
    left = with_ink(drawing, Correction("rub-area", corners)).shapes
    assert left is not None
    assert not left[30:40, 10:30].any()
    left[29:41, 9:31] = True  # a pixel about it may go with it
    assert left.all()


@pytest.mark.parametrize("seed", [None, 3])
@pytest.mark.parametrize("aside_mm", [0.0, 0.25])
def test_a_bridge_goes_on_as_the_line_does(seed: int | None, aside_mm: float) -> None:
    """A gap of 6 mm in a circle of 20 mm: a straight stroke would be 225 um off its middle."""
    half, radius_mm, middle = 3 / 20, 20.0, 26.0
    gap = inked(
        arc((middle, middle), radius_mm, math.degrees(half), 360 - math.degrees(half)),
        seed=seed,
    )
    x, y = middle + radius_mm * math.cos(half), radius_mm * math.sin(half)
    ends = (mm(x + aside_mm, middle + y), mm(x - aside_mm, middle - y))
    bridged = with_ink(gap, Correction("bridge", ends))
    whole = inked(arc((middle, middle), radius_mm))
    drawn = bridged.darkness != gap.darkness
    assert changed(bridged) == {1}
    # a middle that is off by d changes the darkness at an edge by d over the softness, 0.05 mm, at most
    off = np.abs(
        bridged.darkness - whole.darkness[: len(gap.darkness), : gap.darkness.shape[1]]
    )[drawn]
    assert np.percentile(off, 95) < 15 * UM / 0.05 + (4 * NOISE if seed else 0.0)


def test_a_bridge_is_as_dark_and_as_wide_as_its_line() -> None:
    drawing = inked(polyline((4, 10), (14, 10)), polyline((20, 10), (30, 10)), width_mm=0.8)
    faint = Drawing(0.6 * drawing.darkness, drawing.pitch_mm)
    bridged = with_ink(faint, Correction("bridge", (mm(14, 10), mm(20, 10))))
    across, line = (bridged.darkness[:, round(x / drawing.pitch_mm)] for x in (17, 8))
    assert across.max() == pytest.approx(line.max(), rel=0.01)
    assert across.sum() == pytest.approx(line.sum(), rel=0.01)
    assert (
        np.abs(across - line).max() < 0.03
    )  # of the contrast: a fortieth of a pixel at an edge


def test_a_pen_of_its_own_width_and_a_dot() -> None:
    drawing = inked(polyline((4, 10), (30, 10)))
    drawn = with_ink(
        drawing,
        Correction("bridge", (mm(6, 5), mm(20, 6)), Span(0.3, "mm")),
        Correction("bridge", (mm(25, 6),), Span(2, "mm")),
    )
    more_mm2 = (drawn.darkness - drawing.darkness).sum() * drawing.pitch_mm**2
    stroke_mm2 = math.hypot(14, 1) * 0.3 + math.pi * 0.15**2
    assert more_mm2 == pytest.approx(stroke_mm2 + math.pi, rel=0.02)


def test_what_changes_no_ink_is_known() -> None:
    drawing = inked(polyline((4, 10), (30, 10)), seed=2)
    idle = with_ink(
        drawing,
        Correction("rub", (mm(20, 5),)),
        Correction("bridge", (mm(10, 10), mm(20, 10))),
        Correction("rub", (mm(20, 10),)),
    )
    assert changed(idle) == {3}


def test_pixels_stay_where_they_are_at_another_scale_and_resolution() -> None:
    said = Corrections(
        (Correction("stop", (Place(300, 200),)),), PictureFile("scan.png", 1200, 800)
    )
    for width_mm, columns, rows in ((120, 1200, 800), (240, 1200, 800), (120, 600, 400)):
        size = SheetSize(width_mm, width_mm * 2 / 3, columns, rows)
        x, y = size.laid(said).stops[0].place_mm
        assert (x / width_mm, y / width_mm) == pytest.approx((0.25, 0.5))


def test_another_picture_is_refused() -> None:
    said = Corrections((), PictureFile("scan.png", 1200, 800), "scan.morfax.toml")
    with pytest.raises(
        CardFault, match=r"belongs to scan\.png of 1200 x 800 pixels, .* 1200 x 900"
    ):
        SheetSize(120, 90, 1200, 900).laid(said)


def test_a_place_beside_the_sheet_is_refused() -> None:
    said = Corrections((Correction("rub", (mm(10, 10), mm(130, 10))),))
    with pytest.raises(
        CardFault, match=r"correction 1, rub, is at 130mm,10mm, beside the sheet"
    ):
        SheetSize(120, 80, 1200, 800).laid(said)
