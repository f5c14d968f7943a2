"""Riding on an edge: how the head gets past ink that runs beside its line for longer than a knot.

Two lines that come closer than a width run together: the edge between them is gone, but each line's outer
edge is as clean as before, and the line's middle is half a width within it. So the line is felt on along that
edge.

            ____________________ left edge: clean                    After a while the other edge comes back: the line goes on.
             . . . . . . . . . .   the line, half a width within     Or the ink ends in a tip: there the line turned back, and came
            ____      ___________                                     along the other outer edge, half a width within that.
                 \\__/  another line, or the same on its way back

Signals: a place on the line and a heading in; stations of the line out, and where it turned back.

Source: our own (see `knot`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numba import njit

from morfax.motion.arrays import Array
from morfax.tracer.junctions.corner import hides_outside, rounding
from morfax.tracer.sensing.leg import Leg, Meeting, leg_of, meet, turn
from morfax.tracer.sensing.photocell import darkness_at
from morfax.tracer.sensing.ray import Ray, end_of_ink
from morfax.tracer.sensing.scout import onward
from morfax.tracer.sensing.view import View

FARTHEST_MM = 40.0
WELL_WITHIN = 10  # stations from a leg's clean end: both edges are clean there
TIP = math.radians(150)  # a corner that turns by more is a tip
REGAINED_MM = 1.5  # this much of both edges, and the line is by itself again
BESIDE = 4.0  # widths; ink that is beside the line for less is a corner or a crossing
JUMP = 0.25  # of the width, from station to station: the far edge is no longer the same
PASSED = np.array(
    [0.4, 0.6, 0.8, 1.0]
)  # places beyond a vertex at which a line that passes is seen
WIDE = 0.62  # of the width, from the middle to the far edge: ink beside the line


class Walk(NamedTuple):
    """How a line is felt along its edge: the step, how many stations at most, and how many that show both
    edges end the walk."""

    step_mm: float
    stations: int
    regained: int


@dataclass(frozen=True, slots=True)
class Ride:
    """Stations of a line felt along one edge, (n, 3) centre and width; `back` are those of the way back if it
    turned at a tip.
    """

    seen: Array
    back: Array | None


def ride_past(view: View, incoming: Leg) -> Ride | None:
    """Feel on from a leg's clean end along one of its edges; None if neither edge leads past the ink beside
    the line.
    """
    rides = [_ride(view, incoming, side) for side in (-1.0, 1.0)]
    found = [r for r in rides if r is not None]
    return max(found, key=lambda r: len(r.seen)) if found else None


def to_vertex(
    view: View, incoming: Leg, outgoing: Leg, legs_mm: Meeting
) -> tuple[Leg, Leg, Meeting]:
    """The legs of a corner felt on along their outer edges, which stay clean up to the vertex, and where they
    meet then.

    A corner that is rounded is felt up to where its round begins. A leg that meets a line which passes here
    has no outer edge, and that line's may be spoiled by an end of the other's drawn beyond it; nor has a turn
    on whose outside another line leaves.
    """
    if hides_outside(view, incoming, outgoing, legs_mm):
        return incoming, outgoing, legs_mm
    deflection = turn(incoming.heading_at(legs_mm[0]), outgoing.heading_at(-legs_mm[1]))
    side = -math.copysign(1.0, deflection)
    if _passes(view, outgoing.turned_round(), legs_mm[1], deflection) or _passes(
        view, incoming, legs_mm[0], deflection
    ):
        return incoming, outgoing, _within_ink(view, incoming, outgoing, legs_mm)
    round_mm = rounding(view, incoming, outgoing, legs_mm)[1]
    arriving = (
        _along_outside(view, incoming.seen[::-1], side, legs_mm[0] - round_mm, True) or incoming
    )
    leaving = (
        _along_outside(view, outgoing.seen, -side, legs_mm[1] - round_mm, False) or outgoing
    )
    met = meet(arriving, leaving)
    if (
        met is None
        or min(met) < -0.5 * view.width_mm
        or max(met) > max(legs_mm) + view.width_mm
    ):
        arriving, leaving, met = incoming, outgoing, legs_mm
    return arriving, leaving, _within_ink(view, arriving, leaving, met)


def _passes(view: View, leg: Leg, vertex_mm: float, deflection: float) -> bool:
    """Whether a line goes on along a leg's line beyond the vertex of a corner, to where the other leg's ink
    does not reach.
    """
    clear_mm = view.width_mm * max(1.5, 1.2 / max(abs(math.sin(deflection)), 0.1))
    if clear_mm > 4 * view.width_mm or not all(
        view.dark(place) for place in leg.at(vertex_mm + clear_mm * PASSED)
    ):
        return False
    place, heading = leg.at(vertex_mm + clear_mm), leg.heading_at(vertex_mm + clear_mm)
    right, left = view.edges(place, heading, 2 * view.width_mm)
    return (
        abs(left - right - leg.width_mm) < 0.2 * leg.width_mm
        and abs(left + right) < 0.8 * leg.width_mm
    )


def _within_ink(view: View, arriving: Leg, leaving: Leg, met: Meeting) -> Meeting:
    """Where the legs of a sharp tip meet, but not beyond where the pen turned: lines that are nearly parallel
    meet anywhere.
    """
    if abs(turn(arriving.heading_rad, leaving.heading_rad)) < TIP:
        return met
    reach_mm = max(0.0, met[0]) + 2 * view.width_mm
    ink_mm = view.ink_along(arriving.end_mm, arriving.heading_rad, reach_mm)
    beyond = (
        max(0.0, met[0] - (ink_mm - 0.5 * arriving.width_mm)) if math.isfinite(ink_mm) else 0.0
    )
    return met[0] - beyond, met[1] - beyond


def _along_outside(
    view: View, seen: Array, side: float, beyond_mm: float, last: bool
) -> Leg | None:
    """A leg felt along one edge to `beyond_mm` past its clean end: from well within it, where the knot's ink
    has not yet reached the other edge.

    `seen` is in order from the knot outwards, the side is that of somebody who goes towards the knot; the
    leg's clean end is the `last` in travel, or the first. None if there is nothing to feel.
    """
    base = min(WELL_WITHIN, len(seen) // 2)
    way = seen[base, :2] - seen[min(base + 5, len(seen) - 1), :2]
    length_mm = float(np.hypot(*(seen[base, :2] - seen[0, :2]).T)) + beyond_mm
    count = math.floor(length_mm / view.step_mm) + 1
    if count < 4 or base < 2:
        return None
    width = float(np.median(seen[base:, 2]))
    pose = float(seen[base, 0]), float(seen[base, 1]), math.atan2(way[1], way[0])
    felt = _along_edge(view.cells, pose, side, width, Walk(view.step_mm, count, count))
    if len(felt) < 4:
        return None
    outside = np.column_stack([felt[:, :2], np.full(len(felt), width)])[:0:-1]
    both = np.vstack([outside, seen[base:]])
    return leg_of(both[::-1] if last else both, last, view.leg_mm + length_mm)


def _ride(view: View, incoming: Leg, side: float) -> Ride | None:
    """Feel on along the edge on one side (1 left, -1 right)."""
    step, width = view.step_mm, incoming.width_mm
    regained = max(6, round(REGAINED_MM / step))
    x, y = incoming.end_mm
    pose = float(x), float(y), float(incoming.heading_rad)
    walk = Walk(step, round(FARTHEST_MM / step), regained)
    stations = _along_edge(view.cells, pose, side, width, walk)
    stations = stations[:-2]  # the last stand on the round of a tip, if there is one
    wide = np.flatnonzero(~(stations[:, 2] < WIDE * width))
    if not len(wide) or (wide[-1] - wide[0]) * step < BESIDE * width:
        return None
    seen = np.column_stack([stations[:, :2], np.full(len(stations), width)])
    if len(stations) + 2 - wide[-1] > regained:  # the two that were left out count
        return Ride(seen, None)
    turned = _turned_back(stations, seen, int(wide[0]), int(wide[-1]), side, width)
    return turned if turned is not None and _ends_ahead(view, turned.seen, width) else None


def _ends_ahead(view: View, seen: Array, width_mm: float) -> bool:
    """Whether the ink ends within a width ahead of the last of some stations."""
    way = seen[-1, :2] - seen[max(0, len(seen) - 6), :2]
    t = way / np.hypot(*way)
    ray = Ray(seen[-1, 0], seen[-1, 1], t[0], t[1])
    return math.isfinite(end_of_ink(view.cells, ray, 0.0, width_mm))


def _turned_back(
    stations: Array, seen: Array, first: int, last: int, side: float, width_mm: float
) -> Ride | None:
    """The ride to the tip where the ink beside the line ends with it, and the way back along the far edge."""
    excess = stations[:, 2] - 0.5 * width_mm
    if excess[-1] > 0.25 * width_mm:
        return None
    at_tip = np.flatnonzero(excess[last:] <= 0)
    tip = last + int(at_tip[0]) if len(at_tip) else len(stations) - 1
    measured = _from_tip(excess, first, tip, JUMP * width_mm)
    if len(measured) < 6 or tip < 6:
        return None
    back = np.empty((len(measured), 3))
    for k, i in enumerate(measured):
        a, b = seen[max(0, i - 3), :2], seen[min(len(seen) - 1, i + 3), :2]
        t = (b - a) / np.hypot(*(b - a))
        back[k, :2] = seen[i, :2] - side * max(excess[i], 0.0) * np.array([-t[1], t[0]])
        back[k, 2] = width_mm
    return Ride(seen[: tip + 1], back)


def _from_tip(excess: Array, first: int, tip: int, jump_mm: float) -> list[int]:
    """The stations from a tip back to the first at which the far edge was met, up to where it jumps: there it
    is another line's.
    """
    measured = [i for i in range(tip, first - 1, -1) if math.isfinite(excess[i])]
    jumps = [
        k + 1
        for k, (i, j) in enumerate(pairwise(measured))
        if abs(excess[i] - excess[j]) > jump_mm
    ]
    return measured[: jumps[0]] if jumps else measured


@njit(cache=True)
def _along_edge(cells, pose, side, width_mm, walk):  # type: ignore[no-untyped-def]
    """Stations (n, 3) from a pose (x mm, y mm, heading rad) on: middle half a width within the edge on one
    side, and distance to the first light on the other (NaN beyond three widths).

    It stops where that edge or the ink under the middle is lost, or when the line has been by itself for
    `regained` stations after ink beside it.
    """
    out = np.empty((walk.stations, 3))
    x, y, heading = pose
    alone, been_wide = 0, False
    for n in range(walk.stations):
        nx, ny = -side * math.sin(heading), side * math.cos(heading)
        if darkness_at(cells, x, y) < cells.level:
            return out[:n].copy()
        towards = Ray(x, y, nx, ny, 0.0)
        aside = end_of_ink(cells, towards, 0.2 * width_mm, 0.85 * width_mm) - 0.5 * width_mm
        if not abs(aside) < width_mm / 6 + 0.2 * cells.pitch_mm:
            return out[:n].copy()
        x, y = x + aside * nx, y + aside * ny
        out[n, 0], out[n, 1] = x, y
        out[n, 2] = end_of_ink(cells, Ray(x, y, -nx, -ny, 0.0), 0.0, 3.0 * width_mm)
        wide = not out[n, 2] < WIDE * width_mm
        been_wide = been_wide or wide
        alone = 0 if wide else alone + 1
        if (been_wide and alone > walk.regained) or (
            not been_wide and alone > 2 * walk.regained
        ):
            return out[: n + 1].copy()
        if n >= 2:
            heading = onward(out, n + 1)
        x, y = x + walk.step_mm * math.cos(heading), y + walk.step_mm * math.sin(heading)
    return out
