"""Strands: the head's own way through a tangle, as stretches that it can run.

Signals: legs and the vertices between them in; stretches (n, 2) mm out, one ending at each vertex where the
head swivels.

Source: our own (see `pairing`).
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import SPACING_MM, hermite
from morfax.tracer.head.course import ahead_mm, along_leg, onto
from morfax.tracer.head.plan import Plan
from morfax.tracer.sensing.leg import Leg, turn
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.tangle import Tangle

SAME_RAD = math.radians(20)
NEAR_MM = 3.0
KINK_RAD = math.radians(14)  # a smaller change of heading is run through


def stretches_over(
    way_in: tuple[Array, float], incoming: Leg, vertices: Array, outgoing: Leg
) -> list[Array]:
    """Stretches from where the head is over the vertices to the outgoing leg's clean end, one ending at each
    vertex where the head swivels.
    """
    way, along = onto(*way_in, incoming, 0.0)
    start = np.vstack([way, along_leg(incoming, along, 0.0)])
    if not len(vertices):
        return [
            np.vstack(
                [
                    start,
                    hermite(
                        incoming.end_mm,
                        incoming.heading_rad,
                        outgoing.end_mm,
                        outgoing.heading_rad,
                    ),
                ]
            )
        ]
    first = np.vstack([start, _bend(incoming.end_mm, incoming.heading_rad, vertices[0])])
    last = _bend(outgoing.end_mm, outgoing.heading_rad + math.pi, vertices[-1])[::-1]
    out = [first]
    for part in [*(_straight(a, b) for a, b in pairwise(vertices)), last]:
        before, after = out[-1][-1] - out[-1][-2], part[1] - part[0]
        if (
            abs(turn(math.atan2(before[1], before[0]), math.atan2(after[1], after[0])))
            > KINK_RAD
        ):
            out.append(part)
        else:
            out[-1] = np.vstack([out[-1], part[1:]])
    return out


def as_drawn(plan: Plan, tangle: Tangle, width_mm: float) -> list[Array]:
    """What a plan draws: its stretches, what was felt of its leg, and on to that leg's clean end in the
    tangle.
    """
    way = [*plan.stretches[:-1], np.vstack([plan.stretches[-1], plan.leg.seen[:, :2]])]
    for leg in tangle.legs[1:]:
        if same_line(plan.leg, leg, width_mm):
            way[-1] = np.vstack([way[-1], leg.end_mm])
    return way


def same_line(leg: Leg, other: Leg, width_mm: float) -> bool:
    """Whether two legs lie on the same line, near each other."""
    along = ahead_mm(leg.end_mm, other) * math.cos(turn(leg.heading_rad, other.heading_rad))
    gap = other.end_mm - leg.at(along)
    turned = abs(turn(leg.heading_at(along), other.heading_rad))
    return (
        turned < SAME_RAD
        and float(np.hypot(*gap)) < 0.5 * width_mm
        and abs(along) < max(4 * width_mm, NEAR_MM)
    )


def aside_mm(vertices: Array, stretches: list[Array]) -> float:
    """How far vertices reach from some stretches, mm."""
    places = np.vstack(stretches)
    return max(
        (float(np.min(np.hypot(*(places - vertex).T))) for vertex in vertices), default=0.0
    )


def _bend(place: Array, heading: float, vertex: Array) -> Array:
    """Places (n, 2) along the bend from a leg's end to a vertex."""
    shares = np.linspace(
        0, 1, max(2, math.ceil(float(np.hypot(*(vertex - place))) / SPACING_MM) + 1)
    )
    return np.array(
        [pen.bend(place[0], place[1], heading, vertex[0], vertex[1], t) for t in shares]
    )


def _straight(start: Array, end: Array) -> Array:
    """Places (n, 2) along a straight line."""
    return np.linspace(
        start, end, max(2, math.ceil(float(np.hypot(*(end - start))) / SPACING_MM) + 1)
    )
