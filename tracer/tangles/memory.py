"""The tangles that the head has come to, and what it remembers of them.

Signals: the incoming leg and the trail in; the way out of the tangle ahead, and what was left there, out.

Source: our own (see `pairing`).
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.course import ahead_mm
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.trail import Trail
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.sensing.probe import stroke_end
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.redrawing import MOST_LEGS, Sketch, Way
from morfax.tracer.tangles.solution import unravelled
from morfax.tracer.tangles.strands import same_line, stretches_over
from morfax.tracer.tangles.tangle import Tangle, tangle_ahead

LEAST_SEEN = 4  # stations of the incoming leg, to know the pen by
LEAST_AHEAD_MM = 0.1
BACK_RAD, LONGEST_TIP_MM = math.radians(130), 5.5  # lines that run together to one tip


class Tangles:
    """The tangles that the head has come to, each with the way it was drawn: where a line leads into one
    again it takes the strand that is left.
    """

    def __init__(self) -> None:
        self._known: list[tuple[Tangle, Way]] = []
        self._left: list[tuple[int, int, Leg]] = []
        self._beside: list[Leg] = []

    def way_out(
        self,
        view: View,
        incoming: Leg,
        trail: Trail,
        way_in: tuple[Array, float],
        plan: Plan | None,
        number: int = 0,
        rank: int = 0,
    ) -> tuple[Plan | None, bool]:
        """The way from where the head is (place, heading) out of the tangle ahead, and whether it explains
        the tangle's ink.

        It is the plan if that explains the ink as well as any other way, or if the tangle does not end in
        legs, or in too many, or if no way explains its ink. `rank` 1 takes the second best way out, 2 the
        third, and `number` is that of the tangle among the junctions.
        """
        if len(incoming.seen) < LEAST_SEEN:
            return plan, False
        strand = self._strand_left(incoming, trail, way_in[0], view.width_mm)
        if strand is not None and rank == 0:
            first, vertices, last = strand
            return Plan(stretches_over(way_in, first, vertices, last), last), True
        tangle = tangle_ahead(view, incoming)
        odd = (
            len(tangle.legs) % 2 == 1
        )  # one line ends on another: that is a junction, which the legs tell better
        if odd:
            self._beside += [leg for leg in tangle.legs[1:] if _runs_back(view, incoming, leg)]
        if (
            not tangle.whole
            or not 2 <= len(tangle.legs) <= MOST_LEGS
            or (odd and plan is not None)
        ):
            return plan, False
        found, way, others = unravelled(
            Sketch.of(view, tangle), incoming, trail, way_in, plan, rank
        )
        if way is not None:
            self._known.append((tangle, way))
        if rank == 0:
            self._left += [(number, k + 1, leg) for k, leg in enumerate(others)]
        return found, way is not None

    def goes_back(self, tip: Array, trail: Trail, width_mm: float) -> bool:
        """Whether the line that ends at a tip is two that ran together a little before, of which the one has
        not been followed.
        """
        near = [leg for leg in self._beside if np.hypot(*(leg.end_mm - tip)) < LONGEST_TIP_MM]
        self._beside = []
        return any(not trail.holds(leg, width_mm) for leg in near)

    def doubts(self, trail: Trail, width_mm: float) -> tuple[tuple[int, int], ...]:
        """Numbers of the junctions where another way out would have done as well and leads to ink that has
        not been followed, and its rank.
        """
        return tuple(
            (number, rank) for number, rank, leg in self._left if not trail.holds(leg, width_mm)
        )

    def _strand_left(
        self, incoming: Leg, trail: Trail, place: Array, width_mm: float
    ) -> tuple[Leg, Array, Leg] | None:
        """The legs and the vertices between them of the strand that a line leads into; None if it leads into
        no tangle that is known.
        """
        for tangle, way in self._known:
            legs = [tangle.legs[0].turned_round(), *tangle.legs[1:]]
            for pair, vertices in zip(way.pairs, way.vertices, strict=True):
                if 0 in pair:
                    continue  # the one that was taken
                for a, b, between in ((*pair, vertices), (*pair[::-1], vertices[::-1])):
                    first = legs[a].turned_round()
                    if same_line(first, incoming, width_mm) and not trail.holds(
                        legs[b], width_mm
                    ):
                        return (
                            first if ahead_mm(place, first) > LEAST_AHEAD_MM else incoming,
                            between,
                            legs[b],
                        )
        return None


def _runs_back(view: View, incoming: Leg, leg: Leg) -> bool:
    """Whether a leg is that of a line, no mark, that runs together with the incoming one, ahead."""
    back = abs(turn(incoming.heading_rad, leg.heading_rad)) > BACK_RAD
    return back and stroke_end(view, leg, longest_mm(view)) is None
