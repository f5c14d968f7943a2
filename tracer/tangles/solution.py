"""Unravelling a tangle: by which leg, and over which vertices, the head's own line leaves it.

Signals: a tangle, the incoming leg, the trail, and what was planned by the legs alone in; stretches and the
outgoing leg out.

Source: our own (see `pairing`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.trail import Trail
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import Leg, goes_straight, turn
from morfax.tracer.tangles.redrawing import NONE, VERTEX, Sketch, Way, ways
from morfax.tracer.tangles.strands import as_drawn, aside_mm, same_line, stretches_over

CLEAR = 0.25  # misfit up to which a way explains the ink
LEAST_CLEAR, BETTER = (
    1.0,
    0.25,
)  # up to this for two legs far apart, if it is so much better than the plan
FEW = 2.5  # vertices: no more for that, if the plan leads there too
TWICE, LEAST_MISFIT = (
    2.0,
    0.02,
)  # one way explains the ink as well as another: so many times its misfit, and more
DOUBTFUL = 0.08  # straight on stands unless the ink tells against it by more
AS_GOOD = 0.05  # misfit of a plan that needs no other to be compared with
WELL_MM2 = 0.015  # area of wrong ink in a way that explains all of it
BLOT_VERTICES, BLOT_WIDTHS = (
    4.5,
    4.0,
)  # a way with more vertices that reaches no farther, and leaves ink, is a scribble
ROUGH_WIDTHS = 0.6  # to and fro within the line's own ink: that is rough
MARK_AS_GOOD = 1.3  # times the misfit of a way: a tick in its place explains the ink as well
CROSSES_RAD = math.radians(25)  # a line that bends less goes straight on


def unravelled(
    sketch: Sketch,
    incoming: Leg,
    trail: Trail,
    way_in: tuple[Array, float],
    plan: Plan | None,
    rank: int,
) -> tuple[Plan | None, Way | None, list[Leg]]:
    """The way out of a tangle, the way in which its ink is drawn then, None if no way explains it, and the
    legs of others that would do as well.
    """
    view, tangle = sketch.view, sketch.tangle
    drawn = [] if plan is None else as_drawn(plan, tangle, view.width_mm)
    planned = math.inf if plan is None else sketch.misfit_with(Way((), ()), drawn)
    two = len(tangle.legs) == 2
    if (
        plan is not None
        and two
        and planned < AS_GOOD
        and same_line(plan.leg, tangle.legs[1], view.width_mm)
    ):
        return plan, Way(((0, 1),), (NONE,)), []
    every = ways(sketch)
    if _partner(every[0]) is None:
        return plan, None, []  # the line ends here, on another
    clear = max(CLEAR, min(BETTER * planned, LEAST_CLEAR)) if two else CLEAR
    best = _by_leg(sketch, every, trail, plan, clear)
    if not best:
        return plan, None, []
    leg, straight = next(iter(best)), False
    if plan is not None and goes_straight(incoming, plan.leg) and not two:
        for k, way in best.items():
            if same_line(plan.leg, tangle.legs[k], view.width_mm) and _as_good(way, best[leg]):
                leg, straight = k, aside_mm(_own(way), plan.stretches) < view.width_mm
                break
    others = [k for k in best if k != leg]
    if rank and others:
        leg, straight = others[min(rank, len(others)) - 1], False
    way = best[leg]
    as_good = (
        [tangle.legs[k] for k in others if _as_good(best[k], way)]
        if _bends(sketch, way)
        else []
    )
    direct = Plan(stretches_over(way_in, incoming, NONE, tangle.legs[leg]), tangle.legs[leg])
    if any(_is_rough(way, line, view.width_mm) for line in (plan, direct)):
        return plan or direct, way, as_good
    if straight or (
        plan is not None
        and same_line(plan.leg, tangle.legs[leg], view.width_mm)
        and _stands(sketch, way, plan, drawn)
    ):
        return plan, way, as_good
    return (
        Plan(stretches_over(way_in, incoming, _own(way), tangle.legs[leg]), tangle.legs[leg]),
        way,
        as_good,
    )


def _by_leg(
    sketch: Sketch, every: list[Way], trail: Trail, plan: Plan | None, clear: float
) -> dict[int, Way]:
    """The best way to each leg that has not been followed, the best first, of those that explain the ink."""
    view, legs = sketch.view, sketch.tangle.legs
    best: dict[int, Way] = {}
    for way in every:
        leg = _partner(way)
        if leg is None or trail.holds(legs[leg], view.width_mm):
            continue
        there = plan is not None and same_line(plan.leg, legs[leg], view.width_mm)
        if way.misfit < (CLEAR if there and way.cost - way.misfit > FEW * VERTEX else clear):
            best.setdefault(leg, way)
    return best


def _stands(sketch: Sketch, way: Way, plan: Plan, drawn: list[Array]) -> bool:
    """Whether a plan that leads where the best way does explains the ink as well, but for a mark beside it."""
    planned = sketch.misfit_with(_without_own(way), drawn)
    if planned < way.misfit + VERTEX * (1 + len(_own(way))):
        return True
    return goes_straight(sketch.tangle.legs[0], plan.leg) and _is_mark(sketch, way, plan)


def _is_rough(way: Way, line: Plan | None, width_mm: float) -> bool:
    """Whether a way only goes to and fro within the ink of a line, and leaves some unexplained all the same:
    its edges are rough.
    """
    own = _own(way)
    if line is None or len(own) < 2 or way.misfit < WELL_MM2 / width_mm**2:
        return False
    return aside_mm(own, line.stretches) < ROUGH_WIDTHS * width_mm


def _bends(sketch: Sketch, way: Way) -> bool:
    """Whether no strand of a way goes straight on: lines that do are lines that cross, or that another
    touches.
    """
    headings = sketch.poses[:, 2]
    return all(
        abs(turn(headings[a], headings[b] + math.pi)) > CROSSES_RAD for a, b in way.pairs
    )


def _as_good(way: Way, other: Way) -> bool:
    """Whether a way explains the ink about as well as another."""
    return way.cost < other.cost + DOUBTFUL and way.misfit < TWICE * other.misfit + LEAST_MISFIT


def _is_mark(sketch: Sketch, way: Way, plan: Plan) -> bool:
    """Whether what a way draws beside the straight one may be a mark or a blot: no longer than a mark, and no
    stroke of the line explains it better.
    """
    width_mm = sketch.view.width_mm
    beside_mm = aside_mm(_own(way), plan.stretches)
    if beside_mm >= longest_mm(sketch.view):
        return False
    if way.misfit > CLEAR:
        return True
    scribble = (
        way.misfit > WELL_MM2 / width_mm**2 and way.cost - way.misfit > BLOT_VERTICES * VERTEX
    )
    if scribble and beside_mm < BLOT_WIDTHS * width_mm:
        return True
    bare = Way(way.pairs, tuple(NONE for _ in way.pairs))
    marked = sketch.improved(bare, marks_only=True)
    tips = [*_own(way), *(stroke[1] for stroke in marked.strokes)]
    ticks = [np.array(two) for two in combinations(tips, 2)] + list(marked.strokes[:1])
    ticked = min(
        (sketch.settled(replace(bare, strokes=(tick,))).misfit for tick in ticks),
        default=math.inf,
    )
    if ticked < MARK_AS_GOOD * way.misfit + LEAST_MISFIT:
        return True
    if beside_mm < width_mm:
        return marked.misfit < TWICE * way.misfit
    return marked.misfit < way.misfit and marked.cost < way.cost


def _without_own(way: Way) -> Way:
    """The way without the strand of the incoming leg."""
    others = [
        (pair, v) for pair, v in zip(way.pairs, way.vertices, strict=True) if pair[0] != 0
    ]
    return Way(tuple(pair for pair, _ in others), tuple(v for _, v in others), way.strokes)


def _partner(way: Way) -> int | None:
    """The leg with which the incoming one is joined."""
    return next((b for a, b in way.pairs if a == 0), None)


def _own(way: Way) -> Array:
    """The vertices of the incoming leg's strand."""
    return next(v for (a, _), v in zip(way.pairs, way.vertices, strict=True) if a == 0)
