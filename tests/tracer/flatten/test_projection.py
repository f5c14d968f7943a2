"""The projection against its closed form: there and back, scale and tilt of a sheet before a lens."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.phone import Phone
from morfax.tracer.flatten.fit import homography_of
from morfax.tracer.flatten.formats import FORMATS, parsed
from morfax.tracer.flatten.projection import Focal, Pose, Projection, Rectangle
from tests.tracer.flatten.photographs import A4, Array

SHEET = Rectangle(*A4)
CORNERS = np.array([(0, 297), (210, 297), (210, 0), (0, 0)], float)
PX = 1e-6  # rounding of floats, times the way there and back
FOCAL = Focal.stated(26.0)


def projection(
    camera: Phone, corners_mm: Array = CORNERS, sheet: Rectangle = SHEET
) -> Projection:
    """The projection of a phone without distortion, by the sheet's corners."""
    photo = Rectangle(camera.columns, camera.rows)
    homography = homography_of(corners_mm, camera.to_photo(CORNERS, A4), sheet, photo)
    return Projection(sheet, photo, homography)


@pytest.mark.parametrize("k1", [-0.06, 0.0, 0.06])
def test_from_the_sheet_to_the_photograph_and_back(k1: float) -> None:
    plain = projection(Phone(tilt_rad=0.4, about_rad=1.0))
    lens = Projection(plain.sheet, plain.photo, plain.homography, k1, -k1 / 3)
    places = np.random.default_rng(1).uniform((0, 0), A4, (50, 2))
    assert lens.to_sheet(lens.to_photo(places)) == pytest.approx(places, abs=PX)


def test_scale_of_a_sheet_straight_before_the_lens() -> None:
    camera = Phone()
    across = camera.to_photo(CORNERS, A4)
    mm_per_px = 210 / float(np.hypot(*(across[1] - across[0])))
    assert projection(camera).mm_per_px() == pytest.approx((mm_per_px, mm_per_px), rel=1e-6)


@pytest.mark.parametrize("tilt_deg", [0, 5, 25, 50])
@pytest.mark.parametrize("about_rad", [0.0, 0.7, math.pi / 2])
def test_tilt_with_a_known_lens(tilt_deg: float, about_rad: float) -> None:
    camera = Phone(tilt_rad=math.radians(tilt_deg), about_rad=about_rad)
    found = math.degrees(projection(camera).tilt_rad(FOCAL))
    assert found == pytest.approx(
        tilt_deg, abs=0.1
    )  # degrees: the focal length is held loosely


def test_a_sheet_of_another_ratio_does_not_stand_rigidly() -> None:
    camera = Phone(tilt_rad=0.3, about_rad=0.7)
    letter = np.array([(0, 279.4), (215.9, 279.4), (215.9, 0), (0, 0)])
    other = projection(camera, letter, Rectangle(215.9, 279.4))
    assert Pose.of(projection(camera).homography, FOCAL).off < 0.5  # standard deviations
    assert Pose.of(other.homography, FOCAL).off > 10


def test_formats() -> None:
    assert parsed("A4") == FORMATS["a4"]
    assert parsed("148x105mm")[1:] == (148.0, 105.0)
    assert parsed("10 x 20cm")[1:] == (100.0, 200.0)
    assert parsed("8.5in x 11in")[1:] == pytest.approx((215.9, 279.4))
    for text in ("a44", "148", "0x105mm", "1x2mm", "xmm", "1e9x3"):
        with pytest.raises(ValueError, match=r"is no format of paper; give a4, letter"):
            parsed(text)
