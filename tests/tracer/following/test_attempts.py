"""Attempts: which of the head's runs is the line."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.faults import LineFault
from morfax.motion.polyline import area_mm2
from morfax.tracer.following.attempts import DOUBTS, SHORTER, TRIED_MM, TURNS, Attempts
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.start import put_down
from morfax.tracer.head.leaders import CELL, STATIONS
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.view import View
from tests.tracer.inked import arc, inked, polyline

DRAWING = inked(polyline((4, 4), (14, 4)))
VIEW = View(Cells(DRAWING.darkness, DRAWING.pitch_mm, 0.5), 0.5)
STANCE = Stance(np.array([9.0, 4.0]), 0.0, VIEW)
Runs = dict[
    tuple[bool, bool], Followed
]  # by whether the head sets out as it stands, and whether it goes back from tips


def run(ending: str, length_mm: float, *, at_tip: bool = False) -> Followed:
    """A run along X, as it might have ended."""
    positions = np.column_stack([9 + np.linspace(0, length_mm, 100), np.full(100, 4.0)])
    return Followed(positions, ending, 0.0, length_mm, VIEW, ((9.5, 4.0),), at_tip=at_tip)


def chosen(monkeypatch: pytest.MonkeyPatch, runs: Runs) -> Followed:
    """The run that is kept, of runs that are known beforehand."""

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        return runs[math.cos(stance.heading_rad) > 0, self.tips]

    monkeypatch.setattr(Attempts, "run", known)
    return Attempts(DRAWING, Settings(), 100.0).all_of_it(STANCE)


def test_a_line_that_closes_only_back_from_a_tip_is_tried_so_either_way_round(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A coast of 2.2 m ended in a bay one way round, and at a spike of two lines the other way: half of it
    was left.
    """
    runs: Runs = {
        (True, False): run("ended", 40),
        (False, False): run("joined", 65, at_tip=True),
        (False, True): run("closed", 217),
        (True, True): run("lost", 41),
    }
    assert chosen(monkeypatch, runs) is runs[False, True]
    runs[True, False], runs[True, True] = run("joined", 40, at_tip=True), run("closed", 220)
    assert chosen(monkeypatch, runs) is runs[True, True]


