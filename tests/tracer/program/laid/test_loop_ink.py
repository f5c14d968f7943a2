"""Whether a pen along a loop draws what is there: everywhere, and nothing beside it."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.laid.loop_ink import ink_of, is_drawn, is_single, leaves_none
from morfax.tracer.tangles.compass import Core
from tests.tracer.inked import WIDTH_MM, Points, arc, inked, polyline

RING_MM = arc((14, 20), 2.0)
PLATE = polyline((4, 4), (40, 4), (40, 30), (4, 30), (4, 4))
RING = Core(np.array([[14.0, 20.0]]), 2.0, 0.5 * WIDTH_MM)


def of_ring(*others: Points, ring: Points = RING_MM, seed: int | None = 1) -> Drawing:
    """A plate with a ring of 2 mm about (14, 20), and some other lines."""
    return inked(PLATE, ring, *others, seed=seed)


def verdicts(drawing: Drawing, core: Core = RING) -> tuple[bool, bool]:
    """Whether a pen along a core finds ink wherever it draws, and draws all the ink of its patch."""
    sheet = drawing.sheet
    ink = ink_of(sheet, sheet.patch_at(np.array([14.0, 22.0])), WIDTH_MM)
    return is_drawn(ink, core), leaves_none(ink, core)


def test_a_ring_is_drawn_by_its_own_core_and_by_no_smaller_one() -> None:
    assert verdicts(of_ring()) == (True, True)
    assert verdicts(of_ring(), RING._replace(radius_mm=1.7)) == (False, False)


@pytest.mark.parametrize(
    ("open_deg", "is_whole"), [(0, True), (12, True), (35, False), (60, False)]
)
def test_a_ring_that_is_open_is_not_drawn(open_deg: float, is_whole: bool) -> None:
    """Of 35 degrees of the way, 1.2 mm, the pen's round ends leave 0.7 mm of paper; of 12 degrees none."""
    drawing = of_ring(ring=arc((14, 20), 2.0, 0, 360 - open_deg))
    assert verdicts(drawing) == (is_whole, True)


def test_a_speck_of_paper_on_the_line_is_none() -> None:
    drawing = of_ring()
    rows = len(drawing.darkness)
    row, column = (round(at / drawing.pitch_mm) for at in (20.0, 16.0))
    drawing.darkness[rows - row, column] = 0.0
    assert verdicts(drawing) == (True, True)


@pytest.mark.parametrize(("long_mm", "leaves"), [(0.2, True), (0.8, False), (3.0, False)])
def test_a_line_that_joins_a_ring_is_left(long_mm: float, leaves: bool) -> None:
    """One that reaches beyond the ring's ink by less than the pen is broad is a burr."""
    joined = polyline((16.0, 20), (16.0 + long_mm, 20))
    assert verdicts(of_ring(joined)) == (True, leaves)


def test_other_patches_are_none_of_a_rings_ink() -> None:
    """A line 0.9 mm beside the ring's: 0.4 mm of paper between them; and a dot within it."""
    beside, dot = polyline((16.9, 10), (16.9, 28)), polyline((14, 20), (14.01, 20))
    assert verdicts(of_ring(beside, dot)) == (True, True)
    sheet = of_ring(beside, dot).sheet
    ink = ink_of(sheet, sheet.patch_at(np.array([14.0, 22.0])), WIDTH_MM)
    off_mm = np.hypot(*(ink.places_mm - [14, 20]).T)
    dark = ink.darkness > 0.5
    assert np.abs(off_mm[dark] - 2.0).max() < WIDTH_MM
    assert ink.area_mm2 * dark.sum() == pytest.approx(2 * np.pi * 2.0 * WIDTH_MM, rel=0.06)


def test_a_large_rings_ink_is_seen_at_some_of_its_places() -> None:
    """No more than were asked for; each stands for as many as were left out."""
    sheet = of_ring().sheet
    patch = sheet.patch_at(np.array([14.0, 22.0]))
    every, some = ink_of(sheet, patch, WIDTH_MM, 10**6), ink_of(sheet, patch, WIDTH_MM, 400)
    assert 200 < len(some.places_mm) <= 400 < len(every.places_mm)
    assert len(some.places_mm) * some.area_mm2 == pytest.approx(
        len(every.places_mm) * every.area_mm2, rel=0.02
    )


def test_a_way_beside_itself_is_not_single() -> None:
    """An L whose arms are 0.1 mm broad, out along a line and back, and one whose arms are 1 mm broad."""
    assert is_single(RING)
    for wide_mm, single in ((0.1, False), (1.0, True)):
        corners = [(10, 10), (16, 10), (16, 10 + wide_mm), (10 + wide_mm, 10 + wide_mm)]
        corners += [(10 + wide_mm, 16), (10, 16)]
        core = Core(np.array(corners, float), 0.0, 0.5 * WIDTH_MM)
        assert is_single(core) == single
