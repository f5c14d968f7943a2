"""A line among other ink: lines that meet it, gaps, specks, blots, leads, guide lines, and lost lines."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.motion.faults import LineFault
from morfax.tracer.following.direction import Direction
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace import trace
from tests.tracer.following.followed import END_MM, LINE_MM, SEEDS, followed
from tests.tracer.inked import UM, arc, inked, polyline

ACROSS = polyline((4, 10), (24, 10))
STEM = polyline((14, 10), (14, 17))


@SEEDS
def test_a_line_goes_on_past_one_that_ends_on_it(seed: int | None) -> None:
    assert followed(ACROSS, inked(ACROSS, STEM, seed=seed), (8.0, 10.0)).ending == "ended"


@SEEDS
@pytest.mark.parametrize("crossing_deg", [45, 60, 90, 120])
def test_a_line_goes_straight_on_at_a_crossing(crossing_deg: float, seed: int | None) -> None:
    way = 6 * np.array(
        [math.cos(math.radians(crossing_deg)), math.sin(math.radians(crossing_deg))]
    )
    other = np.array([14.0, 10.0]) + np.array([-way, way])
    assert followed(ACROSS, inked(ACROSS, other, seed=seed), (6.0, 10.0)).ending == "ended"


@SEEDS
@pytest.mark.parametrize("paper_mm", [0.1, 0.3])
def test_a_gap_is_carried(paper_mm: float, seed: int | None) -> None:
    """Between the rounds of the pen, which are half a width each."""
    drawing = inked(
        polyline((4, 8), (14, 8)), polyline((14.5 + paper_mm, 8), (26, 8)), seed=seed
    )
    followed(polyline((4, 8), (26, 8)), drawing)


@SEEDS
def test_a_gap_wider_than_allowed_ends_the_line(seed: int | None) -> None:
    drawing = inked(polyline((4, 8), (14, 8)), polyline((14.5 + 1.5, 8), (26, 8)), seed=seed)
    assert followed(polyline((16, 8), (26, 8)), drawing, (20.0, 8.0)).ending == "ended"


def test_a_wider_gap_can_be_allowed() -> None:
    drawing = inked(polyline((4, 8), (14, 8)), polyline((14.5 + 0.8, 8), (26, 8)))
    run = trace(drawing, (20.0, 8.0), Settings(gap_mm=1.0))
    assert distance(run.xy_mm[::4], polyline((4, 8), (26, 8))).hausdorff_mm < END_MM


@SEEDS
def test_a_speck_beside_the_line_hardly_moves_it(seed: int | None) -> None:
    """0.3 mm of dirt on the line's edge stands 0.15 mm out: a quarter of that is allowed."""
    drawing = inked(ACROSS, specks=[arc((15, 10.25), 0.15)], seed=seed)
    followed(ACROSS, drawing, within_mm=40 * UM)


@SEEDS
@pytest.mark.parametrize("radius_mm", [0.5, 1.0])
def test_a_blot_is_gone_through_with_the_heading_held(
    radius_mm: float, seed: int | None
) -> None:
    drawing = inked(ACROSS, specks=[arc((15, 10.1), radius_mm)], seed=seed)
    followed(ACROSS, drawing)


@SEEDS
@pytest.mark.parametrize("apart_mm", [0.7, 0.8])
def test_a_line_passes_close_beside_another(apart_mm: float, seed: int | None) -> None:
    """0.2 mm of paper between them, for 10 mm."""
    drawing = inked(ACROSS, polyline((9, 10 + apart_mm), (19, 10 + apart_mm)), seed=seed)
    followed(ACROSS, drawing, (6.0, 10.0))


@SEEDS
def test_a_line_passes_a_circle_that_nearly_touches_it(seed: int | None) -> None:
    followed(ACROSS, inked(ACROSS, arc((14, 13.6), 3.0), seed=seed), (6.0, 10.0))


def test_a_hairpin_is_followed_to_its_tip_and_back() -> None:
    """Two lines 7 degrees apart: their inks run together 4 mm before the tip. The issue's bound for sharp
    tips, 0.7 mm.
    """
    line = polyline((4, 10), (20, 11), (4, 12))
    run = trace(inked(line))
    assert run.ending == "ended"
    assert distance(run.xy_mm[::4], line).hausdorff_mm < 0.7
    assert run.length_mm == pytest.approx(length_mm(line), abs=1.4)  # there and back


