"""The memory of tangles: those that the head has come to, and what it left there.

Signals: the head's approach in; the way out of the tangle ahead, and junctions that are in doubt, out.

Source: our own (see `sketch`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.course import ahead_mm
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.trail import Trail
from morfax.tracer.limits import TIP_RAD
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, turn
from morfax.tracer.sensing.probe import stroke_end
from morfax.tracer.sensing.view import View

if (
    TYPE_CHECKING
):  # most lines have no tangle: what solves one is imported where the head comes to one
    from morfax.tracer.tangles.redrawing import Redrawing
    from morfax.tracer.tangles.solution import Approach
    from morfax.tracer.tangles.tangle import Tangle

# Chosen by trial on the test drawings.
LEAST_AHEAD_MM = 0.1  # the head can still come onto a strand's own leg
LONGEST_TIP_MM = 5.5  # lines that run together to one tip


class Tangles:
    """The tangles that the head has come to, each with its redrawing.

    Where a line leads into one again, it takes the strand that is left.
    """

    def __init__(self) -> None:
        self._known: list[tuple[Tangle, Redrawing]] = []
        self._left: list[tuple[int, int, Leg]] = []
        self._beside: list[Leg] = []
        self._softness_mm = math.inf  # of the lens: that of the clearest leg so far
        self._side: Leg | None = None  # that the last rule led onto

    def __deepcopy__(self, memo: dict[int, Any]) -> Tangles:
        """A memory that goes on by itself; tangles and legs, which are never changed, are shared."""
        copied = Tangles()
        copied._known, copied._left = list(self._known), list(self._left)
        copied._beside, copied._side = list(self._beside), self._side
        copied._softness_mm = self._softness_mm
        return copied

    @property
    def state(self) -> tuple[list[Redrawing], float, Leg | None]:
        """The redrawings of the tangles so far, the lens's softness, mm, and the side that the last rule led
        onto: what decides by which strand a line leads through again, and by which rule.
        """
        return [redrawing for _, redrawing in self._known], self._softness_mm, self._side

    def way_out(self, view: View, approach: Approach) -> tuple[Plan | None, bool]:
        """The way out of the tangle ahead, and whether it explains the tangle's ink.

        It is the plan if that explains the ink as well as any other way, or if neither a redrawing nor a rule
        explains it.
        """
        plan, is_explained = self._by_legs(view, approach)
        if is_explained:
            return plan, True
        rule = self._by_rule(view, approach)
        return (plan, False) if rule is None else (rule, True)

    def _by_rule(self, view: View, approach: Approach) -> Plan | None:
        """The way over corners whose sides are no legs, if the ink ahead is one line; None if it is not.

        Where the head comes along such a side, and hardly feels a leg, it comes as that rule lay.
        """
        from morfax.tracer.tangles.rule_ahead import rule_ahead
        from morfax.tracer.tangles.sketch import softness_of

        incoming, side = approach.incoming, self._side
        if len(incoming.seen) >= FEWEST_STATIONS:
            self._softness_mm = min(self._softness_mm, softness_of(view, incoming))
        elif side is not None and math.dist(side.end_mm, incoming.end_mm) < view.width_mm:
            approach = approach._replace(incoming=side)
        else:
            return None
        rule = rule_ahead(view, approach, self._softness_mm)
        self._side = None if rule is None else rule.leg
        return rule

    def _by_legs(self, view: View, approach: Approach) -> tuple[Plan | None, bool]:
        """The same by the legs of the tangle, if it ends in legs, and in no more than can be joined."""
        from morfax.tracer.tangles.tangle import tangle_ahead

        incoming, plan = approach.incoming, approach.plan
        if len(incoming.seen) < FEWEST_STATIONS:
            return plan, False
        # 1. the strand that is left of a tangle that is known
        strand = self._strand_left(approach, view.width_mm)
        if strand is not None and approach.rank == 0:
            return strand, True
        # 2. of an odd number of legs one ends on another: that is a junction, which the legs tell better
        tangle = tangle_ahead(view, incoming)
        odd = len(tangle.legs) % 2 == 1
        if odd:
            self._beside += [leg for leg in tangle.legs[1:] if _runs_back(view, incoming, leg)]
        if not _is_closed(tangle) or (odd and plan is not None):
            return plan, False
        return self._redrawn(view, tangle, approach)

    def _redrawn(
        self, view: View, tangle: Tangle, approach: Approach
    ) -> tuple[Plan | None, bool]:
        """The way out by the redrawing that explains the ink, which is remembered; and whether one does."""
        from morfax.tracer.tangles.sketch import Sketch
        from morfax.tracer.tangles.solution import unravelled

        found = unravelled(Sketch.of(view, tangle), approach)
        if found.redrawing is not None:
            self._known.append((tangle, found.redrawing))
        if approach.rank == 0:
            ranked = enumerate(found.others, 1)
            self._left += [(approach.number, rank, leg) for rank, leg in ranked]
        return found.plan, found.redrawing is not None

    def goes_back(self, tip: Array, trail: Trail, width_mm: float) -> bool:
        """Whether a line that ends at a tip is two that ran together before, one of which is not followed."""
        near = [leg for leg in self._beside if np.hypot(*(leg.end_mm - tip)) < LONGEST_TIP_MM]
        self._beside = []
        return any(not trail.holds(leg, width_mm) for leg in near)

    def doubts(self, trail: Trail, width_mm: float) -> tuple[tuple[int, int], ...]:
        """Junctions (number, rank of the way out) where another way would have done as well.

        Only those that lead to ink that has not been followed.
        """
        return tuple(
            (number, rank) for number, rank, leg in self._left if not trail.holds(leg, width_mm)
        )

    def _strand_left(self, approach: Approach, width_mm: float) -> Plan | None:
        """The plan by the strand that a line leads into; None if it leads into no tangle that is known."""
        from morfax.tracer.tangles.strands import same_line, stretches_over

        incoming, place = approach.incoming, approach.stands[0]
        for tangle, way in self._known:
            for a, b, vertices in _strands(way):
                first, last = tangle.legs[a].turned_round(), tangle.legs[b]
                if not same_line(first, incoming, width_mm):
                    continue
                if not approach.trail.holds(last, width_mm):
                    begin = first if ahead_mm(place, first) > LEAST_AHEAD_MM else incoming
                    stretches = stretches_over(approach.stands, begin, vertices, last)
                    return Plan(stretches, last, leader=REDRAWN)
        return None


def _is_closed(tangle: Tangle) -> bool:
    """Whether a tangle ends in legs, and in no more than can be joined."""
    from morfax.tracer.tangles.sketch import MOST_LEGS

    return tangle.whole and 2 <= len(tangle.legs) <= MOST_LEGS


def _strands(way: Redrawing) -> Iterator[tuple[int, int, Array]]:
    """The strands that were not taken, either way round: legs, and the vertices between them."""
    for (a, b), vertices in zip(way.pairs, way.vertices, strict=True):
        if 0 not in (a, b):
            yield a, b, vertices
            yield b, a, vertices[::-1]


def _runs_back(view: View, incoming: Leg, leg: Leg) -> bool:
    """Whether a leg is that of a line, no mark, that runs together with the incoming one, ahead."""
    back = abs(turn(incoming.heading_rad, leg.heading_rad)) > TIP_RAD
    return back and stroke_end(view, leg, longest_mm(view)) is None
