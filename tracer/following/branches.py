"""Branches: where a run of the head leaves an earlier one, so that it begins there and not at the beginning.

Signals: a stance and the turns of a run in; out the head of an earlier run, where this run leaves that.

    first run          ●──────┬0────────┬1───────┬2──────◁        a copy of the head before each junction,
    with a turn at 1                    └1────▶                   and at a tip the head itself
    back from tips                               ◀───────◁

The head is deterministic: up to the junction at which the turns differ, and up to the tip from which it goes
back, two runs are one, to the last bit. They are one altogether if the first never came to that junction.

So a run from a stance from which the head has run before, with the same turns, is not run again.

Source: our own. Questions: `knots` take a run up again, too, where turns or ink differ by their places; they
are kept every few mm, for whoever asks for them, and outlive a trace. Branches are kept at junctions, in
every run, as long as the attempts at one line, or at one patch of ink, go on.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.long_array import one_in
from morfax.motion.usual import THINNED
from morfax.tracer.following.knots import copied

if TYPE_CHECKING:
    from morfax.tracer.following.followed import Followed
    from morfax.tracer.following.follower import Before, Follower
    from morfax.tracer.following.ways_out import Turns
    from morfax.tracer.head.stance import Stance

MOST_HEADS = 128  # kept in all, some 60 kB each; a run that leaves another later begins anew
MOST_MM = 3000.0  # travel of the runs that are kept for the attempts from another stance: 30 MB

Key = tuple[Any, ...]


@dataclass(slots=True)
class _Run:
    """One run: its stance and turns, the head before each of its junctions, by their numbers, the head that
    stands at a tip at which the run ended, and what the run came to.
    """

    stance: Stance
    key: Key
    turns: Turns
    heads: dict[int, Follower] = field(default_factory=dict)
    at_tip: Follower | None = None
    came_to: Followed | None = None
    asked_at: set[int] = field(default_factory=set)  # the junctions at which turns mattered

    def from_there(self, head: Follower, left_at: int) -> Followed | None:
        """What a run comes to that left this one at a junction, and before the next is where this one was.

        The way out that it took of the first junction is not in doubt; the junction may be taken to be
        elsewhere.
        """
        number = left_at + 1
        if self.came_to is None or number not in self.heads or head.junction != number:
            return None
        if not head.goes_on_as(self.heads[number]):
            return None
        doubts = tuple(doubt for doubt in self.came_to.doubts if doubt[0] != left_at)
        places_mm = head.junctions_mm[:number] + self.came_to.junctions_mm[number:]
        return replace(self.came_to, doubts=doubts, junctions_mm=places_mm)


class Branches:
    """The runs that the head has made at one line, as far as others may leave them."""

    def __init__(self) -> None:
        self._runs: list[_Run] = []
        self._kept = 0
        self._low_mm, self._high_mm = np.full(2, np.inf), np.full(2, -np.inf)

    def make_room(self) -> None:
        """Forget the heads of the runs so far, or the runs as well, if they take much memory."""
        kept_mm = sum(run.came_to.travel_mm for run in self._runs if run.came_to is not None)
        if kept_mm > MOST_MM:
            self._runs, self._kept = [], 0
        if 2 * self._kept > MOST_HEADS:
            self._kept = 0
            for run in self._runs:
                run.heads, run.at_tip = {}, None

    def known(self, stance: Stance, turns: Turns) -> Followed | None:
        """What a run comes to that was made before, or whose last turn is at a junction to which the earlier
        run never came.
        """
        same = self._run(stance, turns)
        if same is not None and same.came_to is not None:
            return same.came_to
        earlier = self._with_fewer(stance, turns) if turns.other else None
        if earlier is None or earlier.came_to is None or turns.other[-1] in earlier.asked_at:
            return None
        self._runs.append(replace(earlier, turns=turns, at_tip=None))
        return earlier.came_to

    def head(self, stance: Stance, turns: Turns) -> tuple[Follower | None, Before]:
        """The head where the run that begins now leaves an earlier one, if it does; and what is to be called
        before each junction of this run: it keeps the head.
        """
        run = _Run(stance, _key(stance), turns)
        head, left = self._from_tip(run), None
        if head is None and turns.other:
            left = self._left(run)
            head = None if left is None else self._from_junction(run, left)
        self._runs.append(run)

        def before(head: Follower) -> Followed | None:
            if head.junction in run.heads:
                return None
            if self._kept < MOST_HEADS:
                run.heads[head.junction] = copied(head)
                self._kept += 1
            known = None if left is None else left.from_there(head, turns.other[-1])
            if left is not None and known is not None:
                run.asked_at |= left.asked_at
            return known

        return head, before

    def ended(self, head: Follower, came_to: Followed) -> None:
        """The newest run has ended: keep its head if that stands at a tip."""
        self._runs[-1].at_tip = head if head.is_at_tip else None
        self._runs[-1].came_to = came_to
        self._runs[-1].asked_at |= head.asked_at
        low_mm, high_mm = bounds(one_in(came_to.positions_mm, THINNED))
        self._low_mm = np.minimum(self._low_mm, low_mm / came_to.view.enlarged)
        self._high_mm = np.maximum(self._high_mm, high_mm / came_to.view.enlarged)

    def kept_to(self, low_mm: Array, high_mm: Array) -> bool:
        """Whether no run ever left a box, sheet mm."""
        return bool(((self._low_mm > low_mm) & (self._high_mm < high_mm)).all())

    def _from_tip(self, run: _Run) -> Follower | None:
        """The head that goes back from the tip at which the same run ended."""
        earlier = self._run(run.stance, run.turns._replace(back_from_tips=False))
        if earlier is None or earlier.at_tip is None or not run.turns.back_from_tips:
            return None
        head, earlier.at_tip = earlier.at_tip, None
        head.take_up(run.turns)
        run.heads = dict(earlier.heads)
        return head

    def _left(self, run: _Run) -> _Run | None:
        """The earlier run that a run leaves at the junction of its last turn."""
        earlier = self._with_fewer(run.stance, run.turns)
        return earlier if earlier and run.turns.other[-1] in earlier.heads else None

    def _with_fewer(self, stance: Stance, turns: Turns) -> _Run | None:
        """The run from a stance with the same turns but the last, if it was made."""
        fewer = tuple(turn for turn in turns.other if turn != turns.other[-1])
        return self._run(stance, turns._replace(other=fewer))

    def _from_junction(self, run: _Run, left: _Run) -> Follower:
        """The head before the junction at which a run leaves another."""
        number = run.turns.other[-1]
        run.heads = {k: head for k, head in left.heads.items() if k <= number}
        head = copied(left.heads[number])
        head.take_up(run.turns, at_junction=True)
        return head

    def _run(self, stance: Stance, turns: Turns) -> _Run | None:
        """The run from a stance with some turns, if it was made."""
        key = _key(stance)
        same = (run for run in self._runs if run.key == key and run.turns == turns)
        return next(same, None)


def _key(stance: Stance) -> Key:
    """What a run from a stance depends on. What the cells see is the same if it is the same array."""
    view, cells = stance.view, stance.view.cells
    sees = (
        id(cells.darkness),
        id(cells.tiles),
        cells.level,
        view.pitch_mm,
        view.grainy,
        view.parted,
    )
    line = view.width_mm, view.usual_mm, view.enlarged, view.on_edge
    return (
        *stance.place_mm.tolist(),
        stance.heading_rad,
        stance.at_end,
        stance.reference_mm,
        *sees,
        *line,
    )
