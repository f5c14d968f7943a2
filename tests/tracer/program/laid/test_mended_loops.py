"""A small loop that the head cut short, ran round twice or half way is laid; what is none stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.polyline import length_mm, nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.laid.small_lines import small_lines
from morfax.tracer.program.laid.small_loops import Loop, SmallLoops
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, Points, arc, dot, inked, polyline
from tests.tracer.program.laid.ways import run_along

PLATE = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))
WIDTH_MM = 0.35
HOLE = arc((14, 20), 0.5)
CUT = arc((14, 20), 0.41)  # the head cut it short by 0.09 mm


def rectangle(x: float, y: float, wide_mm: float, high_mm: float) -> Points:
    """A rectangle from its lower left corner."""
    right, top = x + wide_mm, y + high_mm
    return polyline((x, y), (right, y), (right, top), (x, top), (x, y))


def loops_of(*drawn: Points, width_mm: float = WIDTH_MM) -> SmallLoops:
    """The small loops of a sheet with a plate."""
    return SmallLoops(inked(PLATE, *drawn, width_mm=width_mm, seed=1).sheet, Settings())


def as_run(way: Points, ending: str = "closed") -> Line:
    """The line of a head that ran along a way."""
    return replace(run_along(way, ending), width_mm=WIDTH_MM)


def off_mm(way: Points, drawn: Points) -> float:
    """How far a way is from what was drawn, and that from it, at most."""
    true = with_places(drawn, 2 * UM)
    return float(max(nearest_mm(way, true).max(), nearest_mm(true, way).max()))


@pytest.mark.parametrize(
    "line",
    [
        pytest.param(as_run(CUT), id="cut short"),
        pytest.param(as_run(np.vstack([HOLE, HOLE])), id="twice round"),
        pytest.param(as_run(arc((14, 20), 0.5, 0, 250), "ended"), id="not round"),
        pytest.param(replace(as_run(CUT), loop_from=40), id="from within"),
    ],
)
def test_a_hole_that_the_head_did_not_follow_is_laid(line: Line) -> None:
    """Closed, once round, within 20 um; by redrawn ink, and nothing of what went wrong is told of it."""
    mended = loops_of(HOLE).mended(line)
    assert mended is not line and mended.ending == "closed"
    assert off_mm(mended.xy_mm, HOLE) < 20 * UM
    assert mended.length_mm == pytest.approx(length_mm(HOLE), rel=0.01)
    assert mended.width_mm == pytest.approx(WIDTH_MM, rel=0.1)
    assert mended.led.lengths_mm(mended.xy_mm)[REDRAWN] == pytest.approx(
        mended.length_mm, rel=0.01
    )
    assert (mended.fault, mended.loop_from, mended.junctions_mm, mended.breaks) == (
        None,
        None,
        (),
        (),
    )


def test_a_hole_that_was_followed_and_marked_lines_stay() -> None:
    loops = loops_of(HOLE)
    right, cut = as_run(HOLE), as_run(CUT)
    for line in (right, replace(cut, reference_mm=(14.0, 20.0)), replace(cut, on_edge=True)):
        assert loops.mended(line) is line
    dot = Line.of_dot(np.array([14.0, 20.0]), WIDTH_MM, 1)
    assert loops.mended(dot) is dot


def patch_at(loops: SmallLoops, x: float, y: float) -> int:
    """The patch at a place."""
    return loops.sheet.patch_at(np.array([x, y]))


@pytest.mark.parametrize(
    ("drawn", "may_be"),
    [
        pytest.param(arc((14, 20), 0.85), True, id="15 widths round"),
        pytest.param(arc((14, 20), 1.2), False, id="22 widths round"),
        pytest.param(rectangle(10, 20, 9.5, 0.9), True, id="59 long, narrow"),
        pytest.param(rectangle(10, 20, 10.5, 0.9), False, id="65 long, narrow"),
        pytest.param(polyline((10, 20), (14, 20)), False, id="no paper within"),
    ],
)  # fmt: skip
def test_what_may_be_a_small_loop_is_short_or_narrow_and_has_paper_within(
    drawn: Points, may_be: bool
) -> None:
    """Up to 16 widths round, or up to 60 if its sides are hardly apart."""
    loops = loops_of(drawn)
    assert loops._may_be(patch_at(loops, 14, 20), WIDTH_MM) == may_be


@pytest.mark.parametrize(
    ("long_mm", "apart_mm", "is_loop"),
    [(3.0, 0.45, True), (3.0, 0.8, False), (0.9, 0.0, False), (26.0, 0.45, False)],
)
def test_a_filled_slot_is_a_loop_if_it_is_as_broad_as_two_lines(
    long_mm: float, apart_mm: float, is_loop: bool
) -> None:
    """From 1.15 to 2.7 lines, and from 2 to 60 lines long; a single stroke is not. At the sides' seam the ink
    is a little paler.
    """
    slot = polyline(
        (14, 20),
        (14 + long_mm, 20),
        (14 + long_mm, 20 + apart_mm),
        (14, 20 + apart_mm),
        (14, 20),
    )
    loops = loops_of(slot)
    patch = patch_at(loops, 14 + 0.5 * long_mm, 20)
    assert loops._is_broad(patch) == is_loop
    assert (patch in loops.slots) == is_loop
    if is_loop:
        loop = loops.slots[patch]
        assert off_mm(loop.way_mm, slot) < 50 * UM
        assert loop.length_mm == pytest.approx(length_mm(slot), rel=0.02)


def test_a_loop_as_a_line_has_its_number_and_is_closed() -> None:
    loops = loops_of(HOLE)
    loop = loops.of_patch(patch_at(loops, 14, 20.5), WIDTH_MM)
    assert isinstance(loop, Loop)
    line = loop.line(7)
    assert (line.number, line.ending, line.width_mm) == (7, "closed", loop.width_mm)
    assert line.xy_mm is loop.way_mm and line.length_mm == loop.length_mm


def test_small_lines_are_dots_and_slots_numbered_behind_the_lines() -> None:
    """A plate and a hole are lines 1 and 2; a dot is 3 and a narrow slot 4."""
    hole, slot = arc((30, 20), 3.0), rectangle(14, 10, 1.6, 0.6)
    drawing = inked(PLATE, hole, slot, width_mm=0.5, seed=1, specks=[dot((30, 12), 1.0)])
    (_, first), (patch, second) = small_lines(Setup(drawing.sheet))
    assert (first.number, first.is_dot, second.number, second.ending) == (3, True, 4, "closed")
    assert np.hypot(*(first.xy_mm[0] - [30, 12])) < 0.05
    assert patch == drawing.sheet.patch_at(np.array([15.0, 10.0]))
    assert off_mm(second.xy_mm, slot) < 50 * UM
    # where rings may be reference points no slot is looked for
    bare = Setup(replace(drawing.sheet, bare_rings=True))
    assert [line.is_dot for _, line in small_lines(bare)] == [True]
