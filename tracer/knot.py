"""Knots: places where the cells do not see one clean line, and what the head makes of them.

Corners, crossings, junctions, touching lines, gaps and ends have this in common: near them the inks of several legs run together, and what a swinging
cell sees there is not the line. So the head looks at the legs where they are clean, further out, and concludes:

    incoming   the line felt forward from behind the axis until it is no longer clean: place, heading and bend at its last clean station
    legs       cells on rings about the knot: an arc of ink that is joined to the knot by ink, ring by ring, and has the line's width for three rings, is
               a leg; it is felt outward from there in the same way
    outgoing   the leg that goes on straightest
    vertex     where incoming and outgoing meet

All places are sheet mm; a ring's radius grows until legs are found.

Source: patent ES 361967, cell 102 senses an abrupt change of direction ahead of the follower; how it finds the way on is left to the two British patents
named there. Questions: everything else is our own, from first principles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tracer import photocell
from tracer.photocell import Cells

Array = NDArray[np.float64]
Meeting = tuple[float, float]  # how far two legs meet beyond the one's clean end and before the other's, mm

LEVEL = 0.5  # an edge is at this share of the line's darkness
LEG_MM = 1.2  # how much of a leg is felt for its direction, at a line of 0.5 mm
CORNER = math.radians(20)  # a line that turns less within a few stations is smooth
FARTHEST_MM = 5.0  # rings do not grow beyond this, or ten widths


@dataclass(frozen=True, slots=True)
class View:
    """What the head knows of the line it is on: the cells' picture, the line's width, and the darkness at an edge."""

    cells: Cells
    pitch_mm: float
    width_mm: float
    level: float
    usual_mm: float | None = None  # the line's width as a rule, where the width here differs

    @property
    def step_mm(self) -> float:
        """Distance of stations and rings."""
        return max(0.05, 0.6 * self.pitch_mm)

    @property
    def leg_mm(self) -> float:
        """How much of a leg is felt for its direction."""
        return max(LEG_MM, 12 * self.pitch_mm, 1.5 * self.width_mm)

    def feel(self, place: Array, heading: float, length_mm: float) -> Array:
        """Centres and widths (n, 3) of the line from a place on it along a heading, while it is clean."""
        stations = max(4, round(length_mm / self.step_mm) + 1)
        return photocell.scout(
            self.cells, self.pitch_mm, place, heading, self.step_mm, stations, self.width_mm, self.level
        )

    def like(self, place: Array, heading: float) -> View:
        """The view with the width and the darkness that the line has about a place, if they are like what they were: lines swell and fade."""
        way = np.array([math.cos(heading), math.sin(heading)])
        places = [place + k * self.step_mm * way for k in range(5)]
        ink = float(np.median([photocell.darkness_at(self.cells, self.pitch_mm, p[0], p[1]) for p in places]))
        level = LEVEL * min(max(ink, self.level), 4 * self.level)
        reach = 1.5 * self.width_mm + 2 * self.pitch_mm
        found = [photocell.edges(self.cells, self.pitch_mm, p[0], p[1], heading, reach, level) for p in places]
        width = float(np.median([left - right for right, left in found]))  # NaN if any has no edge
        usual = self.usual_mm or self.width_mm
        if not 0.5 < width / usual < 1.6:
            return self
        return replace(self, width_mm=width, level=level, usual_mm=usual + 0.1 * (width - usual))

    def dark(self, place: Array) -> bool:
        """Whether there is ink at a place."""
        return bool(photocell.darkness_at(self.cells, self.pitch_mm, place[0], place[1]) > self.level)


@dataclass(frozen=True, slots=True)
class Leg:
    """A clean stretch of line at a knot: `end_mm` is its clean end, the heading there and the bend are along the travel."""

    end_mm: Array
    heading_rad: float
    bend_per_mm: float
    width_mm: float
    seen: Array

    def at(self, along_mm: float | Array) -> Array:
        """Places (…, 2) at distances from the clean end along the travel (negative: before it)."""
        s = np.asarray(along_mm, float)[..., None]
        t = np.array([math.cos(self.heading_rad), math.sin(self.heading_rad)])
        return self.end_mm + s * t + 0.5 * self.bend_per_mm * s * s * np.array([-t[1], t[0]])

    def shifted(self, along_mm: float, seen: Array) -> Leg:
        """The same line from a place further along it, with what was felt from there."""
        return Leg(self.at(along_mm), self.heading_at(along_mm), self.bend_per_mm, self.width_mm, seen)

    def heading_at(self, along_mm: float) -> float:
        """Heading at a distance from the clean end, rad."""
        return self.heading_rad + math.atan(self.bend_per_mm * along_mm)


def leg_of(seen: Array, last: bool, length_mm: float) -> Leg:
    """Fit a leg to what was felt, (n, 3) in the order of travel; its clean end is towards the `last` station, or else the first.

    As long a stretch is taken as one parabola fits about as well as the nearest part of it.
    """
    seen = _without_blot(seen, last)
    end = seen[-1] if last else seen[0]
    away = np.hypot(*(seen[:, :2] - end[:2]).T)
    best, limit = _leg(seen[away <= 0.5 * length_mm], end, seen)
    for share in (0.75, 1.0):
        leg, misfit = _leg(seen[away <= share * length_mm], end, seen)
        if misfit > 1.3 * limit + 0.001:
            break
        best, limit = leg, misfit
    return best


def _without_blot(seen: Array, last: bool) -> Array:
    """The stations without those next to the knot whose width shows a little of its ink already: a third of them at most."""
    widths = seen[::-1, 2] if last else seen[:, 2]
    usual = float(np.median(widths))
    spread = 1.4826 * float(np.median(np.abs(widths - usual)))
    most = len(seen) // 3
    clean = np.abs(widths[: most + 1] - usual) < max(3 * spread, 0.03 * usual)
    first = int(np.argmax(clean)) if clean.any() else most
    first = min(first + 1, most)
    return seen[: len(seen) - first] if last else seen[first:]


def _leg(near: Array, end: Array, seen: Array) -> tuple[Leg, float]:
    """The leg through some stations, and their root mean square distance from it, mm."""
    chord = near[-1, :2] - near[0, :2]
    heading = math.atan2(chord[1], chord[0])
    t = np.array([math.cos(heading), math.sin(heading)])
    n = np.array([-t[1], t[0]])
    d = near[:, :2] - end[:2]
    (slope, offset, bend), misfit = _fit(d @ t, d @ n)
    place, width = end[:2] + offset * n, float(np.median(near[:, 2]))
    return Leg(place, heading + math.atan(slope), bend / (1 + slope * slope) ** 1.5, width, seen), misfit


@njit(cache=True)
def _fit(x, y):  # type: ignore[no-untyped-def]
    """(slope, offset, bend) at x = 0 of y(x), and the misfit; stations off by more than three times the usual are left out.

    Straight, unless a bend stands out fivefold of the uncertainty that independent stations would have: neighbours share their ink.
    """
    degree = 2 if len(x) >= 8 else min(1, len(x) - 1)
    found, unsure = _parabola(x, y, np.ones(len(x)), degree)
    for _ in range(2):
        away = np.abs(y - found[0] - found[1] * x - found[2] * x * x)
        good = away <= 3 * max(1.4826 * np.median(away), 0.001)
        if good.all() or good.sum() < 8:
            break
        x, y = x[good], y[good]
        found, unsure = _parabola(x, y, np.ones(len(x)), degree)
    rest = y - found[0] - found[1] * x - found[2] * x * x
    if degree == 2 and abs(found[2]) < 5 * unsure * math.sqrt(max(np.sum(rest * rest) / (len(x) - 3), 1e-7)):
        found, _ = _parabola(x, y, np.ones(len(x)), 1)
        rest = y - found[0] - found[1] * x
    return (found[1], found[0], 2 * found[2]), math.sqrt(np.mean(rest * rest))


@njit(cache=True)
def _parabola(x, y, weights, degree):  # type: ignore[no-untyped-def]
    """Coefficients of 1, x, x² of the weighted parabola (or straight line, or mean), and the last one's uncertainty per unit of noise in y."""
    n = degree + 1
    sums, right = np.zeros((n, n)), np.zeros(n)
    for k in range(len(x)):
        for i in range(n):
            right[i] += weights[k] * y[k] * x[k] ** i
            for j in range(n):
                sums[i, j] += weights[k] * x[k] ** (i + j)
    inverse = np.linalg.inv(sums + 1e-12 * np.eye(n))
    found = np.zeros(3)
    found[:n] = inverse @ right
    return found, math.sqrt(abs(inverse[n - 1, n - 1]))


