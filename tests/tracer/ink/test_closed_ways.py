"""Closed ways: which lines of a net are no contour's, and which are drawn by one pen."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink import closed_ways as closed_ways_room
from morfax.tracer.ink import onward as onward_room
from morfax.tracer.ink import outlines
from morfax.tracer.ink.aside import has_arrowhead
from morfax.tracer.ink.chains import Chain, Junction, Junctions, Link, Side
from morfax.tracer.ink.closed_ways import closed_ways
from morfax.tracer.ink.crossing import Crossing
from morfax.tracer.ink.net import FeltLine, Net
from morfax.tracer.ink.onward import Onward
from morfax.tracer.ink.outlines import Outline, goes_round, goes_round_paper
from morfax.tracer.ink.way_round import Search
from morfax.tracer.sensing.leg import Leg

STEP_MM, LINE_MM = 0.05, 0.4


@pytest.mark.parametrize(
    ("widths_mm", "are_two"),
    [
        ((0.27, 0.42, 0.28, 0.41), True),  # a thin line through a thick one
        ((0.27, 0.30, 0.28, 0.29), False),
        ((0.5, 0.8, 0.5), False),  # where two lines become one ink
    ],
)
def test_lines_of_two_pens_are_told_from_ink_that_two_lines_share(
    widths_mm: tuple[float, ...], are_two: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    sides = [Side(n, False) for n in range(len(widths_mm))]
    legs = [
        Leg(np.zeros(2), float(n), 0.0, mm, np.empty((0, 3))) for n, mm in enumerate(widths_mm)
    ]
    there = Junction(sides, False, Crossing(legs, [], Settings()))
    monkeypatch.setattr(Junctions, "at", lambda *_: there)
    onward = Onward(Junctions(Net([]), Settings()))
    assert onward.are_of_two_pens(sides[0], sides[1]) == are_two
    assert not onward.are_of_two_pens(sides[0], sides[2])


def test_an_arrowhead_that_touches_a_long_line_makes_no_other_pen_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends_mm, whole_mm = (0.7, 0.5, 0.7, 0.5), (0.5, 0.5)
    sides = [Side(n, False) for n in range(len(ends_mm))]
    legs = [
        Leg(np.zeros(2), float(n), 0.0, mm, np.empty((0, 3))) for n, mm in enumerate(ends_mm)
    ]
    there = Junction(sides, False, Crossing(legs, [], Settings()))
    monkeypatch.setattr(Junctions, "at", lambda *_: there)
    lines = [
        FeltLine([], [], (0, 1), mm, 30.0, n, np.empty(0)) for n, mm in enumerate(whole_mm)
    ]
    onward = Onward(Junctions(Net(lines), Settings()))
    assert onward.are_of_two_pens(sides[0], sides[1])  # what of them tells no pen
    monkeypatch.setitem(onward.__dict__, "_sure", {0, 1})
    assert not onward.are_of_two_pens(sides[0], sides[1])


def widths(*pieces_mm: tuple[float, float, float]) -> np.ndarray:
    """Widths along a line: pieces, each so long and from one width to another, then 20 mm of line."""
    every = [
        np.linspace(a, b, round(mm / STEP_MM))
        for mm, a, b in (*pieces_mm, (20.0, LINE_MM, LINE_MM))
    ]
    return np.concatenate(every)


@pytest.mark.parametrize(
    ("pieces_mm", "is_one"),
    [
        (((0.5, 3.0, 0.4), (2.5, 0.4, 1.0)), True),  # its tip on an extension line
        (((0.3, 0.4, 0.4), (1.0, 0.5, 0.9), (2.0, 3.0, 3.0)), True),  # broader than cells feel
        (((0.5, 3.0, 0.4),), False),  # a line that ends on another
        (((2.0, 1.0, 0.4),), False),  # on another at a slope
        (((2.0, 0.4, 0.4), (1.0, 0.4, 1.0), (1.0, 1.0, 0.4)), False),  # a blot on the way
        (((0.5, 3.0, 0.4), (0.4, 1.0, 1.0)), False),  # a tick across
    ],
)
def test_an_arrowhead_grows_from_its_tip_and_is_at_once_a_line_again(
    pieces_mm: tuple[tuple[float, float, float], ...], is_one: bool
) -> None:
    assert has_arrowhead(widths(*pieces_mm), STEP_MM, LINE_MM) == is_one


@pytest.mark.parametrize(
    ("long_mm", "bend_per_mm", "is_tip"),
    [
        (25.0, 0.0, True),  # a lobe in a ring
        (5.0, 0.0, False),  # hatching in a wall
        (25.0, 0.1, False),  # circles of 10 mm that touch
    ],
)
def test_a_sharp_tip_is_one_of_long_straight_lines(
    monkeypatch: pytest.MonkeyPatch, long_mm: float, bend_per_mm: float, is_tip: bool
) -> None:
    """Lines of 0.4 mm at 20 degrees share 1.15 mm of ink; a tip's are ten times as long."""
    sides = [Side(n, False) for n in range(2)]
    legs = [Leg(np.zeros(2), 0.0, bend_per_mm, LINE_MM, np.empty((0, 3))) for _ in sides]
    there = Junction(sides, False, Crossing(legs, [], Settings()))
    monkeypatch.setattr(Junctions, "at", lambda *_: there)
    lines = [FeltLine([], [], (0, 1), LINE_MM, long_mm) for _ in sides]
    junctions = Junctions(Net(lines), Settings())
    search = Search(junctions, Onward(junctions), Onward(junctions))
    assert search._is_tip(*sides, np.radians(160)) == is_tip


