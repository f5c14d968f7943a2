"""Rings of cells about a junction: the legs that leave it; and forks and corners in what was felt.

Near corners, crossings, touching lines, gaps and ends the inks of several legs run together, and what a
swinging cell sees there is not the line. So the head looks at the legs where they are clean, further out:

    incoming   the line felt forward from behind the axis until it is no longer clean: place, heading and bend
               at its last clean station
    legs       cells on rings about the junction: an arc of ink that is joined to the junction by ink, ring by
               ring, and has the line's width for three rings, is a leg; it is felt outward from there
    outgoing   the leg that goes on straightest (see `choice`)
    vertex     where incoming and outgoing meet (see `corner`)

A ring's radius grows until legs are found.

Signals: the view, a place and the trail in; legs in sheet mm out.

Source: patent ES 361967, cell 102 senses an abrupt change of direction ahead of the follower; how it finds
the way on is left to the two British patents named there. Questions: everything else is our own, from first
principles.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import heading_of
from morfax.motion.polyline import lengths_mm
from morfax.tracer.junctions.arcs import ARC, outward
from morfax.tracer.limits import USUAL_WIDTH_MM
from morfax.tracer.sensing.leg import FEWEST_STATIONS, LEAST_WIDTHS, TURNS_OFF, Leg, leg_of
from morfax.tracer.sensing.photocell import darkness_at
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings; stations are a view's step apart.
CHORD, SKIPPED = 7, 3  # stations of a chord, and between the chords and the corner
LEANS = 3  # the last stations of a line lean towards what ended it
# stations: of a chord, between places, and after the last of them
FORK_CHORD, FORK_EVERY, FORK_ENDS = 6, 4, 4
# widths: the felt line has left the straight one, and ink goes on beyond
FORK_ASIDE, FORK_BEYOND = 0.9, 0.8
FORK_PLACES = 12  # of ink, all the way

BEGIN = 0.3  # of the width: the first ring
FARTHEST_WIDTHS = 10.0  # rings do not grow beyond this, ...
FARTHEST_MM = FARTHEST_WIDTHS * USUAL_WIDTH_MM  # ... nor, of a thinner line, beyond this
CLEAN_RINGS = 3  # on which an arc has the line's width: a leg
MORE_LEGS = 0.5  # of a leg's length: rings grow on by this after a leg was found


def corner_in(seen: Array, first: int) -> int | None:
    """The station, from `first` on, at which a line that was felt clean turns sharply; None if it does not.

    Chords before and after it differ more there than anywhere within a chord's length, by more than
    `TURNS_OFF`. It is found before there are legs; how sharp it is, its ink says (see `corner`).
    """
    station = corner_at(seen, first)
    return None if station < 0 else int(station)


@njit(cache=True)
def corner_at(seen, first):  # type: ignore[no-untyped-def]
    """The same for kernels: -1 without a corner."""
    reach = CHORD + SKIPPED
    begin = max(first, reach)
    turned = np.zeros(max(0, len(seen) - reach - LEANS - begin))
    for k in range(len(turned)):
        i = begin + k
        bx, by = (
            seen[i - SKIPPED, 0] - seen[i - reach, 0],
            seen[i - SKIPPED, 1] - seen[i - reach, 1],
        )
        ax, ay = (
            seen[i + reach, 0] - seen[i + SKIPPED, 0],
            seen[i + reach, 1] - seen[i + SKIPPED, 1],
        )
        turned[k] = abs(math.atan2(bx * ay - by * ax, bx * ax + by * ay))
    for k in range(len(turned)):
        if turned[k] > TURNS_OFF:
            about = turned[max(0, k - CHORD) : k + CHORD + 1]
            if turned[k] == about.max():
                return begin + k
    return -1


def fork_in(view: View, seen: Array, first: int) -> int | None:
    """The station, from `first` on, where ink goes straight on although the felt line bends away.

    Where the felt line has left the straight one by nearly a width, its own ink no longer reaches there: ink
    there is that of another leg.
    """
    station = fork_at(view.cells, float(view.width_mm), seen, first)
    return None if station < 0 else int(station)


@njit(cache=True)
def fork_at(cells, width_mm, seen, first):  # type: ignore[no-untyped-def]
    """The same for kernels: -1 without a fork."""
    for i in range(max(first, FORK_CHORD), len(seen) - FORK_ENDS, FORK_EVERY):
        x = seen[i, 0]
        y = seen[i, 1]
        way_x = x - seen[i - FORK_CHORD, 0]
        way_y = y - seen[i - FORK_CHORD, 1]
        length = math.hypot(way_x, way_y)
        c, s = way_x / length, way_y / length
        # 1. where the felt line has left the straight one
        k = i
        while k < len(seen):
            if abs((seen[k, 1] - y) * c - (seen[k, 0] - x) * s) > FORK_ASIDE * width_mm:
                break
            k += 1
        if k == len(seen):
            return -1
        # 2. whether ink goes straight on to there, and beyond
        along = (seen[k, 0] - x) * c + (seen[k, 1] - y) * s
        if _is_inked(cells, (x, y, c, s), along + FORK_BEYOND * width_mm):
            return i
    return -1


@njit(cache=True, _nrt=False)
def _is_inked(cells, ray, end_mm):  # type: ignore[no-untyped-def]
    """Whether there is ink at `FORK_PLACES` places along a ray (place, direction) up to its end."""
    x, y, c, s = ray
    step = end_mm / (FORK_PLACES - 1)
    for k in range(FORK_PLACES):
        away_mm = end_mm if k == FORK_PLACES - 1 else k * step
        if not darkness_at(cells, x + away_mm * c, y + away_mm * s) > cells.level:
            return False
    return True


def farthest_mm(view: View) -> float:
    """How far rings grow, mm."""
    return max(FARTHEST_MM, FARTHEST_WIDTHS * view.width_mm)


def legs_around(view: View, centre: Array, trail: Array) -> list[Leg]:
    """The clean legs that leave a junction, but for the one by which the `trail` (n, 2) came in."""
    trail = _up_to(trail, centre)
    way_in = trail, np.hypot(*(trail - centre).T)
    arcs = np.empty(0, ARC)
    found = list[Leg]()
    at = 0
    last_mm = farthest_mm(view)
    more_mm = MORE_LEGS * view.leg_mm
    radii = np.arange(BEGIN * view.width_mm, last_mm, view.step_mm)
    while True:
        # 1. rings outward to one with arcs that may be legs
        sizes_mm = radii, float(view.width_mm), float(last_mm), float(more_mm if found else 0.0)
        at, last_mm, arcs = _to_legs(view.cells, centre, way_in, (at, arcs), sizes_mm)
        if at == len(radii):
            return found
        # 2. those that have been clean for long enough are legs
        before = len(found)
        for k in np.flatnonzero(_undecided(arcs) & (arcs["clean"] >= CLEAN_RINGS)):
            leg = _leg_outward(view, centre, radii[at], arcs[k])
            if leg is not None:
                found.append(leg)
                arcs["found"][k] = True
        # 3. rings go on a little after the first leg, and for as long as some ink is undecided
        if found and (not before or _undecided(arcs).any()):
            last_mm = radii[at] + more_mm
        at += 1


@njit(cache=True)
def _to_legs(cells, centre, way_in, rings, sizes_mm):  # type: ignore[no-untyped-def]
    """Go outward from a ring and the arcs within it, to one that has arcs which may be legs: that ring's
    number, or how many there are; the radius of the last ring; the arcs.

    `way_in`: the trail, and how far from the centre it is; `sizes_mm`: the radii, the line's width, the last
    radius, and how much further rings go while ink is undecided (0: no further).
    """
    (trail, trail_mm), (first, arcs), (radii, width_mm, last_mm, more_mm) = (
        way_in,
        rings,
        sizes_mm,
    )
    for k in range(first, len(radii)):
        if radii[k] > last_mm:
            break
        trail_rad = _crossing(trail, trail_mm, centre, radii[k])
        arcs = outward(cells, centre, (radii[k], width_mm, trail_rad), arcs)
        if len(arcs) == 0:
            break
        is_undecided = False
        for n in range(len(arcs)):
            if not (arcs[n]["found"] or arcs[n]["incoming"]):
                is_undecided = True
                if arcs[n]["clean"] >= CLEAN_RINGS:
                    return k, last_mm, arcs
        if is_undecided and more_mm > 0.0:
            last_mm = radii[k] + more_mm
    return len(radii), last_mm, arcs


def _undecided(arcs: NDArray[np.void]) -> NDArray[np.bool_]:
    """Which arcs are neither the way in nor a leg yet."""
    return np.asarray(~(arcs["found"] | arcs["incoming"]))


def _up_to(trail: Array, centre: Array) -> Array:
    """The trail without its newest places beyond a centre that lies on it: it came in from behind that."""
    back_mm = lengths_mm(trail[::-1])
    newest = trail[::-1][back_mm <= 2 * math.dist(trail[-1], centre)]
    return trail[: len(trail) - int(np.argmin(np.hypot(*(newest - centre).T)))]


@njit(cache=True, _nrt=False)
def _crossing(trail, trail_mm, centre, radius):  # type: ignore[no-untyped-def]
    """Direction in which the trail, back from its newest place, crosses a ring; NaN if it is too short."""
    for k in range(len(trail) - 1, -1, -1):
        if trail_mm[k] >= radius:
            return math.atan2(trail[k, 1] - centre[1], trail[k, 0] - centre[0])
    return math.nan


def _leg_outward(view: View, centre: Array, radius: float, arc: np.void) -> Leg | None:
    """Feel outward along an arc that three rings have seen; None if the line there is not clean after all."""
    radii = radius - view.step_mm * np.arange(CLEAN_RINGS - 1, -1, -1)
    track = np.array([arc["middle_two_back"], arc["middle_one_back"], arc["middle"]])
    places = centre + radii[:, None] * np.column_stack([np.cos(track), np.sin(track)])
    way = places[-1] - places[0]
    heading = heading_of(way)
    view = view.like(places[-1], heading)
    seen = view.feel(places[0], heading, view.leg_mm)
    if len(seen) < FEWEST_STATIONS:
        seen = view.feel(places[-1], heading, view.leg_mm)
    # less may be the blunt end of a tip
    least = max(FEWEST_STATIONS, math.ceil(LEAST_WIDTHS * view.width_mm / view.step_mm))
    return leg_of(seen, False, view.leg_mm) if len(seen) >= least else None