@SEEDS
def test_a_closed_line_with_corners_closes(seed: int | None) -> None:
    line = polyline((4, 4), (20, 4), (20, 14), (12, 9), (4, 14), (4, 4))
    run = followed(line, inked(line, seed=seed), within_mm=LINE_MM)
    assert run.ending == "closed"
    assert np.hypot(*(run.xy_mm[-1] - run.xy_mm[0])) < 20 * UM


@SEEDS
def test_a_line_into_a_black_patch_is_lost_and_says_where(seed: int | None) -> None:
    """5 mm of solid ink ahead: neither an end nor a leg can be seen from where the line enters it."""
    patch = np.array([[24.0, 5], [30, 5], [30, 15], [24, 15]])
    run = trace(inked(ACROSS, specks=[patch], seed=seed), settings=Settings(line_width_mm=0.5))
    assert run.ending == "lost"
    assert run.fault is not None
    assert (run.fault.x_mm, run.fault.y_mm) == pytest.approx(
        (23.0, 10.0), abs=0.7
    )  # the guards see it 1 mm ahead
    assert run.fault.heading_rad == pytest.approx(0, abs=0.02)
    assert (
        "line lost at" in str(run.fault)
        and "heading" in str(run.fault)
        and "--gap" in str(run.fault)
    )
    assert (
        distance(run.xy_mm[::4], ACROSS).path_to_reference.max_mm < LINE_MM
    )  # what was traced is kept


# lead lines, directions, guide lines, and lines that are lost


CIRCLE = arc((16, 14), 6)
LEAD = polyline((4, 14), (10, 14))


def enclosed_mm2(loop: Array) -> float:
    """The area that a loop goes round, above zero if counter-clockwise."""
    x, y = loop.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


@SEEDS
def test_a_lead_line_and_the_loop_that_it_runs_into_are_one_path_once_round(
    seed: int | None,
) -> None:
    """The end is where the loop began: at a vertex, within what a corner is right to."""
    (line,) = trace(inked(LEAD, CIRCLE, seed=seed)).lines
    assert line.ending == "joined" and line.loop_from is not None
    assert line.length_mm == pytest.approx(length_mm(LEAD) + length_mm(CIRCLE), abs=4 * LINE_MM)
    assert np.hypot(*(line.xy_mm[-1] - line.xy_mm[line.loop_from])) < LINE_MM
    assert (
        distance(line.xy_mm[::4], np.vstack([LEAD, arc((16, 14), 6, 180, 540)])).hausdorff_mm
        < 2 * LINE_MM
    )


@pytest.mark.parametrize(
    ("direction", "sign"), [("cw", -1), ("ccw", 1), ("left", -1), ("right", 1)]
)
def test_the_head_takes_a_loop_in_the_direction_that_is_asked_for(
    direction: Direction, sign: int
) -> None:
    (line,) = trace(inked(LEAD, CIRCLE), operator=Operator(direction=direction)).lines
    assert math.copysign(1, enclosed_mm2(line.xy_mm[line.loop_from :])) == sign


@pytest.mark.parametrize(
    ("direction", "sign"), [("cw", -1), ("ccw", 1), ("left", -1), ("right", 1)]
)
def test_so_it_does_on_a_line_without_a_lead_that_it_comes_to_from_below(
    direction: Direction, sign: int
) -> None:
    run = trace(inked(CIRCLE), (16.0, 6.5), operator=Operator(direction=direction))
    assert run.ending == "closed" and math.copysign(1, enclosed_mm2(run.xy_mm)) == sign


def test_an_open_line_has_no_direction_round() -> None:
    with pytest.raises(LineFault, match="direction cw: the line is open"):
        trace(inked(ACROSS), operator=Operator(direction="cw"))


@SEEDS
def test_a_guide_line_is_taken_where_the_card_says_so_and_come_back_from(
    seed: int | None,
) -> None:
    """The head still goes round the loop; it took the guide line and came back from it at one place."""
    guide = polyline((22, 14), (17.5, 14))
    operator = Operator(card=Card.parse('turns = ["right", "left"]'))
    (line,) = trace(inked(LEAD, CIRCLE, guide, seed=seed), (4.2, 14.0), operator=operator).lines
    (taken,) = line.guides
    assert line.ending == "joined"
    assert np.hypot(*(line.xy_mm[taken.tip] - guide[1])) < END_MM
    for at in (taken.leave, taken.back):
        assert np.hypot(*(line.xy_mm[at] - guide[0])) < 2 * LINE_MM
    assert line.length_mm == pytest.approx(
        6 + length_mm(CIRCLE) + 2 * length_mm(guide), abs=8 * LINE_MM
    )