@pytest.mark.parametrize(("go_on", "is_end"), [(0, False), (1, True)])
def test_a_way_that_turns_off_a_line_that_goes_on_has_an_end_there(
    go_on: int, is_end: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Onward, "goes_on", lambda *_: False)
    sides = [Side(n, False) for n in range(2)]
    junctions = Junctions(
        Net([FeltLine([], [], (0, 1), LINE_MM, 4.0) for _ in sides]), Settings()
    )
    search = Search(junctions, Onward(junctions), Onward(junctions))
    on = search._turned(*sides, go_on, are_alone=True)
    assert on is not None and on.is_end == is_end


@pytest.mark.parametrize(("middle", "is_round"), [((5.0, 2.0), True), ((5.0, 8.0), False)])
def test_what_lies_in_a_bay_of_a_chain_is_not_inside_it(
    middle: tuple[float, float], is_round: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    rim = np.array([[0, 0], [10, 0], [10, 10], [6, 10], [6, 4], [4, 4], [4, 10], [0, 10]])
    lines = [FeltLine([], [], (0, 1), LINE_MM, long_mm) for long_mm in (52.0, 10.0)]
    junctions = Junctions(Net(lines), Settings())
    monkeypatch.setattr(Junctions, "places_along", lambda *_: rim)
    boxes = np.array([[[0, 0], [10, 10]], [middle, middle]])
    monkeypatch.setitem(junctions.__dict__, "boxes_mm", boxes)
    monkeypatch.setitem(junctions.__dict__, "middles_mm", np.array([[5.0, 5.0], middle]))
    chain = Chain([Link(0, False)], True)
    assert goes_round(chain, junctions, set()) == is_round
    assert goes_round(chain, junctions, {1})  # where that line is aside


@pytest.mark.parametrize(
    ("apart_widths", "is_paper"),
    [
        (0.3, False),
        (1.0, True),
    ],  # the rims of the bold arm of a cross; a slot whose sides touch
)
def test_a_way_round_the_rims_of_one_line_s_ink_is_no_outline(
    monkeypatch: pytest.MonkeyPatch, apart_widths: float, is_paper: bool
) -> None:
    high_mm = apart_widths * LINE_MM
    sides = [np.array([[0, 0], [4, 0]]), np.array([[4, high_mm], [0, high_mm]])]
    junctions = Junctions(
        Net([FeltLine([], [], (0, 1), LINE_MM, 4.0) for _ in sides]), Settings()
    )
    monkeypatch.setattr(Junctions, "places_along", lambda *_: np.vstack(sides))
    chain = Chain([Link(0, False), Link(1, False)], True)
    monkeypatch.setattr(outlines, "straight_chains", lambda _: [Outline(chain, 8.0)])
    monkeypatch.setattr(outlines, "_outside", lambda _: None)
    assert goes_round_paper(chain, junctions) == is_paper
    assert bool(outlines.outlines(junctions)) == is_paper


def test_how_a_line_goes_on_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search for closed ways asks for each side of a crowded net a dozen times."""
    asked = list[Leg]()

    def turned_by(one: Leg, other: Leg) -> float:
        asked.append(one)
        return 0.0

    legs = [Leg(np.zeros(2), n * np.pi, 0.0, 0.5, np.empty((0, 3))) for n in range(2)]
    sides = [Side(n, False) for n in range(2)]
    there = Junction(sides, False, Crossing(legs, [], Settings()))
    monkeypatch.setattr(Junctions, "at", lambda *_: there)
    monkeypatch.setattr(onward_room, "turned_by", turned_by)
    lines = [FeltLine([], [], (0, 1), 0.5, 1.0, n, np.empty(0)) for n in range(2)]
    onward = Onward(Junctions(Net(lines), Settings()))
    assert all(onward.goes_on(side) for _ in range(3) for side in sides)
    assert len(asked) == len(sides)


def test_areas_are_looked_for_without_lines_aside_and_then_without_the_taken_ones_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    without = list[set[int]]()

    def parts(_: Junctions, left_out: set[int]) -> list[Outline]:
        without.append(left_out)
        return []

    monkeypatch.setattr(closed_ways_room, "parts", parts)
    monkeypatch.setattr(closed_ways_room, "lines_aside", lambda _: {1})
    monkeypatch.setattr(closed_ways_room, "straight_chains", lambda _: [])
    monkeypatch.setattr(Search, "way", lambda *_: None)
    lines = [FeltLine([], [], (0, 1), LINE_MM, 4.0) for _ in range(3)]
    assert list(closed_ways(Junctions(Net(lines), Settings()), {0}, 0.5)) == []
    assert without[-2:] == [{1}, {0, 1}]  # before them the silhouette was looked for
