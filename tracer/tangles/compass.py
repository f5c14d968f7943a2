"""The compass: a small closed line as the way that keeps one distance from a core of a few points.

     · one point: a circle        ·───· two: a slot        ·   · more: a polygon, its corners rounded by
                                                           ·   · the distance, or sharp where that is 0

A closed line of a few widths leaves the head no clean leg to feel between two bends. So the pen's ink along
such a way (see `pen`) is held against the ink that is there, and core, distance and the pen's width are moved
until the two differ least. Of all cores that one is taken which explains the ink with the fewest figures.

Signals: the ink about a closed line in; its way (n, 2) mm out, and how much ink it leaves unexplained (see
`seen_ink`).

Source: our own; a draughtsman draws a hole by a compass, not by hand. Questions: a ring of another shape,
such as a letter, is explained by none of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import cv2
import numpy as np

from morfax.motion import arrays
from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.plane import NOTHING_MM2, left_of, unit
from morfax.motion.polyline import area_mm2, between_corners
from morfax.tracer.drawing.components import INK
from morfax.tracer.tangles import pen
from morfax.tracer.tangles.least_squares import fitted
from morfax.tracer.tangles.seen_ink import PRICE, STEPS, SeenInk, best_of

SHARP = (3, 4, 5, 6)  # corners of the polygons that are tried
ROUNDED = (1, 2, 3, 4)  # points of the cores that are tried
CORE, ROUNDING = 0.6, 0.4  # of half a shape, as a rounded polygon begins
# for each width of the way's length: what a core leaves to begin with, at most; of 58 that settled on the ink
# of a loop the worst left 0.21
BEGIN = 0.3
MOST_SETTLED = 5  # of the cores, those that explain most to begin with
# 1 - cosine of the corner: sides that meet at 45 degrees are drawn in no further
SHARPEST = 0.3
ARC_RAD = math.radians(2.0)  # between the places of an arc: they lie within 1 um of one of 6 mm


class Core(NamedTuple):
    """The points (m, 2) of a core, the distance that the way keeps from it, half the pen's width; mm."""

    points_mm: Array
    radius_mm: float
    half_mm: float
    misfit: float = math.inf

    @property
    def cost(self) -> float:
        """The misfit, and the price of the figures that it takes."""
        return self.misfit + PRICE * self.figures

    @property
    def figures(self) -> int:
        """How many figures it takes."""
        return self.points_mm.size + (self.radius_mm > 0)

    @property
    def length_mm(self) -> float:
        """The length of the way."""
        round_mm = math.tau * self.radius_mm
        if len(self.points_mm) == 1:
            return round_mm
        steps = self.points_mm - np.roll(self.points_mm, 1, axis=0)
        return round_mm + float(np.hypot(*steps.T).sum())

    @property
    def is_convex(self) -> bool:
        """Whether the core turns one way only: the way keeps its distance from no other all along."""
        sides = np.roll(self.points_mm, -1, axis=0) - self.points_mm
        after = np.roll(sides, -1, axis=0)
        turns = sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]
        return len(sides) < 3 or bool(np.all(turns > 0) or np.all(turns < 0))

    def stretches(self) -> list[Array]:
        """The way, counter-clockwise from the middle of a side: stretches (n, 2) mm between sharp corners."""
        points = self.points_mm
        points = points if len(points) < 3 or area_mm2(points) > 0 else points[::-1]
        way = np.vstack(list(self._arcs(points))) if self.radius_mm > 0 else points
        if len(points) > 1:
            middle = 0.5 * (way[:1] + way[-1:])
            way = np.vstack([middle, way, middle])
        return [way] if self.radius_mm > 0 else between_corners(way)

    def _arcs(self, points: Array) -> Iterator[Array]:
        """The arc (n, 2) mm about each point of the core, counter-clockwise."""
        # 1. the heading of the side to each point, and how far the way turns there
        steps = points - np.roll(points, 1, axis=0)
        headings = np.arctan2(steps[:, 1], steps[:, 0])
        turns = (np.roll(headings, -1) - headings) % math.tau if len(points) > 1 else [math.tau]
        # 2. places on the arcs
        for point, heading, turned in zip(points, headings, turns, strict=True):
            share = np.linspace(0.0, 1.0, 2 + math.ceil(turned / ARC_RAD))
            normal = heading - 0.5 * math.pi + share * turned
            yield point + self.radius_mm * np.column_stack([np.cos(normal), np.sin(normal)])