def centre_at(seen: Array, i: int, half_mm: float) -> Leg:
    """The line about station i of what was felt: the parabola through the stations within `half_mm`, weighted towards the middle."""
    d = seen[:, :2] - seen[i, :2]
    near = np.flatnonzero(np.hypot(*d.T) < half_mm)
    chord = d[near[-1]] - d[near[0]]
    heading = math.atan2(chord[1], chord[0])
    t = np.array([math.cos(heading), math.sin(heading)])
    n = np.array([-t[1], t[0]])
    x, y = d[near] @ t, d[near] @ n
    offset, slope, bend = _parabola(x, y, np.maximum(1 - (x / half_mm) ** 2, 0.05), 2)[0]
    return Leg(
        seen[i, :2] + offset * n,
        heading + math.atan(slope),
        2 * bend / (1 + slope * slope) ** 1.5,
        float(np.median(seen[near, 2])),
        seen[i:],
    )


def corner_in(seen: Array, first: int) -> int | None:
    """The station, from `first` on, at which a line that was felt clean turns sharply; None if it does not.

    Chords of ten stations before and after, three stations away from it, differ most there, by more than `CORNER`.
    """
    n, skip = 10, 3
    places = seen[:, :2]
    middle = np.arange(max(first, n + skip), len(seen) - n - skip)
    if not len(middle):
        return None
    before = places[middle - skip] - places[middle - skip - n]
    after = places[middle + skip + n] - places[middle + skip]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turned = np.abs(np.arctan2(cross, np.sum(before * after, axis=1)))
    sharp = np.flatnonzero(turned > CORNER)
    if not len(sharp):
        return None
    run = sharp[: int(np.argmax(np.diff(np.r_[sharp, 10**9]) > 1)) + 1]
    return int(middle[run[np.argmax(turned[run])]])


