"""Probes: how far ink goes on from a leg, whether a stroke ends there, and how many strokes leave a place.

Signals: a view, and a leg or a place in sheet mm, in; distances in mm, counts and arcs in rad out.

A speck of paper on a stroke is not the stroke's end, and a speck of ink is not a stroke.

Source: our own.
"""

from __future__ import annotations

import math

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.plane import direction, left_of
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.photocell import STEP_PX, darkness_at
from morfax.tracer.sensing.ray import Ray, end_of_ink
from morfax.tracer.sensing.view import View

# of the way from a place to a stroke: where it has to be inked
SPOKE = np.linspace(0.2, 1.0, 17)
BESIDE = np.array([0.0, -0.25, 0.25])  # widths: a way in the middle and one on each side of it
PAPER = 0.6  # of the level: lighter is paper for certain
SPECK_PX = 4.0  # a speck of two pixels of paper, seen through an aperture
SPECK_WIDTHS = 0.4  # ink narrower than this is no stroke
TIP_WIDTHS, TIP_PX = 1.2, 5.0  # radius of the ring that tells a tip: outside the pen's round
END_WIDTHS, END_MM = 6.0, 2.0  # beyond a leg's clean end the pen is sought this far


def reach_of_ink(
    view: View, incoming: Leg, farthest_mm: float, aside_mm: float = 0.0
) -> float | None:
    """How far the ink goes on from a leg's end along its line, or beside it (left positive), mm.

    None if farther than asked.
    """
    step = STEP_PX * view.pitch_mm
    last_mm = (int(farthest_mm / step) - 1) * step  # the last sample
    if last_mm < 0:
        return None
    t = direction(incoming.heading_rad)
    place = incoming.end_mm + aside_mm * left_of(t)
    if view.darkness_at(place) < view.level:
        return 0.0
    ray = Ray(place[0], place[1], t[0], t[1], incoming.bend_per_mm)
    end_mm = end_of_ink(view.cells, ray, 0.0, last_mm - 0.5 * step)
    return end_mm if math.isfinite(end_mm) else None


def stroke_end(view: View, leg: Leg, farthest_mm: float) -> float | None:
    """How far a stroke goes on from a leg's end, mm, if it ends there; None if other ink leaves its tip.

    The stroke is felt as far as it is clean, round its bends; from there on its end is looked for straight
    ahead. A speck of paper on the stroke is not its end: beside the speck the ink goes on.
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
    """How far the ink of a stroke may go on from a leg's end, mm; empty if farther than asked.

    Along its middle, beside the middle, and past a speck of paper.
    """
    middle, *beside = (
        reach_of_ink(view, leg, farthest_mm, share * view.width_mm) for share in BESIDE
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
    """Whether a place half a width within the end of ink is the tip of a single stroke.

    Ink that does not touch the tip does not matter.
    """
    radius_mm = max(TIP_WIDTHS * view.width_mm, TIP_PX * view.pitch_mm)
    return lines_from(view, place, radius_mm) == 1


def lines_from(view: View, centre: Array, radius_mm: float) -> int:
    """How many strokes leave a place by ink, of those that a ring of cells sees about it.

    Paper on the way to a stroke is lighter than where the way grazes an edge. A speck of paper does not lie
    on all of the ways side by side.
    """
    headings = strokes_on(view, centre, radius_mm).mean(axis=1)
    beside_mm, along_mm = BESIDE * view.width_mm, radius_mm * SPOKE
    lighter = float(PAPER * view.level)
    return int(_joined(view.cells, lighter, centre, headings, (beside_mm, along_mm)))


@njit(cache=True, _nrt=False)
def _joined(cells, level, centre, headings, ways_mm):  # type: ignore[no-untyped-def]
    """How many headings from a centre have ink, darker than a level, all along one of some ways: so far
    beside the heading (to the left), at so many places along it.
    """
    (beside_mm, along_mm), joined = ways_mm, 0
    for heading in headings:
        c, s = math.cos(heading), math.sin(heading)
        for beside in beside_mm:
            x = centre[0] - beside * s
            y = centre[1] + beside * c
            inked = 0
            while inked < len(along_mm):
                along = along_mm[inked]
                if darkness_at(cells, x + along * c, y + along * s) <= level:
                    break
                inked += 1
            if inked == len(along_mm):
                joined += 1
                break
    return joined


def lines_on(view: View, centre: Array, radius_mm: float) -> int:
    """How many strokes a ring of cells sees about a place; specks do not count."""
    return len(strokes_on(view, centre, radius_mm))


def strokes_on(view: View, centre: Array, radius_mm: float) -> Array:
    """The arcs that a ring sees, (n, 2) rad, without specks."""
    arcs = view.ring(centre, radius_mm)
    lengths_mm = (arcs[:, 1] - arcs[:, 0]) * radius_mm
    return np.asarray(arcs[lengths_mm > SPECK_WIDTHS * view.width_mm])


def end_of(view: View, incoming: Leg) -> float | None:
    """How far beyond a leg's clean end the pen was lifted, mm; None if the ink goes on.

    The pen was lifted half a width within the end of the ink.
    """
    ink = reach_of_ink(view, incoming, END_WIDTHS * view.width_mm + END_MM)
    return None if ink is None else ink - 0.5 * incoming.width_mm
