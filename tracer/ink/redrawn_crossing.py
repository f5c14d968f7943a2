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

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.ink.partners import CORNERED, Pair, is_corner
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View

if TYPE_CHECKING:
    from morfax.tracer.tangles.redrawing import Redrawing
    from morfax.tracer.tangles.sketch import Sketch

# Misfits, in squares of the line's width; by trial on bent strokes with others across their corners.
CLEAR = 0.25  # up to which a redrawing explains the ink
AS_WELL = 0.035  # one explains the ink as well as another: a little more than a vertex costs
LEGS = 4  # there are three ways to join them


def redrawn(view: View, legs: Sequence[Leg], turnings: Array) -> Mapping[Pair, Array]:
    """The vertices (n, 2) mm from the first to the second leg of each pair; none if the ink about the legs
    does not end in them, or no redrawing explains it.
    """
    from morfax.tracer.tangles.between_legs import tangle_between
    from morfax.tracer.tangles.sketch import Sketch, redrawings

    tangle = tangle_between(view, legs)
    if tangle is None:
        return {}
    sketch = Sketch.of(view, tangle)
    plans, freely = _by_legs(sketch, legs, turnings), redrawings(sketch)[0]
    least = min([freely, *plans], key=lambda way: way.cost)
    if least.misfit > CLEAR or freely.strokes:
        return {}
    best = next((way for way in plans if way.cost < least.cost + AS_WELL), freely)
    return dict(zip(best.pairs, best.vertices, strict=True))


def _by_legs(sketch: Sketch, legs: Sequence[Leg], turnings: Array) -> list[Redrawing]:
    """The ways that the legs alone tell, smooth or with a vertex where two meet; the straightest first."""
    from morfax.tracer.tangles.redrawing import Redrawing, matchings

    plans = list[tuple[float, Redrawing]]()
    for pairs in matchings(len(legs)):
        joints = [_joints(legs, pair, turnings[pair]) for pair in pairs]
        every = [sketch.settled(Redrawing(pairs, joint), 0) for joint in product(*joints)]
        if every:
            turned = sum(min(turnings[pair], CORNERED) ** 2 for pair in pairs)
            # two legs that meet at an angle have a corner there, as far as the ink tells
            plans.append((turned, min(every, key=lambda way: way.misfit)))
    return [way for _, way in sorted(plans, key=lambda plan: plan[0])]


def _joints(legs: Sequence[Leg], pair: Pair, turning: float) -> list[Array]:
    """The vertices (n, 2) mm over which a way may go from one leg to another, by these two alone."""
    one, other = legs[pair[0]], legs[pair[1]]
    corner, joints = Corner.of(one, other.turned_round()), list[Array]()
    if corner is not None and is_corner(corner, one.width_mm):
        joints.append(corner.vertex_mm[None])
    if turning < CORNERED:
        joints.append(np.empty((0, 2)))
    return joints
