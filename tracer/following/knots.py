"""Knots: the head as it was on its way, so that a later run goes on from there and not from the beginning.

Signals: runs of the head in; for a run that begins as an earlier one did, the head at the last place before
which both runs are the same.

    first run     ●────k────k────k────k────✗ lost             a turn is told near ✗
    second run              (replayed)  k────┐                the head is taken up at the last knot
                                             └────────►       whose way is far from that place

The head is deterministic: from the same state, with the same ink before it, it makes the same motion. A turn
that was told or taken back counts within a few mm of its place, so up to there the two runs are one, to the
last bit. A run on another drawing begins anew, also where only a little of the ink is another: the width and
the darkness that the head is put down with are measured on all the ink of its line.

Only who asks for it keeps knots (`remembering`): the panel, which traces a drawing again and again.

Source: our own; the patent's operator sets the head back on the line by hand and lets it run on. Questions:
stops are read off the way when it is whole, so a told stop needs no knot: the run is replayed to its end.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.corrections.on_sheet import REACH_MM, REACH_WIDTHS, TurnAt
from morfax.tracer.drawing.drawing import Drawing

if TYPE_CHECKING:
    from morfax.tracer.following.follower import Follower
    from morfax.tracer.following.ways_out import Turns

APART_MM = 6.0  # of travel between two knots: to keep them takes 3 % of the head's time
MOST_KNOTS = 64  # of a run, some 60 kB each; beyond, every second one is dropped
MOST_RUNS = 8  # the last ones that are remembered: a line is tried both ways round, and with a few turns
# how far ahead of the axis a told turn may count: twice its reach, and the legs that are felt there
REACHES, LEGS = 3.0, 3.0


@dataclass(frozen=True, slots=True)
class _Knot:
    """The head at a place of its way, as a copy that is never moved; the places up to there, (n, 2) mm."""

    travel_mm: float
    head: Follower
    places_mm: Array

    def is_before(self, place_mm: tuple[float, float], reach_mm: float) -> bool:
        """Whether the head had not come within a reach of a place."""
        return bool(np.hypot(*(self.places_mm - place_mm).T).min() > reach_mm)


@dataclass(slots=True)
class _Run:
    """The knots of one run, and the turns that were told for it."""

    at: tuple[TurnAt, ...]
    knots: list[_Knot] = field(default_factory=list)
    apart_mm: float = APART_MM

    def keep(self, head: Follower) -> None:
        """Keep the head as it is now, if it has come far enough."""
        travel_mm = head.carriage.travel_mm
        if self.knots and travel_mm - self.knots[-1].travel_mm < self.apart_mm:
            return
        if len(self.knots) == MOST_KNOTS:
            del self.knots[1::2]
            self.apart_mm *= 2
        self.knots.append(_Knot(travel_mm, _copied(head), head.carriage.trail.places()))

    def last_before(self, at: tuple[TurnAt, ...]) -> int:
        """How many knots there are up to which a run with other turns told is the same."""
        changed = set(self.at) ^ set(at)
        for count in range(len(self.knots), 0, -1):
            knot = self.knots[count - 1]
            if all(knot.is_before(turn.place_mm, _reach_mm(knot.head)) for turn in changed):
                return count
        return 0


class Memory:
    """The runs of the head on one drawing that are remembered."""

    def __init__(self) -> None:
        self._drawing: Drawing | None = None
        self._runs: dict[Hashable, _Run] = {}
        self.replayed_mm = 0.0  # in all: travel that was not run again

    def head(
        self, drawing: Drawing, start: Hashable, turns: Turns
    ) -> tuple[Follower | None, Callable[[Follower], None]]:
        """The head of an earlier run at the last knot that is the same, if there is one; and what keeps the
        knots of the run that begins now.
        """
        self._lay_on(drawing)
        key = start, turns._replace(at=())
        before = self._runs.pop(key, None)
        run = _Run(turns.at)
        self._runs[key] = run
        while len(self._runs) > MOST_RUNS:
            del self._runs[next(iter(self._runs))]
        count = 0 if before is None else before.last_before(turns.at)
        if before is None or not count:
            return None, run.keep
        run.knots, run.apart_mm = before.knots[:count], before.apart_mm
        head = _copied(run.knots[-1].head)
        head.take_up(turns)
        self.replayed_mm += head.carriage.travel_mm
        return head, run.keep

    def _lay_on(self, drawing: Drawing) -> None:
        """Forget all runs if another drawing lies on the table."""
        if drawing is self._drawing:
            return
        old, self._drawing = self._drawing, drawing
        if old is None or not (
            old.pitch_mm == drawing.pitch_mm and np.array_equal(old.darkness, drawing.darkness)
        ):
            self._runs.clear()


_MEMORY: ContextVar[Memory | None] = ContextVar("memory", default=None)


def memory() -> Memory | None:
    """The memory that is kept now; None if nobody keeps one."""
    return _MEMORY.get()


@contextmanager
def remembering(kept: Memory) -> Iterator[None]:
    """Have the runs of the head from here on remembered, and those that are known replayed."""
    before = _MEMORY.set(kept)
    try:
        yield
    finally:
        _MEMORY.reset(before)


def _reach_mm(head: Follower) -> float:
    """How near to a told turn's place the head may be without knowing of it, mm."""
    view = head.view
    turns_mm = REACHES * max(REACH_MM, REACH_WIDTHS * view.width_mm)
    return turns_mm + LEGS * view.leg_mm + head.carriage.tuning.guard_lead_mm


def _copied(head: Follower) -> Follower:
    """A head that can be moved without moving the other; what it sees and where it was are shared."""
    shared = [head.view.cells.darkness, *head.carriage.shared()]
    return copy.deepcopy(head, {id(each): each for each in shared})
