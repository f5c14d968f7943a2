"""Parts of closed lines: a part is the very same positions, and parts that are joined are one run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import length_mm, nearest_mm, with_places
from morfax.motion.usual import FEED_MM_S, THINNED
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.head.leaders import CELL, MEMORY, REDRAWN, Led
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    back_along,
    is_bare,
    is_clear,
    is_plain,
    part_of,
    run_on,
)
from morfax.tracer.program.setup import Setup
from tests.tracer.inked import UM, WIDTH_MM, arc, inked, polyline
from tests.tracer.program.laid.ways import STEP_MM, run_along, steps_mm

SQUARE = polyline((5, 5), (25, 5), (25, 25), (5, 25), (5, 5))  # 80 mm round
PLACE_MM = THINNED * STEP_MM  # from one of a line's places to the next


@pytest.mark.parametrize(("first", "last", "long_mm"), [(200, 600, 20.0), (1500, 100, 10.0)])
def test_a_part_runs_from_place_to_place_and_over_the_beginning(
    first: int, last: int, long_mm: float
) -> None:
    """To a place of 50 um; no step of it is longer than the head's own."""
    line = run_along(SQUARE)
    part = part_of(line, first, last)
    assert part.xy_mm[0] == pytest.approx(line.places_mm[first])
    assert np.hypot(*(part.xy_mm[-1] - line.places_mm[last])) < 2 * PLACE_MM
    assert length_mm(part.xy_mm) == pytest.approx(long_mm, abs=2 * PLACE_MM)
    assert steps_mm(part).max() < 1.01 * STEP_MM


def test_a_part_is_of_whole_places_and_led_by_whom_the_line_was() -> None:
    count = len(run_along(SQUARE).xy_mm)
    leaders = np.where(np.arange(count) < count // 2, CELL, MEMORY).astype(np.int8)
    line = run_along(SQUARE, led=Led.along(leaders))
    part = part_of(line, 1400, 300)
    led = part.led.of(len(part.xy_mm))
    assert len(part.xy_mm) % THINNED == 0
    at = np.argmin(np.abs(part.xy_mm - [5, 5]).sum(axis=1))  # the line's beginning
    assert set(led[: at - 1]) == {MEMORY} and set(led[at + 1 :]) == {CELL}


def test_a_line_that_is_turned_round_ends_where_it_began() -> None:
    leaders = np.repeat(np.array([CELL, MEMORY], np.int8), 24000)
    line = run_along(SQUARE, led=Led.along(leaders))
    back = back_along(line)
    assert np.array_equal(back.xy_mm, line.xy_mm[::-1])
    assert np.array_equal(back.led.of(len(back.xy_mm)), line.led.of(len(line.xy_mm))[::-1])


def test_two_lines_and_two_sides_between_them_are_one_closed_line() -> None:
    """Round the one, over the one side, round the other, and back: within 10 um, without a jump."""
    left, right = arc((10, 12), 5, 90, 270), arc((26, 12), 5, -90, 90)
    parts = [
        run_along(left, number=4, ink_mm=31.0, junctions_mm=((10.0, 17.0), (10.0, 7.0))),
        run_along(right, number=2, ink_mm=33.0, junctions_mm=((26.0, 7.0), (10.0, 17.0))),
    ]
    leg = len(left) // 10  # onto the next line
    there = LaidWay((np.vstack([left[-1:], right[:leg]]),), 0.5 * WIDTH_MM)
    back = LaidWay((np.vstack([right[-1:], left[:leg]]),), 0.5 * WIDTH_MM)
    setup = Setup(inked(left, right, width_mm=WIDTH_MM).sheet)
    line = run_on(setup, parts, [there, back])
    whole = np.vstack([left, right, left[:1]])
    assert (line.ending, line.number, line.ink_mm) == ("closed", 2, 33.0)
    assert line.junctions_mm == ((10.0, 17.0), (10.0, 7.0), (26.0, 7.0))
    assert line.length_mm == pytest.approx(length_mm(whole), rel=0.005)
    assert nearest_mm(line.places_mm, with_places(whole, 2 * UM)).max() < 10 * UM
    assert np.hypot(*(line.xy_mm[0] - line.xy_mm[-1])) < PLACE_MM
    # the sides are run from memory, with no step longer than at 10 mm/s, and a twentieth
    sides_mm = there.length_mm + back.length_mm
    assert line.led.lengths_mm(line.xy_mm)[REDRAWN] == pytest.approx(sides_mm, rel=0.03)
    assert steps_mm(line).max() * MOTION_RATE_HZ < 1.05 * FEED_MM_S


def test_lines_with_marks_guides_or_leads_and_edges_are_not_plain() -> None:
    line = run_along(SQUARE)
    mark = Mark("dot", (5.0, 5.0), 0.0)
    assert is_plain(line) and is_bare(line)
    assert not is_plain(replace(line, ending="ended")) and is_bare(
        replace(line, ending="ended")
    )
    for other in (
        replace(line, marks=(mark,)),
        replace(line, reference_mm=(5.0, 5.0)),
        replace(line, guides=(GuideLine(300, 400, 500),)),
        replace(line, loop_from=300),
        replace(line, on_edge=True),
    ):
        assert not is_plain(other) and not is_bare(other)


def test_only_lines_on_pixels_that_show_where_a_pen_was_are_clear() -> None:
    drawing = inked(SQUARE)
    assert is_clear(drawing)
    assert is_clear(replace(drawing, finer=2))
    assert not is_clear(replace(drawing, is_hard=True))
    assert not is_clear(replace(drawing, edges_mm=(SQUARE,)))
    assert not is_clear(
        Drawing(np.asarray(drawing.darkness > 0.5, np.float32), drawing.pitch_mm)
    )
