"""Corners: two legs that meet, how sharp their ink is there, and the stretches that lead through.

A pen of width w that turns on the vertex inks w/2 beyond it on the bisector. What is missing there is by how
much a rounded line passes the vertex; an arc that touches both legs passes it by as much.

    ____________ . vertex        missing = r · (1/cos(d/2) - 1)        d: by how much the way turns
    __________  `\\ .            touch   = r · tan(d/2)                r: radius of the arc
              `\\  \\            so touch follows from missing

Signals: the view, the legs and where they meet in; stretches (n, 2) mm out.

Source: our own, from first principles (see `course`). Other rooms find corners too: `rings.corner_in` in what
was felt of a line, before there are legs; `program.passes.braking` and `motion.segments` in a finished path.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.arrays import median as median_of
from morfax.motion.compiled import njit
from morfax.motion.curves import hermite
from morfax.motion.plane import direction, left_of
from morfax.tracer.head.course import SMOOTH, ahead_mm, along_leg, onto, through_nodes
from morfax.tracer.sensing.leg import STRAIGHT, Leg, meet, turn
from morfax.tracer.sensing.ray import edge_along, edges
from morfax.tracer.sensing.view import View

HIDDEN = 8  # stations at a corner between those that its legs are felt by
HIDES = 0.7  # of the width: a pen that turned on the vertex inks half of it on the outside
SHARP = 0.08  # of the line's width: a corner that misses less ink on the outside is sharp
ACROSS = 0.15  # of the width: the edge is found on rays so far to either side of the bisector
RAYS = 5  # of which the median counts
REACH_WIDTHS, REACH_PX = 2.0, 3  # how far from the vertex the edge is sought
PIECE_RAD = math.radians(30)  # a cubic is an arc within 0.6 um per mm of its radius over this


@dataclass(frozen=True, slots=True)
class Corner:
    """Two legs, and where they meet: beyond the incoming leg's end, and before the outgoing leg's, mm."""

    incoming: Leg
    outgoing: Leg
    beyond_mm: float
    before_mm: float

    @classmethod
    def of(cls, incoming: Leg, outgoing: Leg) -> Corner | None:
        """The corner of two legs; None if they do not meet."""
        met = meet(incoming, outgoing)
        return None if met is None else cls(incoming, outgoing, *met)

    @property
    def vertex_mm(self) -> Array:
        """The vertex, on the incoming leg's line."""
        return self.incoming.at(self.beyond_mm)

    @property
    def width_mm(self) -> float:
        """Mean width of the legs."""
        return 0.5 * (self.incoming.width_mm + self.outgoing.width_mm)

    @property
    def nearest_mm(self) -> float:
        """How far the vertex is from the nearer of the clean ends; negative behind it."""
        return min(self.beyond_mm, self.before_mm)

    @property
    def farthest_mm(self) -> float:
        """How far the vertex is from the farther of the clean ends."""
        return max(self.beyond_mm, self.before_mm)

    def headings_rad(self) -> tuple[float, float]:
        """Headings into the vertex and out of it."""
        arriving = self.incoming.heading_at(self.beyond_mm)
        return arriving, self.outgoing.heading_at(-self.before_mm)

    @property
    def turned_rad(self) -> float:
        """The angle by which the way turns at the vertex, left positive."""
        return turn(*self.headings_rad())

    @property
    def deflection_rad(self) -> float:
        """By how much the way turns at the vertex."""
        return abs(self.turned_rad)