def fork_in(view: View, seen: Array, first: int) -> int | None:
    """The station, from `first` on, from which ink goes straight on although the line that was felt bends away from it; None if there is none.

    Where the felt line has left the straight one by nearly a width, its own ink no longer reaches there: ink there is that of another leg.
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
        if all(view.dark(seen[i, :2] + share * t) for share in np.linspace(0, along + 0.8 * view.width_mm, 12)):
            return i
    return None


def turn(a: float, b: float) -> float:
    """Angle from heading a to heading b, -pi..pi."""
    return math.remainder(b - a, math.tau)


def meet(incoming: Leg, outgoing: Leg) -> Meeting | None:
    """Distances (beyond the incoming leg's end, before the outgoing leg's end) where their lines cross, mm; None if they do not."""
    s = u = 0.0
    for _ in range(6):
        a, b = incoming.heading_at(s), outgoing.heading_at(-u)
        cross = math.sin(turn(a, b))
        if abs(cross) < 0.02:
            return None
        gap = outgoing.at(-u) - incoming.at(s)
        ds = (gap[0] * math.sin(b) - gap[1] * math.cos(b)) / cross
        du = (gap[0] * math.sin(a) - gap[1] * math.cos(a)) / cross
        s, u = s + ds, u - du
        if max(abs(s), abs(u)) > 2 * FARTHEST_MM:
            return None
    return s, u


def reach_of_ink(view: View, incoming: Leg, farthest_mm: float) -> float | None:
    """How far the ink goes on from the incoming leg's end along its line, mm; None if farther than asked."""
    step = 0.35 * view.pitch_mm
    before = 1.0
    for k in range(int(farthest_mm / step)):
        place = incoming.at(k * step)
        now = photocell.darkness_at(view.cells, view.pitch_mm, place[0], place[1])
        if now < view.level:
            return max(0.0, (k - (view.level - now) / max(before - now, 1e-9)) * step)
        before = now
    return None


def legs_around(view: View, centre: Array, trail: Array) -> list[Leg]:
    """The clean legs that leave a knot, other than the one that the `trail` (n, 2), newest last, came in by."""
    farthest = max(FARTHEST_MM, 10 * view.width_mm)
    rings = np.arange(0.3 * view.width_mm, farthest, view.step_mm)
    trail_mm = np.hypot(*(trail - centre).T)
    joined: list[_Arc] = []
    found: list[Leg] = []
    found_at = math.inf
    for radius in rings:
        if radius > found_at + 0.5 * view.leg_mm:
            break
        arcs = photocell.ring(view.cells, view.pitch_mm, centre, radius, view.level)
        joined = _join(arcs, joined, radius, view.width_mm, _crossing(trail, trail_mm, centre, radius))
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
    """An arc of ink on a ring: where it begins and ends (rad), for how many rings it has been clean, whether it is the way in, or a leg already."""

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
        return abs(turn(self.middle, 0.5 * (begin + end))) < 0.5 * (self.end - self.begin + end - begin)


def _crossing(trail: Array, trail_mm: Array, centre: Array, radius: float) -> float | None:
    """Direction in which the trail crosses a ring, going back from its newest place; None if it does not reach so far."""
    beyond = np.flatnonzero(trail_mm >= radius)
    if not len(beyond):
        return None
    place = trail[beyond[-1]] - centre
    return math.atan2(place[1], place[0])


def _join(arcs: Array, inner: list[_Arc], radius: float, width_mm: float, back: float | None) -> list[_Arc]:
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
    return leg_of(seen, False, view.leg_mm) if len(seen) >= 4 else None


def end_of(view: View, incoming: Leg) -> float | None:
    """How far beyond a leg's clean end the pen was lifted, mm: half a width within the end of the ink; None if the ink goes on."""
    ink = reach_of_ink(view, incoming, 6 * view.width_mm + 2.0)
    return None if ink is None else ink - 0.5 * incoming.width_mm
