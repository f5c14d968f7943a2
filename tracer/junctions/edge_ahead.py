"""The edge ahead of the head: its corners by their own legs, tight bends, and the way through them.

Signals: stations felt along the edge of a filled shape (n, 3: x, y mm, and how steep the edge is), the place
of the axis among them; corners, tight places, stretches (n, 2) mm and the leg behind them out.

    shape   ┌────────── leg        The lens draws the edge round, inside the vertex. From 3 s / sin(a) on the
            │╭─ ─ ─ ─              legs are where they are; there they are felt, straight or bent, and meet in
            ││  felt               the vertex. Softness s follows from how steep the edge is.
           leg

Where the edge bends more than the swinging cell can follow, and shows no corner, the way is along the
stations, averaged over less length the more it bends.

Source: our own. Questions: see `drawing.sharpening`, which puts the corners back.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.curves import hermite
from morfax.motion.median import median
from morfax.motion.plane import heading_of
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.sharpening import PutBack, corners_of
from morfax.tracer.drawing.tips import TURNED
from morfax.tracer.effort import FINE_PX
from morfax.tracer.head.course import FELT_LEGS, NODES
from morfax.tracer.head.leaders import MEMORY, STATIONS
from morfax.tracer.head.plan import Plan
from morfax.tracer.sensing.edge_scout import CIRCLE_PX
from morfax.tracer.sensing.leg import Leg, centre_at
from morfax.tracer.sensing.view import View

# Chosen by trial on filled shapes.
# that the edge may turn within half of the length over which stations are averaged
AVERAGED_RAD = 0.36
LEAST_AVERAGED_PX = 1.6  # half of that length at least
TIP_STATIONS = 4  # to either side of a tip, between which the edge turns by `TURNED`
STEEPEST = 0.55  # of the fundamental: no edge is steeper behind an aperture


@dataclass(frozen=True, slots=True)
class Node:
    """A place on the edge as averaged over the stations about it, and which station it is."""

    at: int
    leg: Leg


@dataclass(frozen=True)
class EdgeAhead:
    """An edge as it was felt: stations (n, 3), and the number of that beside the axis."""

    view: View
    felt: Array
    here: int

    @cached_property
    def softness_mm(self) -> float:
        """Standard deviation of the lens as the circling cell sees through it, mm."""
        radius_mm = CIRCLE_PX * self.view.pitch_mm
        first = min(median(self.felt[:, 2]), STEEPEST)
        # first = (ρ - ρ³/8 + ρ⁵/64) / √(2π), ρ: the radius in standard deviations
        ratio = wanted = math.sqrt(math.tau) * first
        for _ in range(20):
            ratio = wanted + ratio**3 / 8 - ratio**5 / 64
        return math.hypot(radius_mm / ratio, radius_mm / math.sqrt(2))

    @cached_property
    def corners(self) -> list[PutBack]:
        """The corners on it, in stations and mm."""
        pitch_mm = self.view.pitch_mm
        places = self.felt[:, :2]
        along_px = lengths_mm(places) / pitch_mm
        at_px = np.arange(0.0, along_px[-1], FINE_PX)
        evenly = np.column_stack([np.interp(at_px, along_px, c) for c in places.T / pitch_mm])
        found = corners_of(
            evenly,
            self.softness_mm / pitch_mm,
            is_closed=False,
            step_px=self.view.step_mm / pitch_mm,
        )
        station = np.searchsorted(along_px, at_px)
        corners = [
            corner._replace(
                first=int(station[corner.first]),
                last=int(station[corner.last]),
                places=corner.places * pitch_mm,
            )
            for corner in found
        ]
        return sorted([*corners, *self._tips(corners)], key=lambda corner: corner.first)

    def _tips(self, corners: list[PutBack]) -> Iterator[PutBack]:
        """Tips too narrow for their legs to show a vertex: they stay where the lens shows them."""
        places, half = self.felt[:, :2], TIP_STATIONS
        if len(places) < 2 * half + 1:
            return
        before = places[half:-half] - places[: -2 * half]
        after = places[2 * half :] - places[half:-half]
        cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        turned = np.abs(np.arctan2(cross, np.einsum("ij,ij->i", before, after)))
        taken = np.zeros(len(places), bool)
        for corner in corners:
            taken[max(0, corner.first - half) : corner.last + half] = True
        for k in np.argsort(-turned):
            at = int(k) + half
            if turned[k] < TURNED:
                break
            if taken[at]:
                continue
            taken[at - 2 * half : at + 2 * half + 1] = True
            into, out = (way / np.hypot(*way) for way in (before[k], after[k]))
            yield PutBack(at - half, at + half, places[at : at + 1], into, out)

    @cached_property
    def nodes(self) -> list[Node]:
        """Places along it, between its corners, from the first station to the last."""
        ends = [0, *(k for corner in self.corners for k in (corner.first, corner.last))]
        ends.append(len(self.felt) - 1)
        nodes = list[Node]()
        for first, last in zip(ends[::2], ends[1::2], strict=True):
            nodes += self._between(first, last)
        return nodes

    def _between(self, first: int, last: int) -> list[Node]:
        """Places from one station to another, averaged over the stations between these."""
        nodes, at = list[Node](), first
        while last > first:
            leg, half_mm = self._averaged(at, first, last)
            nodes.append(Node(at, leg))
            if at == last:
                break
            at = min(at + max(1, int(half_mm / NODES / self.view.step_mm)), last)
        return nodes

    def _averaged(self, at: int, first: int, last: int) -> tuple[Leg, float]:
        """The edge at a station, and half of the length that it is averaged over, mm."""
        half_mm = FELT_LEGS * self.view.leg_mm
        for _ in range(2):
            reach = math.ceil(half_mm / self.view.step_mm)
            begin = max(first, at - reach)
            end = min(last, at + reach) + 1
            seen = self.felt[begin:end].copy()
            seen[:, 2] = self.view.width_mm
            leg = centre_at(seen, at - begin, half_mm)
            if abs(leg.bend_per_mm) * half_mm < AVERAGED_RAD:
                break
            least_mm = LEAST_AVERAGED_PX * self.view.pitch_mm
            half_mm = max(least_mm, AVERAGED_RAD / abs(leg.bend_per_mm))
        return leg, half_mm

    def plan(
        self, stands: tuple[Array, float], clear_mm: float, bend_per_mm: float
    ) -> Plan | None:
        """The way from where the head stands past the tight places ahead, up to a length of plain edge.

        Tight is what bends more than the swinging cell follows; where the edge is tight to the end, the way
        ends there. None if nothing ahead is tight.
        """
        tight = self._tight(stands[0], bend_per_mm)
        if not tight:
            return None
        # the last of the tight places that follow one another
        last = tight[0][1]
        clear = math.ceil(clear_mm / self.view.step_mm)
        for first, over in tight:
            if first > last + clear:
                break
            last = max(last, over)
        ahead = [node for node in self.nodes if node.at > self.here]
        behind = [node for node in ahead if node.at >= last] or ahead[-1:]
        return self._through(stands, behind[0]) if behind else None

    def plain(self, stands: tuple[Array, float], length_mm: float) -> Plan | None:
        """The way along stations for a length; None if they end before."""
        last = self.here + length_mm / self.view.step_mm
        behind = [node for node in self.nodes if node.at >= last]
        return self._through(stands, behind[0]) if behind else None

    def _tight(self, place: Array, bend_per_mm: float) -> list[tuple[int, int]]:
        """First and last stations of corners and tight bends ahead, in order."""
        ahead = [
            (corner.first, corner.last)
            for corner in self.corners
            if self._is_ahead(corner, place)
        ]
        ahead += [
            (node.at, node.at + 1)
            for node in self.nodes
            if node.at > self.here and abs(node.leg.bend_per_mm) > bend_per_mm
        ]
        return sorted(ahead)

    def _is_ahead(self, corner: PutBack, place: Array) -> bool:
        """Whether the vertex of a corner is still ahead of the axis."""
        return corner.last > self.here and float((corner.places[-1] - place) @ corner.into) > 0

    def _through(self, stands: tuple[Array, float], end: Node) -> Plan:
        """Stretches from where the head stands to a node: along nodes, and through corners by their legs."""
        place, heading = stands
        stretches = list[Array]()
        way = list[Array]()
        turned = False
        for mark in self._marks(stands[0], end):
            if isinstance(mark, Node):
                is_first = not stretches and not way
                if is_first and mark != end and self._is_near(mark, place):
                    continue
                way.append(hermite(place, heading, mark.leg.end_mm, mark.leg.heading_rad))
                place, heading = mark.leg.end_mm, mark.leg.heading_rad
            else:
                into, out = (heading_of(v) for v in (mark.into, mark.out))
                way += [hermite(place, heading, mark.places[0], into), mark.places]
                place, heading, turned = mark.places[-1], out, True
                if len(mark.places) == 1:
                    stretches.append(np.vstack(way))
                    way = [mark.places]
        stretches.append(np.vstack(way))
        seen = self.felt[end.at :].copy()
        seen[:, 2] = self.view.width_mm
        leg = Leg(
            end.leg.end_mm, end.leg.heading_rad, end.leg.bend_per_mm, self.view.width_mm, seen
        )
        return Plan(stretches, leg, None, MEMORY if turned else STATIONS)

    def _marks(self, place: Array, end: Node) -> list[Node | PutBack]:
        """The nodes and corners that are ahead, up to a node, in the order of the way."""
        nodes = [node for node in self.nodes if self.here < node.at <= end.at]
        corners = [c for c in self.corners if c.last <= end.at and self._is_ahead(c, place)]
        marks: list[Node | PutBack] = [*nodes, *corners]
        marks.sort(key=lambda mark: mark.at if isinstance(mark, Node) else mark.first + 0.5)
        return marks

    def _is_near(self, node: Node, place: Array) -> bool:
        """Whether a node is too near a place for a curve of its own."""
        near_mm = FELT_LEGS * self.view.leg_mm / NODES
        return float(np.hypot(*(node.leg.end_mm - place))) < near_mm
