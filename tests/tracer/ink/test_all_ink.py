"""All the ink: every stretch followed once, straight on through crossings, up to what it meets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import UM, WIDTH_MM, Points, arc, dot, inked, polyline, together

TWICE = 0.001  # of the length: what may be run more than once
BESIDE_MM = 30 * UM  # strokes from the true line, junctions included
LED_ON_MM = 0.02  # from the end of a stroke to the middle of the line that it meets
SQUARE = polyline((6, 6), (36, 6), (36, 36), (6, 36), (6, 6))
BAR = polyline((6, 20), (36, 20))
SPUR = polyline((36, 28), (44, 28))


def all_of(*lines: Points, seed: int = 1) -> list[Line]:
    """The strokes of lines that are inked."""
    return list(trace_ink(inked(*lines, seed=seed)).lines)


def held_against(strokes: list[Line], lines: list[Points]) -> tuple[float, float, float]:
    """Share of the true lines followed, share run more than once, largest distance from them (mm)."""
    truth = shapely.unary_union([shapely.LineString(line) for line in lines])
    run = shapely.unary_union([shapely.LineString(stroke.xy_mm[::5]) for stroke in strokes])
    followed = shapely.intersection(truth, shapely.buffer(run, 0.5 * WIDTH_MM)).length
    run_mm = sum(length_mm(stroke.xy_mm) for stroke in strokes)
    away = shapely.distance(shapely.points(np.vstack([s.xy_mm for s in strokes])), truth)
    return followed / truth.length, (run_mm - followed) / truth.length, float(away.max())


def test_a_bar_and_a_spur_are_followed_beside_the_outline() -> None:
    strokes = all_of(SQUARE, BAR, SPUR)
    share, twice, away_mm = held_against(strokes, [SQUARE, BAR, SPUR])
    assert share > 0.999 and twice < TWICE and away_mm < BESIDE_MM
    # the square's five corners of odd order: at most half as many strokes, and one for what is even
    assert len(strokes) <= 3


def test_lines_that_cross_go_straight_on() -> None:
    lines = [
        polyline((5, 5), (45, 30)),
        polyline((5, 30), (45, 5)),
        polyline((5, 24), (45, 26)),
    ]
    strokes = all_of(*lines)
    assert sorted(round(s.length_mm) for s in strokes) == sorted(
        round(length_mm(a)) for a in lines
    )
    share, twice, away_mm = held_against(strokes, lines)
    assert share > 0.999 and twice < TWICE and away_mm < BESIDE_MM


def test_circles_laid_over_each_other_come_round() -> None:
    circles = [arc((18, 18), 10), arc((28, 20), 9), arc((22, 28), 8)]
    strokes = all_of(*circles)
    assert [stroke.ending for stroke in strokes] == ["closed"] * 3
    assert held_against(strokes, circles)[0] > 0.999


def test_a_stroke_ends_on_the_middle_of_the_line_that_it_meets() -> None:
    strokes = all_of(BAR, polyline((20, 20), (20, 34)))
    short = min(strokes, key=lambda stroke: stroke.length_mm)
    ends = short.xy_mm[[0, -1]]
    assert abs(ends[:, 1] - 20).min() < LED_ON_MM


@pytest.mark.parametrize(
    ("out_mm", "across_deg"), [(0.3, 90), (0.6, 90), (0.45, 60), (0.45, 40)]
)
def test_a_stroke_that_ends_just_beyond_another_goes_on_to_its_end(
    out_mm: float, across_deg: float
) -> None:
    """What pokes out is no longer than a burr of the other line's edge would be."""
    across = np.radians(across_deg)
    way = np.array([np.cos(across), np.sin(across)])
    end = np.array([20, 20]) + out_mm / np.sin(across) * way
    strokes = all_of(BAR, polyline((20 - 12 * way[0], 20 - 12 * way[1]), (end[0], end[1])))
    short = min(strokes, key=lambda stroke: stroke.length_mm)
    assert (
        np.hypot(*(short.xy_mm[[0, -1]] - end).T).min() < 0.07
    )  # it was as far as it pokes out


@pytest.mark.parametrize(
    ("short_mm", "across_deg"),
    [(0.45, 75), (0.4, 40), (0.4, 15), (0.3, 10), (-0.35, 14), (-0.35, 12)],
)
def test_a_stroke_that_ends_in_the_ink_of_another_ends_where_its_pen_was_lifted(
    short_mm: float, across_deg: float
) -> None:
    """Its end is so far from the middle of the other line, on the near side or on the far one, that its pen's
    round shows.
    """
    across = np.radians(across_deg)
    way = np.array([np.cos(across), np.sin(across)])
    end = np.array([21, 20]) - short_mm / np.sin(across) * way
    strokes = all_of(
        BAR, polyline((end[0] - 14 * way[0], end[1] - 14 * way[1]), (end[0], end[1]))
    )
    short = min(strokes, key=lambda stroke: stroke.length_mm)
    beyond_mm = (short.xy_mm[[0, -1]] - end) @ way
    # a quarter of the round that shows, along the line
    assert abs(beyond_mm).min() < 0.25 * WIDTH_MM
    assert sorted(stroke.length_mm for stroke in strokes) == pytest.approx(
        [14.0, 30.0], abs=0.3
    )


