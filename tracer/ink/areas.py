"""Areas: what the lines of a net part the sheet into, and the ways round them.

Signals: the junctions of a net, and which of its lines count, in; the ways round the areas, each its lines in
order and the sense in which they are gone along, out.

About each junction the legs have an order. Where they crowd, places felt in ink may give it wrong, and two
areas become one. But lines on paper lie in a plane, where Euler's formula holds:

    junctions − lines + areas = 2 · (parts that hang together)

If areas are missing, neighbours in an order are exchanged, the nearest to each other first.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from heapq import heapify, heappop, heappush

import numpy as np

from morfax.motion.plane import direction
from morfax.tracer.ink.chains import Junctions

# a line of the net, and whether it is gone along from its last place to its first
Edge = tuple[int, bool]
Orders = dict[int, list[tuple[float, Edge]]]  # the edges that leave a junction, by angle, rad


def ways_round(left: set[int], junctions: Junctions) -> list[list[Edge]]:
    """The ways round the areas that some lines part: areas within the net anticlockwise, the outside
    clockwise.
    """
    orders = _orders(left, junctions)
    ways = _ways(_onto(orders))
    missing = _areas_of_plane(left, junctions) - len(ways)
    if missing <= 0:
        return ways
    _exchange_neighbours(orders, ways, missing)
    return _ways(_onto(orders))


def _orders(left: set[int], junctions: Junctions) -> Orders:
    """The edges that leave each junction, by their angle about its middle."""
    orders: Orders = {}
    for number, there in junctions.by_number.items():
        ends = np.array([leg.end_mm for leg in there.legs])
        middle = ends.mean(axis=0)
        for side, end, leg in zip(there.sides, ends, there.legs, strict=True):
            if side.line not in left:
                continue
            out = end - middle
            if math.hypot(*out) < leg.width_mm:  # few legs, near together: by where they head
                out = -direction(leg.heading_rad)
            edge = side.line, side.last
            orders.setdefault(number, []).append((math.atan2(out[1], out[0]), edge))
    return {number: sorted(edges) for number, edges in orders.items()}


def _onto(orders: Orders) -> dict[Edge, Edge]:
    """Onto which edge each goes on: the first to the left of the way back."""
    onto = dict[Edge, Edge]()
    for leaving in orders.values():
        edges = [edge for _, edge in leaving]
        for k, edge in enumerate(edges):
            # the same line comes in here the other way about, and goes on to the next one clockwise
            onto[_back(edge)] = edges[k - 1]
    return onto


def _back(edge: Edge) -> Edge:
    """The same line the other way about."""
    line, back = edge
    return line, not back


def _ways(onto: dict[Edge, Edge]) -> list[list[Edge]]:
    """The ways round the areas."""
    ways, seen = list[list[Edge]](), set[Edge]()
    for first in onto:
        way, edge = list[Edge](), first
        while edge not in seen:
            seen.add(edge)
            way.append(edge)
            edge = onto[edge]
        if way:
            ways.append(way)
    return ways


def _areas_of_plane(left: set[int], junctions: Junctions) -> int:
    """How many ways round areas lines in a plane have, by Euler's formula."""
    part_of = dict[int, int]()

    def part(node: int) -> int:
        while part_of.setdefault(node, node) != node:
            node = part_of[node] = part_of[part_of[node]]
        return node

    for n in left:
        one, other = junctions.net.lines[n].junctions
        part_of[part(one)] = part(other)
    parts = sum(node == onto for node, onto in part_of.items())
    return 2 * parts - len(part_of) + len(left)


def _exchange_neighbours(orders: Orders, ways: list[list[Edge]], missing: int) -> None:
    """Exchange neighbours in the orders, the nearest first, while areas are missing and that parts ways.

    `ways` are those round the areas before. An exchange that parts none does not do so later either, but
    beside one that was made: so each is tried once.
    """
    rounds = _Rounds(orders, ways)
    gaps = [gap for number in orders for gap in rounds.gaps(number)]
    heapify(gaps)
    while missing > 0 and gaps:
        gap, number, k = heappop(gaps)
        if rounds.gap(number, k) == gap and rounds.exchanged(number, k):
            missing -= 2
            for changed in rounds.gaps(number, range(k - 2, k + 2)):
                heappush(gaps, changed)


class _Rounds:
    """The ways round areas as neighbours are exchanged, each edge with its way and its place along that.

        … p a b n …    →    … p b a n …        the edges that leave a junction

    What came in by a, b and n went on to p, a and b, and goes on to b, p and a: three edges exchange what
    follows them. If they lie on one way, in this order, it is parted in three; else there are as many ways
    as before, or fewer.
    """

    def __init__(self, orders: Orders, ways: list[list[Edge]]) -> None:
        self._orders, self._onto = orders, _onto(orders)
        self._way = {edge: number for number, way in enumerate(ways) for edge in way}
        # what is parted keeps its order
        self._along = {edge: k for way in ways for k, edge in enumerate(way)}
        self._count = len(ways)

    def gap(self, number: int, k: int) -> float:
        """The angle between two neighbours of a junction, the later of which is number k, rad."""
        edges = self._orders[number]
        return (edges[k][0] - edges[k - 1][0]) % (2 * math.pi)

    def gaps(
        self, number: int, some: Iterable[int] | None = None
    ) -> list[tuple[float, int, int]]:
        """The gaps of a junction, or some of them, each with its place; none where two lines go on."""
        count = len(self._orders[number])
        if count <= 2:
            return []
        places = range(count) if some is None else sorted({k % count for k in some})
        return [(self.gap(number, k), number, k) for k in places]

    def exchanged(self, number: int, k: int) -> bool:
        """Exchange two neighbours if that parts a way; returns whether it does."""
        edges = self._orders[number]
        three = edges[k - 1], edges[k], edges[(k + 1) % len(edges)]
        a, b, n = (_back(edge) for _, edge in three)
        if not self._way[a] == self._way[b] == self._way[n]:
            return False
        at_a, at_b, at_n = self._along[a], self._along[b], self._along[n]
        if not (at_a < at_b < at_n or at_b < at_n < at_a or at_n < at_a < at_b):
            return False
        edges[k - 1], edges[k] = edges[k], edges[k - 1]
        onto = self._onto
        onto[a], onto[b], onto[n] = onto[n], onto[a], onto[b]
        for first in (b, n):
            self._take_down(first)
        return True

    def _take_down(self, first: Edge) -> None:
        """Take down that the edges from one on are a way of their own."""
        edge = first
        while self._way[edge] != self._count:
            self._way[edge] = self._count
            edge = self._onto[edge]
        self._count += 1
