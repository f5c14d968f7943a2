"""Edge following: how the head gets past ink that runs beside its line for longer than a junction.

Two lines that come closer than a width run together: the edge between them is gone, but each line's outer
edge is as clean as before, and the line's middle is half a width within it. So the line is felt on along that
edge.

            ____________________ left edge: clean        After a while the other edge comes back: the line
             . . . . . . . . . .   the line              goes on. Or the ink ends in a tip: there the line
            ____      ___________                        turned back, and came along the other outer edge,
                 \\__/  another line, or the same,        half a width within that.
                       coming back

Signals: a place on the line and a heading in; stations of the line out, and where it turned back.

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.median import median
from morfax.motion.plane import heading_of, left_of, unit
from morfax.tracer.junctions.corner import Corner, hides_outside, rounding
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, LONGER_WIDTHS
from morfax.tracer.sensing.leg import FEWEST_STATIONS, TURNS_BACK, Leg, leg_of, turn
from morfax.tracer.sensing.photocell import darkness_at
from morfax.tracer.sensing.ray import Ray, end_of_ink
from morfax.tracer.sensing.scout import CLEAN, onward
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings.
FARTHEST_MM = 40.0
WELL_WITHIN = 10  # stations from a leg's clean end: both edges are clean there
CHORD = 5  # stations that a heading is taken over
REGAINED_MM = 1.5  # after this much of both edges the line is by itself again
JUMP = 0.25  # of the width, from station to station: the far edge is no longer the same
WIDE = 0.62  # of the width, from the middle to the far edge: ink beside the line
FEWEST_BACK = 6  # stations that make a way to a tip, or back from it

# of the way clear of a vertex: a line that passes is seen there
PASSED = np.array([0.4, 0.6, 0.8, 1.0])
CLEAR_ACROSS, LEAST_SINE = 1.2, 0.1  # that way: beyond the other leg's ink
CENTRED = 0.8  # of the width: by so much a line that passes may be off the leg's line
BEFORE, BEYOND = 0.5, 1.0  # widths that a vertex may move towards the legs, and away from them

NEAR_EDGE = 0.2  # of the width from the middle: the edge that is followed is further out
OFF, OFF_PX = 1 / 6, 0.2  # of the width, and pixels: farther off its place the edge is lost


class Walk(NamedTuple):
    """How a line is felt along its edge: the step, and the most stations.

    So many stations that show both edges end the walk (`regained`).
    """

    step_mm: float
    stations: int
    regained: int


@dataclass(frozen=True, slots=True)
class EdgeRun:
    """Stations of a line felt along one edge, (n, 3) centre and width.

    `back` are those of the way back if it turned at a tip.
    """

    seen: Array
    back: Array | None


def follow_edge(view: View, incoming: Leg) -> EdgeRun | None:
    """Feel on from a leg's clean end along one of its edges; None if neither leads past the ink beside it."""
    runs = [_run_on(view, incoming, side) for side in (-1.0, 1.0)]
    found = [run for run in runs if run is not None]
    return max(found, key=lambda run: len(run.seen)) if found else None


def to_vertex(view: View, corner: Corner) -> Corner:
    """The corner with its legs felt on along their outer edges, which stay clean up to the vertex.

    A corner that is rounded is felt up to where its round begins. A leg that meets a line which passes here
    has no outer edge, and that line's may be spoiled by an end of the other's drawn beyond it; nor has a turn
    on whose outside another line leaves.
    """
    if hides_outside(view, corner):
        return corner
    # 1. a line that passes
    turned, incoming, outgoing = corner.turned_rad, corner.incoming, corner.outgoing
    back = outgoing.turned_round()
    if _passes(view, back, corner.before_mm, turned) or _passes(
        view, incoming, corner.beyond_mm, turned
    ):
        return _within_ink(view, corner)
    # 2. the legs by their outer edges
    side = -math.copysign(1.0, turned)
    round_mm = rounding(view, corner)[1]
    arriving = _along_outside(view, incoming.seen[::-1], side, corner.beyond_mm - round_mm)
    leaving = _along_outside(view, outgoing.seen, -side, corner.before_mm - round_mm)
    into = incoming if arriving is None else leg_of(arriving[0][::-1], True, arriving[1])
    out = outgoing if leaving is None else leg_of(leaving[0], False, leaving[1])
    # 3. where they meet then, if that is about the same place
    found, width_mm = Corner.of(into, out), view.width_mm
    if (
        found is None
        or found.nearest_mm < -BEFORE * width_mm
        or found.farthest_mm > corner.farthest_mm + BEYOND * width_mm
    ):
        found = corner
    return _within_ink(view, found)


