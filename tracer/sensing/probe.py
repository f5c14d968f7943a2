"""TODO."""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import STEP_PX
from morfax.tracer.sensing.ray import Ray, end_of_ink
from morfax.tracer.sensing.view import View

SPOKE = np.linspace(0.2, 1.0, 17)
BESIDE = np.array([0.0, -0.25, 0.25])  # widths
PAPER = 0.6  # of the level: lighter is paper for certain
SPECK_PX = 4.0  # a speck of two pixels of paper, seen through an aperture
SPECK_WIDTHS = 0.4  # ink narrower than this is no stroke


def reach_of_ink(
    view: View, incoming: Leg, farthest_mm: float, aside_mm: float = 0.0
) -> float | None:
    """How far the ink goes on from the incoming leg's end along its line, or beside it (left positive), mm;
    None if farther than asked.
    """
    step = STEP_PX * view.pitch_mm
    last_mm = (int(farthest_mm / step) - 1) * step  # the last sample
    if last_mm < 0:
        return None
    t = np.array([math.cos(incoming.heading_rad), math.sin(incoming.heading_rad)])
    place = incoming.end_mm + aside_mm * np.array([-t[1], t[0]])
    if view.darkness_at(place) < view.level:
        return 0.0
    ray = Ray(place[0], place[1], t[0], t[1], incoming.bend_per_mm)
    end_mm = end_of_ink(view.cells, ray, 0.0, last_mm - 0.5 * step)
    return end_mm if math.isfinite(end_mm) else None


def stroke_end(view: View, leg: Leg, farthest_mm: float) -> float | None:
    """How far the ink of a stroke goes on from a leg's end, mm, if the stroke ends there: no ink leaves its
    tip but the stroke's own; None if not.

    It is felt as far as it is clean, round its bends, and only from there on looked for ahead. A speck of
    paper on the stroke is not its end: beside its middle the ink goes on.
    """
    seen, come_mm = view.feel(leg.end_mm, leg.heading_rad, farthest_mm), 0.0
    if len(seen) > len(leg.seen):
        come_mm = (len(seen) - 1) * view.step_mm
        if come_mm >= farthest_mm - view.step_mm:
            return None
        leg = leg_of(seen, True, view.leg_mm)
    for ink in _inks(view, leg, farthest_mm - come_mm):
        if is_tip(view, leg.at(ink - 0.5 * view.width_mm)):
            return come_mm + ink
    return None


def _inks(view: View, leg: Leg, farthest_mm: float) -> list[float]:
    """How far the ink of a stroke may go on from a leg's end, mm: along its middle, beside that, and past a
    speck of paper; none if farther.
    """
    middle, *beside = (
        reach_of_ink(view, leg, farthest_mm, share * view.width_mm)
        for share in (0.0, -0.25, 0.25)
    )
    if middle is None:
        return []
    inks = [middle, *(reach for reach in beside if reach is not None and reach > middle)]
    for past_mm in middle + np.arange(0.5, SPECK_PX, 0.5) * view.pitch_mm:
        if view.dark(leg.at(past_mm)):
            on = reach_of_ink(view, leg.shifted(past_mm, leg.seen), farthest_mm - past_mm)
            return inks if on is None else [*inks, past_mm + on]
    return inks


def is_tip(view: View, place: Array) -> bool:
    """Whether a place half a width within the end of ink is the tip of a single stroke; what it does not
    touch is no matter.
    """
    return lines_from(view, place, max(1.2 * view.width_mm, 5 * view.pitch_mm)) == 1


def lines_from(view: View, centre: Array, radius_mm: float) -> int:
    """How many strokes leave a place by ink, of those that a ring of cells sees about it; specks are none.

    Paper on the way to a stroke is lighter than where the way grazes an edge; a speck of it is not on all of
    the ways side by side.
    """
    lighter = view.at_level(PAPER * view.level)
    joined = 0
    for heading in strokes_on(view, centre, radius_mm).mean(axis=1):
        way = np.array([math.cos(heading), math.sin(heading)])
        beside = np.outer(BESIDE * view.width_mm, [-way[1], way[0]])
        joined += any(
            all(lighter.dark(centre + off + share * radius_mm * way) for share in SPOKE)
            for off in beside
        )
    return joined


def lines_on(view: View, centre: Array, radius_mm: float) -> int:
    """How many strokes a ring of cells sees about a place; specks are none."""
    return len(strokes_on(view, centre, radius_mm))


def strokes_on(view: View, centre: Array, radius_mm: float) -> Array:
    """The arcs that a ring sees which are no specks, (n, 2) rad."""
    arcs = view.ring(centre, radius_mm)
    return np.asarray(
        arcs[(arcs[:, 1] - arcs[:, 0]) * radius_mm > SPECK_WIDTHS * view.width_mm]
    )


def end_of(view: View, incoming: Leg) -> float | None:
    """How far beyond a leg's clean end the pen was lifted, mm: half a width within the end of the ink; None
    if the ink goes on.
    """
    ink = reach_of_ink(view, incoming, 6 * view.width_mm + 2.0)
    return None if ink is None else ink - 0.5 * incoming.width_mm
