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
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter1d

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.tracer.sensing.leg import FEWEST_STATIONS, LEAST_WIDTHS, Leg, leg_of, turn
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


def corner_in(seen: Array, first: int) -> int | None:
    """The station, from `first` on, at which a line that was felt clean turns sharply; None if it does not.

    Chords before and after it differ more there than anywhere within a chord's length, by more than `CORNER`.
    It is found before there are legs; how sharp it is, its ink says (see `corner`).
    """
    places, reach = seen[:, :2], CHORD + SKIPPED
    middle = np.arange(max(first, reach), len(seen) - reach - LEANS)
    if not len(middle):
        return None
    before = places[middle - SKIPPED] - places[middle - reach]
    after = places[middle + reach] - places[middle + SKIPPED]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = np.abs(np.arctan2(cross, np.sum(before * after, axis=1)))
    most = turned == maximum_filter1d(turned, 2 * CHORD + 1)
    sharp = np.flatnonzero((turned > CORNER) & most)
    return int(middle[sharp[0]]) if len(sharp) else None


def fork_in(view: View, seen: Array, first: int) -> int | None:
    """The station, from `first` on, where ink goes straight on although the felt line bends away.

    Where the felt line has left the straight one by nearly a width, its own ink no longer reaches there: ink
    there is that of another leg.
    """
    for i in range(max(first, FORK_CHORD), len(seen) - FORK_ENDS, FORK_EVERY):
        way = seen[i, :2] - seen[i - FORK_CHORD, :2]
        t = way / np.hypot(*way)
        d = seen[i:, :2] - seen[i, :2]
        aside = np.abs(d[:, 1] * t[0] - d[:, 0] * t[1])
        away = np.flatnonzero(aside > FORK_ASIDE * view.width_mm)
        if not len(away):
            break
        along = float(d[away[0]] @ t)
        shares = np.linspace(0, along + FORK_BEYOND * view.width_mm, FORK_PLACES)
        if all(view.dark(seen[i, :2] + share * t) for share in shares):
            return i
    return None


def legs_around(view: View, centre: Array, trail: Array) -> list[Leg]:
    """The clean legs that leave a junction, but for the one by which the `trail` (n, 2) came in."""
    trail = _up_to(trail, centre)
    trail_mm = np.hypot(*(trail - centre).T)
    joined: list[_Arc] = []
    found: list[Leg] = []
    last_mm = max(FARTHEST_MM, FARTHEST_WIDTHS * view.width_mm)
    for radius in np.arange(BEGIN * view.width_mm, last_mm, view.step_mm):
        if radius > last_mm:
            break
        # 1. the ring's arcs, as they hang on the ring within
        ring = _Ring(
            view.ring(centre, radius), radius, _crossing(trail, trail_mm, centre, radius)
        )
        joined = _joined(ring, joined, view.width_mm)
        if not joined:
            break
        # 2. those that have been clean for long enough are legs
        before = len(found)
        found += _new_legs(view, centre, radius, joined)
        # 3. rings go on a little after the first leg, and for as long as some ink is undecided
        undecided = any(arc.undecided for arc in joined)
        if found and (not before or undecided):
            last_mm = radius + MORE_LEGS * view.leg_mm
    return found


def _new_legs(view: View, centre: Array, radius: float, arcs: list[_Arc]) -> list[Leg]:
    """The legs that arcs are now known to be."""
    found = []
    for arc in arcs:
        if arc.clean >= CLEAN_RINGS and arc.undecided:
            leg = _leg_outward(view, centre, radius, arc)
            if leg is not None:
                found.append(leg)
                arc.found = True
    return found


class _Ring(NamedTuple):
    """A ring: its arcs of ink (n, 2) rad, its radius, and where the trail crosses it (rad)."""

    arcs: Array
    radius_mm: float
    trail_rad: float | None


