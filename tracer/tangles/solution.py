"""The solution of a tangle: by which leg, and over which vertices, the head's own line leaves it.

A plan by the legs alone stands where it explains the ink as well as the best redrawing; else the head goes
over that redrawing's vertices.

Signals: the sketch of a tangle and the head's approach to it in; a plan, the redrawing that explains the ink,
and other legs that would do as well, out.

Source: our own (see `sketch`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.trail import Trail
from morfax.tracer.limits import LONGER_WIDTHS, TIP_RAD
from morfax.tracer.marks.marks import longest_mm
from morfax.tracer.sensing.leg import TURNS_BACK, TURNS_OFF, Leg, goes_straight, turn
from morfax.tracer.tangles.likeness import Patch, Pen
from morfax.tracer.tangles.redrawing import CLEAR, NONE, Redrawing
from morfax.tracer.tangles.sketch import Sketch, redrawings
from morfax.tracer.tangles.strands import as_drawn, aside_mm, same_line, stretches_over
from morfax.tracer.tangles.uncrossed import uncrossed

# Misfits, unless said otherwise; chosen by trial on the test drawings.
# a way between two legs far apart may leave this, if it is better than the plan by such a share
LEAST_CLEAR, BETTER = 1.0, 0.25
FEW = 2.5  # vertices: no more for that, if the plan leads there too
# one explains the ink as well as another: so many times its misfit, and more
TWICE, LEAST_MISFIT = 2.0, 0.02
DOUBTFUL = 0.08  # straight on stands unless the ink tells against it by more
GRAINY = 3.0  # times as much as the line beside it leaves unexplained: that is its grain
LEG_WIDTHS = np.linspace(-0.2, 2.2, 13)  # from a leg's end, where it is looked at for that
SLACK = 0.005  # misfit that noise makes up for, if there is little of it
WELL_MM2 = 0.015  # area of wrong ink in a redrawing that explains all of it
# more vertices that reach no farther, and leave ink, are a scribble
BLOT_VERTICES = 4.5
ROUGH_WIDTHS = 0.6  # to and fro within the line's own ink: that is rough
# times the misfit of a redrawing: a tick in its place explains the ink as well
MARK_AS_GOOD = 1.3


class Approach(NamedTuple):
    """How the head comes to a tangle: the incoming leg, its trail, where it stands, and the plan by the legs.

    `rank` 1 asks for the second best way out, 2 for the third; `number` is the tangle's among the junctions.
    """

    incoming: Leg
    trail: Trail
    stands: tuple[Array, float]
    plan: Plan | None
    number: int = 0
    rank: int = 0

    def over(self, vertices: Array, leg: Leg) -> Plan:
        """The plan by some vertices to a leg."""
        way = stretches_over(self.stands, self.incoming, vertices, leg)
        return Plan(way, leg, leader=REDRAWN)


class Solution(NamedTuple):
    """A plan, the redrawing that explains the ink with it (or None), and other legs that would do as well."""

    plan: Plan | None
    redrawing: Redrawing | None = None
    others: Sequence[Leg] = ()


def unravelled(sketch: Sketch, approach: Approach) -> Solution:
    """The way out of a tangle."""
    plan, legs = approach.plan, sketch.tangle.legs
    # 1. a plan between two legs that explains the ink needs no other
    planned = _planned_misfit(sketch, plan)
    if len(legs) == 2 and planned < LEAST_MISFIT and _leads_to(sketch, plan, 1):
        return Solution(plan, Redrawing(((0, 1),), (NONE,)))
    # 2. the best redrawing by each leg, of those that explain the ink
    best = _by_leg(sketch, approach, planned)
    if not best or (_runs_back(legs) and next(iter(best.values())).misfit > planned):
        return Solution(plan)
    # 3. one of them, and those that would do as well
    leg, straight = _taken(sketch, best, approach)
    way, others = uncrossed(sketch, best[leg], SLACK), _others(sketch, best, leg)
    # 4. the plan, if it explains the ink as well
    direct = approach.over(NONE, legs[leg])
    if any(_is_rough(sketch, way, line) for line in (plan, direct)):
        return Solution(plan or direct, way, others)
    if straight or (_leads_to(sketch, plan, leg) and _stands(sketch, way, plan)):
        return Solution(plan, way, others)
    return Solution(approach.over(way.own, legs[leg]), way, others)


def _runs_back(legs: list[Leg]) -> bool:
    """Whether the only two legs lie beside each other: their inks run together and show little of a tip."""
    return len(legs) == 2 and abs(turn(legs[0].heading_rad, legs[1].heading_rad)) > TURNS_BACK


def _planned_misfit(sketch: Sketch, plan: Plan | None) -> float:
    """The misfit of a plan by itself; infinite if there is no plan."""
    if plan is None:
        return math.inf
    return sketch.misfit_with(Redrawing((), ()), as_drawn(plan, sketch.tangle, _width(sketch)))


def _others(sketch: Sketch, best: dict[int, Redrawing], leg: int) -> list[Leg]:
    """The legs but the one that is taken whose redrawings would do as well."""
    if not _bends(sketch, best[leg]):
        return []
    as_good = [k for k in best if k != leg and _is_as_good(best[k], best[leg])]
    return [sketch.tangle.legs[k] for k in as_good]


def _width(sketch: Sketch) -> float:
    """Width of the head's line, mm."""
    return sketch.view.width_mm