def explained(ink: SeenInk) -> Core | None:
    """The core that explains a ring's ink best with few figures; None for ink of which none can be begun."""
    starts = [with_misfit(ink, start) for start in _starts(ink)]
    near = [start for start in starts if start.misfit < BEGIN * start.length_mm / ink.width_mm]
    likely = sorted(near, key=lambda core: core.cost)[:MOST_SETTLED]
    return best_of(ink, sorted(likely, key=lambda core: core.figures), _settled)


def filled_misfit(ink: SeenInk, core: Core) -> float:
    """How much the same shape filled with ink leaves unexplained."""
    drawn = np.empty(len(ink.places_mm))
    _ink(ink.places_mm, *core[:3], ink.softness_mm, True, drawn)
    return ink.misfit(drawn)


def with_misfit(ink: SeenInk, core: Core) -> Core:
    """A core with its misfit."""
    drawn = np.empty(len(ink.places_mm))
    _ink(ink.places_mm, *core[:3], ink.softness_mm, False, drawn)
    return core._replace(misfit=ink.misfit(drawn))


def _settled(ink: SeenInk, start: Core) -> Core | None:
    """A core moved to where the pen leaves the ink that is there; None if the pen becomes another, or the way
    runs off that ink, or turns back and forth.
    """
    count, is_sharp = len(start.points_mm), start.radius_mm == 0
    drawn = np.empty(len(ink.places_mm))

    def core_of(figures: Array) -> Core:
        radius_mm = 0.0 if is_sharp else abs(float(figures[2 * count]))
        return Core(figures[: 2 * count].reshape(-1, 2), radius_mm, float(figures[-1]))

    def wrong(figures: Array) -> Array:
        _ink(ink.places_mm, *core_of(figures)[:3], ink.softness_mm, False, drawn)
        return drawn - ink.darkness

    def changes(figures: Array) -> Array:
        out = np.empty((len(drawn), len(figures)))
        _changes(ink.places_mm, *core_of(figures)[:3], ink.softness_mm, out)
        out[:, 2 * count : -1] *= np.sign(figures[2 * count : -1])  # of a radius below 0
        return out

    figures = np.r_[start.points_mm.ravel(), [] if is_sharp else start.radius_mm, start.half_mm]
    core = core_of(fitted(wrong, figures, STEPS * len(figures), changes))
    is_pen = 0.5 * ink.half_mm < core.half_mm < 2 * ink.half_mm
    is_loop = is_pen and core.is_convex and ink.holds(np.vstack(core.stretches()))
    return with_misfit(ink, core) if is_loop else None


def _starts(ink: SeenInk) -> Iterator[Core]:
    """Cores to begin with, by the outline of the ink."""
    dark = ink.without_specks(ink.darkness > INK)
    if len(dark) < max(SHARP):
        return
    middle = dark.mean(axis=0)
    hull = cv2.convexHull((dark - middle).astype(np.float32))[:, 0].astype(float)
    for points in ROUNDED[:2]:
        core = _slot(hull, points, ink.half_mm)
        yield core._replace(points_mm=core.points_mm + middle)
    for points in SHARP:
        polygon = _within(_reduced(hull, points), ink.half_mm)
        yield Core(middle + polygon, 0.0, ink.half_mm)
        if points in ROUNDED:
            radius_mm = ROUNDING * float(np.hypot(*polygon.T).min())
            yield Core(middle + CORE * polygon, radius_mm, ink.half_mm)


def _slot(hull: Array, points: int, half_mm: float) -> Core:
    """A circle or a slot that is as long and as wide as the ink, whose hull (n, 2) is given."""
    corners = cv2.boxPoints(cv2.minAreaRect(hull.astype(np.float32))).astype(float)
    middle, sides = corners.mean(axis=0), np.diff(corners[:3], axis=0)
    across_mm, along_mm = np.sort(np.hypot(*sides.T)) - 2 * half_mm
    if points == 1:
        return Core(middle[None], 0.25 * (along_mm + across_mm), half_mm)
    along = sides[int(np.argmax(np.hypot(*sides.T)))]
    reach_mm = max(0.5 * (along_mm - across_mm), 0.1 * half_mm)
    reach = reach_mm * along / float(np.hypot(*along))
    return Core(
        np.array([middle - reach, middle + reach]), 0.5 * max(across_mm, half_mm), half_mm
    )


