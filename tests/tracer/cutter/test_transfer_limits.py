"""Where the cutter cannot come or may not pass, what is cut of a lost line, and gouges beside drawn parts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault, MotionFault
from morfax.motion.motion import join
from morfax.motion.polyline import Nearest
from morfax.tracer.cutter.contour import Cut
from morfax.tracer.cutter.cutter import Cutter, Left, with_cutter
from morfax.tracer.following.line import Line
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.cutter.drawn_parts import (
    FEED_MM_S,
    FROM,
    NEARER_MM,
    SAMPLE_MM,
    WAY,
    beside,
    least_mm,
    marked,
)
from tests.tracer.inked import UM, arc, cross, dot, inked, polyline, tick
from tests.tracer.program.test_program import EXACT_MM, WORK, at, in_work, run_through

FOLLOWED_MM = 25 * UM  # as the head follows a circle or a corner on a scan
STANDS_WITHIN_MM = 50 * UM  # the issue's, of a stop


def test_a_tick_where_the_cutter_cannot_come_stands_at_the_nearest_place() -> None:
    line = marked()
    line = replace(
        line, marks=(line.marks[0], Mark("tick", (18.0, 1.0), float(at(line.xy_mm, (18, 1)))))
    )
    _, stops, _ = beside(line, "inside")
    assert stops[2].place_mm == pytest.approx((16, 2), abs=2 * SAMPLE_MM)


def test_a_card_that_has_the_tool_down_on_its_way_over_the_contour_is_refused() -> None:
    line = marked()
    early = Mark("tick", (2.0, 4.0), float(at(line.xy_mm[:FROM], (2, 4))))
    line = replace(line, marks=(early, *line.marks))
    card = '[[stop]]\nnumber = 1\nmoves = [{ down = "5mm" }]\n'
    with pytest.raises(MotionFault, match="would cut into the part at"):
        beside(line, "inside", card=card)
    assert (
        least_mm(
            beside(line, "outside", card=card)[0],
            line.xy_mm[int(line.loop_from or 0) + 1 :],
            2.0,
        )
        > -NEARER_MM
    )


@pytest.mark.parametrize(
    ("near_mm", "refused"), [(2.001, False), (1.999, False), (1.99, True), (1.9, True)]
)
def test_a_tool_down_on_the_lead_line_may_pass_another_contour_by_its_radius_and_no_nearer(
    near_mm: float, refused: bool
) -> None:
    early = Mark("tick", (2.0, 4.0), float(at(WAY[:FROM], (2, 4))))
    line = replace(marked(), marks=(early, *marked().marks))
    low = 4 + near_mm  # the lead line runs along y = 4
    beyond = run_through((1, low), (1, low + 4), (4, low + 4), (4, low), (1, low))
    other = Line(beyond, "closed", 0.5, 14.0, number=2)
    card = Card.parse('[[stop]]\nnumber = 1\nmoves = [{ down = "5mm" }]\n')
    run = Trace((line, other), Operator(WORK, card))
    if refused:
        with pytest.raises(MotionFault, match="would cut into the part at"):
            with_cutter(run, Cutter(4.0, "outside"), FEED_MM_S)
    else:
        with_cutter(run, Cutter(4.0, "outside"), FEED_MM_S)


def test_a_guide_line_from_the_reference_point_is_run_as_drawn_and_one_with_a_tick_is_cut_beside() -> (
    None
):
    way = run_through((0, 0), (20, 0))
    guide = Line(way, "ended", 0.5, 20.0, reference_mm=(-3.0, 0.0), number=2)
    made, _ = with_cutter(
        Trace((marked(), guide), Operator(WORK)), Cutter(2.0, "left"), FEED_MM_S
    )
    assert np.array_equal(made.lines[1].xy_mm, way) and made.lines[1].numbers == (3,)
    cut = replace(guide, marks=(Mark("tick", (5.0, 0.0), float(at(way, (5, 0)))),))
    positions, stops, _ = beside(cut, "left", 2.0)
    assert in_work(positions)[:, 0].min() == pytest.approx(5, abs=2 * SAMPLE_MM)
    assert in_work(positions)[:, 1] == pytest.approx(1.0, abs=1 * UM)
    assert positions[-1] == pytest.approx([-3.0, 0.0, WORK.clearance_mm], abs=EXACT_MM)
    assert stops[2].place_mm == pytest.approx((20, 1), abs=2 * SAMPLE_MM)


def test_where_no_line_is_cut_nothing_is_in_the_tool_s_way() -> None:
    """A card that has the tool down from a dot to the end of a guide line that passes the sheet's corner."""
    way = run_through((-10, 0), (10, 0))
    dot_on_it = Mark("dot", (-5.0, 0.0), float(at(way, (-5, 0))))
    guide = Line(way, "ended", 0.5, 20.0, reference_mm=(-13.0, 0.0), marks=(dot_on_it,))
    card = Card.parse('[[stop]]\nnumber = 1\nmoves = [{ down = "5mm" }]\n')
    made, left = with_cutter(Trace((guide,), Operator(WORK, card)), Cutter(6.0), FEED_MM_S)
    assert left == Left() and in_work(np.vstack([block.positions_mm for block in made]))[
        :, 0
    ].max() == pytest.approx(10)


