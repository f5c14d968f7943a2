"""Branches: a run with another turn begins where it leaves an earlier run, and comes to the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.motion.arrays import bounds
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following import attempts, branches, clean_line
from morfax.tracer.following.attempts import Attempts
from morfax.tracer.following.clean_line import Knows
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.start import put_down
from morfax.tracer.following.ways_out import STRAIGHT_ON, Turns, WaysOut
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.memory import Tangles
from tests.tracer.inked import inked, polyline

LONGEST_MM = 150.0
# a frame with two bars across it: three areas, and four junctions
LADDER = inked(
    polyline((6, 6), (60, 6), (60, 26), (6, 26), (6, 6)),
    polyline((24, 6), (24, 26)),
    polyline((42, 6), (42, 26)),
    seed=3,
)
OPEN = inked(polyline((6, 6), (40, 6), (40, 20)), seed=2)
START = (12.0, 6.0)


def stance_on(drawing: Drawing) -> Stance:
    return next(put_down(Sheet.of(drawing), START, Settings()))[0]


def attempts_at(drawing: Drawing, *, tips: bool = False) -> Attempts:
    return Attempts(drawing, Settings(), LONGEST_MM, tips=tips)


def assert_same(one: Followed, other: Followed) -> None:
    """Two runs are the same to the last bit."""
    assert np.array_equal(one.positions_mm, other.positions_mm)
    assert (one.ending, one.junctions_mm, one.doubts, one.at_tip) == (
        other.ending,
        other.junctions_mm,
        other.doubts,
        other.at_tip,
    )


def test_a_run_with_other_turns_leaves_the_run_without_them_at_the_junction() -> None:
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    straight = attempts.run(stance)
    assert len(straight.junctions_mm) >= 2
    ways = set()
    for turns in ((0,), (1,), (0, 1), (1, 1)):
        run = attempts.run(stance, turns)
        assert_same(run, attempts_at(LADDER).run(stance, turns))
        ways.add(run.travel_mm)
    assert len(ways) > 1  # the turns lead elsewhere
    head, _ = attempts.branches.head(stance, Turns((1,)))
    assert head is not None
    away_mm = np.hypot(*(head.carriage.stands()[0] - straight.junctions_mm[1]))
    assert (
        away_mm < 4.0 < head.carriage.travel_mm
    )  # near the junction, not where it was put down


def test_no_head_is_put_down_for_another_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    stance, first = stance_on(LADDER), attempts_at(LADDER)
    first.run(stance)
    monkeypatch.setattr(attempts, "_kind", None)
    assert first.run(stance, (1,)).travel_mm > 0


def test_a_turn_at_a_junction_to_which_the_run_never_came_is_not_run_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    turned = attempts.run(stance, (0,))
    beyond = len(turned.junctions_mm) + 1
    assert_same(turned, attempts_at(LADDER).run(stance, (0, beyond)))
    followed = list[Carriage]()
    follow = clean_line.follow
    monkeypatch.setattr(
        clean_line, "follow", lambda c, *more: followed.append(c) or follow(c, *more)
    )
    assert_same(attempts.run(stance, (0, beyond)), turned)
    assert not followed
    # a further turn beside it is
    attempts.run(stance, (0, 1))
    assert followed


def test_a_run_that_was_made_before_is_not_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also for other attempts with the same branches, and a stance that is only alike; until they forget."""
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    first = attempts.run(stance)
    alike = replace(stance, place_mm=stance.place_mm.copy())
    others = replace(attempts_at(LADDER), branches=attempts.branches)
    assert others.run(alike) is first
    assert others.run(replace(stance, heading_rad=stance.heading_rad + 0.01)) is not first
    dim = replace(stance, view=stance.view.at_level(0.9 * stance.view.level))
    assert others.run(dim) is not first
    assert replace(others, by_stations=True).run(stance) is not first
    attempts.branches.make_room()
    assert others.run(stance) is first
    monkeypatch.setattr(branches, "MOST_MM", 0.5 * first.travel_mm)
    attempts.branches.make_room()
    again = others.run(stance)
    assert again is not first
    assert_same(again, first)


def test_a_run_from_another_stance_or_with_other_sides_begins_at_the_beginning() -> None:
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    attempts.run(stance)
    assert attempts.branches.head(stance_on(LADDER), Turns((1,)))[0] is None
    assert attempts.branches.head(stance, Turns((1,), sides=("left",)))[0] is None
    assert attempts.branches.head(stance, Turns((1,), back_from_tips=True))[0] is None


def test_a_run_back_from_a_tip_goes_on_where_the_first_run_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The end of the line is taken for a tip; the head goes to and fro as far as it may."""
    monkeypatch.setattr(Tangles, "goes_back", lambda *_: True)
    stance, attempts = stance_on(OPEN), attempts_at(OPEN)
    ended = attempts.run(stance)
    assert ended.ending == "ended" and ended.at_tip
    back = replace(attempts, tips=True).run(stance)
    assert back.travel_mm > 2 * ended.travel_mm
    assert_same(back, attempts_at(OPEN, tips=True).run(stance))
    # once only: the head is not there any more
    assert_same(back, replace(attempts, tips=True).run(stance))


def test_no_more_heads_are_kept_than_a_few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(branches, "MOST_HEADS", 1)
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    attempts.run(stance)
    assert attempts.branches.head(stance, Turns((1,)))[0] is None
    assert attempts.branches.head(stance, Turns((0,)))[0] is not None


def test_a_turn_in_vain_comes_to_what_the_run_without_it_came_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The head is told the same way out whichever turn is asked for: the rest of the run is not run again."""
    chosen = WaysOut.chosen
    monkeypatch.setattr(
        WaysOut,
        "chosen",
        lambda self, view, leg, carriage: chosen(
            replace(self, turns=STRAIGHT_ON), view, leg, carriage
        ),
    )
    followed_mm = list[float]()
    follow = clean_line.follow

    def counted(carriage: Carriage, view: View, knows: Knows) -> tuple[View, int]:
        before_mm = carriage.travel_mm
        found = follow(carriage, view, knows)
        followed_mm.append(carriage.travel_mm - before_mm)
        return found

    monkeypatch.setattr(clean_line, "follow", counted)
    stance, attempts = stance_on(LADDER), attempts_at(LADDER)
    straight = attempts.run(stance)
    whole_mm = sum(followed_mm)
    followed_mm.clear()
    again = attempts.run(stance, (0,))
    again_mm = sum(followed_mm)
    assert 0 < again_mm < 0.7 * whole_mm
    assert_same(again, straight)
    assert_same(again, attempts_at(LADDER).run(stance, (0,)))


def test_a_box_about_all_runs_tells_whether_the_head_ever_left_it() -> None:
    attempts, step_mm = attempts_at(OPEN), np.array([0.1, 0.0])  # a place in 50 um is looked at
    low_mm, high_mm = bounds(attempts.run(stance_on(OPEN)).positions_mm)
    kept_to = attempts.branches.kept_to
    assert kept_to(low_mm - 0.1, high_mm + 0.1)
    assert not kept_to(low_mm + step_mm, high_mm + 0.1)
    # a run counts that was forgotten for want of room
    attempts.branches._runs.clear()
    assert not kept_to(low_mm - 0.1, high_mm - step_mm)
