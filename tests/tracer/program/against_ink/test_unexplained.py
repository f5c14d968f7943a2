"""A closed path that is not what is drawn is told of, with its place."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.jobs.remarks.on_ink import of_ink
from morfax.motion.polyline import at_lengths, length_mm, nearest_mm
from morfax.tracer.drawing.coarse import SEEN_PX
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.against_ink.redrawn import most_astray
from morfax.tracer.program.against_ink.unexplained import bare_ways
from morfax.tracer.program.program import Trace
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.drawing.test_coarse import scanned
from tests.tracer.inked import Points, arc, inked, polyline
from tests.tracer.program.left_by import left_by

WIDTH_MM = 0.5
STEP_MM = 0.0017  # of the motion: 10 mm/s at 6 kHz
# what ink is there is seen to a pixel or two: 85 um at 300 dpi
PIXEL_MM = 0.17


def with_tip(long_mm: float) -> Points:
    """A circle with a tip on its right, narrower than the line."""
    circle = arc((20, 20), 12)
    return np.vstack(
        [circle[:-1], [[32.0, 20.0], [32.0 + long_mm, 20.05], [32.0, 20.1]], circle[-1:]]
    )


def closed(places_mm: Points) -> Line:
    """A line as if the head had come round along some places."""
    whole_mm = length_mm(places_mm)
    positions_mm = at_lengths(places_mm, np.arange(0.0, whole_mm, STEP_MM))
    return Line(positions_mm, "closed", WIDTH_MM, whole_mm)


@pytest.mark.parametrize("long_mm", [1.2 * WIDTH_MM, 2.5, 6.0])
def test_ink_beside_a_closed_way_is_told_with_its_place_and_how_far_it_reaches(
    long_mm: float,
) -> None:
    drawing = inked(with_tip(long_mm), seed=1)
    (left,) = left_by(Setup(Sheet.of(drawing)), [closed(arc((20, 20), 12))])
    assert left.kind == "ink"
    assert left.place_mm == pytest.approx((32 + long_mm + WIDTH_MM / 2, 20.05), abs=PIXEL_MM)
    assert left.length_mm == pytest.approx(long_mm + WIDTH_MM / 2, abs=PIXEL_MM)


def test_ink_beside_a_line_that_ran_into_itself_is_told_too() -> None:
    drawing = inked(with_tip(6.0), seed=1)
    line = replace(closed(arc((20, 20), 12)), ending="joined")
    (left,) = left_by(Setup(Sheet.of(drawing)), [line])
    assert left.length_mm == pytest.approx(6 + WIDTH_MM / 2, abs=PIXEL_MM)
    (said,) = [text for text in of_ink(Trace((line,), unexplained=(left,)), several=False)]
    assert "1 piece of ink joined to the line beside its way" in said


def slanting(first_mm: float, last_mm: float) -> Points:
    """A straight line from one place to another along one at 45 degrees."""
    first, last = (10 + math.sqrt(0.5) * mm for mm in (first_mm, last_mm))
    return polyline((first, first), (last, last))


@pytest.mark.parametrize("ends_mm", [(0.0, 15.0), (15.0, 30.0), (5.0, 20.0), (0.0, 30.0)])
def test_an_open_line_that_ends_where_its_ink_goes_on_leaves_the_rest(
    ends_mm: tuple[float, float],
) -> None:
    """The line drawn is 30 mm long, and the head ran along a part of it, or all."""
    setup = Setup(Sheet.of(inked(slanting(0.0, 30.0), seed=1)))
    line = replace(closed(slanting(*ends_mm)), ending="ended")
    left_mm = [mm for mm in (ends_mm[0], 30 - ends_mm[1]) if mm > 0]
    found = left_by(setup, [line])
    assert [place.kind for place in found] == ["ink"] * len(left_mm)
    for place, mm in zip(found, sorted(left_mm, reverse=True), strict=True):
        assert place.length_mm == pytest.approx(mm + WIDTH_MM / 2, abs=2 * PIXEL_MM)


def test_a_burr_of_half_a_width_is_not_told() -> None:
    drawing = inked(with_tip(0.5 * WIDTH_MM), seed=1)
    assert left_by(Setup(Sheet.of(drawing)), [closed(arc((20, 20), 12))]) == ()


TIP = np.pi / 10  # half of the angle of a star's tips
STAR = [
    (22 + r * np.sin(k * np.pi / 5), 22 + r * np.cos(k * np.pi / 5))
    for k, r in zip(range(11), [15.0, 5.73] * 6, strict=False)
]


def point_of(tip: tuple[float, float]) -> Points:
    """The ink of a pen that points its corners beyond a tip of the star, 1.6 widths from it."""
    out = math.atan2(tip[1] - 22, tip[0] - 22)
    half_mm, side = 0.5 * WIDTH_MM, 0.5 * np.pi - TIP
    at = [(out - side, half_mm), (out, half_mm / math.sin(TIP)), (out + side, half_mm)]
    beyond = [(tip[0] + r * math.cos(a), tip[1] + r * math.sin(a)) for a, r in at]
    return polyline(tip, *beyond)


def test_the_points_of_pointed_tips_are_no_ink_that_was_missed() -> None:
    drawing = inked(polyline(*STAR), specks=[point_of(tip) for tip in STAR[::2]], seed=1)
    assert left_by(Setup(Sheet.of(drawing)), [closed(polyline(*STAR))]) == ()
    (x, y), short = STAR[2], STAR.copy()
    short[2] = (x - 1.5, y - 0.49)  # the tip is cut short by 3 widths
    told = left_by(Setup(Sheet.of(drawing)), [closed(polyline(*short))])
    furthest = max(
        (place for place in told if place.kind == "ink"), key=lambda it: it.length_mm
    )
    assert math.dist(furthest.place_mm, (x, y)) < 2 * WIDTH_MM


def test_a_way_over_bare_paper_is_told_unless_it_is_a_gap_that_may_be_crossed() -> None:
    drawing = inked(arc((20, 20), 12, 17.2, 360), seed=1)  # 3.6 mm are missing
    setup = Setup(Sheet.of(drawing))
    (bare,) = left_by(setup, [closed(arc((20, 20), 12))])
    assert bare.kind == "bare" and bare.length_mm == pytest.approx(
        3.6 - WIDTH_MM, abs=2 * PIXEL_MM
    )
    assert nearest_mm(np.array([bare.place_mm]), arc((20, 20), 12))[0] < PIXEL_MM
    allowing = replace(setup, settings=replace(setup.settings, gap_mm=4.0))
    assert left_by(allowing, [closed(arc((20, 20), 12))]) == ()


def test_a_way_beside_the_edge_of_a_shape_is_told_as_that() -> None:
    """On a fetched stencil the head was told to run over 18.6 mm of bare paper, half a pixel off the edge."""
    edge = arc((20, 20), 12)
    sheet = Sheet.of(replace(inked(arc((20, 20), 12, 17.2, 360), seed=1), edges_mm=(edge,)))
    (beside,) = bare_ways(sheet, [closed(edge)], 0.5)
    assert beside.kind == "aside"


def test_of_open_lines_among_others_and_of_a_drawn_program_no_ink_is_missed() -> None:
    """An open line alone accounts for all its ink; among others these may have been meant to be left."""
    setup = Setup(Sheet.of(inked(with_tip(6.0), seed=1)))
    circle = closed(arc((20, 20), 12))
    ended = replace(circle, ending="ended")
    far = replace(closed(polyline((2, 2), (9, 2))), ending="ended")
    assert [place.kind for place in left_by(setup, [ended])] == ["ink"]
    assert left_by(setup, [ended, far]) == ()
    assert left_by(replace(setup, operator=Operator(marks="on")), [circle]) == ()


def test_a_clean_outline_explains_its_ink_and_a_bar_from_it_does_not() -> None:
    outline = polyline((10, 10), (50, 10), (50, 40), (10, 40), (10, 10))
    assert trace(inked(outline, seed=1)).unexplained == ()
    with_bar = inked(outline, polyline((50, 25), (58, 25)), seed=1)
    (bar,) = trace(with_bar, (30, 10)).unexplained
    assert bar.place_mm == pytest.approx((58 + WIDTH_MM / 2, 25), abs=2 * PIXEL_MM)
    assert trace_lines(inked(outline, arc((30, 25), 6), seed=1)).unexplained == ()


BAY = polyline(
    (6, 6), (40, 6), (40, 26), (24.5, 26), (24.5, 25), (22.5, 25), (22.5, 26), (6, 26), (6, 6)
)
ACROSS = polyline((6, 6), (40, 6), (40, 26), (6, 26), (6, 6))
COARSE_DPI, LOOKS_MM = 51.0, 0.92  # a line of one pixel, and how wide it looks


def coarse(places_mm: Points) -> Line:
    """A line that came round on a coarse scan."""
    return replace(closed(places_mm), width_mm=LOOKS_MM)


def test_a_small_bay_that_is_cut_off_on_a_coarse_scan_is_told_with_a_resolution() -> None:
    drawing = scanned(BAY, COARSE_DPI)
    told = left_by(Setup(drawing.sheet), [coarse(ACROSS)])
    assert {place.wants_dpi for place in told if place.kind != "ink"} == {200}
    places_mm = np.array([place.place_mm for place in told])
    assert np.hypot(*(places_mm - (23.5, 25.5)).T).max() < 1.5  # of a bay of 2 by 1 mm
    assert left_by(Setup(drawing.sheet), [coarse(BAY)]) == ()
    fine = left_by(Setup(replace(drawing, finer=1).sheet), [coarse(ACROSS)])
    assert [place.kind for place in fine] == ["beside"]


def test_a_coarse_line_counts_a_pixel_less_wide_than_it_looks() -> None:
    drawing, circle = scanned(with_tip(1.0), COARSE_DPI), coarse(arc((20, 20), 12))
    (left,) = left_by(Setup(drawing.sheet), [circle])
    assert left.kind == "ink" and left.length_mm == pytest.approx(1.0, abs=0.5)  # a pixel
    assert left_by(Setup(replace(drawing, finer=1).sheet), [circle]) == ()


def aside(off_mm: float) -> Points:
    """The way round `ACROSS`, so far aside along 1.5 mm of its upper edge: three pixels."""
    up = 26 + off_mm
    bend = [(24.5, 26), (24.2, up), (22.7, up), (22.4, 26)]
    return polyline((6, 6), (40, 6), (40, 26), *bend, (6, 26), (6, 6))


def test_a_way_beside_the_pixels_of_a_line_of_one_pixel_is_told() -> None:
    """Such a way is over grey pixels, and over no bare paper."""
    drawing = scanned(ACROSS, COARSE_DPI)
    assert left_by(Setup(drawing.sheet), [coarse(ACROSS)]) == ()
    far = 0.35  # mm, of a pixel of 0.5: nearer by 0.1 mm it is within what right paths are off
    (told,) = left_by(Setup(drawing.sheet), [coarse(aside(far))])
    assert told.wants_dpi == 200 and np.hypot(*(np.array(told.place_mm) - (23.5, 26))) < 1.5
    broader = replace(drawing, seen_px=SEEN_PX)  # a line of two pixels has a flat top
    assert left_by(Setup(broader.sheet), [coarse(aside(far))]) == ()


def test_what_differs_grows_with_the_distance() -> None:
    drawing = scanned(ACROSS, COARSE_DPI)
    differ = [most_astray(drawing, aside(off_mm)).darkness for off_mm in (0.0, 0.2, 0.4, 0.6)]
    assert differ == sorted(differ) and differ[0] < 0.1 and differ[-1] > 0.25
