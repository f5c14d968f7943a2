"""Lines cut down ramps and over tabs: height, speed and slope along them."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.feed import run_along
from morfax.motion.motion import MOTION_RATE_HZ, join
from morfax.motion.polyline import lengths_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Work
from morfax.tracer.program.program import Trace

UM = 1e-3
SPEED_MM_S = 10.0
NODE_MM = 0.05  # between the places of a line here
RADIUS_MM = 20.0


def line(places: list[tuple[float, float]] | Array, ending: str = "closed") -> Line:
    """A line as a head runs it that makes no error."""
    way = with_places(np.asarray(places, float), NODE_MM)
    xy_mm = run_along(way, SPEED_MM_S, 500.0)
    return Line(xy_mm, ending, 0.5, float(lengths_mm(xy_mm)[-1]))


def circle(radius_mm: float = RADIUS_MM, centre_mm: tuple[float, float] = (0, 0)) -> Line:
    angles = np.linspace(0, 2 * math.pi, max(90, int(2 * math.pi * radius_mm / NODE_MM)))
    return line(
        np.asarray(centre_mm) + radius_mm * np.column_stack([np.cos(angles), np.sin(angles)])
    )


def cut(work: Work, *lines: Line) -> Array:
    """X, Y, Z of a program, (n, 3) mm; nothing in it leaps."""
    positions_mm = join(Trace(lines, Operator(work))).positions_mm
    steps = np.abs(np.diff(positions_mm, axis=0)) * MOTION_RATE_HZ
    in_work = positions_mm[1:, 2] < work.clearance_mm - 1 * UM
    assert np.hypot(*steps[in_work, :2].T).max() < 1.02 * SPEED_MM_S
    assert steps[:, 2].max() < 1.02 * work.feed_mm_s
    return positions_mm


def slopes(positions_mm: Array) -> Array:
    """Z to the way of X and Y, of the steps in which both move; where X and Y hardly move it is not felt."""
    steps = np.diff(positions_mm, axis=0)
    across = np.hypot(*steps[:, :2].T)
    felt = (across > 0.1 * UM) & (np.abs(steps[:, 2]) > 1e-9)
    return steps[felt, 2] / across[felt]


def at_depth(positions_mm: Array, depth_mm: float) -> Array:
    return positions_mm[np.abs(positions_mm[:, 2] + depth_mm) < 1e-9, :2]