def _passes(view: View, leg: Leg, vertex_mm: float, turned: float) -> bool:
    """Whether a line goes on along a leg's line beyond a vertex, clear of the other leg's ink."""
    clear_mm = view.width_mm * max(
        CLEAR_WIDTHS, CLEAR_ACROSS / max(abs(math.sin(turned)), LEAST_SINE)
    )
    if clear_mm > LONGER_WIDTHS * view.width_mm:
        return False
    if not all(view.dark(place) for place in leg.at(vertex_mm + clear_mm * PASSED)):
        return False
    place = leg.at(vertex_mm + clear_mm)
    heading = leg.heading_at(vertex_mm + clear_mm)
    right, left = view.edges(place, heading, 2 * view.width_mm)
    like = abs(left - right - leg.width_mm) < CLEAN * leg.width_mm
    return like and abs(left + right) < CENTRED * leg.width_mm


def _within_ink(view: View, corner: Corner) -> Corner:
    """A sharp tip with its vertex no further than where the pen turned.

    Lines that are nearly parallel meet anywhere.
    """
    arriving = corner.incoming
    if abs(turn(arriving.heading_rad, corner.outgoing.heading_rad)) < TURNS_BACK:
        return corner
    reach_mm = max(0.0, corner.beyond_mm) + 2 * view.width_mm
    ink_mm = view.ink_along(arriving.end_mm, arriving.heading_rad, reach_mm)
    if not math.isfinite(ink_mm):
        return corner
    too_far = max(0.0, corner.beyond_mm - (ink_mm - 0.5 * arriving.width_mm))
    return replace(
        corner, beyond_mm=corner.beyond_mm - too_far, before_mm=corner.before_mm - too_far
    )