def side_by_side(deg: float, first_mm: float, second_mm: float) -> list[Points]:
    """Two lines that come to (22, 20) at an angle to each other, and end so far beyond."""
    ends = ((0.5 * deg, first_mm), (-0.5 * deg, second_mm))
    ways = [(np.array([np.cos(np.radians(at)), np.sin(np.radians(at))]), mm) for at, mm in ends]
    return [np.array([(22, 20) - 15 * way, (22, 20) + mm * way]) for way, mm in ways]


@pytest.mark.parametrize(
    ("deg", "first_mm", "second_mm"), [(40, 1.0, 1.1), (30, 1.5, 1.3), (4, 0.0, -2.5)]
)
def test_two_lines_that_end_in_each_other_s_ink_are_no_tip(
    deg: float, first_mm: float, second_mm: float
) -> None:
    """They cross just before they end, or one ends beside the other. (They were one stroke.)"""
    lines = side_by_side(deg, first_mm, second_mm)
    strokes = all_of(*lines)
    assert len(strokes) == 2
    for line in lines:
        off = [np.hypot(*(stroke.xy_mm[[0, -1]] - line[0]).T).min() for stroke in strokes]
        own = strokes[int(np.argmin(off))].xy_mm[[0, -1]]
        assert np.hypot(*(own - line[1]).T).min() < 0.1


@pytest.mark.parametrize("deg", [8.0, 15.0, 25.0, 40.0])
def test_a_line_with_a_tip_stays_one_line(deg: float) -> None:
    one, other = side_by_side(deg, 0.0, 0.0)
    (stroke,) = all_of(np.vstack([one, other[0]]))
    assert np.hypot(*(stroke.xy_mm - (22, 20)).T).min() < 0.2


@pytest.mark.parametrize("seed", [1, 2])
def test_a_line_that_ends_beside_another_ends_beyond_what_crosses_both(seed: int) -> None:
    """The ink of both beyond the crossing was taken for a run of one, and 3.1 mm of the other were lost."""
    end = np.array([26, 20.25])
    ending = np.array([end - 20 * np.array([np.cos(0.052), -np.sin(0.052)]), end])
    crossing = [polyline((20, 10), (20, 30)), polyline((14, 8), (24.5, 30))]
    strokes = all_of(polyline((5, 20), (40, 20)), ending, *crossing, seed=seed)
    ends = np.vstack([stroke.xy_mm[[0, -1]] for stroke in strokes])
    assert len(strokes) == 4
    assert np.hypot(*(ends - end).T).min() < 0.05


def test_white_paper_is_not_crossed_for_struck_ink() -> None:
    """Two dashes 1.4 mm apart: nearer than a struck line may be wide, and wider than the allowed gap.

    The longer line is struck off before them.
    """
    dashes = [polyline((5, 10), (20, 10)), polyline((21.4 + WIDTH_MM, 10), (36, 10))]
    assert len(all_of(polyline((5, 25), (40, 25)), *dashes)) == 3


def test_what_cannot_be_followed_is_in_the_balance() -> None:
    speck = polyline((40, 30), (40.8, 30), (40.8, 30.6), (40, 30.6), (40, 30))
    trace = trace_ink(inked(SQUARE, specks=[speck], seed=1))
    assert trace.ink is not None
    assert trace.ink.followed_share > 0.995
    assert 0 < trace.ink.specks_mm < 2
    assert trace.ink.followed_mm == pytest.approx(
        length_mm(SQUARE), rel=0.03
    )  # by the area of the ink


def test_a_dot_broader_than_two_lines_is_told_and_a_full_stop_is_not() -> None:
    """No solid area yet: the pupil of an eye on a colouring page went without a word."""
    told = trace_ink(inked(SQUARE, specks=[dot((25, 20), 1.4), dot((20, 20), 0.7)], seed=1))
    assert told.ink is not None and not told.ink.solids
    ((x, y, across_mm),) = told.ink.dots
    assert (x, y) == pytest.approx((25, 20), abs=0.1)
    assert across_mm == pytest.approx(1.4, abs=0.2)


def test_three_lines_through_one_place_keep_their_partners() -> None:
    lines = [
        polyline((5, 20), (45, 20)),
        polyline((15, 3), (35, 37)),
        polyline((17, 38), (33, 2)),
    ]
    strokes = all_of(*lines)
    assert len(strokes) == 3
    assert held_against(strokes, lines)[2] < BESIDE_MM
    for stroke in strokes:
        straight_mm = np.hypot(*(stroke.xy_mm[-1] - stroke.xy_mm[0]))
        assert stroke.length_mm == pytest.approx(straight_mm, abs=0.05)