def _leads_to(sketch: Sketch, plan: Plan | None, leg: int) -> bool:
    """Whether a plan leads to a leg of the tangle."""
    return plan is not None and same_line(plan.leg, sketch.tangle.legs[leg], _width(sketch))


def _by_leg(sketch: Sketch, approach: Approach, planned: float) -> dict[int, Redrawing]:
    """The best redrawing to each leg that has not been followed, the best first, if it explains the ink.

    None if the line ends here, on another; `planned` is the misfit of the plan.
    """
    every, best = redrawings(sketch), dict[int, Redrawing]()
    if every[0].partner is None:
        return best
    clear = CLEAR
    if len(sketch.tangle.legs) == 2:
        clear = max(CLEAR, min(BETTER * planned, LEAST_CLEAR))
    for way in every:
        leg = way.partner
        if leg is None or _is_spent(sketch, approach.trail, leg):
            continue
        laboured = way.effort > FEW * sketch.vertex and _leads_to(sketch, approach.plan, leg)
        if way.misfit < (CLEAR if laboured else clear):
            best.setdefault(leg, way)
    return best


def _is_spent(sketch: Sketch, trail: Trail, leg: int) -> bool:
    """Whether a leg has been followed; the only other one of a corner may be that on which the head began."""
    out, width_mm = sketch.tangle.legs[leg], _width(sketch)
    only = len(sketch.tangle.legs) == 2
    return trail.holds(out, width_mm) and not (only and trail.began_on(out, width_mm))


def _taken(sketch: Sketch, best: dict[int, Redrawing], approach: Approach) -> tuple[int, bool]:
    """The leg to take, and whether the plan goes there straight, past what the redrawing has beside it."""
    plan, leg = approach.plan, next(iter(best))
    others = [k for k in best if k != leg]
    straight = False
    # 1. straight on, if that explains the ink as well
    if plan is not None and len(sketch.tangle.legs) != 2:
        for k, way in best.items() if goes_straight(approach.incoming, plan.leg) else ():
            if _leads_to(sketch, plan, k) and _is_as_good(way, best[leg]):
                straight = aside_mm(way.own, plan.stretches) < _width(sketch)
                leg, others = k, [other for other in best if other != k]
                break
    # 2. another, if that is asked for
    if approach.rank and others:
        return others[min(approach.rank, len(others)) - 1], False
    return leg, straight


def _stands(sketch: Sketch, way: Redrawing, plan: Plan | None) -> bool:
    """Whether a plan that leads where a redrawing does explains the ink as well, but for a mark beside it."""
    if plan is None:
        return False
    drawn = as_drawn(plan, sketch.tangle, _width(sketch))
    planned = sketch.misfit_with(way.without_own(), drawn)
    straight = goes_straight(sketch.tangle.legs[0], plan.leg)
    grain = 0.0
    if len(sketch.tangle.legs) == 2 and _is_gentle(sketch, way):
        grain = min(_grain(sketch), way.misfit)  # no redrawing explains grain
    # 1. a corner or a step of two legs: only its vertices are in question, and only noise and the line's
    # grain excuse more; a blot leaves more unexplained than the line beside it
    if grain > 0.0 and way.misfit < GRAINY * grain + SLACK:
        if planned < max(TWICE * way.misfit, GRAINY * grain) + SLACK:
            return True
        return straight and _leads_to(sketch, plan, 0) and _is_mark(sketch, way, plan, SLACK)
    # 2. any other
    if planned < way.misfit + sketch.vertex * (1 + len(way.own)):
        return True
    return straight and _is_mark(sketch, way, plan, LEAST_MISFIT)