def _along_outside(
    view: View, seen: Array, side: float, beyond_mm: float
) -> tuple[Array, float] | None:
    """Stations (n, 3) of a leg felt along one edge to `beyond_mm` past its clean end, and its length, mm.

    It is felt from well within the leg, where the junction's ink has not yet reached the other edge. Stations
    are in order from the junction outwards; the side is that of somebody who goes towards the junction. None
    if there is nothing to feel.
    """
    base = min(WELL_WITHIN, len(seen) // 2)
    way = seen[base, :2] - seen[min(base + CHORD, len(seen) - 1), :2]
    length_mm = float(np.hypot(*(seen[base, :2] - seen[0, :2]).T)) + beyond_mm
    count = math.floor(length_mm / view.step_mm) + 1
    if count < FEWEST_STATIONS or base < 2:
        return None
    width = median(seen[base:, 2])
    pose = float(seen[base, 0]), float(seen[base, 1]), heading_of(way)
    felt = _along_edge(view.cells, pose, side, width, Walk(view.step_mm, count, count))
    if len(felt) < FEWEST_STATIONS:
        return None
    outside = np.column_stack([felt[:, :2], np.full(len(felt), width)])[:0:-1]
    return np.vstack([outside, seen[base:]]), view.leg_mm + length_mm


def _run_on(view: View, incoming: Leg, side: float) -> EdgeRun | None:
    """Feel on along the edge on one side (1 left, -1 right)."""
    # 1. stations along the edge, but for the last two, which may stand on the round of a tip
    step, width = view.step_mm, incoming.width_mm
    walk = Walk(step, round(FARTHEST_MM / step), round(REGAINED_MM / step))
    x, y = incoming.end_mm
    pose = float(x), float(y), float(incoming.heading_rad)
    felt = _along_edge(view.cells, pose, side, width, walk)
    stations = felt[:-2]
    # 2. where ink is beside them
    wide = np.flatnonzero(~(stations[:, 2] < WIDE * width))
    if not len(wide) or (wide[-1] - wide[0]) * step < LONGER_WIDTHS * width:
        return None
    # 3. past that ink, or back from the tip where it ends
    seen = np.column_stack([stations[:, :2], np.full(len(stations), width)])
    if len(felt) - wide[-1] > walk.regained:
        return EdgeRun(seen, None)
    excess = stations[:, 2] - 0.5 * width
    turned = _turned_back(excess, seen, (int(wide[0]), int(wide[-1])), side)
    return turned if turned is not None and _ends_ahead(view, turned.seen, width) else None


def _ends_ahead(view: View, seen: Array, width_mm: float) -> bool:
    """Whether the ink ends within a width ahead of the last of some stations."""
    way = seen[-1, :2] - seen[max(0, len(seen) - 1 - CHORD), :2]
    t = unit(way)
    ray = Ray(seen[-1, 0], seen[-1, 1], t[0], t[1])
    return math.isfinite(end_of_ink(view.cells, ray, 0.0, width_mm))


def _turned_back(
    excess: Array, seen: Array, wide: tuple[int, int], side: float
) -> EdgeRun | None:
    """The run to the tip where the ink beside the line ends, and the way back along the far edge.

    `excess` is how much farther than half a width the far edge is from each station, mm; `wide` are the first
    and the last station with ink beside them.
    """
    (first, last), width_mm = wide, float(seen[0, 2])
    if excess[-1] > JUMP * width_mm:
        return None
    # 1. the tip
    at_tip = np.flatnonzero(excess[last:] <= 0)
    tip = last + int(at_tip[0]) if len(at_tip) else len(seen) - 1
    measured = _from_tip(excess, first, tip, JUMP * width_mm)
    if len(measured) < FEWEST_BACK or tip < FEWEST_BACK:
        return None
    is_beside = excess[measured[-1]] >= (WIDE - 0.5) * width_mm
    if not is_beside:  # the way back would be the way there: this is a corner
        return None
    # 2. the way back, half a width within the far edge
    back = np.empty((len(measured), 3))
    for k, i in enumerate(measured):
        a = seen[max(0, i - 3), :2]
        b = seen[min(len(seen) - 1, i + 3), :2]
        t = unit(b - a)
        across = side * left_of(t)
        back[k, :2] = seen[i, :2] - max(excess[i], 0.0) * across
        back[k, 2] = width_mm
    return EdgeRun(seen[: tip + 1], back)


def _from_tip(excess: Array, first: int, tip: int, jump_mm: float) -> list[int]:
    """The stations from a tip back to the first at which the far edge was met.

    They end where that edge jumps: there it is another line's.
    """
    measured = [i for i in range(tip, first - 1, -1) if math.isfinite(excess[i])]
    for k, (i, j) in enumerate(pairwise(measured)):
        if abs(excess[i] - excess[j]) > jump_mm:
            return measured[: k + 1]
    return measured


@njit(cache=True)
def _along_edge(cells, pose, side, width_mm, walk):  # type: ignore[no-untyped-def]
    """Stations (n, 3) from a pose (x mm, y mm, heading rad) on: the middle, half a width within the edge on
    one side, and the distance to the first light on the other (NaN beyond `ABOUT_WIDTHS`).

    It stops where that edge or the ink under the middle is lost, or when the line has been by itself for
    `regained` stations after ink beside it.
    """
    out = np.empty((walk.stations, 3))
    x, y, heading = pose
    alone, been_wide = 0, False
    near = NEAR_EDGE * width_mm
    across = ABOUT_WIDTHS * width_mm
    for n in range(walk.stations):
        # 1. the edge, and the middle half a width within it
        if darkness_at(cells, x, y) < cells.level:
            return out[:n].copy()
        nx = -side * math.sin(heading)
        ny = side * math.cos(heading)
        aside = end_of_ink(cells, Ray(x, y, nx, ny, 0.0), near, across) - 0.5 * width_mm
        if not abs(aside) < OFF * width_mm + OFF_PX * cells.pitch_mm:
            return out[:n].copy()
        x += aside * nx
        y += aside * ny
        out[n, 0], out[n, 1] = x, y
        # 2. the other edge
        out[n, 2] = end_of_ink(cells, Ray(x, y, -nx, -ny, 0.0), 0.0, across)
        wide = not out[n, 2] < WIDE * width_mm
        been_wide = been_wide or wide
        alone = 0 if wide else alone + 1
        if alone > (walk.regained if been_wide else 2 * walk.regained):
            return out[: n + 1].copy()
        # 3. a step on
        if n >= 2:
            heading = onward(out, n + 1)
        x += walk.step_mm * math.cos(heading)
        y += walk.step_mm * math.sin(heading)
    return out
