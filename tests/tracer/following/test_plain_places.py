"""Plain places: a kernel tells their order, and what the head sees there is made out for those asked for."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following import plain_places
from morfax.tracer.following.plain_places import (
    aperture_for,
    places_of,
    plainest_first,
    view_of,
)
from morfax.tracer.program.trace import trace
from tests.tracer.inked import arc, inked, polyline

TWO_PX_DPI = 102.0  # a line of 0.5 mm is two pixels wide
WAVE_MM = np.linspace(0.0, 24.0, 400)
LINES = {
    "circle": [arc((12, 12), 4.0)],
    "wave": [np.column_stack([WAVE_MM + 4, 10 + 2 * np.sin(WAVE_MM / 2)])],
    "corners and a crossing": [polyline((4, 4), (24, 4), (24, 18), (10, 2))],
}


@pytest.mark.parametrize("name", LINES)
def test_the_kernel_puts_places_in_the_order_of_what_is_felt_there(name: str) -> None:
    sheet = Sheet.of(inked(*LINES[name], seed=5))
    stroke = sheet.longest()
    view = view_of(sheet, None, stroke.width_mm)
    places = places_of(stroke, None)
    felt = [plain_places._stance_at(view, place) for place in places]
    clean = [each for each in felt if each is not None]
    clean.sort(key=lambda each: each[1:], reverse=True)
    found = list(plainest_first(view, places))
    assert len(clean) > 10
    assert [stance.place_mm.tolist() for stance in found] == [
        stance.place_mm.tolist() for stance, _, _ in clean
    ]


def test_a_place_is_made_out_only_when_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = Sheet.of(inked(*LINES["circle"], seed=5))
    stroke = sheet.longest()
    view, made_out = view_of(sheet, None, stroke.width_mm), list[Array]()
    whole = plain_places._stance_at
    monkeypatch.setattr(
        plain_places,
        "_stance_at",
        lambda view, place: made_out.append(place) or whole(view, place),
    )
    assert next(plainest_first(view, places_of(stroke, None))) is not None
    assert len(made_out) == 1


def test_cells_are_no_finer_than_large_pixels_but_no_spot_hides_a_thin_line() -> None:
    """At 300 dpi a third of the width is wider than the steps; at 100 dpi lines of 2 pixels are seen through
    0.9 pixels, and hard ones through 1.4.
    """
    fine, coarse = inked(*LINES["circle"]), inked(*LINES["circle"], dpi=100)
    hard = replace(coarse, is_hard=True)
    assert aperture_for(fine, 0.5) == pytest.approx(0.15)
    assert aperture_for(coarse, 0.5) == pytest.approx(0.45 * 0.5)
    assert aperture_for(hard, 0.5) == pytest.approx(1.4 * coarse.pitch_mm)
    # the pixels that count are the scan's own
    finer = replace(hard, pitch_mm=0.5 * hard.pitch_mm, finer=2)
    assert aperture_for(finer, 0.5) == aperture_for(hard, 0.5)


def test_a_scan_of_two_levels_is_followed_within_half_a_pixel() -> None:
    """Cells finer than the pixels followed their steps into a bend, 0.32 mm (1.3 pixels) off."""
    turns = np.linspace(0, math.tau, 2000)
    radii = 14 + 2 * np.cos(3 * turns)
    lobes = 22 + np.column_stack([radii * np.cos(turns), radii * np.sin(turns)])
    ink = inked(lobes, dpi=TWO_PX_DPI).darkness
    levels = np.where(ink > 0.5, 0, 255).astype(np.uint8)
    scan = Scan(Path("two.png"), levels, Stated((TWO_PX_DPI, TWO_PX_DPI)))
    drawing = Drawing.of(scan, Scale())
    assert drawing.is_hard
    run = trace(drawing).lines[0]
    off_mm = distance(run.xy_mm[::4], lobes).path_to_reference.max_mm
    assert off_mm < 0.5 * drawing.finer * drawing.pitch_mm


@pytest.mark.parametrize("pitch_mm", [0.04, 0.25])
def test_the_ring_about_a_place_is_outside_of_its_own_ink_and_of_several_pixels(
    pitch_mm: float,
) -> None:
    """Within half a width it would see ink all round; far out it sees other lines."""
    radii = list[float]()

    def ring(_: Array, radius_mm: float) -> list[Array]:
        radii.append(radius_mm)
        return []

    view = SimpleNamespace(on_edge=False, width_mm=0.5, pitch_mm=pitch_mm, ring=ring)
    assert plain_places._heading(cast(Any, view), np.zeros(2)) is None
    (radius_mm,) = radii
    assert radius_mm > 0.75 * view.width_mm and radius_mm >= 4 * pitch_mm
    assert radius_mm < max(1.25 * view.width_mm, 6 * pitch_mm)


@pytest.mark.parametrize("name", LINES)
def test_whether_the_head_can_stand_is_told_by_the_kernel(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Place by place as what is felt there has it; to make it out took 4 % of a plate of holes."""
    sheet = Sheet.of(inked(*LINES[name], seed=5))
    stroke = sheet.longest()
    view = view_of(sheet, None, stroke.width_mm)
    off = np.random.default_rng(6).normal(0.0, 0.3, stroke.middles_mm.shape)
    places = np.vstack([stroke.middles_mm, stroke.middles_mm + off])
    stands = [plain_places._stance_at(view, place) is not None for place in places]
    assert 10 < sum(stands) < len(places)
    assert (plain_places._scores(view, places)[:, 0] > 0).tolist() == stands
    monkeypatch.setattr(plain_places, "_stance_at", None)
    here = tuple(places[stands.index(True)].tolist())
    assert plain_places.stands_near(view, stroke, here)
    monkeypatch.setattr(plain_places, "places_of", lambda *_: places[~np.array(stands)])
    assert not plain_places.stands_near(view, stroke, here)
