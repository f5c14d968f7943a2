"""The rule ahead: how a line goes on over corners so near to one another that none of its sides is a leg.

    ──╮  ╭─╮  ╭─╮  ╭──     teeth with sides of a width or two: where the head is, on a side, it feels no clean
      │  │ │  │ │  │       line as long as its legs, and the wave through the ink comes to none within its
      ╰──╯ ╰──╯ ╰──╯       reach

The wave shows that the ink is one line, which neither ends nor forks. So a folding rule is laid along its way
to a place at which the ink is as broad as the line, and the head runs over the corners of that, to the middle
of the longest side; where there is another it is not the last, which ends where the ink was cut.

Signals: a view and the leg by which the head comes in; the way on, or None, out.

Source: our own (see `wavefront` and `folding_rule`).
"""

from __future__ import annotations

import math
from itertools import groupby

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import direction, heading_of
from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.effort import LOOKED_MM
from morfax.tracer.head.course import ahead_mm, along_leg, onto
from morfax.tracer.head.leaders import REDRAWN
from morfax.tracer.head.plan import Plan
from morfax.tracer.junctions.rings import farthest_mm
from morfax.tracer.junctions.width_change import STEP
from morfax.tracer.limits import ABOUT_WIDTHS
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import distances, folding_rule
from morfax.tracer.tangles.folding_rule import Rule
from morfax.tracer.tangles.redrawing import NONE
from morfax.tracer.tangles.seen_ink import SURE, SeenInk
from morfax.tracer.tangles.solution import TWICE, Approach
from morfax.tracer.tangles.tangle import CLEAN_FRONTS, LEAST_BROAD, MOST_BROAD, ink_of
from morfax.tracer.tangles.wavefront import Fronts, fronts_from

# for each width of its length, as misfit: a right rule leaves less; by trial on teeth at 200 to 600 dpi, of
# which those that were looked at left 0.001 to 0.012
LEFT = 0.014
CLEAN = 2  # fronts one after the other as broad as the line: there a rule may end; by trial


def rule_ahead(view: View, approach: Approach, softness_mm: float) -> Plan | None:
    """The way on over corners whose sides are no legs; None if the ink ends or forks before it is as broad as
    the line again, if no rule explains it, or if the plan does.

    `softness_mm` is the lens's.
    """
    incoming, plan = approach.incoming, approach.plan
    reach_mm = farthest_mm(view)
    behind_mm = _behind(approach, reach_mm)
    fronts = fronts_from(view, incoming.end_mm, incoming.heading_rad, reach_mm, behind_mm)
    for last in _lasts(view, fronts):
        way = np.vstack([incoming.end_mm, fronts.way_to(last)])
        ink = _ink(view, fronts, last, behind_mm, softness_mm)
        most = LEFT * length_mm(way) / view.width_mm
        if plan is not None and ink.misfit_along(_planned(plan)) < TWICE * most:
            return None
        rule = _explained(ink, way, TWICE * most)
        if rule is not None and most <= rule.misfit < TWICE * most:
            rule = _with_free_end(ink, rule)
        if rule is not None and rule.misfit < most and _leads_on(rule, incoming, view.width_mm):
            return _plan(incoming, approach.stands, rule)
    return None


def _explained(ink: SeenInk, way: Array, most: float) -> Rule | None:
    """The rule about a way (n, 2) mm that explains the ink best with few figures: those of few corners are
    tried first, and one of more only where they leave ink. None are where that of most leaves too much: what
    it does not explain, fewer do not. If it comes off the ink, it tells nothing.
    """
    best: Rule | None = None
    rules = list(folding_rule.along(way, ink.half_mm))
    of_most = folding_rule.explained(ink, rules[-2:-1], of_bay=False)  # the last is rounded
    if of_most is not None and of_most.misfit > most:
        return None
    for _, alike in groupby(rules, lambda rule: len(rule.corners_mm)):
        rule = folding_rule.explained(ink, alike, of_bay=False)
        if rule is not None and (best is None or rule.cost < best.cost):
            best = rule
        if best is not None and best.misfit < SURE * best.length_mm / ink.width_mm:
            break
    return best


