"""Arcs of ink on rings of cells about a junction, and how they hang on those of the ring within.

Signals: a centre, the ring's radius, the line's width and where the trail crosses the ring, and the arcs of
the ring within, in; the arcs of the ring that ink joins to those out (rad, see `ARC`).

Source: our own (see `rings`).
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit
from morfax.tracer.sensing.photocell import TWO_PI, dark_arcs, look_round, looks_round, ring

# of the width, and half the arc: as wide as the line; by trial on the test drawings
NARROWEST, WIDEST, WIDEST_RAD = 0.5, 1.45, 1.2

# an arc of ink on a ring: where it begins and ends, its middle, and those of the two rings within, rad; for
# how many rings it has been clean; whether it is the way in, or a leg already
ARC = np.dtype(
    [
        ("begin", np.float64),
        ("end", np.float64),
        ("middle", np.float64),
        ("middle_one_back", np.float64),
        ("middle_two_back", np.float64),
        ("clean", np.int64),
        ("incoming", np.bool_),
        ("found", np.bool_),
    ]
)


@njit(cache=True)
def outward(cells, centre, ring_mm, inner):  # type: ignore[no-untyped-def]
    """The arcs of a ring that are joined by ink to those of the ring within it.

    `ring_mm` holds the ring's radius, the line's width, and the direction in which the trail crosses (rad).
    """
    radius_mm, width_mm, trail_rad = ring_mm
    seen = _ring_on(cells, centre, radius_mm, inner)
    arcs = np.zeros(len(seen), ARC)
    count = 0
    for k in range(len(seen)):
        begin = seen[k, 0]
        end = seen[k, 1]
        # 1. the arcs within on which it hangs
        parents, parent, incoming, settled, found = _parents(inner, begin, end)
        if len(inner) > 0 and parents == 0:
            continue
        arc = arcs[count]
        count += 1
        arc["begin"], arc["end"], arc["middle"] = begin, end, 0.5 * (begin + end)
        arc["found"] = found
        # 2. the way in: the trail crosses it, or it hangs on the way in, and not on the junction
        if parents > 0 and settled == parents:
            arc["incoming"] = True
        elif math.isnan(trail_rad):
            arc["incoming"] = incoming > 0
        else:
            arc["incoming"] = _overlap(begin, end, trail_rad, trail_rad)
        # 3. clean: as wide as the line, with its parent's rings if it is the only child of an only parent
        if _is_as_wide(end - begin, radius_mm, width_mm):
            arc["clean"] = 1
            if parents == 1 and _children(inner[parent], seen) == 1:
                arc["clean"] = inner[parent]["clean"] + 1
                arc["middle_one_back"] = inner[parent]["middle"]
                arc["middle_two_back"] = inner[parent]["middle_one_back"]
    return arcs[:count].copy()


@njit(cache=True)
def _ring_on(cells, centre, radius_mm, inner):  # type: ignore[no-untyped-def]
    """The dark arcs (n, 2) rad of a ring that hang on the arcs of the ring within it, and perhaps others; all
    of the first ring. A cell looks no further than these arcs reach.
    """
    if len(inner) == 0:
        return ring(cells, centre, radius_mm)
    seen = np.full(looks_round(cells, radius_mm), -1.0)  # where nobody looks it is light
    looks = len(seen)
    for arc in inner:
        first = math.floor(arc["begin"] * looks / TWO_PI)
        last = min(math.ceil(arc["end"] * looks / TWO_PI), first + looks - 1)
        for k in range(first, last + 1):
            seen[k % looks] = look_round(cells, centre, radius_mm, k % looks, looks)
        # on to where it is light
        for begin, step in ((first, -1), (last, 1)):
            k = begin
            while seen[k % looks] >= cells.level and abs(k - begin) < looks:
                k += step
                seen[k % looks] = look_round(cells, centre, radius_mm, k % looks, looks)
    return dark_arcs(seen, cells.level)


@njit(cache=True)
def _parents(inner, begin, end):  # type: ignore[no-untyped-def]
    """How many arcs of the ring within an arc (rad) hangs on; the last of them; how many are the way in,
    and how many of these were clean twice; whether one is found.
    """
    parents, parent, incoming, settled, found = 0, 0, 0, 0, False
    for p in range(len(inner)):
        if _overlap(inner[p]["begin"], inner[p]["end"], begin, end):
            parents, parent = parents + 1, p
            incoming += inner[p]["incoming"]
            settled += inner[p]["incoming"] and inner[p]["clean"] > 1
            found = found or inner[p]["found"]
    return parents, parent, incoming, settled, found


@njit(cache=True)
def _children(arc, seen):  # type: ignore[no-untyped-def]
    """How many arcs (n, 2) rad of the next ring hang on an arc."""
    count = 0
    for k in range(len(seen)):
        count += _overlap(arc["begin"], arc["end"], seen[k, 0], seen[k, 1])
    return count


@njit(cache=True)
def _overlap(begin, end, other_begin, other_end):  # type: ignore[no-untyped-def]
    """Whether two arcs, rad, have a direction in common."""
    apart = 0.5 * (other_begin + other_end) - 0.5 * (begin + end)
    apart -= TWO_PI * round(apart / TWO_PI)
    return abs(apart) < 0.5 * (end - begin + other_end - other_begin)


@njit(cache=True)
def _is_as_wide(arc_rad, radius_mm, width_mm):  # type: ignore[no-untyped-def]
    """Whether an arc is about as wide as the line."""
    half = min(0.5 * arc_rad, 0.5 * math.pi)
    width = 2 * radius_mm * math.sin(half)
    return NARROWEST * width_mm < width < WIDEST * width_mm and half < WIDEST_RAD
