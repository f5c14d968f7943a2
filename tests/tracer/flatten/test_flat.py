"""Small photographs made flat, against the truth: marks, edges of the sheet, four places; what is refused.

Tolerances: an edge is found to a tenth of a pixel (25 µm of these small photographs) wherever it is looked
for, and many are fitted.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace

import cv2
import numpy as np
import pytest

from morfax.motion.faults import DrawingFault
from morfax.tracer.flatten.flat import flattened
from morfax.tracer.flatten.format_choice import tilt_and_cost
from morfax.tracer.flatten.layout import Layout
from morfax.tracer.flatten.wanted import Wanted, parsed
from tests.tracer.flatten.photographs import (
    A4,
    FOCAL,
    LETTER,
    PAPER,
    Picture,
    Size,
    fill,
    made,
    marked,
    off_mm,
    phone,
    plain,
    rms,
)

MARKS, AUTO = Wanted("marks"), Wanted("auto")
MM = 1.0


@pytest.fixture(scope="module")
def photograph() -> Picture:
    """A sheet with marks, tilted by 15 degrees."""
    return phone(15, 0.03).photograph(marked(), A4)


# --- marks


@pytest.mark.parametrize(("tilt_deg", "k1"), [(0, 0.0), (25, 0.05), (25, -0.05)])
def test_marks_flatten_a_tilted_sheet_behind_a_bent_lens(tilt_deg: float, k1: float) -> None:
    camera = phone(tilt_deg, k1)
    found = made(camera.photograph(marked(), A4), AUTO)
    off = off_mm(found, camera, A4)
    assert rms(off) < 0.03 * MM  # asked of 12 Mpx: 0.06
    assert math.degrees(found.tilt_rad) == pytest.approx(tilt_deg, abs=0.3)
    assert re.fullmatch(
        r"1[34] of 14 marks on a4, 210 x 297 mm", found.told
    )  # some are 25 px small
    assert found.bar_mm == pytest.approx(100, abs=0.1)
    assert found.fit is not None and found.fit.size_share < 0.001
    assert found.fit.softness_px == pytest.approx(
        0.6, abs=0.25
    )  # the small print's own blur is in it


def test_the_sheet_of_letter_is_told_by_its_marks() -> None:
    camera = phone(10)
    found = made(camera.photograph(marked("letter"), LETTER), MARKS)
    assert found.paper.name == "letter" and rms(off_mm(found, camera, LETTER)) < 0.03 * MM


def test_marks_that_are_covered_are_done_without() -> None:
    sheet = marked()
    layout = Layout.of("a4")
    for number in (0, 5, 8):
        (left, top), _, (right, bottom), _ = layout.marks_mm[number]
        fill(sheet, (left - 3, bottom - 3, right, top - 4), PAPER)
    camera = phone(15, 0.03)
    found = made(camera.photograph(sheet, A4), MARKS)
    assert found.told.startswith("11 of 14 marks")
    assert rms(off_mm(found, camera, A4)) < 0.04 * MM


def test_the_flat_sheet_holds_what_was_drawn_and_no_marks(photograph: Picture) -> None:
    flat, pitch_mm, found = flattened(photograph, MARKS, focal=FOCAL)
    assert pitch_mm == pytest.approx(
        found.mm_per_px[0], rel=1e-3
    )  # whole pixels fill the width
    assert flat.shape[1] * pitch_mm == pytest.approx(210)
    assert 0 <= len(flat) * pitch_mm - 297 < pitch_mm
    darkest = flat[..., 1:].min(axis=2)  # as the head sees it, without red
    level = cv2.blur(cv2.dilate(darkest, np.ones((9, 9))), (31, 31)).astype(int)
    assert (
        level - darkest
    ).max() < 25  # levels; ink has 150: neither marks, nor bar, nor grid, nor table


def test_a_bar_of_99_6_mm_makes_everything_smaller(photograph: Picture) -> None:
    whole, small = (made(photograph, MARKS, bar) for bar in (100.0, 99.6))
    assert small.mm_per_px == pytest.approx([0.996 * mm for mm in whole.mm_per_px])
    assert small.bar_mm == pytest.approx(99.6, abs=0.1)
    assert "209.16 x 295.812 mm" in small.told


def test_a_bent_sheet_is_told_and_one_bent_further_refused(photograph: Picture) -> None:
    def bent(px: float) -> Picture:
        """The photograph, its middle drawn aside."""
        rows, columns = photograph.shape[:2]
        x, y = np.meshgrid(
            np.arange(columns, dtype=np.float32), np.arange(rows, dtype=np.float32)
        )
        x += np.float32(px) * np.sin(2 * np.pi * y / rows)
        return np.asarray(cv2.remap(photograph, x, y, cv2.INTER_LINEAR), np.uint8)

    found = made(bent(4), MARKS)
    assert len(found.warnings) == 1 and "press the sheet flat" in found.warnings[0]
    # a mark at the crest of the bend lies off by some 4 pixels, one between crests by none
    assert found.fit is not None and found.fit.max_mm > 1.3 * found.fit.rms_mm
    with pytest.raises(
        DrawingFault, match=r"marks are up to .* mm off a flat sheet.*more than 1 %"
    ):
        made(bent(30), MARKS)
    assert made(photograph, MARKS).warnings == ()


def test_a_sheet_that_leaves_the_photograph_is_told_or_refused(photograph: Picture) -> None:
    told = made(
        np.ascontiguousarray(photograph[:, : -photograph.shape[1] // 8]), MARKS
    ).warnings
    assert any("outside the photograph" in text for text in told)
    with pytest.raises(DrawingFault, match=r"only 4 of 14 marks are seen, around"):
        made(np.ascontiguousarray(photograph[: len(photograph) // 5]), MARKS)


def test_two_sheets_are_refused(photograph: Picture) -> None:
    with pytest.raises(DrawingFault, match=r"mark \d+ is in the photograph twice"):
        made(np.hstack([photograph, photograph]), MARKS)


def test_a_mirrored_photograph_has_no_marks(photograph: Picture) -> None:
    with pytest.raises(DrawingFault, match="shows no marks; print a sheet"):
        made(np.ascontiguousarray(photograph[:, ::-1]), MARKS)


def test_ink_that_spreads_moves_no_mark() -> None:
    spread = cv2.erode(marked(), np.ones((5, 5)))  # 0.2 mm on all sides
    camera = phone(10)
    found = made(camera.photograph(np.asarray(spread, np.uint8), A4), MARKS)
    assert found.fit is not None and found.fit.gain_mm == pytest.approx(0.2, abs=0.04)
    assert rms(off_mm(found, camera, A4)) < 0.03 * MM


def test_a_blurred_photograph_is_told() -> None:
    found = made(plain(phone(5, blur_px=4), A4), parsed("paper=a4"))
    assert len(found.warnings) == 1
    assert re.match(r"the photograph is blurred by more than 2\.5 pixels", found.warnings[0])


# --- by itself


def test_the_one_format_that_fits_is_taken() -> None:
    camera = phone(10, 0.01)
    found = made(plain(camera, LETTER), AUTO)
    assert found.told == "edges of letter, 215.9 x 279.4 mm"
    assert found.warnings == (
        "morfax takes the sheet for letter, 215.9 x 279.4 mm, by its shape alone; if it has another format,"
        " give that, such as --flatten paper=a4",
    )


def test_sheets_of_the_a_series_cannot_be_told_apart() -> None:
    with pytest.raises(DrawingFault) as refused:
        made(plain(phone(20), A4), AUTO)
    said = str(refused.value)
    assert "its sheet can be a4, a3, a5, a2 or a6" in said
    assert "--flatten paper=a4" in said and "--flatten marks" in said and "X,Y X,Y" in said


def test_a_sheet_of_no_known_format() -> None:
    size: Size = (200.0, 200.0)
    with pytest.raises(
        DrawingFault,
        match="has the shape of no known format; give its size, such as --flatten paper=148",
    ):
        made(plain(phone(10), size), AUTO)


@pytest.mark.parametrize("wanted", [AUTO, parsed("paper=a4")], ids=["auto", "paper"])
def test_a_photograph_without_marks_or_edges_is_refused_with_the_ways(wanted: Wanted) -> None:
    inside = plain(replace(phone(10), fills=1.6), A4)
    with pytest.raises(DrawingFault) as refused:
        made(inside, wanted)
    said = str(refused.value)
    assert "--flatten marks" in said and "X,Y X,Y" in said and "\n" not in said


# --- four places


def test_four_places_and_the_rectangle_that_they_are() -> None:
    camera = phone(20)
    corners = np.array([(40, 240), (170, 240), (170, 60), (40, 60)], float)
    x, y = camera.to_photo(corners, A4).T
    text = " ".join(f"{a:.3f},{b:.3f}" for a, b in zip(x, y, strict=True)) + "=130x180mm"
    flat, pitch_mm, found = flattened(plain(camera, A4), parsed(text), focal=FOCAL)
    assert flat.shape[1] * pitch_mm == pytest.approx(130)
    assert math.degrees(found.tilt_rad) == pytest.approx(20, abs=0.3)
    places = np.array([(50, 70), (160, 230)], float)
    back = found.projection.to_sheet(camera.to_photo(places, A4)) + np.array([40, 60])
    assert back == pytest.approx(places, abs=0.01 * MM)  # places to a thousandth of a pixel


def test_a_place_outside_the_photograph() -> None:
    with pytest.raises(
        DrawingFault, match="a place is outside the photograph, which has 1020 x 1360"
    ):
        made(plain(phone(), A4), parsed("0,0 4000,0 4000,900 0,900=130x180mm"))


# --- what a tilt costs


def test_what_a_tilt_costs_is_told_without_the_format() -> None:
    for tilt_deg in (0, 20):
        photograph = plain(phone(tilt_deg), A4)
        found = tilt_and_cost(photograph, FOCAL)
        assert found is not None
        finest, coarsest = made(photograph, parsed("paper=a4")).mm_per_px
        assert math.degrees(found[0]) == pytest.approx(tilt_deg, abs=2)  # roughly found edges
        assert found[1] == pytest.approx(coarsest / finest - 1, abs=0.05)
    assert tilt_and_cost(np.full((600, 400, 3), 200, np.uint8), FOCAL) is None
