"""Before the head moves: the lines of the sheet, where the head is put down, and its trail."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion.faults import DrawingFault, LineFault
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.start import put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.trail import Trail
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.sensing.leg import Leg
from tests.tracer.inked import UM, WIDTH_MM, arc, corner, dot, inked, polyline

# on clean ink, as a parabola through what was felt has it; 5 um on a line along the pixels
ON_IT_MM = 8 * UM


# lines


@pytest.mark.parametrize("width_mm", [0.25, 0.5, 0.8])
def test_lengths_and_widths_of_lines(width_mm: float) -> None:
    sheet = Sheet.of(inked(polyline((4, 4), (24, 7)), arc((14, 16), 6), width_mm=width_mm))
    line = sheet.nearest((14.0, 5.5), 3.0)
    circle = sheet.longest()
    assert line.length_mm == pytest.approx(
        math.hypot(20, 3) + width_mm, rel=0.2
    )  # area over width: for choosing only
    assert circle.length_mm == pytest.approx(math.tau * 6, rel=0.2)
    assert line.width_mm == pytest.approx(width_mm, abs=0.15 * width_mm + 30 * UM)


def test_ends_are_found_and_a_closed_line_has_none() -> None:
    line = polyline((4, 4), (24, 7))
    ends = Sheet.of(inked(line)).longest().ends_mm
    for end in line:
        assert np.hypot(*(ends - end).T).min() < WIDTH_MM
    assert len(Sheet.of(inked(arc((10, 10), 6))).longest().ends_mm) == 0


def test_the_nearest_line_is_within_reach_or_said_to_be_far() -> None:
    sheet = Sheet.of(inked(arc((10, 10), 6)))
    assert sheet.nearest((10.0, 14.0), 3.0).length_mm > 30
    with pytest.raises(
        LineFault, match=r"no line within 3 mm of 10,10 mm: the nearest is 5\.[78] mm away, at"
    ):
        sheet.nearest((10.0, 10.0), 3.0)


def test_specks_are_no_lines() -> None:
    with pytest.raises(DrawingFault, match="no line on the drawing"):
        Sheet.of(inked(polyline((4, 4), (4.5, 4))))


# the head put down


def first(
    drawing: Drawing, start_mm: tuple[float, float] | None = None, width_mm: float | None = None
) -> tuple[Stance, float]:
    """The stance that is tried first, and the line's length, mm."""
    return next(
        iter(put_down(drawing, start_mm, Settings(aperture_mm=0.15, line_width_mm=width_mm)))
    )


@settings(max_examples=15)
@given(angle=st.floats(0, math.tau))
def test_the_head_is_put_down_on_the_line_near_the_place_asked_for(angle: float) -> None:
    asked = (12 + 8 * math.cos(angle), 12 + 8 * math.sin(angle))
    stance, length_mm = first(inked(arc((12, 12), 8)), asked)
    assert abs(np.hypot(*(stance.place_mm - 12)) - 8) < ON_IT_MM
    assert np.hypot(*(stance.place_mm - asked)) < 3.2
    tangent = math.atan2(*(stance.place_mm - 12)[::-1]) + math.pi / 2
    assert (
        abs(math.sin(stance.heading_rad - tangent)) < 0.01
    )  # along the line, one way or the other
    assert stance.view.width_mm == pytest.approx(WIDTH_MM, abs=40 * UM)
    assert length_mm == pytest.approx(math.tau * 8, rel=0.15)


def test_the_head_is_put_down_where_the_line_is_smooth() -> None:
    line = polyline((4, 4), (20, 4), (20, 14), (4, 14), (4, 4))
    stance, _ = first(inked(line))
    assert min(np.hypot(*(stance.place_mm - vertex)) for vertex in line) > 1.5
    assert abs(math.sin(2 * stance.heading_rad)) < 0.02  # along one of the sides
    assert not stance.at_end


@pytest.mark.parametrize("seed", [None, 1])
def test_an_open_line_is_begun_at_an_end_heading_inward(seed: int | None) -> None:
    line = corner(60)
    stance, _ = first(inked(line, seed=seed))
    assert stance.at_end
    apart = np.hypot(*(line[[0, 2]] - stance.place_mm).T)
    end = line[0] if apart[0] < apart[1] else line[2]
    assert apart.min() < 40 * UM  # half a width within the pen's round, seen by an aperture
    inward = line[1] - end
    assert math.cos(stance.heading_rad - math.atan2(inward[1], inward[0])) > 0.999


def test_a_speck_beside_an_end_does_not_hide_it() -> None:
    for k in range(8):
        a = math.radians(80 + 30 * k)  # about the end, but for the line itself
        speck = dot(
            (6 + 0.5 * math.cos(a), 8 + 0.5 * math.sin(a)), 0.15
        )  # where the ring of cells runs
        drawing = inked(polyline((6, 8), (26, 10)), width_mm=0.3, specks=(speck,))
        stance, _ = next(put_down(drawing, (6, 8)))
        assert stance.at_end and math.dist(stance.place_mm, (6, 8)) < 50 * UM


