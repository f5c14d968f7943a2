"""The lines of a net: each closed line once, told by the junctions; the head is put down for no trial."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
import shapely
import shapely.affinity

from morfax.tracer.following.attempts import Attempts
from morfax.tracer.following.line import Line
from morfax.tracer.program.setup import Setup
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import found_lines, trace_lines
from tests.tracer.inked import Points, arc, inked, polyline

FRAME = polyline((8, 8), (58, 8), (58, 44), (8, 44), (8, 8))
HOLE = arc((24, 26), 6)
SQUARE = polyline((38, 18), (50, 18), (50, 30), (38, 30), (38, 18))
CORNERS_MM = 0.15  # the pen's corners


@pytest.fixture
def no_trials(monkeypatch: pytest.MonkeyPatch) -> None:
    """The head is not put down to look where a line leads."""

    def refuse(*_: object) -> None:
        raise AssertionError("the head is put down for a trial")

    monkeypatch.setattr(Attempts, "run", refuse)


def cut(*lines: Points) -> list[Line]:
    """The contours of a sheet."""
    return list(trace_lines(inked(*lines, seed=3)).lines)


def are(lines: Sequence[Line], *drawn: Points, within_mm: float = CORNERS_MM) -> bool:
    """Whether lines are just the closed ones that were drawn, each once."""
    ways = [shapely.LinearRing(line.loop_mm[::20]) for line in lines if line.ending == "closed"]
    near = [
        sum(way.hausdorff_distance(shapely.LineString(line)) < within_mm for way in ways)
        for line in drawn
    ]
    return len(ways) == len(lines) == len(drawn) and near == [1] * len(drawn)


def hatching(apart_mm: float, *holes: Points) -> list[Points]:
    """Lines at 45 degrees across the frame, but not the holes."""
    area = shapely.Polygon(FRAME).difference(
        shapely.union_all([shapely.Polygon(h) for h in holes])
    )
    lines = [shapely.LineString([(x, 0), (x + 60, 60)]) for x in np.arange(-49, 60, apart_mm)]
    pieces = shapely.get_parts(shapely.intersection(shapely.MultiLineString(lines), area))
    return [shapely.get_coordinates(piece) for piece in pieces if piece.length > 1]


@pytest.mark.usefixtures("no_trials")
def test_hatching_is_no_line_and_breaks_none() -> None:
    hatched = hatching(5.3, HOLE, SQUARE)
    lines = cut(FRAME, HOLE, SQUARE, *hatched)
    assert are(lines, FRAME, HOLE, SQUARE)


@pytest.mark.usefixtures("no_trials")
def test_hatching_that_goes_on_from_a_side_of_a_square_takes_no_partner_from_it() -> None:
    beyond = polyline((50, 30), (50, 44)), polyline((38, 24), (30, 24))
    assert are(cut(FRAME, SQUARE, *beyond), FRAME, SQUARE)


@pytest.mark.usefixtures("no_trials")
def test_circles_that_overlap_are_cut_as_the_pen_drew_them() -> None:
    circles = [arc((16 + 10 * k, 20 + 4 * (k % 2)), 8) for k in range(4)]
    assert are(cut(*circles), *circles)


@pytest.mark.usefixtures("no_trials")
def test_a_ring_to_which_a_lead_line_comes_is_closed() -> None:
    """One area, and one end of the ink; the lead line is told as left out."""
    ring, lead = arc((16, 20), 8), polyline((24, 20), (40, 26))
    trace = trace_lines(inked(ring, lead, seed=3))
    assert are(trace.lines, ring)
    assert trace.left_out_mm == pytest.approx(math.hypot(16, 6), rel=0.1)


@pytest.mark.usefixtures("no_trials")
def test_of_a_small_ring_that_is_part_of_a_stroke_the_stroke_is_run() -> None:
    """A six: its loop is less than nine tenths of the stroke, whose end runs into it."""
    round_rad = np.linspace(np.pi, 2.5 * np.pi, 100)
    bowl = 3.0 * np.column_stack([np.cos(round_rad), np.sin(round_rad)]) + 16.0
    six = np.vstack([polyline((13, 24), (13, 16.2)), bowl, [[13.0, 18.5]]])
    (line,) = cut(six)
    assert line.ending == "ended" and line.length_mm > 0.9 * shapely.LineString(six).length


def test_the_head_follows_a_plain_ring_with_sharp_bends_itself(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No lines meet on it: one run is enough, and takes its corners as they are."""
    runs, run = list[object](), Attempts.run

    def counted(self: Attempts, *asked: object) -> object:
        runs.append(asked)
        return run(self, *asked)

    monkeypatch.setattr(Attempts, "run", counted)
    assert are(cut(SQUARE), SQUARE) and len(runs) == 1


