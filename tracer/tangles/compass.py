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

from morfax.motion.arrays import Array
from morfax.motion.plane import left_of, unit
from morfax.motion.polyline import area_mm2, between_corners
from morfax.tracer.drawing.components import INK
from morfax.tracer.tangles import core_ink
from morfax.tracer.tangles.figured import Figured
from morfax.tracer.tangles.least_squares import fitted
from morfax.tracer.tangles.seen_ink import PRICE, STEPS, SeenInk, best_of

SHARP = (3, 4, 5, 6)  # corners of the polygons that are tried
ROUNDED = (1, 2, 3, 4)  # points of the cores that are tried
CORE = 0.6  # of half a shape, as a rounded polygon begins; the rest is its rounding
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
    return ink.misfit(_drawn(ink, core, is_filled=True))


def with_misfit(ink: SeenInk, core: Core) -> Core:
    """A core with its misfit."""
    return core._replace(misfit=ink.misfit(_drawn(ink, core)))


def _drawn(ink: SeenInk, core: Core, *, is_filled: bool = False) -> Array:
    """Darkness (n,) that a pen leaves along a core's way, and within it if it is filled."""
    drawn = np.empty(len(ink.places_mm))
    core_ink.ink(ink.places_mm, tuple(core[:3]), ink.softness_mm, is_filled, drawn)
    return drawn


def _settled(ink: SeenInk, start: Core) -> Core | None:
    """A core moved to where the pen leaves the ink that is there; None if the pen becomes another, or the way
    runs off that ink, or turns back and forth.
    """
    count, radius = start.points_mm.size, [start.radius_mm] if start.radius_mm > 0 else []
    figures = np.r_[start.points_mm.ravel(), radius, start.half_mm]
    found = fitted(Figured.core(), ink.for_kernel(), figures, STEPS * len(figures))
    radius_mm = abs(float(found[count])) if radius else 0.0
    core = Core(found[:count].reshape(-1, 2), radius_mm, float(found[-1]))
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
            radius_mm = (1 - CORE) * float(np.hypot(*polygon.T).min())
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
