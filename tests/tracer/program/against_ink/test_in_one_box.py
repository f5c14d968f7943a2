"""A way that cuts a step or a bump of less than a width is told; specks, ticks and blots on a right one are
not.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.against_ink import in_one_box as module
from morfax.tracer.program.against_ink.in_one_box import with_boxes
from morfax.tracer.program.against_ink.own_ink import (
    NEARLY,
    TILE_PX,
    OwnInk,
    parts,
    pen_of,
)
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.against_ink.test_own_ink import WIDTH_MM, closed

BUMP_MM = (24.0, 24.0)


def plate(high_mm: float) -> Points:
    """A plate of 40 x 20 mm with a bump in its upper side, as high as broad."""
    (x, y), half_mm = BUMP_MM, 0.5 * high_mm
    bump = (x + half_mm, y), (x, y + high_mm), (x - half_mm, y)
    return polyline((4, 4), (44, 4), (44, 24), *bump, (4, 24), (4, 4))


def told(drawing: Drawing, way: Points) -> list[tuple[float, float]]:
    """Where a closed way surely runs beside its ink."""
    return [place.place_mm for place in with_boxes(OwnInk(drawing, [closed(way)]), ())]


def speckled(drawing: Drawing, x_mm: float) -> Drawing:
    """A drawing with a light speck on the lower side of the plate, and a dark one beside it."""
    darkness, rows = drawing.darkness.copy(), len(drawing.darkness)
    row, column = (round(mm / drawing.pitch_mm - 0.5) for mm in (4.0, x_mm))
    darkness[rows - 1 - row, column], darkness[rows - 1 - row + 5, column + 1] = 0.0, 1.0
    return replace(drawing, darkness=darkness)


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_a_bump_of_less_than_a_width_is_told(seed: int | None) -> None:
    """What is over there is far below what a speck leaves."""
    drawing, way = inked(plate(0.5), seed=seed), plate(0.0)
    (place_mm,) = told(drawing, way)
    assert math.dist(place_mm, BUMP_MM) < 2 * WIDTH_MM


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_way_that_was_drawn_is_not(seed: int | None) -> None:
    assert told(inked(plate(0.4), seed=seed), plate(0.4)) == []


def test_a_light_speck_beside_a_dark_one_is_none() -> None:
    drawing = speckled(inked(plate(0.0), seed=1), 20.0)
    own = OwnInk(drawing, [closed(plate(0.0))])
    assert list(own.beside(NEARLY)), "specks must be over, or nothing is tried"
    assert with_boxes(own, ()) == ()


def test_ticks_blots_and_other_lines_are_none() -> None:
    tick, bar = polyline((10, 24), (10, 25)), polyline((30, 4), (30, 24))
    drawing = inked(plate(0.4), tick, bar, specks=[arc((16, 4.2), 0.5)], seed=1)
    assert told(drawing, plate(0.4)) == []


def test_the_kernel_is_its_plain_python() -> None:
    drawing = inked(plate(0.5), dpi=150, seed=1)
    own = OwnInk(drawing, [closed(plate(0.0))])
    ways, pen = own.ways, pen_of(drawing, own.ways)
    places_mm = np.array([module.place_of_mm(drawing, place) for place in ways.places_px])
    is_station = np.hypot(*(places_mm - BUMP_MM).T) < WIDTH_MM
    for part in parts(drawing, ways, is_station, TILE_PX, pen):
        asked: list[Array] = [
            kernel(part.seen, part.ways, part.at, part.pen, part.room)
            for kernel in (module.in_one_box, module.in_one_box.py_func)
        ]
        np.testing.assert_allclose(*asked)