def _grain(sketch: Sketch) -> float:
    """What the tangle would leave unexplained if its ink were as like the pen's as that of its legs is."""
    width_mm, grain = _width(sketch), list[float]()
    for k, leg in enumerate(sketch.tangle.legs):
        along = width_mm * (LEG_WIDTHS if k else -LEG_WIDTHS)
        middle = leg.at(float(along[len(along) // 2]))
        pen = Pen.of(sketch.view, leg)
        grain.append(Patch.about(sketch.view, middle, width_mm, pen).misfit(leg.at(along)))
    return min(grain) * sketch.tangle.area_mm2 / width_mm**2


def _is_gentle(sketch: Sketch, way: Redrawing) -> bool:
    """Whether a strand between two legs turns back on itself nowhere."""
    ends = sketch.poses[:, :2]
    steps = np.diff(np.vstack([ends[:1], way.own, ends[1:2]]), axis=0)
    headings = [
        sketch.poses[0, 2],
        *np.arctan2(steps[:, 1], steps[:, 0]),
        sketch.poses[1, 2] + math.pi,
    ]
    return all(abs(turn(a, b)) < TIP_RAD for a, b in pairwise(headings))


def _is_rough(sketch: Sketch, way: Redrawing, line: Plan | None) -> bool:
    """Whether a redrawing goes to and fro within a line's ink, and leaves some all the same: rough edges.

    The line explains most of the ink then; a step of the line leaves more of it.
    """
    width_mm = _width(sketch)
    if line is None or len(way.own) < 2 or way.misfit < WELL_MM2 / width_mm**2:
        return False
    within = aside_mm(way.own, line.stretches) < ROUGH_WIDTHS * width_mm
    return within and _planned_misfit(sketch, line) < CLEAR


def _bends(sketch: Sketch, way: Redrawing) -> bool:
    """Whether no strand goes straight on: lines that do are lines that cross, or that another touches."""
    headings = sketch.poses[:, 2]
    return all(abs(turn(headings[a], headings[b] + math.pi)) > TURNS_OFF for a, b in way.pairs)


def _is_as_good(way: Redrawing, other: Redrawing) -> bool:
    """Whether a redrawing explains the ink about as well as another."""
    like = way.misfit < TWICE * other.misfit + LEAST_MISFIT
    return like and way.cost < other.cost + DOUBTFUL


def _is_mark(sketch: Sketch, way: Redrawing, plan: Plan, slack: float) -> bool:
    """Whether what is drawn beside a straight plan may be a mark or a blot.

    It is no longer than a mark, the plan lies on ink, and no stroke of the line explains it better.
    `slack`: what a tick may leave unexplained beyond that.
    """
    beside_mm = aside_mm(way.own, plan.stretches)
    if beside_mm >= longest_mm(sketch.view):
        return False
    if (sketch.view.darkness_along(np.vstack(plan.stretches)) < sketch.view.level).any():
        return False
    if way.misfit > CLEAR or _is_scribble(sketch, way, beside_mm):
        return True
    bare = Redrawing(way.pairs, tuple(NONE for _ in way.pairs))
    marked = sketch.improved(bare, marks_only=True)
    if _ticked(sketch, way, marked, bare) < MARK_AS_GOOD * way.misfit + slack:
        return True
    if beside_mm < _width(sketch):
        return marked.misfit < TWICE * way.misfit
    return marked.misfit < way.misfit and marked.cost < way.cost


def _is_scribble(sketch: Sketch, way: Redrawing, beside_mm: float) -> bool:
    """Whether a redrawing has many vertices that reach nowhere, and leaves ink all the same."""
    width_mm = _width(sketch)
    laboured = (
        way.effort > BLOT_VERTICES * sketch.vertex and way.misfit > WELL_MM2 / width_mm**2
    )
    return laboured and beside_mm < LONGER_WIDTHS * width_mm


def _ticked(sketch: Sketch, way: Redrawing, marked: Redrawing, bare: Redrawing) -> float:
    """Misfit of the bare legs and one tick, between any two tips of what is drawn beside them."""
    tips = [*way.own, *(stroke[1] for stroke in marked.strokes)]
    ticks = [np.array(two) for two in combinations(tips, 2)] + list(marked.strokes[:1])
    misfits = [sketch.settled(replace(bare, strokes=(tick,))).misfit for tick in ticks]
    return min(misfits, default=math.inf)
