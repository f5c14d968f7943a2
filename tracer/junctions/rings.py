"""Knots: places where the cells do not see one clean line, and what the head makes of them.

Corners, crossings, junctions, touching lines, gaps and ends have this in common: near them the inks of
several legs run together, and what a swinging cell sees there is not the line. So the head looks at the legs
where they are clean, further out, and concludes:

    incoming   the line felt forward from behind the axis until it is no longer clean: place, heading and bend at its last clean station
    legs       cells on rings about the knot: an arc of ink that is joined to the knot by ink, ring by ring, and has the line's width for three rings, is
               a leg; it is felt outward from there in the same way
    outgoing   the leg that goes on straightest
    vertex     where incoming and outgoing meet

All places are sheet mm; a ring's radius grows until legs are found.

Source: patent ES 361967, cell 102 senses an abrupt change of direction ahead of the follower; how it finds
the way on is left to the two British patents named there. Questions: everything else is our own, from first
principles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg, leg_of, turn
from morfax.tracer.sensing.view import View

CORNER = math.radians(20)  # a line that turns less within a few stations is smooth
LEAST_WIDTHS = 0.8  # of clean line make a leg
FARTHEST_MM = 5.0  # rings do not grow beyond this, or ten widths


def corner_in(seen: Array, first: int) -> int | None:
    """The station, from `first` on, at which a line that was felt clean turns sharply; None if it does not.

    Chords of seven stations before and after, three stations away from it, differ more there than anywhere
    within seven stations, by more than `CORNER`. The line's last stations lean towards what ended it.
    """
    n, skip, lean = 7, 3, 3
    places = seen[:, :2]
    middle = np.arange(max(first, n + skip), len(seen) - n - skip - lean)
    if not len(middle):
        return None
    before = places[middle - skip] - places[middle - skip - n]
    after = places[middle + skip + n] - places[middle + skip]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = np.abs(np.arctan2(cross, np.sum(before * after, axis=1)))
    sharp = np.flatnonzero((turned > CORNER) & (turned == maximum_filter1d(turned, 2 * n + 1)))
    return int(middle[sharp[0]]) if len(sharp) else None


def fork_in(view: View, seen: Array, first: int) -> int | None:
    """The station, from `first` on, from which ink goes straight on although the line that was felt bends
    away from it; None if there is none.

    Where the felt line has left the straight one by nearly a width, its own ink no longer reaches there: ink
    there is that of another leg.
    """
    back = 6
    for i in range(max(first, back), len(seen) - 4, 4):
        way = seen[i, :2] - seen[i - back, :2]
        t = way / np.hypot(*way)
        d = seen[i:, :2] - seen[i, :2]
        aside = np.abs(d[:, 1] * t[0] - d[:, 0] * t[1])
        away = np.flatnonzero(aside > 0.9 * view.width_mm)
        if not len(away):
            break
        along = float(d[away[0]] @ t)
        if all(
            view.dark(seen[i, :2] + share * t)
            for share in np.linspace(0, along + 0.8 * view.width_mm, 12)
        ):
            return i
    return None


def legs_around(view: View, centre: Array, trail: Array) -> list[Leg]:
    """The clean legs that leave a knot, other than the one that the `trail` (n, 2), newest last, came in by."""
    farthest = max(FARTHEST_MM, 10 * view.width_mm)
    rings = np.arange(0.3 * view.width_mm, farthest, view.step_mm)
    trail = _up_to(trail, centre)
    trail_mm = np.hypot(*(trail - centre).T)
    joined: list[_Arc] = []
    found: list[Leg] = []
    found_at = math.inf
    for radius in rings:
        if radius > found_at + 0.5 * view.leg_mm:
            break
        arcs = view.ring(centre, radius)
        joined = _join(
            arcs, joined, radius, view.width_mm, _crossing(trail, trail_mm, centre, radius)
        )
        if not joined:
            break
        for arc in joined:
            if arc.clean >= 3 and not arc.incoming and not arc.found:
                leg = _leg_outward(view, centre, radius, arc)
                if leg is not None:
                    found.append(leg)
                    arc.found = True
        if found and found_at == math.inf:
            found_at = radius
        if found and any(not a.found and not a.incoming for a in joined):
            found_at = radius  # some ink is still undecided: look further
    return found


@dataclass(slots=True)
class _Arc:
    """An arc of ink on a ring: where it begins and ends (rad), for how many rings it has been clean, whether
    it is the way in, or a leg already.
    """

    begin: float
    end: float
    clean: int
    incoming: bool
    found: bool
    track: tuple[float, ...]

    @property
    def middle(self) -> float:
        return 0.5 * (self.begin + self.end)

    def overlaps(self, begin: float, end: float) -> bool:
        return abs(turn(self.middle, 0.5 * (begin + end))) < 0.5 * (
            self.end - self.begin + end - begin
        )


def _up_to(trail: Array, centre: Array) -> Array:
    """The trail without its newest places beyond a centre that lies on it: there it came in from behind, and
    not from where it ends.
    """
    back_mm = np.r_[0.0, np.cumsum(np.hypot(*np.diff(trail[::-1], axis=0).T))]
    newest = trail[::-1][back_mm <= 2 * math.dist(trail[-1], centre)]
    return trail[: len(trail) - int(np.argmin(np.hypot(*(newest - centre).T)))]


def _crossing(trail: Array, trail_mm: Array, centre: Array, radius: float) -> float | None:
    """Direction in which the trail crosses a ring, going back from its newest place; None if it does not
    reach so far.
    """
    beyond = np.flatnonzero(trail_mm >= radius)
    if not len(beyond):
        return None
    place = trail[beyond[-1]] - centre
    return math.atan2(place[1], place[0])


def _join(
    arcs: Array, inner: list[_Arc], radius: float, width_mm: float, back: float | None
) -> list[_Arc]:
    """The arcs of a ring that are joined by ink to those of the ring within it."""
    out = []
    for begin, end in arcs:
        parents = [a for a in inner if a.overlaps(begin, end)]
        if inner and not parents:
            continue
        arc = _Arc(begin, end, 0, False, any(a.found for a in parents), ())
        if back is not None:
            arc.incoming = arc.overlaps(back, back)
        else:
            arc.incoming = any(a.incoming for a in parents)
        if parents and all(a.incoming and a.clean > 1 for a in parents):
            arc.incoming = True  # it hangs on the way in, not on the knot
        half = min(0.5 * (end - begin), 0.5 * math.pi)
        width = 2 * radius * math.sin(half)
        alone = len(parents) == 1 and sum(parents[0].overlaps(b, e) for b, e in arcs) == 1
        if 0.5 * width_mm < width < 1.45 * width_mm and half < 1.2:
            arc.clean = parents[0].clean + 1 if alone else 1
            arc.track = ((*parents[0].track, arc.middle) if alone else (arc.middle,))[-3:]
        out.append(arc)
    return out


def _leg_outward(view: View, centre: Array, radius: float, arc: _Arc) -> Leg | None:
    """Feel outward along an arc that three rings have seen; None if the line there is not clean after all."""
    radii = radius - view.step_mm * np.arange(2, -1, -1)
    places = centre + radii[:, None] * np.column_stack([np.cos(arc.track), np.sin(arc.track)])
    way = places[-1] - places[0]
    heading = math.atan2(way[1], way[0])
    view = view.like(places[-1], heading)
    seen = view.feel(places[0], heading, view.leg_mm)
    if len(seen) < 4:
        seen = view.feel(places[-1], heading, view.leg_mm)
    least = max(
        4, math.ceil(LEAST_WIDTHS * view.width_mm / view.step_mm)
    )  # less may be the blunt end of a tip
    return leg_of(seen, False, view.leg_mm) if len(seen) >= least else None
