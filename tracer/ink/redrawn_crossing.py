"""A redrawn crossing: which of four legs are one line, and over which vertices, by the ink between them.

Signals: the legs of a crossing as they come in, by how much a way turns from each to each other, and how the
head sees one of their lines, in; pairs of legs and the vertices (n, 2) mm between them out.

    ══════╦══════       a stroke turns within another's ink: each leg meets two others or three, and which of
         ╱ ╲            them it goes on in is told by the ink that a pen on these ways leaves (see
        ╱   ╲           `tangles.sketch`)

Where the ink tells little, the legs tell more: a vertex deep in another line's ink may lie anywhere, and each
leg's own line leads to it. So ways by the legs alone go before others that explain the ink about as well.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

from morfax.motion.arrays import Array
from morfax.tracer.ink.partners import CORNERED, Pair, is_corner
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.between_legs import tangle_between
from morfax.tracer.tangles.redrawing import CLEAR, NONE, Redrawing, matchings
from morfax.tracer.tangles.sketch import Sketch, redrawings

# A misfit, in squares of the line's width; by trial on bent strokes with others across their corners:
AS_WELL = 0.035  # one explains the ink as well as another: a little more than a vertex costs


def redrawn(view: View, legs: Sequence[Leg], turnings: Array) -> Mapping[Pair, Array]:
    """The vertices (n, 2) mm from the first to the second leg of each pair; none if the ink about the legs
    does not end in them, or no redrawing explains it.
    """
    tangle = tangle_between(view, legs)
    if tangle is None:
        return {}
    sketch = Sketch.of(view, tangle)
    by_legs, freely = list(_by_legs(sketch, legs, turnings)), redrawings(sketch)
    least = min([*by_legs, *freely], key=lambda way: way.cost)
    if least.misfit > CLEAR or least.strokes:
        return {}
    # the straightest of those that explain the ink about as well, by the legs alone before any other
    ranked = [(_turned(way, turnings), way) for way in by_legs]
    ranked += [(_turned(way, turnings, freely=True), way) for way in freely]
    as_good = [(turned, way) for turned, way in ranked if way.cost < least.cost + AS_WELL]
    _, best = min(as_good, key=lambda one: one[0])
    return dict(zip(best.pairs, best.vertices, strict=True))


def _turned(way: Redrawing, turnings: Array, *, freely: bool = False) -> float:
    """By how much the strands of a redrawing turn, rad²; one that turns anywhere as if at a corner."""
    turned_rad = [
        CORNERED if freely and len(vertices) else min(turnings[pair], CORNERED)
        for pair, vertices in zip(way.pairs, way.vertices, strict=True)
    ]
    return sum(turned**2 for turned in turned_rad)


def _by_legs(sketch: Sketch, legs: Sequence[Leg], turnings: Array) -> Iterator[Redrawing]:
    """For each way to join the legs what these alone tell, smooth or with a vertex where two of them meet."""
    for pairs in matchings(len(legs)):
        joints = [_joints(legs, pair, turnings[pair]) for pair in pairs]
        every = [sketch.settled(Redrawing(pairs, joint), 0) for joint in product(*joints)]
        if every:
            # two legs that meet at an angle have a corner there, as far as the ink tells
            yield min(every, key=lambda way: way.misfit)


def _joints(legs: Sequence[Leg], pair: Pair, turning: float) -> list[Array]:
    """The vertices (n, 2) mm over which a way may go from one leg to another, by these two alone."""
    one, other = legs[pair[0]], legs[pair[1]]
    corner, joints = Corner.of(one, other.turned_round()), list[Array]()
    if corner is not None and is_corner(corner, one.width_mm):
        joints.append(corner.vertex_mm[None])
    if turning < CORNERED:
        joints.append(NONE)
    return joints
