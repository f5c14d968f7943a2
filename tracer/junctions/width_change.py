"""Changes of width: where a line goes on with another pen, which draws wider or narrower.

Engraved and inked drawings have shade lines: the sides of a part away from the light are drawn wider. A line
that goes on with a step in its width ends the clean leg, and no leg of its own width leads on. So the head
looks for a line of another width: straight ahead, in line with its own; else about the junction, where it
takes the leg that goes on straightest.

    ________                          ________
            |_________________                |     two lines that run together are wider too,
     . . . . . . . . . . . . .         . . . .|. .  but to one side of the head's own
     _______ _________________        ________|___
            |

Signals: the incoming leg and the trail in; the outgoing leg out, as it is seen there, and where the two meet.

Source: our own (see `rings`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.head.course import SMOOTH, ahead_mm
from morfax.tracer.head.trail import Trail
from morfax.tracer.junctions.choice import WayIn, survey
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.limits import LONGER_WIDTHS
from morfax.tracer.sensing.leg import Leg, leg_of, turn
from morfax.tracer.sensing.view import View

# Chosen by trial on the test drawings. Pens and edges are times the line's width.
PENS = (2.0, 0.45)  # with a ring's tolerance each, from a quarter of the width to three times
WIDEST, NARROWEST = 3.5, 0.25  # straight ahead
ALIKE = 0.1  # no other pen
STEP = 0.2  # another pen, and no swelling of the line
# so long and so evenly: two lines that run together do not stay so
STEADY_WIDTHS, STEADY = 8.0, 0.06
AHEAD_STEP = 0.5  # widths: in such steps, up to `LONGER_WIDTHS`, the other line is looked for
FAR_LEGS = 2.0  # the vertex lies further off than at a corner of one width
ASIDE = 0.4  # of what a line beside it would set the middle off: it is in line
LEAST_ASIDE_MM = 0.015  # the way ahead is known as well as this


class OtherWidth(NamedTuple):
    """A line of another width: how it is seen, its leg, and its corner with the way in; None if in line."""

    view: View
    leg: Leg
    corner: Corner | None


def of_another_pen(view: View, incoming: Leg, trail: Trail) -> OtherWidth | None:
    """The line that goes on from a leg's clean end with another width, and has not been followed; or None."""
    # 1. straight ahead
    for onward in _straight_ahead(view, incoming):
        if not trail.holds(onward.leg, view.width_mm):
            return onward
    # 2. about the junction
    for times in PENS:
        other = replace(view, width_mm=times * view.width_mm, usual_mm=None)
        leg, corner, _ = survey(WayIn(other, incoming, trail))
        if leg is None or corner is None or abs(leg.width_mm / view.width_mm - 1) <= STEP:
            continue
        found = replace(view, width_mm=leg.width_mm, usual_mm=None)
        far = _felt(found, leg.end_mm, leg.heading_rad, FAR_LEGS) or leg
        return OtherWidth(found, far, Corner.of(incoming, far))
    return None


def another_pen(view: View, leg: Leg) -> bool:
    """Whether a leg is wider or narrower than the line, and stays so."""
    if abs(leg.width_mm / view.width_mm - 1) < STEP:
        return False
    other = replace(view, width_mm=leg.width_mm)
    seen = other.feel(leg.end_mm, leg.heading_rad, STEADY_WIDTHS * leg.width_mm)
    if len(seen) * view.step_mm < STEADY_WIDTHS * leg.width_mm:
        return False
    near, far = (median(part[:, 2]) for part in np.array_split(seen, 2))
    within_mm = STEADY * leg.width_mm
    return abs(far - near) < within_mm and float(np.std(seen[:, 2])) < within_mm


def _straight_ahead(view: View, incoming: Leg) -> Iterator[OtherWidth]:
    """Lines of another width in line with a leg."""
    step = AHEAD_STEP * view.width_mm
    for along in np.arange(step, LONGER_WIDTHS * view.width_mm, step):
        place, heading = incoming.at(along), incoming.heading_at(along)
        reach_mm = WIDEST * view.width_mm
        right, left = view.edges(place, heading, reach_mm)
        times = (left - right) / view.width_mm
        if not NARROWEST < times < WIDEST or abs(times - 1) < ALIKE:
            continue
        other = replace(view, width_mm=left - right, usual_mm=None)
        leg = _felt(other, place, heading)
        if leg is not None and _in_line(incoming, leg):
            yield OtherWidth(replace(other, width_mm=leg.width_mm), leg, None)


def _felt(view: View, place: Array, heading: float, legs: float = 1.0) -> Leg | None:
    """The line felt from a place on, if it is clean for so many legs' lengths."""
    length_mm = legs * view.leg_mm
    seen = view.feel(place, heading, length_mm)
    return leg_of(seen, False, length_mm) if len(seen) > length_mm / view.step_mm else None


def _in_line(incoming: Leg, leg: Leg) -> bool:
    """Whether a wider or narrower line has the same middle: a line with another beside it has not."""
    along = -ahead_mm(leg.end_mm, incoming)
    aside = float(np.hypot(*(leg.end_mm - incoming.at(along))))
    allowed = max(ASIDE * 0.5 * abs(leg.width_mm - incoming.width_mm), LEAST_ASIDE_MM)
    turned = abs(turn(incoming.heading_at(along), leg.heading_rad))
    return aside < allowed and turned < SMOOTH
