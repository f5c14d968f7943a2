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
    ways = _ways(orders)
    wanted = _areas_of_plane(left, junctions)
    while len(ways) < wanted:
        better = _exchanged(orders, len(ways))
        if better is None:
            break
        ways = better
    return ways


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


def _ways(orders: Orders) -> list[list[Edge]]:
    """The ways round the areas: from each line on to the first to the left of the way back."""
    onto = dict[Edge, Edge]()
    for leaving in orders.values():
        edges = [edge for _, edge in leaving]
        for k, (line, back) in enumerate(edges):
            # the same line comes in here the other way about, and goes on to the next one clockwise
            onto[line, not back] = edges[k - 1]
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
            node = part_of[node]
        return node

    for n in left:
        one, other = junctions.net.lines[n].junctions
        part_of[part(one)] = part(other)
    parts = sum(node == onto for node, onto in part_of.items())
    return 2 * parts - len(part_of) + len(left)


def _exchanged(orders: Orders, count: int) -> list[list[Edge]] | None:
    """The ways when two neighbours in an order are exchanged, so that there are more; None if none helps."""
    gaps = [
        ((edges[k][0] - edges[k - 1][0]) % (2 * math.pi), number, k)
        for number, edges in orders.items()
        if len(edges) > 2
        for k in range(len(edges))
    ]
    for _, number, k in sorted(gaps):
        edges = orders[number]
        edges[k - 1], edges[k] = edges[k], edges[k - 1]
        ways = _ways(orders)
        if len(ways) > count:
            return ways
        edges[k - 1], edges[k] = edges[k], edges[k - 1]
    return None