def test_a_ring_with_a_gap_closes_by_catching_it_again_wherever_the_head_begins() -> None:
    ring = inked(arc((14, 14), 9, 10, 350), seed=1)  # 3.1 mm apart, less the pen's width
    for start_mm in (None, (5.0, 14.0)):
        assert trace(ring, start_mm, Settings(recatch_mm=2.0)).ending == "ended"
        run = trace(ring, start_mm, Settings(recatch_mm=5.0))
        assert run.ending == "closed" and run.length_mm == pytest.approx(18 * math.pi, abs=0.1)


@pytest.mark.parametrize("radius_mm", [8.0, 20.0])
@pytest.mark.parametrize("seed", range(3))
def test_a_dashed_circle_is_followed_all_the_way_round(radius_mm: float, seed: int) -> None:
    """Dashes of 2.5 mm, 1 mm apart: the bend of so short a piece is uncertain."""
    dashes = round(2 * math.pi * radius_mm / 4)
    step = 360 / dashes
    pieces = [arc((24, 24), radius_mm, k * step, (k + 2.5 / 4) * step) for k in range(dashes)]
    run = trace(inked(*pieces, seed=seed), settings=Settings(gap_mm=1.3))
    assert run.ending == "closed" and run.length_mm == pytest.approx(
        2 * math.pi * radius_mm, rel=0.003
    )


def test_a_lost_line_is_caught_again_within_the_limit_only() -> None:
    broken = inked(polyline((4, 10), (14, 10)), polyline((16.5, 10.8), (28, 14)))
    kept = trace(broken, (8.0, 10.0), Settings(recatch_mm=2.0))
    caught = trace(broken, (8.0, 10.0), Settings(recatch_mm=4.0))
    assert (kept.ending, caught.ending) == ("ended", "ended")
    assert kept.length_mm == pytest.approx(10, abs=2 * END_MM)
    assert caught.length_mm == pytest.approx(
        10 + math.hypot(2.5, 0.8) + math.hypot(11.5, 3.2), abs=0.1
    )


def gear(teeth: int = 11, outer_mm: float = 24.0, depth_mm: float = 6.0) -> Array:
    """A wheel with 4 corners to a tooth, whose sides are straight."""
    step, places = math.tau / teeth, []
    for k in range(teeth):
        for share, radius in ((0, 0), (0.4, 0), (0.5, depth_mm), (0.95, depth_mm)):
            angle = step * (k + share)
            along = np.array([math.cos(angle), math.sin(angle)])
            places.append(30 + (outer_mm - radius) * along)
    return polyline(*places, places[0])


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_corner_after_a_side_that_seems_to_bend(seed: int) -> None:
    """A side of 5 mm, felt with noise, may seem to bend; then the corner's vertex seemed to miss ink, and the
    corner was rounded by up to 104 um.
    """
    followed(gear(), inked(gear(), width_mm=0.7, seed=seed))


@pytest.mark.parametrize("height_mm", [1.1, 1.3])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_step_as_high_as_the_line_is_wide(height_mm: float, seed: int) -> None:
    """It was taken for a tick across a line that goes straight on, and cut off by 0.36 mm."""
    line = polyline((4, 10), (14, 10), (14.3, 10 + height_mm), (34, 10 + height_mm))
    followed(line, inked(line, width_mm=1.0, seed=seed))


@pytest.mark.parametrize("seed", [1, 2])
def test_a_slot_closes_through_the_corner_before_home(seed: int) -> None:
    """Both long sides are in one tangle: the one on which the head began was no way out of it."""
    turned = np.array([[math.cos(0.3), -math.sin(0.3)], [math.sin(0.3), math.cos(0.3)]])
    corners = np.array([(-1.5, -0.85), (1.5, -0.85), (1.5, 0.85), (-1.5, 0.85)]) @ turned.T + 12
    line = polyline(*corners, corners[0])
    followed(line, inked(line, width_mm=1.0, seed=seed), within_mm=30 * UM)


def test_legs_are_found_along_a_line_that_runs_with_the_rows() -> None:
    """More than 64 fronts of a wave stand in each row of pixels: they touched each other several times over,
    and none of them counted as a line.
    """
    line = polyline((4, 8), (24, 8.1), (24.2, 9.3), (50, 9.4))
    followed(line, inked(line, width_mm=1.0, seed=1))