@pytest.mark.parametrize("apart_mm", [16.3, 16.0, 15.7])
def test_circles_that_touch_are_two_lines(apart_mm: float) -> None:
    circles = arc((16, 20), 8), arc((16 + apart_mm, 20), 8)
    assert are(cut(*circles), *circles)


@pytest.mark.usefixtures("no_trials")
def test_bars_and_a_grid_are_left_out_and_told() -> None:
    bars = [polyline((x, 8), (x, 44)) for x in (18, 30, 45)]
    bars += [polyline((8, y), (58, y)) for y in (16, 33)]
    trace = trace_lines(inked(FRAME, *bars, seed=3))
    assert are(trace.lines, FRAME)
    assert trace.left_out_mm == pytest.approx(3 * 36 + 2 * 50, rel=0.1)


def test_what_only_bars_join_is_gone_round_part_by_part() -> None:
    """Two shapes with a bar across, from corner to corner, and a bar from one to the other."""
    left = polyline((8, 8), (24, 8), (24, 30), (8, 30), (8, 8))
    right = left + np.array([28, 4])
    bars = [polyline(shape[0], shape[2]) for shape in (left, right)]
    assert are(cut(left, right, *bars, polyline((24, 20), (36, 20))), left, right)


def test_a_stroke_across_is_a_line_if_both_its_ends_are_free() -> None:
    across = polyline((24, 16), (24, 36)), polyline((4, 38), (12, 38))
    lines = cut(HOLE, FRAME, *across[:1], polyline((24, 36), (24, 44)))
    assert are([line for line in lines if line.ending == "closed"], FRAME, HOLE)
    assert [line.ending for line in cut(HOLE, across[0])].count("ended") == 1


def test_numbers_are_those_of_the_lines_that_are_listed() -> None:
    drawing = inked(FRAME, HOLE, SQUARE, *hatching(12.0, HOLE, SQUARE), seed=3)
    every = {line.number: line for line in trace_lines(drawing).lines}
    assert sorted(every) == [1, 2, 3]
    (alone,) = found_lines(Setup(drawing.sheet), (2,)).lines
    assert alone.length_mm == every[2].length_mm
    assert every[1].length_mm > every[2].length_mm > every[3].length_mm


def arrow(tip: tuple[float, float], way: tuple[float, float]) -> list[Points]:
    """An arrowhead 3.5 mm long, filled with lines."""
    ends, (u, v) = np.linspace(-0.45, 0.45, 7), way
    return [polyline(tip, (tip[0] + 3.5 * u - k * v, tip[1] + 3.5 * v + k * u)) for k in ends]


def test_a_dimension_is_no_side_of_a_contour() -> None:
    """Its extension lines go straight on from the sides of the frame."""
    below = polyline((8, 8), (8, 0)), polyline((58, 8), (58, 0)), polyline((8, 2), (58, 2))
    lines = cut(FRAME, *below, *arrow((8, 2), (1, 0)), *arrow((58, 2), (-1, 0)))
    assert are(lines, FRAME)


def test_a_centre_line_makes_no_halves() -> None:
    """Nor does the open arc of a thread round the hole."""
    thread = arc((24, 26), 7.5)[: int(0.74 * len(HOLE))]
    lines = cut(FRAME, HOLE, thread, polyline((14, 26), (34, 26)), polyline((24, 16), (24, 36)))
    assert are([line for line in lines if line.ending == "closed"], FRAME, HOLE)


def test_hatching_that_ends_at_corners_cuts_none_off() -> None:
    """One stroke goes from a corner of the bore to a corner of the outline."""
    bore = polyline((30, 20), (58, 20), (58, 32), (30, 32), (30, 20))
    area = shapely.Polygon(FRAME).difference(shapely.Polygon(bore))
    strokes = [shapely.LineString([(x, 0), (x + 60, 60)]) for x in np.arange(-50, 60, 4.0)]
    pieces = shapely.get_parts(shapely.intersection(shapely.MultiLineString(strokes), area))
    lines = cut(FRAME, bore[1:], *(shapely.get_coordinates(p) for p in pieces if p.length > 1))
    assert are(lines[-1:], FRAME)


