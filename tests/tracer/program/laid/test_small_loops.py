"""Small holes and slots of a part are cut where they are drawn, and once round."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm, nearest_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.laid.small_loops import SmallLoops
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_ink import trace_ink
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import Points, arc, inked, polyline

UM = 1e-3
PLATE = polyline((4, 4), (44, 4), (44, 30), (4, 30), (4, 4))


def box(wide_mm: float, high_mm: float, turned_deg: float) -> Points:
    """A rectangle about (14, 20)."""
    half = 0.5 * np.array(
        [(-wide_mm, -high_mm), (wide_mm, -high_mm), (wide_mm, high_mm), (-wide_mm, high_mm)]
    )
    c, s = math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))
    turned = half @ np.array([(c, s), (-s, c)]) + (14, 20)
    return np.vstack([turned, turned[:1]])


def slot(long_mm: float, wide_mm: float) -> Points:
    """A slot with round ends about (14, 20)."""
    reach, radius = 0.5 * (long_mm - wide_mm), 0.5 * wide_mm
    ends = arc((14 + reach, 20), radius, -90, 90), arc((14 - reach, 20), radius, 90, 270)
    return np.vstack([*ends, ends[0][:1]])


def small_line(trace: Trace) -> Line:
    """The shorter of two closed lines."""
    assert [line.ending for line in trace.lines] == ["closed", "closed"]
    return min(trace.lines, key=lambda line: line.length_mm)


def off_mm(line: Line, drawn: Points) -> float:
    """How far a line is from one that was drawn, and that from it, at most."""
    way: Array = line.xy_mm
    true = with_places(drawn, 2 * UM)
    return float(max(nearest_mm(way, true).max(), nearest_mm(true, way).max()))


@pytest.mark.parametrize(
    ("drawn", "width_mm"),
    [
        (arc((14, 20), 0.5), 0.35),
        (arc((14, 20), 0.6), 0.35),
        (arc((14, 20), 0.5), 0.5),
        (slot(2.6, 1.6), 1.0),
        (slot(3.0, 0.9), 0.6),
        (box(1.5, 1.2, 20), 0.5),
        (box(3.0, 1.2, 0), 1.0),
        (box(2.2, 0.8, 60), 0.5),
        (slot(9.0, 0.9), 0.5),
        (box(8.0, 0.8, 0), 0.5),
    ],
)
def test_a_small_hole_in_a_plate_is_cut_true_and_once(drawn: Points, width_mm: float) -> None:
    """Within 40 um: the ink of one corner that is cut short by so much is what the compass has to gain."""
    drawing = inked(PLATE, drawn, width_mm=width_mm, seed=1)
    once_mm = float(np.hypot(*np.diff(drawn, axis=0).T).sum())
    for trace in (trace_lines(drawing), trace_ink(drawing)):
        line = small_line(trace)
        assert off_mm(line, drawn) < 40 * UM
        assert line.length_mm == pytest.approx(once_mm, rel=0.02)


def test_a_loop_that_the_compass_laid_was_led_by_redrawn_ink() -> None:
    line = small_line(trace_lines(inked(PLATE, arc((14, 20), 0.5), width_mm=0.35, seed=1)))
    lengths_mm = line.led.lengths_mm(line.xy_mm)
    assert lengths_mm[REDRAWN] == pytest.approx(line.length_mm, rel=0.01)


def test_a_loop_that_the_head_follows_true_stays_its_own() -> None:
    line = small_line(trace_lines(inked(PLATE, arc((14, 20), 1.1), width_mm=0.4, seed=1)))
    assert line.led.lengths_mm(line.xy_mm)[REDRAWN] == 0.0


def test_a_loop_of_another_shape_is_none_of_the_compass() -> None:
    """A pen lifted between a ring and the stroke across it leaves no circle."""
    theta = arc((14, 20), 1.0), polyline((12.6, 20), (15.4, 20))
    sheet = inked(PLATE, *theta, width_mm=0.5, seed=1).sheet
    patch = sheet.patch_at(np.array([14.0, 21.0]))
    assert SmallLoops(sheet, Settings()).of_patch(patch, 0.5) is None


def test_holes_of_several_sizes_in_a_row_are_no_letters() -> None:
    radii = (0.6, 1.0, 0.75, 1.3, 0.5)
    rings = [arc((10 + 4 * k, 20), radius) for k, radius in enumerate(radii)]
    trace = trace_lines(inked(PLATE, *rings, width_mm=0.4, seed=1))
    assert trace.letters == ()
    assert [line.ending for line in trace.lines] == ["closed"] * 6


@pytest.mark.parametrize("apart_mm", [0.7, 0.8, 0.9])
def test_a_narrow_line_that_is_open_at_one_end_is_no_slot(apart_mm: float) -> None:
    """Paper shows between its ends, 0.2 to 0.4 mm of it: a last side that is drawn there would be cut."""
    bent = polyline((17, 20), (11, 20), (11, 20 + apart_mm), (17, 20 + apart_mm))
    for trace in (trace_lines, trace_ink):
        closed = [
            line for line in trace(inked(PLATE, bent, seed=1)).lines if line.ending == "closed"
        ]
        assert len(closed) == 1


def around(spine: Points, wide_mm: float) -> Points:
    """The closed line about a spine (n, 2), half of a width to either side; square ends."""
    ahead = np.gradient(spine, axis=0)
    left = (
        0.5
        * wide_mm
        * np.column_stack([-ahead[:, 1], ahead[:, 0]])
        / np.hypot(*ahead.T)[:, None]
    )
    return np.vstack([spine + left, (spine - left)[::-1], (spine + left)[:1]])


X_MM = np.linspace(8, 30, 120)
WAVE = np.column_stack([X_MM, 18 + 2 * np.sin(X_MM / 3)])
HOOK = polyline((10, 12), (30, 12), (30, 20), (29.3, 20), (29.3, 12.7), (10, 12.7), (10, 12))


@pytest.mark.parametrize(
    ("drawn", "width_mm"),
    [
        (around(arc((22, 8), 12.0, 50, 130), 0.7), 0.5),
        (around(WAVE, 0.65), 0.5),
        (around(WAVE, 0.5), 0.35),
        (slot(20.0, 0.7) + np.array([8.0, 0.0]), 0.5),
        (HOOK, 0.5),
    ],
)
def test_a_narrow_loop_of_any_shape_is_cut_true_and_once(
    drawn: Points, width_mm: float
) -> None:
    """Within 0.1 mm, a pixel and a fifth, at the corner of a hook, which the rim does not show; half of that
    elsewhere.
    """
    drawing = inked(PLATE, drawn, width_mm=width_mm, seed=1)
    once_mm = float(np.hypot(*np.diff(drawn, axis=0).T).sum())
    for trace in (trace_lines(drawing), trace_ink(drawing)):
        line = small_line(trace)
        assert off_mm(line, drawn) < (100 if drawn is HOOK else 50) * UM
        assert line.length_mm == pytest.approx(once_mm, rel=0.02)


def test_a_way_that_runs_a_piece_of_a_narrow_loop_twice_gives_place_to_one_that_does_not() -> (
    None
):
    """Its pen would leave the same ink; the way as it was drawn stays."""
    drawn = around(arc((22, 8), 12.0, 50, 130), 1.0)
    loops = SmallLoops(inked(PLATE, drawn, seed=1).sheet, Settings())
    way = with_places(drawn, 2 * UM)
    assert loops.of_way(way, 0.5) is None
    back = way[3000:3400]
    twice = loops.of_way(np.vstack([way[:3400], back[::-1], way[3000:]]), 0.5)
    assert twice is not None
    assert twice.length_mm == pytest.approx(length_mm(drawn), rel=0.02)


@pytest.mark.parametrize("wide_mm", [0.8, 1.0, 1.2])
def test_a_broad_dash_is_no_narrow_loop(wide_mm: float) -> None:
    """As broad as two lines and long, but there is no seam between them."""
    half = 0.5 * (wide_mm - 0.5)
    arcs = [arc((22, 8), 12 + off, 50, 130) for off in np.linspace(-half, half, 5)]
    sheet = inked(PLATE, *arcs, seed=1).sheet
    patch = sheet.patch_at(np.array([22.0, 20.0]))
    assert SmallLoops(sheet, Settings()).of_patch(patch, 0.5) is None


@pytest.mark.parametrize(
    "other", [polyline((22, 20.3), (22, 24)), polyline((22, 19.4), (22, 20.6))]
)
def test_a_narrow_loop_that_a_line_joins_or_crosses_is_none_alone(other: Points) -> None:
    """The rim goes out along the one and back; the other lies within it."""
    loop = around(arc((22, 8), 12.0, 50, 130), 1.2)
    sheet = inked(PLATE, loop, other, seed=1).sheet
    patch = sheet.patch_at(np.array([22.0, 20.6]))
    assert SmallLoops(sheet, Settings()).of_patch(patch, 0.5) is None
