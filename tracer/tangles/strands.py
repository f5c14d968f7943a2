"""Strands: the head's own way through a tangle, as stretches that it can run.

Signals: legs and the vertices between them in; stretches (n, 2) mm out, one ending at each vertex where the
head swivels.

Source: our own (see `sketch`).
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.motion.polyline import APART_MM
from morfax.tracer.head.course import SMOOTH, ahead_mm, along_leg, onto
from morfax.tracer.head.plan import Plan
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.sensing.leg import TURNS_OFF, Leg, turn
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.tangle import Tangle

# Chosen by trial on the test drawings: two legs are on one line if they are
ASIDE = 0.5  # of the width: no further off each other's line
NEAR_MM = 3.0  # no further apart along it


def stretches_over(
    stands: tuple[Array, float], incoming: Leg, vertices: Array, outgoing: Leg
) -> list[Array]:
    """Stretches from where the head is over the vertices to the outgoing leg's clean end.

    One ends at each vertex where the head swivels.
    """
    way, along = onto(*stands, incoming, 0.0)
    start = np.vstack([way, along_leg(incoming, along, 0.0)])
    into, out_of = (
        (incoming.end_mm, incoming.heading_rad),
        (outgoing.end_mm, outgoing.heading_rad),
    )
    # 1. without a vertex, a cubic
    if not len(vertices):
        return [np.vstack([start, hermite(*into, *out_of)])]
    # 2. a bend to the first vertex, straight lines, and a bend from the last
    first = np.vstack([start, _bend(*into, vertices[0])])
    last = _bend(outgoing.end_mm, outgoing.heading_rad + math.pi, vertices[-1])[::-1]
    out = [first]
    for part in [*(_straight(a, b) for a, b in pairwise(vertices)), last]:
        if _turned(out[-1], part) > SMOOTH:
            out.append(part)
        else:
            out[-1] = np.vstack([out[-1], part[1:]])
    return out


def _turned(before: Array, after: Array) -> float:
    """By how much a way turns from one part to the next, rad."""
    arriving, leaving = before[-1] - before[-2], after[1] - after[0]
    arriving_rad = math.atan2(arriving[1], arriving[0])
    leaving_rad = math.atan2(leaving[1], leaving[0])
    return abs(turn(arriving_rad, leaving_rad))


def as_drawn(plan: Plan, tangle: Tangle, width_mm: float) -> list[Array]:
    """What a plan draws: its stretches, what was felt of its leg, and on to that leg's end in the tangle."""
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
    near = abs(along) < max(LONGER_WIDTHS * width_mm, NEAR_MM)
    return turned < TURNS_OFF and near and float(np.hypot(*gap)) < ASIDE * width_mm


def aside_mm(vertices: Array, stretches: list[Array]) -> float:
    """How far vertices reach from some stretches, mm."""
    places = np.vstack(stretches)
    away = [float(np.min(np.hypot(*(places - vertex).T))) for vertex in vertices]
    return max(away, default=0.0)


def _bend(place: Array, heading: float, vertex: Array) -> Array:
    """Places (n, 2) along the bend from a leg's end to a vertex."""
    pose = np.array([place[0], place[1], heading])
    shares = np.linspace(0, 1, _count(place, vertex))
    places = np.empty((len(shares), 2))
    pen.bend_at(pose, vertex[0], vertex[1], shares, places)
    return places


def _straight(start: Array, end: Array) -> Array:
    """Places (n, 2) along a straight line."""
    return np.linspace(start, end, _count(start, end))


def _count(start: Array, end: Array) -> int:
    """How many places there are between two."""
    return max(2, math.ceil(float(np.hypot(*(end - start))) / APART_MM) + 1)