def test_a_sharp_crossing_is_one_junction() -> None:
    """At 6 degrees two lines of 0.5 mm share their ink for 10 mm."""
    lines = [polyline((5, 20), (55, 20)), polyline((5, 17.4), (55, 22.6))]
    strokes = all_of(*lines)
    assert len(strokes) == 2
    share, _twice, away_mm = held_against(strokes, lines)
    assert share > 0.999 and away_mm < BESIDE_MM


def test_a_short_bar_between_two_lines_is_a_stroke() -> None:
    """Its ink is hardly longer than the junctions at its ends."""
    lines = [
        polyline((5, 10), (35, 10)),
        polyline((5, 11.2), (35, 11.2)),
        polyline((20, 10), (20, 11.2)),
    ]
    strokes = all_of(*lines)
    assert sorted(round(s.length_mm) for s in strokes) == [1, 30, 30]


def test_a_gap_is_crossed_up_to_the_head_s_own(gap_mm: float = 0.4) -> None:
    dashes = [polyline((5, 10), (20, 10)), polyline((20 + gap_mm + WIDTH_MM, 10), (36, 10))]
    drawing = inked(*dashes, seed=1)
    assert len(trace_ink(drawing).lines) == 1
    assert len(trace_ink(drawing, replace(Settings(), gap_mm=0.2)).lines) == 2


def test_a_speck_of_paper_on_a_line_does_not_part_it() -> None:
    """It leaves the line without an edge for two pixels."""
    drawing = inked(SQUARE, BAR, seed=1)
    row, column = (
        drawing.darkness.shape[0] - round(20 / drawing.pitch_mm),
        round(20 / drawing.pitch_mm),
    )
    drawing.darkness[row - 1 : row + 1, column - 40 : column + 40 : 20] = 0.0
    share, _, away_mm = held_against(list(trace_ink(drawing).lines), [SQUARE, BAR])
    assert share > 0.999 and away_mm < BESIDE_MM


def test_progress_is_told_within_a_line() -> None:
    heard = list[float]()
    trace_ink(
        inked(SQUARE, seed=1), progress=lambda come_mm, all_mm: heard.append(come_mm / all_mm)
    )
    assert len(heard) > 5 and heard == sorted(heard) and heard[-1] == pytest.approx(1, abs=0.02)


def test_the_same_strokes_on_a_sheet_that_is_mirrored() -> None:
    drawing = inked(SQUARE, BAR, SPUR, seed=3)
    mirrored = Drawing(np.ascontiguousarray(drawing.darkness[:, ::-1]), drawing.pitch_mm)
    lengths = [sorted(s.length_mm for s in trace_ink(d).lines) for d in (drawing, mirrored)]
    assert sum(lengths[0]) == pytest.approx(sum(lengths[1]), abs=0.3)


def reached(strokes: list[Line], places: list[tuple[float, float]]) -> float:
    """How far the strokes stay away from the worst of some places, mm."""
    run = np.vstack([stroke.xy_mm for stroke in strokes])
    return max(float(np.hypot(*(run - place).T).min()) for place in places)


def test_a_tuft_of_short_strokes_is_followed_to_every_tip() -> None:
    tips = [(19.0, 21.4), (20.0, 21.7), (21.0, 21.4)]
    strokes = all_of(SQUARE, *(polyline((20, 20), tip) for tip in tips))
    # a round pen's ink ends half a width beyond each tip, where its edges bend round
    assert reached(strokes, tips) < 0.5 * WIDTH_MM


def test_a_twig_that_stands_out_by_a_width_is_no_burr() -> None:
    strokes = all_of(SQUARE, polyline((20, 36), (20, 36.85)))
    assert reached(strokes, [(20, 36.85)]) < 0.5 * WIDTH_MM


def test_a_short_dash_is_a_stroke_and_a_dot_is_none() -> None:
    dash, blot = polyline((15, 20), (16.1, 20)), dot((25, 20), 1.4)
    trace = trace_ink(inked(SQUARE, dash, specks=(blot,), seed=1))
    assert reached(list(trace.lines), [(15.5, 20)]) < BESIDE_MM
    assert reached(list(trace.lines), [(25, 20)]) > 5
    assert trace.ink is not None and trace.ink.followed_share > 0.995


def test_a_line_that_becomes_broader_is_followed_at_both_widths() -> None:
    narrow, broad = polyline((6, 20), (26, 20)), polyline((26, 20), (38, 20))
    strokes = list(trace_ink(together((narrow, 0.5), (broad, 1.2), seed=1)).lines)
    assert len(strokes) == 1
    assert reached(strokes, [(6, 20), (16, 20), (30, 20), (37.5, 20)]) < 0.5 * WIDTH_MM


def test_a_line_that_tapers_is_followed_to_its_tip() -> None:
    tapering = [(polyline((18 + k, 20), (19 + k, 20)), 0.7 - 0.04 * k) for k in range(10)]
    drawing = together((polyline((6, 20), (18, 20)), 1.2), *tapering, seed=1)
    assert reached(list(trace_ink(drawing).lines), [(10, 20), (22, 20), (27, 20)]) < 0.1
