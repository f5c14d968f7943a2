"""Knots: the head as it was on its way, so that a later run goes on from there and not from the beginning.

Signals: runs of the head in; for a run that begins as an earlier one did, the head at the last place before
which both runs are the same.

    first run     ●────k────k────k────k────✗ lost             near ✗ a turn is told, or ink is changed
    second run              (replayed)  k────┐                the head is taken up at the last knot
                                             └────────►       whose way is far from that place

The head is deterministic: from the same state, with the same ink before it, it makes the same motion. A turn
that was told or taken back, and ink that was rubbed out or drawn, count within some mm of their place, so up
to there the two runs are one, to the last bit. A run begins anew on another drawing, and where the head is
put down otherwise than before (see `unchanged`).

Only who asks for it keeps knots (`remembering`): the panel, which traces a drawing again and again.

Source: our own; the patent's operator sets the head back on the line by hand and lets it run on. Questions:
stops are read off the way when it is whole, so a told stop needs no knot: the run is replayed to its end.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Hashable
from contextlib import AbstractContextManager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.held import held
from morfax.tracer.corrections.on_sheet import REACH_MM, REACH_WIDTHS, TurnAt
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.tiles import Tiles

if TYPE_CHECKING:
    from morfax.tracer.following.follower import Follower
    from morfax.tracer.following.ways_out import Turns
    from morfax.tracer.sensing.view import View

APART_MM = 6.0  # of travel between two knots: to keep them takes 3 % of the head's time
MOST_KNOTS = 64  # of a run, some 60 kB each; beyond, every second one is dropped
MOST_RUNS = 8  # the last ones that are remembered: a line is tried both ways round, and with a few turns
# how far ahead of the axis a told turn may count: twice its reach, and the legs that are felt there
REACHES = 3.0
APART_PX = 16  # changed pixels that are nearer to each other are one change
MOST_CHANGES = 200  # places of changed ink; more are another drawing


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
    """The knots of one run, the turns that were told for it, and the ink that it sees."""

    at: tuple[TurnAt, ...]
    darkness: Darkness
    knots: list[_Knot] = field(default_factory=list)
    apart_mm: float = APART_MM

    def keep(self, head: Follower) -> bool:
        """Keep the head as it is now, if it has come far enough; whether it was kept."""
        travel_mm = head.carriage.travel_mm
        if self.knots and travel_mm - self.knots[-1].travel_mm < self.apart_mm:
            return False
        if head.view.cells.darkness is not self.darkness:  # it looks through larger cells
            return False
        if len(self.knots) == MOST_KNOTS:
            del self.knots[1::2]
            self.apart_mm *= 2
        self.knots.append(_Knot(travel_mm, copied(head), head.carriage.trail.places()))
        return True

    def on(self, view: View, count: int) -> list[_Knot]:
        """The first knots, with heads that look at another sheet, which is the same up to there."""
        knots = self.knots[:count]
        before = self.darkness, knots[-1].head.view.others
        now = view.cells.darkness, view.others
        changed = {id(old): new for old, new in zip(before, now, strict=True) if old is not new}
        if not changed:
            return knots
        return [replace(knot, head=copied(knot.head, changed)) for knot in knots]

    def cut_off(self, changed_mm: Array) -> None:
        """Forget the knots from where the head came near to changed ink: boxes (n, 4) mm, x, y to x, y."""
        while self.knots:
            knot = self.knots[-1]
            reach_mm = _reach_mm(knot.head) + knot.head.settings.gap_mm
            reach_mm += knot.head.settings.recatch_mm
            places = knot.places_mm[:, None]
            beyond = np.maximum(changed_mm[:, :2] - places, places - changed_mm[:, 2:])
            if np.hypot(*np.maximum(beyond, 0.0).transpose(2, 0, 1)).min() > reach_mm:
                return
            self.knots.pop()

    def last_before(self, at: tuple[TurnAt, ...]) -> int:
        """How many knots there are up to which a run with other turns told is the same."""
        changed = set(self.at) ^ set(at)
        for count in range(len(self.knots), 0, -1):
            knot = self.knots[count - 1]
            if all(knot.is_before(turn.place_mm, _reach_mm(knot.head)) for turn in changed):
                return count
        return 0


Kept = Callable[[Hashable, tuple[TurnAt, ...], "Follower"], None]


class Memory:
    """The runs of the head on one drawing that are remembered; `kept` hears of each new knot."""

    def __init__(self, kept: Kept | None = None) -> None:
        self._drawing: Drawing | None = None
        self._runs: dict[Hashable, _Run] = {}
        self._cut_off: dict[Hashable, _Run] = {}  # of another memory, until they go on
        self.kept = kept
        self.replayed_mm = 0.0  # in all: travel that was not run again

    def take_in(self, key: Hashable, at: tuple[TurnAt, ...], head: Follower) -> None:
        """Remember a run that another memory kept, by its last knot."""
        knot = _Knot(head.carriage.travel_mm, head, head.carriage.trail.places())
        self._cut_off[key] = _Run(at, head.view.cells.darkness, [knot])

    def head(
        self, drawing: Drawing, start: Hashable, turns: Turns, view: View
    ) -> tuple[Follower | None, Callable[[Follower], None]]:
        """The head of an earlier run at the last knot that is the same, if there is one; and what keeps the
        knots of the run that begins now. `view` is what the head sees.
        """
        self._lay_on(drawing)
        key = start, turns._replace(at=())
        before = self._cut_off.pop(key, None) or self._runs.pop(key, None)
        run = _Run(turns.at, view.cells.darkness)
        self._runs[key] = run
        while len(self._runs) > MOST_RUNS:
            del self._runs[next(iter(self._runs))]

        def keep(head: Follower) -> None:
            if run.keep(head) and self.kept is not None:
                self.kept(key, turns.at, head)

        count = 0 if before is None else before.last_before(turns.at)
        if before is None or not count:
            return None, keep
        run.knots, run.apart_mm = before.on(view, count), before.apart_mm
        head = copied(run.knots[-1].head)
        head.take_up(turns)
        self.replayed_mm += head.carriage.travel_mm
        return head, keep

    def _lay_on(self, drawing: Drawing) -> None:
        """Cut off the runs where another drawing has other ink; forget them if it is another altogether."""
        old, self._drawing = self._drawing, drawing
        if old is None or old is drawing:
            return
        changed_mm = changes_mm(old, drawing)
        if changed_mm is None:
            self._runs.clear()
            self._cut_off.clear()
        elif len(changed_mm):
            for run in (*self._runs.values(), *self._cut_off.values()):
                run.cut_off(changed_mm)


def changes_mm(old: Drawing, new: Drawing) -> Array | None:
    """Where the ink of two drawings differs: boxes (n, 4) mm; None if they are two altogether."""
    if isinstance(old.darkness, Tiles) or isinstance(new.darkness, Tiles):
        return None
    are_alike = old.pitch_mm == new.pitch_mm and old.darkness.shape == new.darkness.shape
    if not are_alike or old.edges_mm or new.edges_mm:
        return None
    differs = (old.darkness != new.darkness).astype(np.uint8)
    if not differs.any():
        return np.empty((0, 4))
    near = cv2.dilate(differs, np.ones((APART_PX + 1,) * 2, np.uint8))
    count, _, boxes, _ = cv2.connectedComponentsWithStats(near)
    if count - 1 > MOST_CHANGES:
        return None
    left, top, width, height = boxes[1:, :4].T
    bottom = len(differs) - top - height
    edges_px = np.column_stack([left, bottom, left + width, bottom + height])
    return np.asarray(edges_px * new.pitch_mm, float)


_MEMORY: ContextVar[Memory | None] = ContextVar("memory", default=None)


def memory() -> Memory | None:
    """The memory that is kept now; None if nobody keeps one."""
    return _MEMORY.get()


def remembering(kept: Memory) -> AbstractContextManager[None]:
    """Have the runs of the head from here on remembered, and those that are known replayed."""
    return held(_MEMORY, kept)


def _reach_mm(head: Follower) -> float:
    """How near to a told turn's place the head may be without knowing of it, mm."""
    view = head.view
    turns_mm = REACHES * max(REACH_MM, REACH_WIDTHS * view.width_mm)
    return turns_mm + REACHES * view.leg_mm + head.carriage.tuning.guard_lead_mm


def copied(head: Follower, other: dict[int, Any] | None = None) -> Follower:
    """A head that can be moved without moving the first; what it sees and where it was are shared, but for
    `other` ink, and ink of other lines, by the id of the first's.
    """
    shared = [head.view.cells.darkness, *head.carriage.shared()]
    return copy.deepcopy(head, {**{id(each): each for each in shared}, **(other or {})})