def through_corner(
    view: View, stands: tuple[Array, float], corner: Corner, end_mm: float
) -> list[Array]:
    """Stretches from where the head stands (place, heading) through a corner.

    They end `end_mm` beyond the outgoing leg's clean end.
    """
    incoming, outgoing = corner.incoming, corner.outgoing
    missing, touch = rounding(view, corner)
    # 1. an arc, where there is room for it
    room_mm = corner.beyond_mm + ahead_mm(stands[0], incoming)
    if 0 < touch < min(corner.before_mm + end_mm, room_mm):
        return [rounded_corner(stands, corner, touch, end_mm)]
    # 2. one bend from leg to leg, where it misses the vertex as the ink does, and more nearly than by nothing
    if touch > 0:
        way, along = onto(*stands, incoming, min(corner.beyond_mm, 0.0))
        start = incoming.at(along), incoming.heading_at(along)
        end = outgoing.at(end_mm), outgoing.heading_at(end_mm)
        bend = _bend(start, end, corner, missing)
        passes_mm = float(np.hypot(*(bend - corner.vertex_mm).T).min())
        if abs(passes_mm - missing) < missing:
            return [np.vstack([way, bend])]
    # 3. the vertex
    return sharp_corner(stands, corner, end_mm)


def _bend(
    start: tuple[Array, float], end: tuple[Array, float], corner: Corner, missing_mm: float
) -> Array:
    """A bend (n, 2) from one place and heading to another, as far inside of the vertex as ink is missing.

    It is one cubic where that place no longer lies within the turn.
    """
    heading = corner.headings_rad()[0] + 0.5 * corner.turned_rad
    inward = math.copysign(1.0, corner.turned_rad) * left_of(direction(heading))
    middle = corner.vertex_mm + missing_mm * inward
    if max((middle - start[0]) @ inward, (middle - end[0]) @ inward) < 0:
        return through_nodes([start, (middle, heading), end])
    return hermite(*start, *end)


def rounded_corner(
    stands: tuple[Array, float], corner: Corner, touch_mm: float, end_mm: float
) -> Array:
    """The way (n, 2) by the arc that touches both legs so far from their vertex (see `through_corner`)."""
    incoming, outgoing = corner.incoming, corner.outgoing
    a = corner.beyond_mm - touch_mm
    b = -corner.before_mm + touch_mm
    way, along = onto(*stands, incoming, a)
    bend = _arc(incoming.at(a), incoming.heading_at(a), outgoing.at(b), outgoing.heading_at(b))
    return np.vstack([way, along_leg(incoming, along, a), bend, along_leg(outgoing, b, end_mm)])


def sharp_corner(stands: tuple[Array, float], corner: Corner, end_mm: float) -> list[Array]:
    """Two stretches, to the vertex and from there (see `through_corner`)."""
    incoming, outgoing = corner.incoming, corner.outgoing
    way, along = onto(*stands, incoming, corner.beyond_mm)
    arriving = along_leg(incoming, along, corner.beyond_mm)
    leaving = along_leg(outgoing, -corner.before_mm, end_mm)
    vertex = 0.5 * (corner.vertex_mm + outgoing.at(-corner.before_mm))
    arriving[-1] = leaving[0] = vertex
    return [np.vstack([way, arriving]), leaving]


def rounding(view: View, corner: Corner) -> tuple[float, float]:
    """The ink missing on the outside of a corner, and how far from the vertex its round touches the legs, mm.

    The second is 0 for a sharp corner.
    """
    missing = missing_ink_mm(view, corner)
    if missing <= SHARP * view.width_mm:
        return missing, 0.0
    half = corner.deflection_rad / 2
    return missing, missing * math.tan(half) / (1 / math.cos(half) - 1)


def is_sharp(view: View, corner: Corner) -> bool:
    """Whether the ink of an obtuse corner is that of a sharp one.

    It misses less than a third of what an arc over the hidden stations would.
    """
    by_arc_mm = HIDDEN * view.step_mm * math.tan(corner.deflection_rad / 4)
    return missing_ink_mm(view, corner) <= by_arc_mm / 3


def bends_on(view: View, corner: Corner) -> bool:
    """Whether two legs meet at no greater angle than one of them makes by bending on.

    It bends on over the stations that are hidden between the legs.
    """
    bend = max(abs(corner.incoming.bend_per_mm), abs(corner.outgoing.bend_per_mm))
    return corner.deflection_rad < SMOOTH + bend * HIDDEN * view.step_mm


