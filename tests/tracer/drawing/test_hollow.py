"""Hollow lines: two lines that the scan hardly parts, against one line of any pen.

Broken on purpose, with `PALER` three times as large or a third, or `CERTAIN` left out, tests here fail.
"""

from __future__ import annotations

from functools import partial

import cv2
import numpy as np
import pytest

from morfax.jobs.remarks.hollow_lines import HollowLines
from morfax.tracer.drawing import hollow as hollow_lines
from morfax.tracer.drawing.deviation import darkness_across
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace import trace
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline

MIDDLE_MM, RADIUS_MM = (26.0, 26.0), 20.0
WITHIN_MM = 0.08  # of the rows' distance: a sixteenth of the ink's width, 1.25 mm


def hollow(drawing: Drawing, places: Points, width_mm: float) -> hollow_lines.Hollow | None:
    """The hollow stretches of a path on a drawing."""
    seen = partial(darkness_across, drawing)
    return hollow_lines.hollow(seen, places, width_mm, drawing.pitch_mm)


def rings(apart_mm: float, dpi: float, seed: int = 1) -> Drawing:
    """Two circles round one middle."""
    both = [arc(MIDDLE_MM, RADIUS_MM + side * apart_mm / 2) for side in (-1, 1)]
    return inked(*both, dpi=dpi, seed=seed)


@pytest.mark.parametrize(
    ("apart_mm", "dpi"),
    [(0.75, 120.0), (0.65, 150.0), (0.6, 200.0), (0.6, 300.0), (0.6, 100.0)],
)
def test_a_path_between_two_lines_is_told_with_their_distance(
    apart_mm: float, dpi: float
) -> None:
    drawing = rings(apart_mm, dpi)
    (line,) = trace(drawing).lines
    off_mm = np.abs(np.hypot(*(line.xy_mm - MIDDLE_MM).T) - RADIUS_MM)
    assert off_mm.max() < 0.1  # the path of neither
    found = hollow(drawing, line.places_mm, line.width_mm)
    assert found is not None
    assert found.length_mm > 0.9 * line.length_mm
    assert found.apart_mm == pytest.approx(apart_mm, abs=WITHIN_MM)
    assert np.hypot(*np.subtract(found.place_mm, MIDDLE_MM)) == pytest.approx(
        RADIUS_MM, abs=0.1
    )


def test_the_place_that_is_told_is_the_middle_of_the_longest_stretch() -> None:
    """Along X, on pixels of 0.05 mm and so in pieces of 3 mm: hollow from 3 to 9 mm, and from 15 to 27 mm."""

    def seen(places: Points, _headings: Points, across_mm: Points) -> Points:
        x = places[:, :1]
        is_hollow = ((x > 3) & (x < 9)) | ((x > 15) & (x < 27))
        return np.where(is_hollow & (np.abs(across_mm) < 0.3), 0.8, 1.0)

    found = hollow_lines.hollow(seen, polyline((0, 0), (45, 0)), 1.25, 0.05)
    assert found is not None and found.length_mm == 18.0
    assert found.place_mm == pytest.approx((21, 0))


def test_the_resolution_that_the_remark_advises_parts_the_lines() -> None:
    told = rings(0.75, 120.0)
    remarks = HollowLines.along(told, trace(told))
    assert remarks.finer == "scan at 250 dpi"
    (said,) = remarks.remarks()
    assert "scan at 250 dpi or more" in said and "two lines 0.7" in said
    finer = rings(0.75, 250.0)
    (line,) = trace(finer).lines
    assert (
        np.abs(np.abs(np.hypot(*(line.xy_mm - MIDDLE_MM).T) - RADIUS_MM) - 0.375).max() < 0.02
    )
    assert not tuple(HollowLines.along(finer, trace(finer)).remarks())


CORNERS = polyline((6, 6), (30, 9), (27, 31), (5, 28), (6, 6))


@pytest.mark.parametrize("dpi", [100.0, 150.0, 300.0])
@pytest.mark.parametrize("width_mm", [WIDTH_MM, 1.3])
@pytest.mark.parametrize("way", [arc(MIDDLE_MM, RADIUS_MM), CORNERS], ids=["round", "corners"])
def test_one_line_is_not_hollow(way: Points, width_mm: float, dpi: float) -> None:
    for seed in range(3):
        drawing = inked(way, width_mm=width_mm, dpi=dpi, seed=seed)
        (line,) = trace(drawing).lines
        assert hollow(drawing, line.places_mm, line.width_mm) is None


def test_a_pen_that_skips_here_and_there_leaves_no_hollow_line() -> None:
    """Specks of paper in the line's middle, a tenth of its ink: pale places, and no row of them."""
    drawing = inked(arc(MIDDLE_MM, RADIUS_MM), width_mm=1.0, seed=4)
    rng = np.random.default_rng(5)
    specks = cv2.GaussianBlur(rng.normal(size=drawing.darkness.shape), (0, 0), 1.5)
    worn = drawing.darkness * (specks < np.quantile(specks, 0.9))
    drawing = Drawing(np.asarray(worn, np.float32), drawing.pitch_mm)
    ring_mm = arc(MIDDLE_MM, RADIUS_MM)
    assert hollow(drawing, ring_mm, 1.0) is None


@pytest.mark.parametrize(("paler", "told"), [(0.04, False), (0.1, True)])
def test_a_middle_that_is_paler_by_what_a_scanner_s_sharpening_leaves_is_not_told(
    paler: float, told: bool
) -> None:
    """Sharpening leaves the rims of broad lines darker than their middle, by some percent."""
    ring_mm = arc(MIDDLE_MM, RADIUS_MM)
    broad, middle = inked(ring_mm, width_mm=1.2, seed=1), inked(ring_mm, width_mm=0.4)
    pixels = broad.darkness[: len(middle.darkness), : middle.darkness.shape[1]]
    darkness = np.asarray(pixels - paler * middle.darkness, np.float32)
    found = hollow(Drawing(darkness, middle.pitch_mm), ring_mm, 1.2)
    assert (found is not None) == told


def test_a_path_that_is_shorter_than_two_pieces_says_nothing() -> None:
    drawing = rings(0.75, 150.0)
    way = arc(MIDDLE_MM, RADIUS_MM)
    assert hollow(drawing, way, 1.25) is not None
    assert hollow(drawing, way[: len(way) // 40], 1.25) is None
