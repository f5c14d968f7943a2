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
from dataclasses import replace
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
LEGS = 4


def redrawn(view: View, legs: Sequence[Leg], turnings: Array) -> Mapping[Pair, Array]:
    """The vertices (n, 2) mm from the first to the second leg of each pair; none if the ink about four legs
    does not end in them, or no redrawing explains it.
    """
    from morfax.tracer.tangles.sketch import Sketch, redrawings
    from morfax.tracer.tangles.tangle import tangle_ahead

    tangle = tangle_ahead(view, legs[0])
    numbers = _numbers(tangle.legs, legs, view.width_mm) if tangle.whole else []
    if sorted(numbers) != list(range(LEGS)):
        return {}
    # 1. the crossing's legs are felt further than the tangle's, and tell their lines better
    own = [legs[0], *(legs[n].turned_round() for n in numbers[1:])]
    sketch = Sketch.of(view, replace(tangle, legs=own))
    plans = _by_legs(sketch, own, turnings[np.ix_(numbers, numbers)])
    # 2. held against the ink, with those that may turn anywhere
    freely = redrawings(sketch)[0]
    least = min([freely, *plans], key=lambda way: way.cost)
    if least.misfit > CLEAR or freely.strokes:
        return {}
    best = next((way for way in plans if way.cost < least.cost + AS_WELL), freely)
    found = dict[Pair, Array]()
    for (a, b), vertices in zip(best.pairs, best.vertices, strict=True):
        one, other = numbers[a], numbers[b]
        found[min(one, other), max(one, other)] = vertices if one < other else vertices[::-1]
    return found


def _numbers(found: Sequence[Leg], legs: Sequence[Leg], width_mm: float) -> list[int]:
    """Which of a crossing's legs each of a tangle's is, the first of both being the same; -1 for none."""
    from morfax.tracer.tangles.strands import same_line

    numbers = [0]
    for leg in found[1:]:
        same = (
            n for n in range(1, len(legs)) if same_line(leg, legs[n].turned_round(), width_mm)
        )
        numbers.append(next(same, -1))
    return numbers


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
    one, other = (legs[n] if n == 0 else legs[n].turned_round() for n in pair)
    out, joints = other.turned_round(), list[Array]()
    corner = Corner.of(one, out)
    if corner is not None and is_corner(corner, one.width_mm):
        joints.append(corner.vertex_mm[None])
    if turning < CORNERED:
        joints.append(np.empty((0, 2)))
    return joints