def missing_ink_mm(view: View, corner: Corner) -> float:
    """By how much the ink falls short of a sharp corner's on the outside of the bisector, mm; or 0.

    Where another line leaves on the outside of a slight turn, it is by how much the ink exceeds a sharp
    corner's on the inside.
    """
    half_mm = 0.5 * corner.width_mm
    if not hides_outside(view, corner):
        found = _edge_mm(view, corner, 1)
        return max(0.0, half_mm - found) if math.isfinite(found) else 0.0
    within = _edge_mm(view, corner, -1)
    sharp = half_mm / math.cos(0.5 * corner.deflection_rad)
    return max(0.0, within - sharp) if math.isfinite(within) else 0.0


def hides_outside(view: View, corner: Corner) -> bool:
    """Whether another line leaves on the outside of a slight turn: there is more ink than a corner's."""
    if corner.deflection_rad >= STRAIGHT:
        return False
    return not _edge_mm(view, corner, 1) < HIDES * corner.incoming.width_mm


def _edge_mm(view: View, corner: Corner, side: int) -> float:
    """How far the ink reaches from the vertex along the bisector, outside (1) or inside (-1), mm.

    NaN if it has no edge there.
    """
    before, after = corner.headings_rad()
    x = math.cos(before) - math.cos(after)
    y = math.sin(before) - math.sin(after)
    outward = math.atan2(side * y, side * x)
    reach_mm = REACH_WIDTHS * corner.width_mm + REACH_PX * view.pitch_mm
    vertex_mm = corner.incoming.place(corner.beyond_mm)
    return float(_edge(view.cells, vertex_mm, outward, (corner.width_mm, reach_mm), side > 0))


@njit(cache=True)
def _edge(cells, vertex, outward, sizes_mm, is_outside):  # type: ignore[no-untyped-def]
    """How far the ink reaches from a vertex, mm: the median of some rays. `sizes_mm`: the line's width, and
    how far the edge is sought.
    """
    width_mm = sizes_mm[0]
    c = math.cos(outward)
    s = math.sin(outward)
    found = np.empty(RAYS)
    for k in range(RAYS):
        off = (k * (2 * ACROSS / (RAYS - 1)) - ACROSS) * width_mm
        place = vertex[0] + off * s, vertex[1] + off * -c
        found[k] = _edge_outward(cells, place, outward, sizes_mm)
        if is_outside:  # the pen's round leaves the tangent by off²/width
            found[k] += off * off / width_mm
    return median_of(found)


@njit(cache=True)
def _edge_outward(cells, place, outward, sizes_mm):  # type: ignore[no-untyped-def]
    """Where the ink about a place ends outward, mm; NaN if there is no ink.

    A light speck in the ink does not end it.
    """
    width_mm, reach_mm = sizes_mm
    _, edge = edges(cells, place[0], place[1], outward - math.pi / 2, reach_mm)
    within_mm = 0.5 * width_mm
    x = place[0] - within_mm * math.cos(outward)
    y = place[1] - within_mm * math.sin(outward)
    beyond = edge_along(cells, x, y, outward, reach_mm) - within_mm
    return beyond if math.isnan(edge) or beyond > edge else edge


def _arc(start: Array, heading: float, end: Array, end_heading: float) -> Array:
    """An arc that leaves along one heading and arrives along another, in cubics of at most `PIECE_RAD`."""
    angle = turn(heading, end_heading)
    pieces = max(1, math.ceil(abs(angle) / PIECE_RAD))
    radius = float(np.hypot(*(end - start))) / (2 * math.sin(abs(angle) / 2))
    side = math.copysign(1.0, angle)
    centre = start + side * radius * left_of(direction(heading))
    headings = heading + angle * np.arange(pieces + 1) / pieces
    nodes = centre + side * radius * np.column_stack([np.sin(headings), -np.cos(headings)])
    nodes[-1] = end
    return np.vstack(
        [hermite(nodes[i], headings[i], nodes[i + 1], headings[i + 1]) for i in range(pieces)]
    )