def test_of_a_lost_line_what_was_traced_is_cut_on_a_side_of_its_travel() -> None:
    fault = LineFault("line lost at 10.00,0.00 mm", x_mm=10.0, y_mm=0.0, heading_rad=0.0)
    line = Line(run_through((0, 0), (10, 0)), "lost", 0.5, 10.0, fault)
    for side, y_mm in (("left", 1.0), ("right", -1.0)):
        positions, _, made = beside(line, side, 2.0)  # type: ignore[arg-type]
        assert made.fault is fault and made.ending == "lost"
        assert in_work(positions)[:, 1] == pytest.approx(y_mm, abs=1 * UM)
        assert in_work(positions)[:, 0].max() == pytest.approx(10, abs=SAMPLE_MM)
    with pytest.raises(
        LineFault,
        match=r"line lost at .* has no outside, so it is not cut; --side left or right cuts it",
    ):
        beside(line, "outside", 2.0)
    both = Trace((marked(), replace(line, number=2)), Operator(WORK))
    made, _ = with_cutter(both, Cutter(2.0, "outside"), FEED_MM_S)
    assert str(made.fault).startswith("line 2 of 2 is incomplete") and "has no outside" in str(
        made.fault
    )
    in_pieces = replace(made, lines=(replace(made.lines[0], number=2), made.lines[1]))
    assert str(in_pieces.fault).startswith("line lost at")


def circle_of(x_mm: float, y_mm: float, number: int) -> Line:
    turn = np.linspace(0, math.tau, 2000)
    places = np.column_stack([x_mm + 5 * np.cos(turn), y_mm + 5 * np.sin(turn)])
    return Line(places, "closed", 0.5, 31.4, number=number)


def test_a_line_that_may_be_a_hole_of_a_lost_one_is_not_cut_on_the_wrong_side() -> None:
    fault = LineFault("line lost at 40.00,0.00 mm", x_mm=40.0, y_mm=0.0, heading_rad=0.0)
    outline = Line(run_through((0, 0), (40, 0)), "lost", 0.5, 40.0, fault, number=1)
    hole, apart = circle_of(20, 9, 2), circle_of(60, 9, 3)
    trace = Trace((hole, apart, outline), Operator(WORK))
    made, _ = with_cutter(trace, Cutter(2.0), FEED_MM_S, in_lost={2: 1})
    assert [len(line.xy_mm) > 1 for line in made.lines] == [False, True, False]
    assert str(made.fault).startswith(
        "lines 1, 2 of 3 are incomplete, the others are cut; line 2:"
    )
    assert "line 2 may be a hole of line 1, which was lost" in str(made.fault)
    assert "--lines 2 --side inside" in str(made.fault)
    beside_travel, _ = with_cutter(trace, Cutter(2.0, "left"), FEED_MM_S, in_lost={2: 1})
    assert all(len(line.xy_mm) > 1 for line in beside_travel.lines)
    with pytest.raises(LineFault, match=r"lines 1, 2 of 2 are incomplete, no line is whole"):
        with_cutter(
            replace(trace, lines=(hole, outline)), Cutter(2.0), FEED_MM_S, in_lost={2: 1}
        )


def program(angle_deg: float, radius_mm: float = 12.0) -> tuple[list[Array], list[Array]]:
    """A circle about (30, 20) with a cross, a lead line and its tick, a tick on the circle, a guide line
    inwards and its dot.
    """
    x, y = 30.0, 20.0
    a = math.radians(angle_deg)
    on_circle = (x + radius_mm * math.cos(a), y + radius_mm * math.sin(a))
    lead = polyline((6, y), (x - radius_mm, y))
    lines = [
        arc((x, y), radius_mm),
        lead,
        *cross((6, y)),
        tick((13, y)),
        tick(on_circle, angle_deg + 90),
    ]
    return [*lines, polyline((x, y + radius_mm), (x, y + 2))], [dot((x, y + 2), 1.6)]