def test_a_hole_with_an_arrowhead_and_short_ends_of_other_lines_comes_round_once() -> None:
    """They are as short as marks, but no line of the sheet has a reference point: the head went out along
    one of them and back, 2.7 mm more.
    """
    plate, radius_mm = polyline((5, 5), (45, 5), (45, 35), (5, 35), (5, 5)), 4.95

    def at(degrees: float, away_mm: float) -> tuple[float, float]:
        turned = math.radians(degrees)
        return 25 + away_mm * math.cos(turned), 20 + away_mm * math.sin(turned)

    ticks = [
        polyline(at(degrees, radius_mm - mm), at(degrees, radius_mm + mm))
        for degrees, mm in ((90, 1.2), (270, 1.2), (130, 0.8), (310, 0.8))
    ]
    head = polyline(at(50, radius_mm), at(46.4, radius_mm + 1.4), at(53.6, radius_mm + 1.4))
    drawing = inked(plate, arc((25, 20), radius_mm), *ticks, specks=[head], seed=1)
    lines = trace_lines(drawing).lines
    assert [line.ending for line in lines] == ["closed", "closed"]
    assert min(line.length_mm for line in lines) == pytest.approx(math.tau * radius_mm, abs=0.1)


@pytest.mark.usefixtures("no_trials")
@pytest.mark.parametrize(
    ("aside_mm", "within_mm"),
    [(0.0, CORNERS_MM), (1.0, CORNERS_MM), (-1.0, 0.2)],  # the last is round within their ink
)
def test_rectangles_that_cross_at_a_flat_angle_are_cut_as_the_pen_drew_them(
    aside_mm: float, within_mm: float
) -> None:
    """A corner of either lies on a side of the other; the head took the way round the outside of both, and
    within their rims they exchanged their ways between two crossings.
    """
    one = polyline((8, 10), (48, 10), (48, 34), (8, 34), (8, 10))
    turned = shapely.affinity.rotate(shapely.LineString(one), 9.0, (27.0, 22.0))
    other = shapely.get_coordinates(turned) + np.array([aside_mm, 0.0])
    assert are(cut(one, other), one, other, within_mm=within_mm)


def test_an_extension_line_from_a_centre_cross_is_no_lead_line() -> None:
    """A lead line ends at the contour; this one crosses it, from the middle of a slot that is dimensioned."""
    edge = polyline((20, 8), (20, 44))
    cross = polyline((38, 26), (42, 26)), polyline((40, 24), (40, 28))
    beside = polyline((42, 26), (70, 26)), polyline((68, 26), (68, 34))
    drawing = inked(FRAME, edge, *cross, *beside, seed=3)
    lines = trace_lines(drawing).lines
    (first,) = [line for line in lines if line.ending == "closed"]
    assert are([first], FRAME)
    assert all(line.reference_mm is None for line in lines)
    assert are(trace(drawing).lines, FRAME)


def test_the_silhouette_goes_before_the_figures_of_which_it_is_made() -> None:
    """A bracket on a plate whose edge runs on below it, from the corner of which an extension line comes."""
    quarter = np.linspace(-math.pi / 2, 0, 60)
    feet = [
        np.c_[x + way * 5 * np.cos(quarter), 21 + 5 * np.sin(quarter)]
        for x, way in ((20, 1), (46, -1))
    ]
    sides = polyline((25, 21), (25, 36)), polyline((41, 21), (41, 36))
    plate = polyline((8, 8), (58, 8), (58, 16), (8, 16), (8, 8))
    boss, below = arc((33, 36), 8), polyline((58, 8), (58, 0))
    first = max(cut(plate, boss, *feet, *sides, below), key=lambda line: line.length_mm)
    figure = shapely.union_all(
        [shapely.Polygon(plate), shapely.Polygon(boss), shapely.box(25, 16, 41, 36)]
        + [
            shapely.box(x, 16, x + 5, 21).difference(shapely.Point(x0, 21).buffer(5, 64))
            for x, x0 in ((20, 20), (41, 46))
        ]
    )
    assert are([first], shapely.get_coordinates(figure.exterior))