@dataclass(slots=True)
class _Arc:
    """An arc of ink on a ring: where it begins and ends (rad), for how many rings it has been clean, whether
    it is the way in, or a leg already, and its middles on the last rings.
    """

    begin: float
    end: float
    clean: int
    incoming: bool
    found: bool
    track: tuple[float, ...]

    @property
    def middle(self) -> float:
        """Direction of its middle, rad."""
        return 0.5 * (self.begin + self.end)

    @property
    def undecided(self) -> bool:
        """Whether it is neither the way in nor a leg yet."""
        return not self.found and not self.incoming

    def overlaps(self, begin: float, end: float) -> bool:
        """Whether it has a direction in common with another arc."""
        apart = abs(turn(self.middle, 0.5 * (begin + end)))
        return apart < 0.5 * (self.end - self.begin + end - begin)


def _up_to(trail: Array, centre: Array) -> Array:
    """The trail without its newest places beyond a centre that lies on it: it came in from behind that."""
    back_mm = lengths_mm(trail[::-1])
    newest = trail[::-1][back_mm <= 2 * math.dist(trail[-1], centre)]
    return trail[: len(trail) - int(np.argmin(np.hypot(*(newest - centre).T)))]


def _crossing(trail: Array, trail_mm: Array, centre: Array, radius: float) -> float | None:
    """Direction in which the trail, back from its newest place, crosses a ring; None if it is too short."""
    beyond = np.flatnonzero(trail_mm >= radius)
    if not len(beyond):
        return None
    place = trail[beyond[-1]] - centre
    return math.atan2(place[1], place[0])


def _joined(ring: _Ring, inner: list[_Arc], width_mm: float) -> list[_Arc]:
    """The arcs of a ring that are joined by ink to those of the ring within it."""
    out = []
    for begin, end in ring.arcs:
        parents = [arc for arc in inner if arc.overlaps(begin, end)]
        if inner and not parents:
            continue
        arc = _Arc(begin, end, 0, False, any(a.found for a in parents), ())
        arc.incoming = _is_way_in(arc, parents, ring.trail_rad)
        if _is_as_wide(arc, ring.radius_mm, width_mm):
            _go_on(arc, parents, ring.arcs)
        out.append(arc)
    return out


def _is_as_wide(arc: _Arc, radius_mm: float, width_mm: float) -> bool:
    """Whether an arc is about as wide as the line."""
    half = min(0.5 * (arc.end - arc.begin), 0.5 * math.pi)
    width = 2 * radius_mm * math.sin(half)
    return NARROWEST * width_mm < width < WIDEST * width_mm and half < WIDEST_RAD


def _go_on(arc: _Arc, parents: list[_Arc], arcs: Array) -> None:
    """Count an arc clean: with its parent's rings, if it is the only child of an only parent."""
    alone = len(parents) == 1 and sum(parents[0].overlaps(b, e) for b, e in arcs) == 1
    arc.clean = parents[0].clean + 1 if alone else 1
    track = (*parents[0].track, arc.middle) if alone else (arc.middle,)
    arc.track = track[-CLEAN_RINGS:]


def _is_way_in(arc: _Arc, parents: list[_Arc], trail_rad: float | None) -> bool:
    """Whether an arc is the way in: the trail crosses it, or it hangs on the way in, not on the junction."""
    if parents and all(a.incoming and a.clean > 1 for a in parents):
        return True
    if trail_rad is None:
        return any(a.incoming for a in parents)
    return arc.overlaps(trail_rad, trail_rad)


def _leg_outward(view: View, centre: Array, radius: float, arc: _Arc) -> Leg | None:
    """Feel outward along an arc that three rings have seen; None if the line there is not clean after all."""
    radii = radius - view.step_mm * np.arange(CLEAN_RINGS - 1, -1, -1)
    places = centre + radii[:, None] * np.column_stack([np.cos(arc.track), np.sin(arc.track)])
    way = places[-1] - places[0]
    heading = math.atan2(way[1], way[0])
    view = view.like(places[-1], heading)
    seen = view.feel(places[0], heading, view.leg_mm)
    if len(seen) < FEWEST_STATIONS:
        seen = view.feel(places[-1], heading, view.leg_mm)
    # less may be the blunt end of a tip
    least = max(FEWEST_STATIONS, math.ceil(LEAST_WIDTHS * view.width_mm / view.step_mm))
    return leg_of(seen, False, view.leg_mm) if len(seen) >= least else None