def _with_free_end(ink: SeenInk, rule: Rule) -> Rule | None:
    """A rule whose last side ends where it explains the ink best: where that was cut aslant, the middle of
    the cut lies beside the side. None if it ends elsewhere.
    """
    ahead = rule.last_mm - rule.corners_mm[-1]
    beyond_mm = rule.last_mm + ink.half_mm * ahead / max(np.hypot(*ahead), NOT_ZERO)
    corners_mm, rounded = np.vstack([rule.corners_mm, rule.last_mm]), np.r_[rule.rounded, False]
    free = rule._replace(last_mm=beyond_mm, corners_mm=corners_mm, rounded=rounded)
    found = folding_rule.explained(ink, [free], of_bay=False)
    if found is None or math.dist(found.corners_mm[-1], rule.last_mm) > ink.width_mm:
        return None
    *corners, last_mm = found.corners_mm
    return found._replace(
        last_mm=last_mm, corners_mm=np.array(corners), rounded=found.rounded[:-1]
    )


def _leads_on(rule: Rule, incoming: Leg, width_mm: float) -> bool:
    """Whether a rule begins ahead of a leg, and not back along it, with the pen of its line."""
    is_ahead = float(rule.ahead @ direction(incoming.heading_rad)) > 0
    return is_ahead and abs(2 * rule.half_mm / width_mm - 1) < STEP


def _lasts(view: View, fronts: Fronts) -> list[int]:
    """The fronts to which a rule may lead, beyond a corner and as broad as the line: the nearest of those
    that are so one after the other, and before it, or without it, the two nearest that are so alone, as
    between sides that run together. None if the ink forks before, and none near its end.
    """
    goes_on = fronts.beyond_mm() > ABOUT_WIDTHS * view.width_mm
    clean, is_beyond, come, alone = 0, False, -1, list[int]()
    for k in np.flatnonzero(goes_on).tolist():
        if fronts.at[k] == come:
            return []
        come = fronts.at[k]
        if not LEAST_BROAD < fronts.breadth_mm[k] / view.width_mm < MOST_BROAD:
            clean, is_beyond = 0, is_beyond or k > CLEAN_FRONTS
        elif is_beyond:
            clean += 1
            if clean == CLEAN:
                return [k, *alone[:-1]][:3]
            alone.append(k)
    return alone[:2]


def _behind(approach: Approach, reach_mm: float) -> Array:
    """The way (n, 2) mm by which the head came, as far as the wave reaches, to the end of its leg."""
    place_mm, incoming = approach.stands[0], approach.incoming
    come = evenly(np.vstack([approach.trail.recent(), place_mm]), LOOKED_MM)
    come = come[-round(reach_mm / LOOKED_MM) :]
    to_end_mm = ahead_mm(place_mm, incoming)
    if to_end_mm > 0:
        return np.vstack([come, incoming.at(np.array([-0.5 * to_end_mm, 0.0]))])
    is_passed = (come - incoming.end_mm) @ direction(incoming.heading_rad) > 0
    return np.vstack([come[: len(come) - int(np.argmin(is_passed[::-1]))], incoming.end_mm])


def _ink(
    view: View, fronts: Fronts, last: int, behind_mm: Array, softness_mm: float
) -> SeenInk:
    """The ink ahead as far as a front; what lies on the way behind is drawn there."""
    inside = (fronts.label >= 0) & (fronts.label <= last)
    places, darkness, area_mm2 = ink_of(view, inside, fronts.corner)
    known_mm, each_mm2 = distances.away_from(places, behind_mm), area_mm2 / max(len(places), 1)
    return SeenInk(places, darkness, known_mm, 0.5 * view.width_mm, softness_mm, each_mm2, 0.0)


def _planned(plan: Plan) -> Array:
    """The way (n, 2) mm of a plan, and on along what was felt of its leg."""
    return np.vstack([*plan.stretches, plan.leg.seen[:, :2]])


def _plan(incoming: Leg, stands: tuple[Array, float], rule: Rule) -> Plan:
    """The way over a rule's corners to the middle of its longest side but the first, and but the last one if
    there is another.
    """
    places = np.vstack([rule.first_mm, rule.corners_mm, rule.last_mm])
    sides = np.diff(places, axis=0)
    side = 1 + int(np.hypot(*sides[1 : max(len(sides) - 1, 2)].T).argmax())
    middle = places[side] + 0.5 * sides[side]
    corners_mm, rounded = rule.corners_mm[:side], rule.rounded[:side]
    there = rule._replace(last_mm=middle, corners_mm=corners_mm, rounded=rounded)
    way, along = onto(*stands, incoming, 0.0)
    first, *others = there.stretches()
    begin = np.vstack([way, along_leg(incoming, along, 0.0), first])
    leg = Leg(middle, heading_of(sides[side]), 0.0, 2 * rule.half_mm, NONE)
    return Plan([begin, *others], leg, leader=REDRAWN)
