"""Filled shapes: the head rides on their edge as on a line, round corners as sharp as drawn, and holes are
lines of their own.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from scipy.spatial import cKDTree

from morfax.motion.contour import distance
from morfax.motion.motion import thin
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.trace import trace
from tests.tracer.drawing.filled import CIRCLE, filled
from tests.tracer.inked import DPI, UM, Points, polyline

# five corners outward, one inward
STEPPED = polyline((8, 8), (28, 8), (28, 18), (18, 18), (18, 26), (8, 26), (8, 8))


def star(turned_deg: float = 7) -> Points:
    """Five tips of 36 degrees and five corners inward."""
    angle, radius = (
        np.radians(turned_deg + 36 * np.arange(11)),
        np.where(np.arange(11) % 2, 12 * 0.381966, 12),
    )
    return np.asarray(
        np.array([17, 17]) + np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    )


def nearest_um(path: Points, places: Points) -> Points:
    """How near a path comes to each of some places, um."""
    return np.asarray(cKDTree(path).query(places)[0]) / UM


def test_round_a_disc(tmp_path: Path) -> None:
    run = trace(Drawing.open(filled(tmp_path / "disc.png", CIRCLE), edge=True))
    found = distance(thin(run), CIRCLE)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 4 * UM, found  # asked: 5


def test_corners_are_sharp_both_outward_and_inward(tmp_path: Path) -> None:
    run = trace(Drawing.open(filled(tmp_path / "stepped.png", STEPPED), edge=True))
    found = distance(thin(run), STEPPED)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 4 * UM, found
    assert found.hausdorff_mm < 25 * UM, found  # asked: 60


@pytest.mark.parametrize("turned_deg", [7, 20])
def test_tips_of_36_degrees_are_sharp(tmp_path: Path, turned_deg: float) -> None:
    run = trace(Drawing.open(filled(tmp_path / "star.png", star(turned_deg)), edge=True))
    found = distance(thin(run), star(turned_deg))
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 4.5 * UM, found
    assert nearest_um(run.xy_mm, star(turned_deg)).max() < 50  # asked: 80


@pytest.mark.parametrize("times", [2, 6, 10])
def test_the_same_pixels_of_a_larger_print_are_followed_as_well(
    tmp_path: Path, times: int
) -> None:
    """At 150, 50 and 30 dpi the head follows on a smaller scale, and no faster on the sheet."""
    file = filled(tmp_path / "stepped.png", STEPPED)
    run = trace(Drawing.open(file, edge=True, dpi=DPI / times))
    found = distance(thin(run), times * STEPPED)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < times * 5 * UM, found
    assert found.hausdorff_mm < times * 30 * UM, found  # a third of a pixel, as at 300 dpi
    assert run.length_mm / run.duration_s < 10


def test_a_round_corner_stays_round(tmp_path: Path) -> None:
    """A round of 0.5 mm is six times as soft as the lens."""
    slot = shapely.box(10, 10, 26, 22).buffer(0.5, quad_segs=64)
    outline = np.array(slot.exterior.coords)
    run = trace(Drawing.open(filled(tmp_path / "slot.png", outline), edge=True))
    found = distance(thin(run), outline)
    assert run.ending == "closed" and found.hausdorff_mm < 30 * UM, (
        found
    )  # sharp corners would be 207 um out


@pytest.mark.parametrize(("shade", "light"), [(100, False), (0, True), (100, True)])
def test_on_uneven_paper_and_light_on_dark(tmp_path: Path, shade: float, light: bool) -> None:
    run = trace(
        Drawing.open(
            filled(tmp_path / "plate.png", STEPPED, shade=shade, light=light), edge=True
        )
    )
    found = distance(thin(run), STEPPED)
    assert run.ending == "closed" and found.path_to_reference.rms_mm < 6 * UM, (
        found
    )  # the noise is twice as much of the contrast
    assert found.hausdorff_mm < 50 * UM, found