def _reduced(hull: Array, corners: int) -> Array:
    """A convex polygon with so many corners: of those of a hull the one is left out that matters least."""
    while len(hull) > corners:
        before, after = np.roll(hull, 1, axis=0) - hull, np.roll(hull, -1, axis=0) - hull
        matters = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        hull = np.delete(hull, int(np.argmin(matters)), axis=0)
    return hull


def _within(polygon: Array, half_mm: float) -> Array:
    """A convex polygon (n, 2) with its sides half a width further in."""
    polygon = polygon if area_mm2(polygon) > 0 else polygon[::-1]
    ahead = np.roll(polygon, -1, axis=0) - polygon
    inward = unit(left_of(ahead))
    before = np.roll(inward, 1, axis=0)
    spread = np.maximum(1 + np.sum(inward * before, axis=1), SHARPEST)
    return np.asarray(polygon + half_mm * (inward + before) / spread[:, None])


@njit(cache=True)
def _ink(places, points, radius_mm, half_mm, softness_mm, is_filled, out):  # type: ignore[no-untyped-def]
    """Darkness (n,) that a pen leaves at places (n, 2) along the way at a radius from points (m, 2), and
    within it if it is filled.
    """
    sides = _sides(points)
    for k in range(len(places)):
        from_core_mm, _, _ = _from_core(places[k, 0], places[k, 1], points, sides)
        away_mm = from_core_mm - radius_mm
        away_mm = away_mm if is_filled else abs(away_mm)
        out[k] = pen.ink_at(away_mm, half_mm, softness_mm)


@njit(cache=True)
def _changes(places, points, radius_mm, half_mm, softness_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` (n, f) with by how much each coordinate of the points, the radius, if there is a column for
    it, and half the pen's width darken the places, per mm (see `moved_way`).
    """
    sides, last = _sides(points), out.shape[1] - 1
    for k in range(len(places)):
        x, y = places[k, 0], places[k, 1]
        from_core_mm, i, share = _from_core(x, y, points, sides)
        away_mm = from_core_mm - radius_mm
        fades = pen.fades_at(abs(away_mm), half_mm, softness_mm)
        out[k, :] = 0.0
        out[k, last] = fades
        # the way comes nearer as the radius grows, or the core comes nearer, to a place outside of it
        by = math.copysign(fades, away_mm)
        if last > 2 * len(points):
            out[k, last - 1] = by
        if fades == 0.0 or abs(from_core_mm) < NOT_ZERO:
            continue
        j = (i + 1) % len(points)
        dx = by * (x - points[i, 0] - share * sides[i, 0]) / from_core_mm
        dy = by * (y - points[i, 1] - share * sides[i, 1]) / from_core_mm
        out[k, 2 * i] += (1 - share) * dx
        out[k, 2 * i + 1] += (1 - share) * dy
        out[k, 2 * j] += share * dx
        out[k, 2 * j + 1] += share * dy


@njit(cache=True)
def _sides(points):  # type: ignore[no-untyped-def]
    """The sides of a polygon (m, 2) from each point to the next: x, y and the square of the length (m, 3)."""
    sides = np.empty((len(points), 3))
    for i in range(len(points)):
        j = (i + 1) % len(points)
        vx, vy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
        sides[i, 0], sides[i, 1], sides[i, 2] = vx, vy, vx * vx + vy * vy + NOTHING_MM2
    return sides


@njit(cache=True)
def _from_core(x, y, points, sides):  # type: ignore[no-untyped-def]
    """Distance of a place from a point, a stretch or a polygon (m, 2) with its sides, negative within a
    polygon; the nearest side, and at which share of it.

    The root is taken only of squares that are, but for rounding, the least so far: it takes longest.
    """
    inside, best, best2, side, share = False, math.inf, math.inf, 0, 0.0
    for i in range(len(points)):
        vx, vy = sides[i, 0], sides[i, 1]
        wx, wy = x - points[i, 0], y - points[i, 1]
        t = min(max((wx * vx + wy * vy) / sides[i, 2], 0.0), 1.0)
        ax, ay = wx - t * vx, wy - t * vy
        square = ax * ax + ay * ay
        if square <= best2:
            away_mm = math.hypot(ax, ay)
            if away_mm < best:
                best, side, share = away_mm, i, t
            best2 = square * (1 + arrays.ROUNDED)
        j = (i + 1) % len(points)
        if (points[i, 1] > y) != (points[j, 1] > y) and x < points[i, 0] + wy * vx / vy:
            inside = not inside
    return -best if inside else best, side, share