@pytest.mark.parametrize(
    ("angle_deg", "diameter_mm", "seed"), [(0, 2.0, 0), (-47.3, 5.0, 1), (31.9, 2.0, 2)]
)
def test_beside_a_drawn_circle_runs_the_circle_and_all_that_is_drawn_on_it(
    angle_deg: float, diameter_mm: float, seed: int
) -> None:
    lines, dots = program(angle_deg)
    followed = trace(
        inked(*lines, seed=seed, specks=dots),
        None,
        None,
        Operator(WORK, Card.parse('turns = ["left", "right"]')),
    )
    cut = Cut.of(followed.lines[0], followed.operator, 1)
    assert cut is not None and len(cut.stops) == 3
    hole = next(stop for stop in cut.stops if stop.kind == "hole")
    for side, out in (("outside", 1), ("inside", -1)):
        made, left = with_cutter(followed, Cutter(diameter_mm, side), FEED_MM_S)  # type: ignore[arg-type]
        positions = join(made).positions_mm
        (line,), radius_mm = made.lines, 12 + out * diameter_mm / 2
        way = np.vstack(line.without_guides(line.loop_from or 0, len(line.xy_mm) - 1))
        off_mm = np.hypot(*(way - (30, 20)).T) - radius_mm
        assert np.abs(off_mm).max() < FOLLOWED_MM and left == Left()
        assert np.sqrt(np.mean(off_mm**2)) < 6 * UM  # the head's own, with lead and guide line
        beside_mm = (
            Nearest([cut.places_mm], diameter_mm / 2).distances_mm(way) - diameter_mm / 2
        )
        assert np.abs(beside_mm).max() < 5 * UM  # where the head wavers about the lead line
        assert least_mm(positions, cut.places_mm, diameter_mm / 2) > -NEARER_MM
        halts = {a.halt.number: a.halt for a in made.actions[0] if a.halt.number is not None}
        assert halts[hole.number].place_mm == pytest.approx(hole.place_mm, abs=EXACT_MM)
        assert math.dist(hole.place_mm, (30, 22)) < STANDS_WITHIN_MM
        foot = (
            30 + radius_mm * math.cos(math.radians(angle_deg)),
            20 + radius_mm * math.sin(math.radians(angle_deg)),
        )
        ticked = next(
            halts[stop.number].place_mm
            for stop in cut.stops
            if stop.kind == "tick" and stop.number != 1
        )
        assert math.dist(ticked, foot) < STANDS_WITHIN_MM
        for end in (positions[0], positions[-1]):
            assert end == pytest.approx(
                [*(followed.reference_mm or ()), WORK.clearance_mm], abs=EXACT_MM
            )


def test_beside_a_part_with_inner_corners_the_tool_gouges_nothing_and_lists_what_it_leaves() -> (
    None
):
    part = polyline(
        (16, 20), (16, 36), (28, 36), (28, 26), (40, 26), (40, 8), (16, 8), (16, 20)
    )
    drawing = inked(
        part,
        polyline((4, 20), (16, 20)),
        tick((10, 20)),
        tick((34, 26)),
        *cross((4, 20)),
        seed=5,
    )
    followed = trace(drawing, None, None, Operator(WORK))
    cut = Cut.of(followed.lines[0], followed.operator, 1)
    assert cut is not None
    for side, corners in (
        ("outside", [(28, 26)]),
        ("inside", [(16, 36), (28, 36), (40, 26), (40, 8), (16, 8)]),
    ):
        made, left = with_cutter(followed, Cutter(6.0, side), FEED_MM_S)  # type: ignore[arg-type]
        assert least_mm(join(made).positions_mm, cut.places_mm, 3.0) > -NEARER_MM
        assert len(left.stretches) == len(corners)
        for corner_mm in corners:
            (there,) = (
                u for u in left.stretches if math.dist(u.place_mm, corner_mm) < 2 * FOLLOWED_MM
            )
            assert there.left_mm == pytest.approx(3 * (math.sqrt(2) - 1), abs=2 * FOLLOWED_MM)
        places = [a.halt.place_mm for a in made.actions[0] if a.halt.number is not None]
        assert math.dist(places[1], (34, 29 if side == "outside" else 23)) < STANDS_WITHIN_MM
