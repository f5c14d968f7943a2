"""Knots: a run goes on from where an earlier one was the same, and comes to the same."""

from __future__ import annotations

import copy
from collections.abc import Hashable

import numpy as np
import pytest

from morfax.tracer.corrections.corrections import Correction, Corrections, Place
from morfax.tracer.drawing.corrected import corrected
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following import attempts, knots
from morfax.tracer.following.attempts import Attempts
from morfax.tracer.following.follower import Follower
from morfax.tracer.following.knots import Memory, changes_mm, remembering
from morfax.tracer.following.start import put_down
from morfax.tracer.head import watched
from morfax.tracer.head.carriage import Carriage
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace
from tests.tracer.inked import inked, polyline

# a comb whose back goes on beyond its last tooth
COMB = inked(
    polyline((6, 6), (6, 20), (60, 20), (60, 6), (50, 6), (50, 12), (40, 12), (40, 6), (6, 6)),
    polyline((60, 20), (75, 20)),
    polyline((30, 6), (30, 2)),  # a tick, and a junction on the way
    seed=5,
)
START = (20.0, 6.0)


def told(drawing: Drawing, *each: Correction) -> Drawing:
    """A drawing with corrections."""
    return corrected(drawing, Corrections(each))


def turn(kind: str, x: float, y: float) -> Correction:
    """A told turn."""
    return Correction(kind, (Place(x, y, "mm"),))  # type: ignore[arg-type]


def same(one: Trace, other: Trace) -> bool:
    """Whether two traces are the same to the last bit."""
    return np.array_equal(one.xy_mm, other.xy_mm) and all(
        (a.ending, a.junctions_mm, a.marks, a.served)
        == (b.ending, b.junctions_mm, b.marks, b.served)
        for a, b in zip(one.lines, other.lines, strict=True)
    )


def test_a_run_goes_on_at_the_last_knot_and_comes_to_what_a_run_from_the_beginning_does() -> (
    None
):
    kept = Memory()
    changes = [
        (),
        (turn("right", 60, 20),),
        (turn("right", 60, 20), turn("straight", 30, 6)),
        (),
    ]
    replayed = []
    for corrections in changes:
        drawing = told(COMB, *corrections)
        before_mm = kept.replayed_mm
        with remembering(kept):
            again = trace(drawing, START)
        replayed.append(kept.replayed_mm - before_mm)
        assert same(again, trace(drawing, START))
    assert replayed[0] == 0
    assert all(mm > 10 for mm in replayed[1:])  # not from the beginning


def rub(x: float, y: float) -> Correction:
    """Ink rubbed out."""
    return Correction("rub", (Place(x, y, "mm"),))


def bridge(*places: tuple[float, float]) -> Correction:
    """Ink drawn."""
    return Correction("bridge", tuple(Place(x, y, "mm") for x, y in places))


@pytest.mark.parametrize("start", [START, None])
def test_ink_that_is_changed_ahead_does_not_begin_the_run_anew(
    start: tuple[float, float] | None,
) -> None:
    kept, replayed = Memory(), []
    changes = [
        (),
        (rub(40, 20),),  # on the way, far from the start
        (rub(40, 20), bridge((41.5, 20), (38.5, 20))),
        (rub(75, 20),),
        (),
    ]
    for corrections in changes:
        drawing = told(COMB, *corrections)
        before_mm = kept.replayed_mm
        with remembering(kept):
            again = trace(drawing, start)
        replayed.append(kept.replayed_mm - before_mm)
        assert same(again, trace(drawing, start))
    assert replayed[0] == 0 and sum(mm > 5 for mm in replayed[1:]) >= 3


def test_what_the_operator_changed_lies_in_boxes_on_the_sheet() -> None:
    """With 8 pixels about them, half of what parts two changes. Other sizes are two drawings."""
    blank = np.zeros((200, 300), np.float32)
    changed = blank.copy()
    changed[50:60, 100:140] = changed[150, 20] = 1.0
    boxes = changes_mm(Drawing(blank, 0.1), Drawing(changed, 0.1))
    assert boxes is not None
    right, left = sorted(boxes.tolist(), reverse=True)
    assert right == pytest.approx([9.2, 13.2, 14.8, 15.8]) and left == pytest.approx(
        [1.2, 4.1, 2.9, 5.8]
    )
    same_mm = changes_mm(Drawing(blank, 0.1), Drawing(blank.copy(), 0.1))
    assert same_mm is not None and len(same_mm) == 0
    assert changes_mm(Drawing(blank, 0.1), Drawing(blank, 0.2)) is None
    assert changes_mm(Drawing(blank, 0.1), Drawing(blank[:100], 0.1)) is None


def test_no_head_is_put_down_where_one_is_taken_up(monkeypatch: pytest.MonkeyPatch) -> None:
    stance = next(put_down(Sheet.of(COMB), START, Settings()))[0]
    with remembering(Memory()):
        first = Attempts(COMB, Settings(), 200.0).run(stance)
        monkeypatch.setattr(attempts, "_kind", None)
        again = Attempts(COMB, Settings(), 200.0).run(stance)
    assert np.array_equal(again.positions_mm, first.positions_mm)


def test_another_drawing_is_begun_anew() -> None:
    kept, other = Memory(), inked(polyline((6, 6), (6, 20), (60, 20), (60, 6), (6, 6)), seed=5)
    with remembering(kept):
        trace(COMB, START)
        again = trace(other, START)
    assert kept.replayed_mm == 0
    assert same(again, trace(other, START))


def test_whoever_watches_sees_the_way_up_to_the_knot() -> None:
    class Watcher:
        def __init__(self) -> None:
            self.places = 0

        def put_down(self, carriage: Carriage) -> None:
            pass

        def taken_up(self, carriage: Carriage) -> None:
            self.places += len(carriage.positions_mm)

        def moved(self, carriage: Carriage, positions: np.ndarray) -> None:
            pass

        def says(self, what: str) -> None:
            pass

    kept, first, second = Memory(), Watcher(), Watcher()
    for who, drawing in ((first, COMB), (second, told(COMB, turn("right", 60, 20)))):
        with remembering(kept), watched.watching(who):
            trace(drawing, START)
    assert first.places == 0
    assert second.places > 6000  # of a second of motion, 10 mm


def test_few_knots_serve_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(knots, "MOST_KNOTS", 5)
    kept, drawing = Memory(), told(COMB, turn("right", 60, 20))
    with remembering(kept):
        trace(COMB, START)
        again = trace(drawing, START)
    assert kept.replayed_mm > 0
    assert same(again, trace(drawing, START))


def test_all_runs_that_were_cut_off_go_on_however_many(monkeypatch: pytest.MonkeyPatch) -> None:
    """More than are remembered of runs that were done: each line of a sheet has one."""
    kept = dict[Hashable, Follower]()

    def keep(key: Hashable, at: object, head: Follower) -> None:
        kept[key] = copy.deepcopy(head)

    with remembering(Memory(keep)):
        trace(COMB, START)
        trace(COMB, (60.0, 10.0))
    monkeypatch.setattr(knots, "MOST_RUNS", 1)
    again = Memory()
    for key, head in kept.items():
        again.take_in(key, (), head)
    with remembering(again):
        trace(COMB, START)
        first_mm = again.replayed_mm
        trace(COMB, (60.0, 10.0))
    assert first_mm > 10 and again.replayed_mm - first_mm > 10
