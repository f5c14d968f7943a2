"""A line as it was followed, on ways whose geometry is known: what it passes, where it turns and leads."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import with_places
from morfax.motion.usual import FEED_MM_S, MOTION_RATE_HZ, THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark

WIDTH_MM = 0.5
STEP_MM = FEED_MM_S / MOTION_RATE_HZ  # from one position of the head to the next
THIN_MM = THINNED * STEP_MM  # from one place of a way to the next
LEAD = np.array([(0, 0), (10, 0), (10, 5), (15, 5), (15, 0), (10, 0)], float)
JOINED = 10.0 / STEP_MM  # the position at which the loop of that begins


def way(*places: tuple[float, float]) -> Array:
    """Positions of the head along straight pieces, (n, 2) mm."""
    return with_places(np.array(places, float), STEP_MM)


def line(xy_mm: Array, ending: str = "ended", **more: object) -> Line:
    length_mm = float(np.hypot(*np.diff(xy_mm, axis=0).T).sum())
    return Line(xy_mm, ending, WIDTH_MM, length_mm, **more)  # type: ignore[arg-type]


def test_a_way_that_comes_by_its_own_end_passes_it() -> None:
    """It leaves 10,0, comes by there again 80.2 mm on and 0.2 mm away, and ends 10 mm further."""
    passes = line(way((10, 0), (30, 0), (30, 20), (0, 20), (0, 0.2), (10, 0.2), (10, 10)))
    end = passes.passes_its_end(0.3, 20.0)
    assert end is not None and np.array_equal(end, (10, 0))
    assert passes.passes_its_end(0.1, 20.0) is None  # not as near
    assert passes.passes_its_end(0.3, 100.0) is None  # not as far on
    turned = line(passes.xy_mm[::-1])
    assert np.array_equal(turned.passes_its_end(0.3, 20.0), (10, 0))  # type: ignore[arg-type]


def test_a_way_that_comes_back_to_its_beginning_and_ends_there_passes_no_end() -> None:
    closed = line(way((10, 0), (30, 0), (30, 20), (0, 20), (0, 0), (9.9, 0)))
    assert closed.passes_its_end(0.3, 20.0) is None


def test_an_open_line_has_a_gap_where_its_end_points_at_its_beginning() -> None:
    square = ((12, 0), (30, 0), (30, 20), (0, 20), (0, 0))
    assert line(way(*square, (9, 0))).gap_mm == pytest.approx(3.0)
    assert line(way(*square, (9, 0)), "joined").gap_mm is None
    assert line(way(*square, (6, 0))).gap_mm is None  # 6 mm are too far
    assert line(way(*square, (9, 0), (9, 3))).gap_mm is None  # it points elsewhere
    assert line(way((12, 3), *square, (9, 0))).gap_mm is None  # it comes from elsewhere
    speck = way((0.15, 0), (0.15, 0.1), (0, 0.1), (0, 0), (0.12, 0))
    assert line(speck).gap_mm is None  # shorter than what shows a heading
    # a tenth of the line at the most: of 22 mm, and of 18
    small = (0, 4), (0, 0), (0.5, 0)
    assert line(way((2.5, 0), (8, 0), (8, 4), *small)).gap_mm == pytest.approx(2.0)
    assert line(way((2.5, 0), (6, 0), (6, 4), *small)).gap_mm is None


def test_a_line_with_a_loop_has_a_lead_if_a_tick_or_a_reference_point_says_so() -> None:
    def leads(**more: object) -> Line:
        return line(way(*map(tuple, LEAD)), "joined", loop_from=round(JOINED), **more)

    tick, behind = Mark("tick", (5.0, 0.0), JOINED / 2), Mark("tick", (10.0, 2.0), 1.2 * JOINED)
    assert leads(marks=(tick,)).is_lead and leads(marks=(tick,)).first == round(JOINED)
    assert leads(reference_mm=(0.0, 0.0)).is_lead
    for unmarked in (leads(), leads(marks=(behind,))):
        assert not unmarked.is_lead and unmarked.first == 0
    assert not leads(marks=(Mark("dot", (5.0, 0.0), JOINED / 2),)).is_lead
    assert np.array_equal(leads().loop_mm[0], (10, 0))


def test_a_line_that_did_not_come_back_is_its_own_up_to_its_first_junction() -> None:
    """To within one and a half widths of it, where another line's ink begins."""
    lost = line(way((0, 0), (20, 0)), "lost", junctions_mm=((8.0, 0.0), (15.0, 0.0)))
    own_mm = lost.own_mm[-1, 0]
    assert own_mm == pytest.approx(8.0 - 1.5 * WIDTH_MM, abs=2 * THIN_MM)
    assert len(line(lost.xy_mm, "lost").own_mm) == len(lost.places_mm)
    closed = line(lost.xy_mm, "closed", junctions_mm=lost.junctions_mm)
    assert len(closed.own_mm) == len(lost.places_mm)


@pytest.mark.parametrize(("side", "turned"), [("left", True), ("right", False)])
def test_a_line_turns_at_a_junction_to_the_side_of_its_bend(side: str, turned: bool) -> None:
    bend = line(way((0, 0), (10, 0), (10, 10)))
    assert bend.turns_at((10.0, 0.0), side) is turned  # type: ignore[arg-type]
    assert not bend.turns_at((5.0, 0.0), side)  # type: ignore[arg-type]
    assert not bend.turns_at((11.0, 0.0), side)  # type: ignore[arg-type]


def test_a_line_that_comes_by_a_junction_twice_turns_there_if_it_does_once() -> None:
    """First straight over it, then onto it from below and to the right."""
    over = line(way((0, 0), (20, 0), (20, -10), (10, -10), (10, 0), (15, 0)))
    assert over.turns_at((10.0, 0.0), "right")
    assert not over.turns_at((10.0, 0.0), "left")


def test_guide_lines_part_a_line_and_count_from_where_they_leave() -> None:
    guides = GuideLine(100, 150, 200), GuideLine(300, 310, 320)
    taken = line(way((0, 0), (20, 0)), guides=guides)
    assert taken.ranges(0, 400) == [(0, 100), (200, 300), (320, 401)]
    assert taken.ranges(100, 250) == [(100, 251)]  # the first was left before
    assert taken.ranges(0, 300) == [
        (0, 100),
        (200, 300),
    ]  # what is behind the second is not asked
    lengths = [len(stretch) for stretch in taken.without_guides(0, 400)]
    assert lengths == [100, 100, 81]
