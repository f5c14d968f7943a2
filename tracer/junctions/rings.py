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
from morfax.motion.polyline import lengths_mm
from morfax.tracer.sensing.leg import FEWEST_STATIONS, LEAST_WIDTHS, Leg, leg_of
from morfax.tracer.sensing.photocell import TWO_PI, darkness_at, ring
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings; stations are a view's step apart.
CORNER = math.radians(20)  # a line that turns less within a few stations is smooth
CHORD, SKIPPED = 7, 3  # stations of a chord, and between the chords and the corner
LEANS = 3  # the last stations of a line lean towards what ended it
# stations: of a chord, between places, and after the last of them
FORK_CHORD, FORK_EVERY, FORK_ENDS = 6, 4, 4
# widths: the felt line has left the straight one, and ink goes on beyond
FORK_ASIDE, FORK_BEYOND = 0.9, 0.8
FORK_PLACES = 12  # of ink, all the way

BEGIN = 0.3  # of the width: the first ring
FARTHEST_MM, FARTHEST_WIDTHS = 5.0, 10.0  # rings do not grow beyond the larger of these
CLEAN_RINGS = 3  # on which an arc has the line's width: a leg
# of the width, and half the arc: as wide as the line
NARROWEST, WIDEST, WIDEST_RAD = 0.5, 1.45, 1.2
MORE_LEGS = 0.5  # of a leg's length: rings grow on by this after a leg was found

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


def corner_in(seen: Array, first: int) -> int | None:
    """The station, from `first` on, at which a line that was felt clean turns sharply; None if it does not.

    Chords before and after it differ more there than anywhere within a chord's length, by more than `CORNER`.
    It is found before there are legs; how sharp it is, its ink says (see `corner`).
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
        if turned[k] > CORNER:
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
        x, y = seen[i, 0], seen[i, 1]
        way_x, way_y = x - seen[i - FORK_CHORD, 0], y - seen[i - FORK_CHORD, 1]
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


def legs_around(view: View, centre: Array, trail: Array) -> list[Leg]:
    """The clean legs that leave a junction, but for the one by which the `trail` (n, 2) came in."""
    trail = _up_to(trail, centre)
    trail_mm = np.hypot(*(trail - centre).T)
    arcs = np.empty(0, ARC)
    found: list[Leg] = []
    last_mm = max(FARTHEST_MM, FARTHEST_WIDTHS * view.width_mm)
    for radius in np.arange(BEGIN * view.width_mm, last_mm, view.step_mm):
        if radius > last_mm:
            break
        # 1. the ring's arcs, as they hang on the ring within
        trail_rad = _crossing(trail, trail_mm, centre, radius)
        arcs = _outward(view.cells, centre, (radius, view.width_mm, trail_rad), arcs)
        if not len(arcs):
            break
        # 2. those that have been clean for long enough are legs
        before = len(found)
        for k in np.flatnonzero(_undecided(arcs) & (arcs["clean"] >= CLEAN_RINGS)):
            leg = _leg_outward(view, centre, radius, arcs[k])
            if leg is not None:
                found.append(leg)
                arcs["found"][k] = True
        # 3. rings go on a little after the first leg, and for as long as some ink is undecided
        if found and (not before or _undecided(arcs).any()):
            last_mm = radius + MORE_LEGS * view.leg_mm
    return found


def _undecided(arcs: NDArray[np.void]) -> NDArray[np.bool_]:
    """Which arcs are neither the way in nor a leg yet."""
    return np.asarray(~(arcs["found"] | arcs["incoming"]))


def _up_to(trail: Array, centre: Array) -> Array:
    """The trail without its newest places beyond a centre that lies on it: it came in from behind that."""
    back_mm = lengths_mm(trail[::-1])
    newest = trail[::-1][back_mm <= 2 * math.dist(trail[-1], centre)]
    return trail[: len(trail) - int(np.argmin(np.hypot(*(newest - centre).T)))]


def _crossing(trail: Array, trail_mm: Array, centre: Array, radius: float) -> float:
    """Direction in which the trail, back from its newest place, crosses a ring; NaN if it is too short."""
    beyond = np.flatnonzero(trail_mm >= radius)
    if not len(beyond):
        return math.nan
    place = trail[beyond[-1]] - centre
    return math.atan2(place[1], place[0])


def _leg_outward(view: View, centre: Array, radius: float, arc: np.void) -> Leg | None:
    """Feel outward along an arc that three rings have seen; None if the line there is not clean after all."""
    radii = radius - view.step_mm * np.arange(CLEAN_RINGS - 1, -1, -1)
    track = np.array([arc["middle_two_back"], arc["middle_one_back"], arc["middle"]])
    places = centre + radii[:, None] * np.column_stack([np.cos(track), np.sin(track)])
    way = places[-1] - places[0]
    heading = math.atan2(way[1], way[0])
    view = view.like(places[-1], heading)
    seen = view.feel(places[0], heading, view.leg_mm)
    if len(seen) < FEWEST_STATIONS:
        seen = view.feel(places[-1], heading, view.leg_mm)
    # less may be the blunt end of a tip
    least = max(FEWEST_STATIONS, math.ceil(LEAST_WIDTHS * view.width_mm / view.step_mm))
    return leg_of(seen, False, view.leg_mm) if len(seen) >= least else None


@njit(cache=True)
def _outward(cells, centre, ring_mm, inner):  # type: ignore[no-untyped-def]
    """The arcs of a ring that are joined by ink to those of the ring within it.

    `ring_mm` holds the ring's radius, the line's width, and the direction in which the trail crosses (rad).
    """
    radius_mm, width_mm, trail_rad = ring_mm
    seen = ring(cells, centre, radius_mm)
    arcs = np.zeros(len(seen), ARC)
    count = 0
    for k in range(len(seen)):
        begin, end = seen[k, 0], seen[k, 1]
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
