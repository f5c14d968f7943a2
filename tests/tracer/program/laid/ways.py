"""Lines as a head would have run along them, apart from any drawing."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import shapely

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import evenly, length_mm
from morfax.motion.usual import FEED_MM_S, THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL, Led
from tests.tracer.inked import WIDTH_MM, Points

STEP_MM = FEED_MM_S / MOTION_RATE_HZ  # from position to position


def run_along(way: Points, ending: str = "closed", **more: Any) -> Line:
    """The line of a head that ran along a way (n, 2) mm at its own speed, led by its cell."""
    xy_mm = evenly(way, STEP_MM)
    xy_mm = xy_mm[: len(xy_mm) // THINNED * THINNED]  # up to one of its thinned places
    led = more.pop("led", Led.along(np.full(len(xy_mm), CELL, np.int8)))
    return Line(xy_mm, ending, WIDTH_MM, length_mm(xy_mm), led=led, **more)


def circle(x: float, y: float, radius_mm: float) -> Points:
    """A circle."""
    angles = np.linspace(0, math.tau, 361)
    return np.column_stack([x + radius_mm * np.cos(angles), y + radius_mm * np.sin(angles)])


def off_mm(line: Line, truth: Points) -> float:
    """How far a closed line is from a true one, or that from it."""
    return float(shapely.LinearRing(line.loop_mm).hausdorff_distance(shapely.LineString(truth)))


def steps_mm(line: Line) -> Points:
    """How far it is from each position of a line to the next, mm."""
    return np.asarray(np.hypot(*np.diff(line.xy_mm, axis=0).T))


def turned(places: Points, by_rad: float) -> Points:
    """Places (n, 2) mm turned, on a sheet."""
    cosine, sine = np.cos(by_rad), np.sin(by_rad)
    there = places @ np.array([[cosine, sine], [-sine, cosine]])
    return np.asarray(there - there.min(axis=0) + 4)
