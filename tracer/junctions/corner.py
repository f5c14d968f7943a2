"""TODO."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.tracer.head.course import ahead_mm, along_leg, onto
from morfax.tracer.sensing.leg import Leg, Meeting, turn
from morfax.tracer.sensing.view import View

HIDDEN = 8  # stations at a corner between those that its legs are felt by
SLIGHT = math.radians(40)  # a turn up to this goes straight on at a junction
HIDES = 0.7  # of the width: a pen that turned on the vertex inks half of it on the outside
SHARP = 0.08  # of the line's width: a corner whose ink misses less than this on the outside is sharp


def through_corner(
    view: View,
    stands: tuple[Array, float],
    incoming: Leg,
    outgoing: Leg,
    legs_mm: Meeting,
    end_mm: float,
) -> list[Array]:
    """Stretches from where the head stands (place, heading) through a corner to `end_mm` beyond the outgoing
    leg's first station.
    """
    s, u = legs_mm
    missing, touch = rounding(view, incoming, outgoing, legs_mm)
    bent = touch > 0 and (
        missing > 0.3 * view.width_mm or deflection(incoming, outgoing, legs_mm) < SLIGHT
    )
    if touch > 0 and touch < u + end_mm and touch < s + ahead_mm(stands[0], incoming):
        return [rounded_corner(stands, incoming, outgoing, legs_mm, touch, end_mm)]
    if bent:
        way, along = onto(*stands, incoming, min(s, 0.0))
        start, end = incoming.at(along), outgoing.at(end_mm)
        return [
            np.vstack(
                [
                    way,
                    hermite(
                        start, incoming.heading_at(along), end, outgoing.heading_at(end_mm)
                    ),
                ]
            )
        ]
    return sharp_corner(stands, incoming, outgoing, legs_mm, end_mm)


def rounded_corner(
    stands: tuple[Array, float],
    incoming: Leg,
    outgoing: Leg,
    legs_mm: Meeting,
    touch_mm: float,
    end_mm: float,
) -> Array:
    """The way (n, 2) from where the head stands by the arc that touches both legs so far from their vertex,
    to beyond the outgoing leg's first station.
    """
    s, u = legs_mm
    way, along = onto(*stands, incoming, s - touch_mm)
    a, b = s - touch_mm, -u + touch_mm
    bend = _arc(incoming.at(a), incoming.heading_at(a), outgoing.at(b), outgoing.heading_at(b))
    return np.vstack([way, along_leg(incoming, along, a), bend, along_leg(outgoing, b, end_mm)])


def sharp_corner(
    stands: tuple[Array, float], incoming: Leg, outgoing: Leg, legs_mm: Meeting, end_mm: float
) -> list[Array]:
    """Stretches from where the head stands to the vertex, and from there to `end_mm` beyond the outgoing
    leg's first station.
    """
    s, u = legs_mm
    way, along = onto(*stands, incoming, s)
    vertex = 0.5 * (incoming.at(s) + outgoing.at(-u))
    arriving, leaving = along_leg(incoming, along, s), along_leg(outgoing, -u, end_mm)
    arriving[-1] = leaving[0] = vertex
    return [np.vstack([way, arriving]), leaving]


def rounding(view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> tuple[float, float]:
    """The ink missing on the outside of a corner, mm, and how far from the vertex its round touches the legs
    (0: it is sharp), mm.
    """
    missing = missing_ink_mm(view, incoming, outgoing, legs_mm)
    if missing <= SHARP * view.width_mm:
        return missing, 0.0
    turned = deflection(incoming, outgoing, legs_mm)
    return missing, missing * math.tan(turned / 2) / (1 / math.cos(turned / 2) - 1)


def is_sharp(view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> bool:
    """Whether the ink of an obtuse corner is that of a sharp one: it misses less than a third of what an arc
    over the hidden stations would.
    """
    turned = deflection(incoming, outgoing, legs_mm)
    return (
        missing_ink_mm(view, incoming, outgoing, legs_mm)
        <= HIDDEN * view.step_mm * math.tan(turned / 4) / 3
    )


def missing_ink_mm(view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> float:
    """By how much the ink falls short of a sharp corner's on the outside of the bisector, mm (0 if it does
    not).

    Where another line leaves on the outside of a slight turn, it is by how much the ink is more than a sharp
    corner's on the inside.
    """
    found, width_mm = (
        _edge_mm(view, incoming, outgoing, legs_mm, 1),
        0.5 * (incoming.width_mm + outgoing.width_mm),
    )
    if not hides_outside(view, incoming, outgoing, legs_mm):
        return max(0.0, 0.5 * width_mm - found) if math.isfinite(found) else 0.0
    within, half = (
        _edge_mm(view, incoming, outgoing, legs_mm, -1),
        0.5 * deflection(incoming, outgoing, legs_mm),
    )
    return max(0.0, within - 0.5 * width_mm / math.cos(half)) if math.isfinite(within) else 0.0


def hides_outside(view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> bool:
    """Whether another line leaves on the outside of a slight turn: there is more ink than a corner's, and its
    edges tell nothing of it.
    """
    found = _edge_mm(view, incoming, outgoing, legs_mm, 1)
    return (
        deflection(incoming, outgoing, legs_mm) < SLIGHT
        and not found < HIDES * incoming.width_mm
    )


def deflection(incoming: Leg, outgoing: Leg, legs_mm: Meeting) -> float:
    """By how much the way turns where two legs meet, rad."""
    return abs(turn(incoming.heading_at(legs_mm[0]), outgoing.heading_at(-legs_mm[1])))


def _edge_mm(view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting, side: int) -> float:
    """How far the ink of a corner reaches from the vertex along the bisector, to the outside (1) or the
    inside (-1), mm; NaN if it has no edge there.
    """
    vertex, width_mm = incoming.at(legs_mm[0]), 0.5 * (incoming.width_mm + outgoing.width_mm)
    before, after = incoming.heading_at(legs_mm[0]), outgoing.heading_at(-legs_mm[1])
    out = side * np.array(
        [math.cos(before) - math.cos(after), math.sin(before) - math.sin(after)]
    )
    outward = math.atan2(out[1], out[0])
    reach = 2.0 * width_mm + 3 * view.pitch_mm
    aside = np.array([math.sin(outward), -math.cos(outward)])
    edges_mm = []
    for off in (
        np.linspace(-0.15, 0.15, 5) * width_mm
    ):  # the pen's round leaves the tangent by off²/width
        edge = _edge_outward(view, vertex + off * aside, outward, width_mm, reach)
        edges_mm.append(edge + (off * off / width_mm if side > 0 else 0.0))
    return float(np.median(edges_mm))


def _edge_outward(
    view: View, place: Array, outward: float, width_mm: float, reach_mm: float
) -> float:
    """Where the ink about a place ends outward, mm; NaN if there is none. A light speck in the ink does not
    end it.
    """
    _, edge = view.edges(place, outward - math.pi / 2, reach_mm)
    within_mm = 0.5 * width_mm
    within = place - within_mm * np.array([math.cos(outward), math.sin(outward)])
    beyond = view.ink_along(within, outward, reach_mm) - within_mm
    return float(np.fmax(edge, beyond))


def _arc(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """An arc that leaves along one heading and arrives along another: cubics of at most 30 degrees each."""
    angle = turn(heading, end_heading)
    pieces = max(1, math.ceil(abs(angle) / math.radians(30)))
    radius = float(np.hypot(*(end - start))) / (2 * math.sin(abs(angle) / 2))
    side = math.copysign(1.0, angle)
    centre = start + side * radius * np.array([-math.sin(heading), math.cos(heading)])
    headings = heading + angle * np.arange(pieces + 1) / pieces
    nodes = centre + side * radius * np.column_stack([np.sin(headings), -np.cos(headings)])
    nodes[-1] = end
    return np.vstack(
        [hermite(nodes[i], headings[i], nodes[i + 1], headings[i + 1]) for i in range(pieces)]
    )
