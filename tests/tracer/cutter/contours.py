"""Closed lines that are cut, level by level."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import at_lengths, lengths_mm
from morfax.tracer.cutter.along_lines import contoured
from morfax.tracer.cutter.contouring import Contouring
from morfax.tracer.cutter.cutter import Cutter, with_cutter
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace

FEED_MM_S = 10.0
STEP_MM = 10.0 / 6000  # of a head at 10 mm/s
ON_LINE_MM = 0.002  # a step of the head, and a position between two of them


def positions(places: Any) -> Array:
    """Positions of a head that runs along places at 10 mm/s, (n, 2) mm."""
    way = np.array(places, float)
    length = lengths_mm(way)[-1]
    return at_lengths(way, np.linspace(0.0, length, round(length / STEP_MM) + 1))


def closed(places: Any, number: int = 1, **drawn: Any) -> Line:
    """A closed line through some places, as the head followed it."""
    xy_mm = positions([*places, places[0]])
    return Line(xy_mm, "closed", 0.5, float(lengths_mm(xy_mm)[-1]), number=number, **drawn)


def square(half_mm: float, x_mm: float = 0.0, y_mm: float = 0.0) -> list[tuple[float, float]]:
    """Corners of a square about a place, counter-clockwise; it begins in the middle of its lower side."""
    low, high = -half_mm, half_mm
    round_about = [(0.0, low), (high, low), (high, high), (low, high), (low, low)]
    return [(x + x_mm, y + y_mm) for x, y in round_about]


def circle(radius_mm: float, x_mm: float = 0.0, y_mm: float = 0.0) -> list[tuple[float, float]]:
    """Places of a circle, counter-clockwise, 1 um true."""
    count = max(90, math.ceil(math.pi / math.sqrt(2e-3 / radius_mm)))
    angles = np.linspace(0, 2 * math.pi, count, endpoint=False)
    return [(x_mm + radius_mm * math.cos(a), y_mm + radius_mm * math.sin(a)) for a in angles]


def cut(trace: Trace, contouring: Contouring, cutter: Cutter | None) -> Trace:
    """The lines contoured, with or without a cutter."""
    if cutter is None:
        return contoured(trace, contouring, FEED_MM_S)
    return with_cutter(trace, cutter, FEED_MM_S, contouring)[0]


def loop(line: Line) -> Array:
    """The closed part of a line, without its leads, (n, 2) mm."""
    return line.xy_mm[line.first : line.last + 1]


LEVELS = Trace(
    (
        closed(
            square(10)[::-1], 3
        ),  # an island in a hole of a plate, each followed its own way
        closed(square(20), 2),
        closed(square(30), 1),
    )
)
