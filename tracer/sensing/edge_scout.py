"""The edge scout: feels along the edge of a filled shape with a cell that goes in circles.

Signals: a pose near the edge in; stations of the edge (n, 3: x and y, mm, and the size
of the fundamental) out.

A cell goes once round a place, on a circle of radius r. Half of the circle is dark when its middle is on the
edge; the fundamental points into the shape, and its size tells how steep the edge is:

    mean  = 1/N · sum D(phase)                    aside = (mean - 1/2) · r / |first|, along the fundamental
    first = 2/N · sum D(phase)·(cos, sin)         the edge runs square to it

The circle is moved until its mean is a half, and goes on along the edge by a step. So the scout goes round
corners as the lens shows them, however sharp they are.

Source: our own; tracers of flame cutters have cells that go in circles, too. Questions: none gives a radius.
Chosen by trial: 0.8 pixels, at which the fundamental is the steepest for its noise.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.compiled import njit
from morfax.tracer.sensing.photocell import TWO_PI, darkness_at

CIRCLE_PX = 0.8  # radius
CIRCLE_SAMPLES = 12
BALANCED = 0.5  # of the circle is dark on the edge
TRIES = 3  # circles at a station: each is nearer to the edge than the one before
FARTHEST_PX = 0.5  # by which a circle is moved at once
# size of a fundamental that still is an edge: four times that of a scan's noise
FAINTEST = 0.04
CERTAIN = 0.1  # size of one that shows the way
# of a step: what comes less far on is none, and what comes as much too far is two
SHORTEST = 0.3
LONGEST = 2 - SHORTEST
TURNS = 0.5  # cosine: a step turns less than 60 degrees
TURN_SAMPLES = 36  # all round


@njit(cache=True, _nrt=False)
def circle(cells, x_mm, y_mm):  # type: ignore[no-untyped-def]
    """Mean, and fundamental along X and Y, of what a cell sees once round a place."""
    radius = CIRCLE_PX * cells.pitch_mm
    mean = first_x = first_y = 0.0
    for k in range(CIRCLE_SAMPLES):
        a = TWO_PI * (k + 0.5) / CIRCLE_SAMPLES
        c, s = math.cos(a), math.sin(a)
        seen = darkness_at(cells, x_mm + radius * c, y_mm + radius * s)
        mean += seen / CIRCLE_SAMPLES
        first_x += 2.0 * seen * c / CIRCLE_SAMPLES
        first_y += 2.0 * seen * s / CIRCLE_SAMPLES
    return mean, first_x, first_y


@njit(cache=True, _nrt=False)
def onto_edge(cells, x_mm, y_mm):  # type: ignore[no-untyped-def]
    """The place on the edge next to a place, the unit vector into the shape, and the size of the fundamental.

    NaN without an edge.
    """
    farthest = FARTHEST_PX * cells.pitch_mm
    inward_x = inward_y = size = math.nan
    for _ in range(TRIES):
        mean, first_x, first_y = circle(cells, x_mm, y_mm)
        size = math.hypot(first_x, first_y)
        if size < FAINTEST:
            return math.nan, math.nan, math.nan, math.nan, size
        inward_x, inward_y = first_x / size, first_y / size
        aside = (BALANCED - mean) * CIRCLE_PX * cells.pitch_mm / size
        aside = min(max(aside, -farthest), farthest)
        x_mm += aside * inward_x
        y_mm += aside * inward_y
    return x_mm, y_mm, inward_x, inward_y, size


@njit(cache=True, _nrt=False)
def _round_about(cells, pose, side, step_mm):  # type: ignore[no-untyped-def]
    """The next place of an edge a step on from a pose, found on a circle of that radius.

    From behind round through the shape, which is to a side (1 left, -1 right). NaN without shape and paper on
    it.
    """
    x_mm, y_mm, heading = pose
    behind, before = heading + math.pi, math.nan
    for k in range(1, TURN_SAMPLES):
        a = behind - side * TWO_PI * k / TURN_SAMPLES
        seen = darkness_at(cells, x_mm + step_mm * math.cos(a), y_mm + step_mm * math.sin(a))
        if before >= BALANCED > seen:
            a += side * TWO_PI / TURN_SAMPLES * (BALANCED - seen) / (before - seen)
            return x_mm + step_mm * math.cos(a), y_mm + step_mm * math.sin(a)
        before = seen
    return math.nan, math.nan


@njit(cache=True)
def along_edge(cells, pose, step_mm, stations):  # type: ignore[no-untyped-def]
    """Feel along an edge from a pose (x mm, y mm, heading rad) near it, while there is one: (n, 3).

    The shape stays on the side on which it is at the beginning. At a tip so thin that the circle sees both of
    its sides, the next place is looked for all round.
    """
    seen = np.empty((stations, 3))
    x, y, heading = pose
    x, y, inward_x, inward_y, size = onto_edge(cells, x, y)
    side = 1.0 if -math.sin(heading) * inward_x + math.cos(heading) * inward_y > 0 else -1.0
    way_x, way_y = side * inward_y, -side * inward_x
    for k in range(stations):
        if math.isnan(x):
            return seen[:k].copy()
        seen[k, 0], seen[k, 1], seen[k, 2] = x, y, size
        # 1. by a step along the edge as the circle shows it: the shape is a quarter turn to its side
        next_x, next_y, inward_x, inward_y, size = onto_edge(
            cells, x + step_mm * way_x, y + step_mm * way_y
        )
        on_x, on_y = side * inward_y, -side * inward_x
        dx, dy = next_x - x, next_y - y
        come_mm = math.hypot(dx, dy)
        turned = on_x * way_x + on_y * way_y
        is_near = SHORTEST * step_mm < come_mm < LONGEST * step_mm
        if not (size > CERTAIN and is_near and turned > TURNS and dx * way_x + dy * way_y > 0):
            # 2. or all round
            stands = (x, y, math.atan2(way_y, way_x))
            next_x, next_y = _round_about(cells, stands, side, step_mm)
            on_x = (next_x - x) / step_mm
            on_y = (next_y - y) / step_mm
        x, y, way_x, way_y = next_x, next_y, on_x, on_y
    return seen
