"""Uncrossed: a redrawing whose strand crosses itself is held against that which does not.

    ───╮ ╭───      at the mouth of a spike whose two sides share their ink the pen may have come by the near
       ╲ ╱         side or by the far one: the ink is the same but for the corners of the mouth, and the
        V          outline of a part does not cross itself there

Signals: the sketch of a tangle and a redrawing of it in; that redrawing or the other one out.

Source: our own. Questions: a loop of a line that was written crosses itself; the other way round it has two
sharp corners more, which the ink tells.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.crossings import crossings_of
from morfax.motion.plane import NOTHING_MM2, cross, direction, meeting
from morfax.tracer.tangles.redrawing import Redrawing
from morfax.tracer.tangles.sketch import Sketch


def uncrossed(sketch: Sketch, way: Redrawing, slack: float) -> Redrawing:
    """A redrawing over the vertices of its own strand the other way round, if only so that does not cross
    itself, and explains the ink as well: it may cost more by no more than some slack.
    """
    strand = next(k for k, (leg, _) in enumerate(way.pairs) if leg == 0)
    if not _crosses_itself(sketch, way, strand):
        return way
    turned = _onto_legs(sketch, way.pairs[strand], way.own[::-1])
    other = sketch.settled(way.with_strand(strand, turned))
    is_as_good = other.cost < way.cost + slack
    return other if is_as_good and not _crosses_itself(sketch, other, strand) else way


def _crosses_itself(sketch: Sketch, way: Redrawing, strand: int) -> bool:
    """Whether a strand crosses itself, straight from the end of the one leg to that of the other."""
    first, last = sketch.poses[list(way.pairs[strand]), :2]
    places = np.vstack([first, way.vertices[strand], last])
    return len(crossings_of(places, np.arange(len(places) - 1))) > 0


def _onto_legs(sketch: Sketch, legs: tuple[int, int], vertices: Array) -> Array:
    """Vertices (n, 2), the first and the last where the sides beyond them meet the legs."""
    found = vertices.copy()
    for leg, end, beyond in ((legs[0], 0, 1), (legs[1], -1, -2)):
        place, along = sketch.poses[leg, :2], direction(sketch.poses[leg, 2])
        side = vertices[end] - vertices[beyond]
        if abs(cross(along, side)) > NOTHING_MM2:
            found[end] = meeting(place, along, vertices[beyond], side)
    return found
