"""Branches: where a run of the head leaves an earlier one, so that it begins there and not at the beginning.

Signals: a stance and the turns of a run in; out the head of an earlier run, where this run leaves that.

    first run          ●──────┬0────────┬1───────┬2──────◁        a copy of the head before each junction,
    with a turn at 1                    └1────▶                   and at a tip the head itself
    back from tips                               ◀───────◁

The head is deterministic: up to the junction at which the turns differ, and up to the tip from which it goes
back, two runs are one, to the last bit.

Source: our own. Questions: `knots` take a run up again, too, where turns or ink differ by their places; they
are kept every few mm, for whoever asks for them, and outlive a trace. Branches are kept at junctions, in
every run, as long as the attempts at one line go on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from morfax.tracer.following.knots import copied

if TYPE_CHECKING:
    from morfax.tracer.following.follower import Follower
    from morfax.tracer.following.ways_out import Turns
    from morfax.tracer.head.stance import Stance

MOST_HEADS = 128  # kept in all, some 60 kB each; a run that leaves another later begins anew


@dataclass(slots=True)
class _Run:
    """One run: its stance and turns, the head before each of its junctions, by their numbers, and the head
    that stands at a tip at which the run ended.
    """

    stance: Stance
    turns: Turns
    heads: dict[int, Follower] = field(default_factory=dict)
    at_tip: Follower | None = None


class Branches:
    """The runs that the head has made at one line, as far as others may leave them."""

    def __init__(self) -> None:
        self._runs: list[_Run] = []

    def head(
        self, stance: Stance, turns: Turns
    ) -> tuple[Follower | None, Callable[[Follower], None]]:
        """The head where the run that begins now leaves an earlier one, if it does; and what keeps this run's
        heads, for which it is called before each junction.
        """
        run = _Run(stance, turns)
        head = self._from_tip(run) or self._from_junction(run)
        self._runs.append(run)

        def keep(head: Follower) -> None:
            heads_in_all = sum(len(each.heads) for each in self._runs)
            if head.junction not in run.heads and heads_in_all < MOST_HEADS:
                run.heads[head.junction] = copied(head)

        return head, keep

    def ended(self, head: Follower) -> None:
        """The newest run has ended: keep its head if that stands at a tip."""
        self._runs[-1].at_tip = head if head.is_at_tip else None

    def _from_tip(self, run: _Run) -> Follower | None:
        """The head that goes back from the tip at which the same run ended."""
        earlier = self._run(run.stance, run.turns._replace(back_from_tips=False))
        if earlier is None or earlier.at_tip is None or not run.turns.back_from_tips:
            return None
        head, earlier.at_tip = earlier.at_tip, None
        head.take_up(run.turns)
        run.heads = dict(earlier.heads)
        return head

    def _from_junction(self, run: _Run) -> Follower | None:
        """The head before the junction at which an earlier run took another turn."""
        if not run.turns.other:
            return None
        number = run.turns.other[-1]
        fewer = tuple(turn for turn in run.turns.other if turn != number)
        earlier = self._run(run.stance, run.turns._replace(other=fewer))
        if earlier is None or number not in earlier.heads:
            return None
        head = copied(earlier.heads[number])
        head.take_up(run.turns, at_junction=True)
        return head

    def _run(self, stance: Stance, turns: Turns) -> _Run | None:
        """The run from a stance with some turns, if it was made."""
        same = (run for run in self._runs if run.stance is stance and run.turns == turns)
        return next(same, None)
