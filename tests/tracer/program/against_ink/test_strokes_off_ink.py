"""Strokes that are not what is drawn where lines meet are told, with their place; those that are not."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.jobs.remarks.on_ink import of_ink
from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL, STATIONS, Led
from morfax.tracer.program.against_ink import strokes_off_ink as module
from morfax.tracer.program.against_ink.pen_on_ink import Ways
from morfax.tracer.program.against_ink.strokes_off_ink import _off_at, _places, strokes_off_ink
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_ink import trace_ink
from tests.tracer.inked import Points, inked, polyline

WIDTH_MM, STEP_MM = 0.5, 0.0017
ABOUT_MM = 1.5  # from where it is wrong, a place is told
# a corner whose tip stands a little out of another line's ink
ACROSS = polyline((4, 20), (36, 20))
TIP = polyline((12, 8), (20, 20.6), (28, 8))
CUT = polyline((12, 8), (19.4, 19.6), (20.6, 19.6), (28, 8))
ENDED = polyline((12, 8), (19.3, 19.5)), polyline((20.7, 19.5), (28, 8))


def stroke(places_mm: Points, leader: int = STATIONS, width_mm: float = WIDTH_MM) -> Line:
    """A stroke along some places, led so all along."""
    whole_mm = length_mm(places_mm)
    way_mm = at_lengths(places_mm, np.arange(0.0, whole_mm, STEP_MM))
    led = Led.along(np.full(len(way_mm), leader, np.int8))
    return Line(way_mm, "ended", width_mm, whole_mm, led=led)


@pytest.mark.parametrize("wrong", [(CUT,), ENDED], ids=["cut", "ended"])
@pytest.mark.parametrize("seed", [None, 3])
def test_a_corner_that_is_missing_in_another_line_is_told(
    wrong: tuple[Points, ...], seed: int | None
) -> None:
    drawing = inked(ACROSS, TIP, seed=seed)
    lines = [stroke(ACROSS), *map(stroke, wrong)]
    (place,) = strokes_off_ink(drawing, lines)
    assert np.hypot(*(np.array(place.place_mm) - TIP[len(TIP) // 2])) < ABOUT_MM
    (said,) = of_ink(Trace(tuple(lines), unexplained=(place,)), several=True)
    x, y = place.place_mm
    assert f"do not match the ink at 1 place, the worst at {x:.1f},{y:.1f} mm" in said


def test_a_place_of_one_station_has_a_length() -> None:
    """0 mm of a stroke off its ink were listed."""
    drawing, at = inked(ACROSS), np.array([[100, 100]], np.float32)
    ways = Ways(at, np.zeros(1, np.int32), np.array([3.0]), np.ones(1, bool))
    (place,) = _places(drawing, ways, np.array([0]), np.array([1.0]))
    assert drawing.pitch_mm < place.length_mm < WIDTH_MM


@pytest.mark.parametrize("seed", [None, 3, 4])
def test_strokes_that_are_what_is_drawn_are_not_told(seed: int | None) -> None:
    assert strokes_off_ink(inked(ACROSS, TIP, seed=seed), [stroke(ACROSS), stroke(TIP)]) == []


@pytest.mark.parametrize("seed", [None, 3])
def test_a_stroke_that_goes_on_from_ink_of_two_lines_is_not_told(seed: int | None) -> None:
    """Its width is that of its longest run, in the ink that two lines share."""
    shared = [polyline((4, y), (24, y)) for y in (19.85, 20.15)]
    on, lone = polyline((24, 20), (36, 20), (36, 30)), polyline((4, 6), (36, 6))
    strokes = [stroke(polyline((4, 20), (36, 20), (36, 30)), width_mm=0.8)]
    strokes += [stroke(lone) for _ in range(2)]
    drawing = inked(*shared, on, lone, seed=seed)
    assert strokes_off_ink(drawing, strokes) == []
    strokes[0] = stroke(polyline((4, 20), (35.6, 20), (35.6, 30)), width_mm=0.8)
    told = strokes_off_ink(drawing, strokes)
    assert told and all(place.place_mm[0] > 35 for place in told)  # along all of it


# two lines with their inks side by side, and one across these that turns to and fro in them, or does not
BESIDE = [polyline((4, y), (36, y)) for y in (19.8, 20.2)]
TO_AND_FRO = polyline((20, 8), (20, 20), (20.5, 20.2), (19.6, 20.1), (20, 19.7), (20, 32))


@pytest.mark.parametrize(
    ("across", "count"), [(TO_AND_FRO, 1), (polyline((20, 8), (20, 32)), 0)]
)
def test_a_stroke_that_turns_to_and_fro_in_others_ink_is_told(
    across: Points, count: int
) -> None:
    drawing = inked(*BESIDE, polyline((20, 8), (20, 32)), seed=3)
    told = strokes_off_ink(drawing, [stroke(line) for line in (*BESIDE, across)])
    assert len(told) == count
    assert all(np.hypot(*(np.array(place.place_mm) - 20)) < ABOUT_MM for place in told)


def test_a_stroke_that_turns_to_and_fro_in_its_own_ink_is_not_told() -> None:
    """So do letters and teeth."""
    teeth = polyline((8, 20), (20, 20), (20, 21), (20.8, 21), (20.8, 20), (32, 20))
    assert strokes_off_ink(inked(teeth, seed=3), [stroke(teeth)]) == []


def test_an_end_that_is_alone_is_not_told() -> None:
    drawing = inked(ACROSS, seed=3)
    assert strokes_off_ink(drawing, [stroke(polyline((4.6, 20), (35.4, 20)))]) == []


GAP = polyline((4, 20), (19, 20)), polyline((21, 20), (36, 20))


@pytest.mark.parametrize("gap_mm", [0.0, 1.0])
def test_a_gap_that_the_head_may_cross_is_not_told(gap_mm: float) -> None:
    told = strokes_off_ink(inked(*GAP, seed=3), [stroke(ACROSS)], gap_mm)
    assert bool(told) == (gap_mm == 0.0)


def test_paper_beside_another_stroke_is_no_gap() -> None:
    beside = polyline((19.6, 20.7), (19.6, 30))
    drawing, strokes = inked(*GAP, beside, seed=3), [stroke(ACROSS), stroke(beside)]
    worst = strokes_off_ink(drawing, strokes, 1.0)[0]
    assert worst.place_mm == pytest.approx((20, 20), abs=ABOUT_MM)


def test_where_the_cell_led_the_ink_is_the_lines_own() -> None:
    drawing = inked(ACROSS, TIP, seed=3)
    assert strokes_off_ink(drawing, [stroke(line, CELL) for line in (ACROSS, CUT)]) == []


def spilt(line: Points, radius_mm: float) -> list[Points]:
    """Ink that a felt pen left at places along its rims."""
    at_mm = np.arange(2.0, length_mm(line) - 2.0, 1.1)
    sides = 0.5 * WIDTH_MM * np.where(np.arange(len(at_mm)) % 3, 1, -1)
    places = at_lengths(line, at_mm) + np.outer(sides, [0.3, 1.0])
    round_rad = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    rim = radius_mm * np.column_stack([np.cos(round_rad), np.sin(round_rad)])
    return [place + rim for place in places]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_a_felt_pen_leaves_all_along_is_not_told(seed: int) -> None:
    """As it would be if the cell had led nowhere; a stroke beside its ink is told."""
    specks = [speck for line in (ACROSS, TIP) for speck in spilt(line, 0.24)]
    drawing = inked(ACROSS, TIP, seed=seed, specks=specks)
    across, bend = stroke(ACROSS, CELL), stroke(TIP)
    assert strokes_off_ink(drawing, [across, bend]) == []
    assert strokes_off_ink(inked(ACROSS, TIP, seed=seed, specks=specks), [stroke(ACROSS), bend])
    assert strokes_off_ink(drawing, [across, stroke(polyline((12, 8), (20, 18)))])


def test_strokes_of_all_the_ink_are_held_against_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if the head had left out all but the first stroke."""
    lines = polyline((4, 4), (36, 28)), polyline((4, 28), (36, 4)), polyline((4, 15), (36, 17))
    from morfax.tracer.program import trace_ink as module

    whole = trace_ink(inked(*lines, seed=1))
    assert not whole.unexplained
    monkeypatch.setattr(module, "_long_enough", lambda strokes: strokes[:2])
    monkeypatch.setattr(module, "put_down_again", lambda *_: ())
    assert {place.kind for place in trace_ink(inked(*lines, seed=1)).unexplained} == {"off"}


def test_strokes_on_their_ink_are_held_against_their_own_pens_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_off_at", _off_at.py_func)
    monkeypatch.setattr(module, "_best_of", None)  # nobody asks for it
    assert strokes_off_ink(inked(ACROSS, seed=3), [stroke(ACROSS)]) == []


@pytest.mark.parametrize("way", [TIP, CUT])
def test_what_their_own_pens_leave_is_no_less_than_what_the_best_do(
    monkeypatch: pytest.MonkeyPatch, way: Points
) -> None:
    """So no place is lost where the others are not tried."""
    found = list[np.ndarray]()

    def off_at(
        seen: object, ways: object, at: object, limits: np.ndarray, *rest: object
    ) -> object:
        quick, best = (_off_at(seen, ways, at, limits + by, *rest) for by in (1e9, -1e9))
        found.append(np.array([quick, best]))
        return best

    monkeypatch.setattr(module, "_off_at", off_at)
    strokes_off_ink(inked(ACROSS, TIP, seed=3), [stroke(ACROSS), stroke(way)])
    quick, best = np.hstack(found)
    assert np.all(quick >= best) and np.any(quick > best)