@pytest.mark.parametrize("seed", [1, 67, 187, 196])
def test_a_wavering_line_of_three_pixels_has_ends_and_no_tips(seed: int) -> None:
    """Its width is seen to waver by a quarter of a pixel; on the last three of two hundred as much as that of
    a tip grows.
    """
    rng, x_mm = np.random.default_rng(seed), np.linspace(-10, 10, 400)
    wave = np.column_stack(
        [x_mm, 0.1 * np.sin(rng.uniform(0.5, 1.2) * x_mm + rng.uniform(0, 6))]
    )
    a = rng.uniform(0, math.tau)
    line = wave @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]]) + [16, 16]
    stance, _ = next(put_down(inked(line, dpi=150.0, seed=seed), (line[0, 0], line[0, 1])))
    assert stance.at_end and math.dist(stance.place_mm, line[0]) < 100 * UM  # 0.6 of a pixel


def test_a_line_as_wide_as_told_is_looked_for() -> None:
    stance, _ = first(inked(arc((12, 12), 8), width_mm=0.8), width_mm=0.8)
    assert stance.view.width_mm == pytest.approx(0.8, abs=40 * UM)


# the trail


def leg(*points: tuple[float, float]) -> Leg:
    seen = np.column_stack([np.array(points, float), np.full(len(points), WIDTH_MM)])
    return Leg(seen[0, :2], 0.0, 0.0, WIDTH_MM, seen)


@settings(max_examples=30)
@given(
    parts=st.lists(st.integers(1, 3000), min_size=1, max_size=6), step_mm=st.floats(0.02, 0.1)
)
def test_the_trail_keeps_a_place_every_step_however_it_is_told(
    parts: list[int], step_mm: float
) -> None:
    trail = Trail(np.zeros(2), step_mm)
    x = np.arange(1, sum(parts) + 1) * 0.00167  # a sample at 10 mm/s
    for first, count in zip(np.cumsum([0, *parts]), parts, strict=False):
        trail.add(np.column_stack([x[first : first + count], np.zeros(count)]))
    places = trail.recent()
    assert (
        np.all(np.diff(places[:, 0]) > 0)
        and np.diff(places[:, 0]).max(initial=0) < 2 * step_mm + 0.002
    )
    assert places[-1, 0] > x[-1] - (len(parts) + 1) * step_mm - 0.002


def test_the_trail_leads_back() -> None:
    trail = Trail(np.zeros(2), 0.05)
    circle = arc((0, 5), 5, -90, 60)
    trail.add(circle)
    place, heading = trail.back(1.0)
    assert np.hypot(*(place - [0, 5])) == pytest.approx(5, abs=1 * UM)
    assert np.hypot(*(place - circle[-1])) == pytest.approx(1.0, abs=0.12)  # two steps
    tangent = math.atan2(place[1] - 5, place[0]) + math.pi / 2
    assert abs(math.remainder(heading - tangent, math.tau)) < 0.05  # a chord of four steps


def test_the_trail_knows_what_has_been_followed_in_either_sense_but_not_the_newest() -> None:
    trail = Trail(np.zeros(2), 0.05)
    trail.add(np.column_stack([np.arange(0, 10, 0.01), np.zeros(1000)]))
    assert trail.holds(leg((2, 0), (2.1, 0), (2.2, 0), (2.3, 0)), WIDTH_MM)
    assert trail.holds(leg((3, 0.05), (2.9, 0.05), (2.8, 0.05), (2.7, 0.05)), WIDTH_MM)
    assert not trail.holds(leg((2, 0.4), (2.1, 0.4), (2.2, 0.4), (2.3, 0.4)), WIDTH_MM)
    assert not trail.holds(leg((9, 0), (9.1, 0), (9.2, 0), (9.3, 0)), WIDTH_MM)


def test_where_nothing_is_clean_the_way_that_the_message_advises_follows_the_lines() -> None:
    """Two lines whose ink the scan joins here and there: alone neither shows a clean stretch."""
    across_mm = np.array([-12.0, 54.0]) / math.hypot(12, 54)
    way = polyline((8, 20), (62, 32))
    drawing = inked(way, way + 0.88 * across_mm, dpi=150, seed=1)
    drawing = Drawing(cv2.GaussianBlur(drawing.darkness, (0, 0), 0.7), drawing.pitch_mm)
    said = r"no clean stretch .* two pixels of paper part two lines along 5\d mm.*; scan at 300 dpi or more"
    with pytest.raises(LineFault, match=said + ".* with --lines all, give --line"):
        next(put_down(drawing))
    ends = sorted(len(line.xy_mm) > 1 and line.length_mm for line in trace_ink(drawing).lines)
    assert ends == pytest.approx([math.hypot(12, 54)] * 2, abs=0.5)