def test_a_line_that_closes_has_no_need_of_tips(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: Runs = {
        (True, False): run("closed", 100),
        (False, False): run("joined", 65, at_tip=True),
    }
    assert chosen(monkeypatch, runs) is runs[True, False]


def test_a_run_that_goes_back_along_the_line_that_it_came_by_has_not_gone_back_from_a_tip(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An envelope's flap: 50 mm of its top were cut twice."""
    there = np.column_stack([9 + np.linspace(0, 200, 6000), np.full(6000, 4.0)])
    runs: Runs = {
        (True, False): run("joined", 90),
        (False, False): run("joined", 65, at_tip=True),
        (False, True): replace(
            run("closed", 250), positions_mm=np.vstack([there, there[:-1500:-1]])
        ),
    }
    assert chosen(monkeypatch, runs) is runs[True, False]


def test_a_tip_that_leads_nowhere_leaves_the_longest_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    runs: Runs = {
        (True, False): run("ended", 40),
        (False, False): run("joined", 65, at_tip=True),
        (False, True): run("lost", 70),
    }
    assert chosen(monkeypatch, runs) is runs[False, False]


def test_a_line_that_closes_only_without_the_slow_cell_is_run_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A line of two pixels' width ended at a junction after 110 of 129 mm. Without a slow stretch, no run
    would be another; a broad line closes with the slow cell, if at all.
    """
    tried: list[bool] = []
    fine = replace(VIEW, width_mm=2 * VIEW.pitch_mm)

    def run_of(went_slowly: bool, by_stations: str, view: View = fine) -> Followed:
        def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
            tried.append(self.by_stations)
            if self.by_stations:
                return run(by_stations, 129)
            return replace(run("ended", 110), went_slowly=went_slowly)

        monkeypatch.setattr(Attempts, "run", known)
        stance = replace(STANCE, at_end=True, view=view)
        return Attempts(DRAWING, Settings(), 100.0).all_of_it(stance)

    assert run_of(went_slowly=True, by_stations="closed").ending == "closed"
    assert run_of(went_slowly=True, by_stations="joined").ending == "ended"
    tried.clear()
    assert run_of(went_slowly=False, by_stations="closed").ending == "ended"
    assert run_of(went_slowly=True, by_stations="closed", view=VIEW).ending == "ended"
    assert not any(tried)


def test_stations_lead_where_the_slow_cell_is_left_out() -> None:
    """Round a circle of 1.2 mm, on which no fast cell keeps."""
    drawing = inked(arc((8, 8), 1.2), seed=1)
    stance, _ = next(iter(put_down(drawing)))
    attempts = Attempts(drawing, Settings(), 40.0)
    for by_stations in (False, True):
        done = replace(attempts, by_stations=by_stations).run(stance)
        led = done.led.lengths_mm(done.positions_mm)
        assert done.went_slowly is not by_stations
        assert (led[CELL] > led[STATIONS]) is not by_stations


def test_a_head_that_cannot_set_out_from_one_end_of_a_line_does_from_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The end of an engraved arc of one pixel bends: 33 of 450 mm were kept as the line."""
    there, other_way = run("ended", 33), run("ended", 417)
    other_way = replace(other_way, positions_mm=other_way.positions_mm * [-1, 1])
    from_end, from_other = run("lost", 0), run("ended", 450)

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        if stance.place_mm[0] == STANCE.place_mm[0]:
            return there if math.cos(stance.heading_rad) > 0 else other_way
        return from_end if stance.place_mm[0] > 0 else from_other

    monkeypatch.setattr(Attempts, "run", known)
    assert Attempts(DRAWING, Settings(), 100.0).all_of_it(STANCE) is from_other


@pytest.mark.parametrize(
    ("ending", "back_mm", "aside_mm", "count"),
    [
        ("ended", 60, 0.0, 2),
        ("ended", 40.5, 0.0, 3),  # it ends about where the head was put down
        ("ended", 60, 1.0, 3),  # it goes another way
        ("joined", 60, 0.0, 3),
    ],
)
def test_an_open_line_run_back_from_its_end_is_not_run_the_other_way_round_as_well(
    monkeypatch: pytest.MonkeyPatch, ending: str, back_mm: float, aside_mm: float, count: int
) -> None:
    there, tried = run("ended", 40), list[float]()
    x_mm = 49 - np.linspace(0, back_mm, 6000)
    places = np.column_stack([x_mm, np.full(6000, 4 + aside_mm)])
    back = replace(run(ending, back_mm), positions_mm=places)

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        tried.append(stance.heading_rad)
        if stance.at_end:
            return back
        return there if math.cos(stance.heading_rad) > 0 else run("ended", 20)

    monkeypatch.setattr(Attempts, "run", known)
    assert Attempts(DRAWING, Settings(), 100.0).all_of_it(STANCE) is back
    assert len(tried) == count


def test_doubts_are_settled_one_after_the_other_each_from_the_longest_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A coast of 2.2 m was run ten times: after another turn its junctions have other numbers."""
    lengths = {(): 200, (3,): 200, (3, 3): 208, (3, 3, 9): 207, (3, 3, 9, 9): 220}
    doubts = {(): ((3, 1), (3, 2), (5, 1), (5, 2)), (3, 3): ((9, 1), (9, 2))}
    tried = list[tuple[int, ...]]()

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        tried.append(turns)
        return replace(run("closed", lengths[turns]), doubts=doubts.get(turns, ()))

    monkeypatch.setattr(Attempts, "run", known)
    stance = replace(STANCE, at_end=True)
    assert Attempts(DRAWING, Settings(), 100.0).all_of_it(stance).travel_mm == 220
    assert tried == list(lengths)


@pytest.mark.parametrize(("ending", "more"), [("closed", DOUBTS), ("ended", 0)])
def test_no_more_doubts_are_looked_into_than_is_allowed(
    monkeypatch: pytest.MonkeyPatch, ending: str, more: int
) -> None:
    """Each other turn is longer, and has a doubt of its own; those of an open run do not count."""
    tried = list[tuple[int, ...]]()

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        tried.append(turns)
        return replace(run(ending, 100 + len(turns)), doubts=((len(turns), 1),))

    monkeypatch.setattr(Attempts, "run", known)
    Attempts(DRAWING, Settings(), 100.0).all_of_it(replace(STANCE, at_end=True))
    assert len(tried) == 1 + more


@pytest.mark.parametrize("shorter", [False, True])
def test_of_both_ways_round_the_second_is_the_line_if_it_is_shorter_by_enough(
    monkeypatch: pytest.MonkeyPatch, shorter: bool
) -> None:
    """Straight on has led elsewhere then, before it came back: by a twentieth of the way."""
    share = SHORTER - 0.01 if shorter else SHORTER + 0.01
    runs = {(True, False): run("closed", 100), (False, False): run("closed", 100 * share)}
    assert chosen(monkeypatch, runs) is runs[not shorter, False]


def with_turns(
    monkeypatch: pytest.MonkeyPatch,
    comes_to: Callable[[tuple[int, ...]], tuple[str, float]],
    junctions: int,
) -> tuple[Followed, list[tuple[int, ...]]]:
    """The run that is kept of a line with so many junctions at which other turns come to what is told, and
    the turns that were tried.
    """
    tried = list[tuple[int, ...]]()
    places = tuple((9.5 + k, 4.0) for k in range(junctions))

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        tried.append(turns)
        return replace(run(*comes_to(turns)), junctions_mm=places)

    monkeypatch.setattr(Attempts, "run", known)
    found = Attempts(DRAWING, Settings(), 100.0).all_of_it(STANCE)
    return found, [turns for turns in tried if turns]


def test_of_other_turns_the_shortest_way_that_closes_is_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At two junctions only where no turn at one alone closes."""
    closing = {(0,): 90.0, (2,): 60.0, (0, 1): 50.0}

    def comes_to(turns: tuple[int, ...]) -> tuple[str, float]:
        return ("closed", closing[turns]) if turns in closing else ("joined", 70.0)

    found, tried = with_turns(monkeypatch, comes_to, 3)
    assert (found.ending, found.travel_mm) == ("closed", 60.0)
    assert tried == [(0,), (1,), (2,)]
    del closing[0,], closing[2,]
    found, tried = with_turns(monkeypatch, comes_to, 3)
    assert (found.ending, found.travel_mm) == ("closed", 50.0)
    assert tried == [(0,), (1,), (2,), (0, 1), (0, 2), (1, 2)]


def test_other_turns_are_tried_at_so_many_junctions_and_for_so_long(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where none closes, the line stays as it was found at first."""
    found, tried = with_turns(monkeypatch, lambda _: ("joined", 1.0), 2 * TURNS)
    assert (found.ending, found.travel_mm) == ("joined", 1.0)
    assert len(tried) == TURNS + TURNS * (TURNS - 1) // 2
    _, tried = with_turns(monkeypatch, lambda _: ("joined", 0.4 * TRIED_MM), 2 * TURNS)
    assert len(tried) == 3


def round_about(sense: float) -> Followed:
    """A run round a circle, left about or right about."""
    angles = sense * np.linspace(0.0, math.tau, 100)
    positions = 9 + np.column_stack([np.cos(angles), np.sin(angles)])
    return Followed(positions, "closed", 0.0, math.tau, VIEW, ())


def test_a_line_is_followed_in_the_direction_that_is_asked_for_or_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    senses = {True: 1.0, False: -1.0}  # by whether the head sets out as it stands

    def known(self: Attempts, stance: Stance, turns: tuple[int, ...] = ()) -> Followed:
        return round_about(senses[math.cos(stance.heading_rad) > 0])

    monkeypatch.setattr(Attempts, "run", known)
    attempts = Attempts(DRAWING, Settings(), 100.0)
    for direction, sign in (("ccw", 1.0), ("cw", -1.0)):
        found = attempts.asked_for(STANCE, direction)
        assert sign * area_mm2(found.positions_mm) > 0
    senses[False] = 1.0
    with pytest.raises(LineFault, match="does not come back that way round"):
        attempts.asked_for(STANCE, "cw")
