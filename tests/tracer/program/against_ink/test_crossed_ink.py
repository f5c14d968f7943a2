"""A closed way that crosses itself where all is ink is told; one that goes round paper there is not.

Broken on purpose, with every loop taken for inked, the eye of a written loop is told; with none, nothing is.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm, with_places
from morfax.tracer.following.line import Line
from morfax.tracer.program.against_ink.crossed_ink import crossed_in_ink
from tests.tracer.inked import WIDTH_MM, inked, polyline

NEAR, TIP, FAR = (
    (14.0, 10.0),
    (14.2, 6.5),
    (14.4, 10.0),
)  # a spike's sides at its mouth, and its tip
REST = [(30.0, 10.0), (30.0, 20.0), (5.0, 20.0), (5.0, 10.0)]


def closed(*places: tuple[float, float]) -> Line:
    """A closed line over some places."""
    way: Array = with_places(polyline(*places, places[0]), 0.002)
    return Line(way, "closed", WIDTH_MM, length_mm(way))


def test_sides_of_a_spike_that_are_exchanged_are_told_and_its_outline_is_not() -> None:
    outline = closed(NEAR, TIP, FAR, *REST)
    drawing = inked(outline.xy_mm, seed=1)
    assert not list(crossed_in_ink(drawing, [outline]))
    exchanged = closed((14.4, 9.9), TIP, (14.0, 9.9), *REST)
    ((x, y), long_mm), *more = crossed_in_ink(drawing, [exchanged])
    assert not more and np.hypot(x - 14.2, y - 10.0) < WIDTH_MM
    assert 6.0 < long_mm < 8.0  # down the spike and up again


def test_the_eye_of_a_loop_that_was_drawn_is_paper() -> None:
    eye = [(14.6, 10.0), (13.4, 6.0), (15.0, 6.0), (13.8, 10.0)]
    line = closed(*eye, *REST[::-1])
    assert not list(crossed_in_ink(inked(line.xy_mm, seed=1), [line]))
