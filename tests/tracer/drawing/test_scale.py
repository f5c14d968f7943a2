"""The scale by two places that are a known distance apart: its figure, how exact it is, what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from morfax.motion.faults import DrawingFault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.scale import Known, Scale
from morfax.tracer.drawing.scan import Scan, Stated

SHEET = Scan(Path("scan.png"), np.zeros((3000, 2000), np.uint8))


def known(first: tuple[float, float], second: tuple[float, float], mm: float) -> Scale:
    """A scale by two places."""
    return Scale(known=Known(first, second, mm))


@pytest.mark.parametrize("angle_deg", [0, 30, 90, 200])
def test_two_places_give_the_scale_in_any_direction(angle_deg: float) -> None:
    """100 mm at 300 dpi are 1181.1 pixels."""
    length = 100 / MM_PER_INCH * 300 / 1.5
    away = (
        length * math.cos(math.radians(angle_deg)),
        length * math.sin(math.radians(angle_deg)),
    )
    scale = known((1000, 1500), (1000 + away[0], 1500 + away[1]), 100 / 1.5)
    assert scale.pitches_mm(SHEET) == pytest.approx((MM_PER_INCH / 300,) * 2, rel=1e-12)


def test_what_two_places_give_and_how_exactly_is_said() -> None:
    scale = known((100, 100), (1100, 100), 127)
    assert scale.notes(SHEET) == (
        "--known gives 200 dpi, a sheet of 254.00 x 381.00 mm; a pixel more or less makes 0.1 % of it",
    )
    assert Scale(dpi=200).notes(SHEET) == ()


def test_oblong_pixels_stay_oblong() -> None:
    """A fax of 204 x 98 dpi, measured down its side."""
    fax = Scan(Path("fax.tif"), SHEET.pixels, Stated((204.0, 98.0)))
    down = known((500, 100), (500, 100 + 980), 10 * MM_PER_INCH)
    assert down.pitches_mm(fax) == pytest.approx(
        (MM_PER_INCH / 204, MM_PER_INCH / 98), rel=1e-12
    )


@pytest.mark.parametrize("second", [(500, 500), (599, 500), (500, 401)])
def test_places_too_near_each_other_are_refused(second: tuple[float, float]) -> None:
    with pytest.raises(
        DrawingFault, match=r"places (0|99) pixels apart; give two that are 100"
    ):
        known((500, 500), second, 100).pitches_mm(SHEET)


@pytest.mark.parametrize("place", [(-1, 5), (2001, 5), (5, 3001), (math.nan, 5)])
def test_a_place_beside_the_page_is_refused(place: tuple[float, float]) -> None:
    with pytest.raises(DrawingFault, match=r"which is not on the page of 2000 x 3000 pixels"):
        known((500, 500), place, 100).pitches_mm(SHEET)


@pytest.mark.parametrize("length_mm", [1e-3, 1e6])
def test_a_length_that_no_scan_has_is_refused(length_mm: float) -> None:
    with pytest.raises(
        DrawingFault, match=r"--known is .*; it must give pixels of 0.001 to 10 mm"
    ):
        known((500, 500), (1500, 500), length_mm).pitches_mm(SHEET)


def test_only_one_way_to_give_a_scale() -> None:
    two = Scale(dpi=300, known=Known((0, 0), (500, 0), 100))
    with pytest.raises(
        DrawingFault, match=r"both --dpi and --known .* give one of --dpi and --known"
    ):
        two.pitches_mm(SHEET)
