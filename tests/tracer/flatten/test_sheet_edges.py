"""A photograph is made flat by the edges of its sheet alone."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import cv2
import numpy as np
import pytest

from morfax.motion.faults import DrawingFault
from morfax.tracer.flatten.wanted import Wanted, parsed
from tests.tracer.flatten.photographs import (
    A4,
    LETTER,
    Picture,
    Size,
    blank,
    made,
    off_mm,
    phone,
    plain,
    rms,
)

MARKS, AUTO = Wanted("marks"), Wanted("auto")
MM = 1.0


@pytest.mark.parametrize(("tilt_deg", "k1"), [(0, 0.0), (25, 0.02), (25, -0.02)])
def test_edges_flatten_a_tilted_sheet(tilt_deg: float, k1: float) -> None:
    camera = phone(tilt_deg, k1)
    found = made(plain(camera, A4), parsed("paper=a4"))
    assert rms(off_mm(found, camera, A4)) < 0.1 * MM  # asked of 12 Mpx: 0.2
    assert math.degrees(found.tilt_rad) == pytest.approx(tilt_deg, abs=0.3)


def test_blur_makes_the_sheet_no_larger() -> None:
    camera = phone(0, blur_px=2)
    found = made(plain(camera, A4), parsed("paper=a4"))
    assert rms(off_mm(found, camera, A4)) < 0.05 * MM  # 0.18 by levels instead of light


def thumbed(picture: Picture, place_px: tuple[float, float], across_px: int = 90) -> Picture:
    """The photograph with a thumb at a place."""
    x, y = (round(v) for v in place_px)
    return np.asarray(
        cv2.circle(picture.copy(), (x, y), across_px // 2, (190, 140, 115), -1), np.uint8
    )


@pytest.mark.parametrize("place_mm", [(0, 297), (210, 0), (0, 150)])
def test_a_thumb_over_a_corner_or_an_edge(place_mm: tuple[float, float]) -> None:
    camera = phone(12, 0.01)
    thumb = camera.to_photo(np.array([place_mm], float), A4)[0]
    picture = thumbed(plain(camera, A4), (thumb[0], thumb[1]))
    found = made(picture, parsed("paper=a4"))
    assert rms(off_mm(found, camera, A4)) < 0.15 * MM


def test_a_sheet_lies_as_it_does_in_the_photograph() -> None:
    camera = phone(8)
    lying: Size = (148.0, 105.0)
    photograph = plain(camera, lying)
    for text in ("paper=148x105mm", "paper=105x148mm", "paper=a6"):
        found = made(photograph, parsed(text))
        assert (found.paper.width_mm, found.paper.height_mm) == lying


def test_paper_on_a_lighter_table_of_another_colour() -> None:
    camera = phone(10)
    grey = np.full_like(blank(A4), 120)
    photograph = camera.photograph(grey, A4)  # darker than …
    sheet = photograph.min(axis=2) > 80
    table = np.where(sheet[..., None], photograph, (205, 185, 120)).astype(np.uint8)
    assert rms(off_mm(made(table, parsed("paper=a4")), camera, A4)) < 0.5 * MM  # a jagged edge


def test_a_format_that_the_sheet_does_not_have_is_refused() -> None:
    picture = plain(phone(10, 0.01), LETTER)
    with pytest.raises(
        DrawingFault, match=r"sides of a4 \(210 x 297 mm\); letter would fit; give"
    ):
        made(picture, parsed("paper=a4"))


def test_a_named_format_is_believed_where_no_sheet_stands_so_and_this_is_told() -> None:
    camera = replace(phone(20), fills=0.7)
    shear = np.array([[1, 0.12, -80], [0, 1, 0]])
    sheet = plain(camera, A4)
    sheared = cv2.warpAffine(sheet, shear, sheet.shape[1::-1], borderValue=sheet[0, 0].tolist())
    found = made(np.asarray(sheared, np.uint8), parsed("paper=a4"))
    assert len(found.warnings) == 1
    assert re.match(
        r"no camera sees a sheet in this shape.* --flatten says that the sheet is a4$",
        found.warnings[0],
    )
    inside = np.array([(30, 30), (180, 40), (105, 150), (20, 270), (190, 260)], float)
    seen = camera.to_photo(inside, A4) @ shear[:, :2].T + shear[:, 2]
    assert np.abs(found.projection.to_sheet(seen) - inside).max() < 0.15 * MM  # 5 px a mm


def test_a_rigid_sheet_of_other_sides_is_not_the_named_one() -> None:
    with pytest.raises(DrawingFault, match="does not have the sides of a4"):
        made(plain(phone(10), (200.0, 200.0)), parsed("paper=a4"))
