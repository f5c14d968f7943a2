"""Junctions counted once each, and guide lines from where they were left to where the line goes on; both by
hand and on drawings.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import AGAIN_MM, GuideLine, PassedJunctions, _first_near
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, arc, dot, inked, polyline

HERE, THERE = np.array([10.0, 0.0]), np.array([20.0, 0.0])
WITHIN_MM = 50 * UM  # as a corner's vertex
PLATE = arc((30, 20), 12)
LEAD = polyline((4, 20), (18, 20))


def test_a_junction_counts_once_while_the_head_is_at_it() -> None:
    junctions = PassedJunctions()
    for place, travel_mm in ((HERE, 10.0), (HERE, 10.0 + AGAIN_MM / 2), (THERE, 20.0)):
        junctions.come_to(partial(np.asarray, place), travel_mm)
    assert junctions.places_mm == [(10.0, 0.0), (20.0, 0.0)]
    assert junctions.next(20.0) == 1 and junctions.next(20.0 + 2 * AGAIN_MM) == 2


def test_a_guide_line_is_left_for_ends_and_is_come_back_from() -> None:
    junctions = PassedJunctions()
    out, back = np.linspace([10, 0], [10, 5], 51), np.linspace([10, 5], [10, 0], 51)
    way = np.vstack(
        [np.linspace([0, 0], [10, 0], 101), out, back, np.linspace([10, 0], [20, 0], 101)]
    )
    junctions.take(HERE, 95)
    assert not junctions.comes_back(HERE, 1.0)  # not before it has been to the end
    assert (
        junctions.turn_round(152)
        and junctions.comes_back(HERE, 1.0)
        and not junctions.comes_back(THERE, 1.0)
    )
    assert junctions.guides(way) == ()  # it has been to the end, and is not yet back
    junctions.is_back(200, 30.0)
    assert junctions.next(31.0) == -1 + len(junctions.places_mm) or not junctions.places_mm
    assert not junctions.comes_back(HERE, 1.0) and not junctions.turn_round(250)
    (guide,) = junctions.guides(way)
    assert isinstance(guide, GuideLine) and guide.tip == 151
    assert way[guide.leave] == pytest.approx(HERE) and way[guide.back] == pytest.approx(HERE)


def test_the_head_is_back_when_it_first_comes_by_the_junction() -> None:
    """Later it may come by nearer."""
    away_mm = np.array([1.0, 0.045, 0.04, 1.0, 0.01, 1.0])
    way = np.column_stack([10.0 + away_mm, np.zeros(6)])
    assert _first_near(way, np.array([10.0, 0.0])) == 2
    assert _first_near(way[[0, 3, 5]] + 0.1, np.array([10.0, 0.0])) == 0  # not so near at all


def test_the_end_of_a_line_that_is_no_guide_is_the_end() -> None:
    assert not PassedJunctions().turn_round(100)


# on drawings


def traced(
    *lines: np.ndarray,
    turns: str = "[]",
    width_mm: float = 0.5,
    dots: tuple[np.ndarray, ...] = (),
) -> Line:
    operator = Operator(card=Card.parse(f"turns = {turns}\n"))
    return trace(
        inked(LEAD, PLATE, *lines, width_mm=width_mm, seed=11, specks=dots),
        (4, 20),
        operator=operator,
    ).lines[0]


def guide(at_deg: float, slant_deg: float, length_mm: float = 8.0) -> np.ndarray:
    """A guide line inward from the plate, so far from square to it."""
    a = math.radians(at_deg)
    foot = np.array([30 + 12 * math.cos(a), 20 + 12 * math.sin(a)])
    way = math.radians(at_deg + 180 + slant_deg)
    return np.array([foot, foot + length_mm * np.array([math.cos(way), math.sin(way)])])


@pytest.mark.parametrize("width_mm", [0.3, 0.8])
@pytest.mark.parametrize("slant_deg", [-45.0, 0.0, 45.0])
def test_a_junction_is_where_its_lines_meet_whether_it_is_taken_or_passed(
    slant_deg: float, width_mm: float
) -> None:
    off = guide(60, slant_deg)
    for turns, guides in (('["left"]', 0), ('["left", "right"]', 1)):
        line = traced(
            off, turns=turns, width_mm=width_mm
        )  # clockwise: what lies inside is on the right
        assert len(line.junctions_mm) == 2 and len(line.guides) == guides
        assert math.dist(line.junctions_mm[0], LEAD[1]) < width_mm
        assert math.dist(line.junctions_mm[1], off[0]) < 0.5 * width_mm


def test_coming_back_from_a_guide_line_counts_no_junction_and_takes_no_turn() -> None:
    first, second = guide(60, 40), guide(-60, 0)
    line = traced(first, second, turns='["left", "right", "right"]')
    assert line.is_lead is False and line.ending == "joined" and len(line.junctions_mm) == 3
    tips = [line.xy_mm[taken.tip] for taken in line.guides]
    assert [
        math.dist(a, b) < WITHIN_MM for a, b in zip(tips, (first[1], second[1]), strict=True)
    ] == [
        True,
        True,
    ]


def test_a_guide_line_ends_in_the_middle_of_its_dot_though_it_comes_askew() -> None:
    off = guide(60, 20)
    centre = (float(off[1, 0]) + 0.2, float(off[1, 1]))
    line = traced(off, turns='["left", "right"]', dots=(dot(centre, 2.0),))
    assert math.dist(line.xy_mm[line.guides[0].tip], centre) < WITHIN_MM


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("slant_deg", [54, -54])
def test_where_a_lead_line_joins_aslant_is_where_it_meets_the_contour(
    slant_deg: float, width_mm: float
) -> None:
    """36 degrees to the contour are straight on at a junction, and yet the legs meet where they do: the clean
    end was 1.7 mm before that.
    """
    a = math.radians(slant_deg)
    lead = polyline((18 - 14 * math.cos(a), 28 - 14 * math.sin(a)), (18, 28))
    line = trace(
        inked(arc((30, 28), 12), lead, width_mm=width_mm, seed=5), (lead[0, 0], lead[0, 1])
    ).lines[0]
    assert len(line.junctions_mm) == 1 and math.dist(line.junctions_mm[0], (18, 28)) < 0.3


@pytest.mark.parametrize("seed", [7, 94, 101])
def test_a_guide_line_on_the_outside_of_a_bend_makes_no_corner_of_it(seed: int) -> None:
    """On its inside the bend is seen to be round; by the outside alone the head went 0.2 mm up the guide line
    on the second of these.
    """
    rng = np.random.default_rng(seed)
    radius_mm, width_mm, angle = (
        rng.uniform(4, 10),
        rng.choice([0.3, 0.5, 0.8]),
        rng.uniform(0, math.tau),
    )
    out = angle + math.radians(rng.uniform(-45, 45))
    foot = (20 + radius_mm * math.cos(angle), 20 + radius_mm * math.sin(angle))
    guide = polyline(foot, (foot[0] + 8 * math.cos(out), foot[1] + 8 * math.sin(out)))
    start = (40 - foot[0], 40 - foot[1])
    line = trace(
        inked(arc((20, 20), radius_mm), guide, width_mm=float(width_mm), seed=seed), start
    ).lines[0]
    assert line.ending == "closed"
    assert np.abs(np.hypot(*(line.xy_mm - [20, 20]).T) - radius_mm).max() < 30 * UM
