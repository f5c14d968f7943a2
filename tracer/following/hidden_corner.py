"""Hidden corners: whether a line turns more sharply than the way round that was felt, or was laid.

A line is felt over a length that rounds its corners, and the lens rounds the edge of a corner's ink. So a
round that is neither a vertex nor an arc by its edge is a corner, or a step of several, where a pen along the
felt line leaves other ink than is there. Two corners beside one another, as at the root of a gear's tooth,
are an arc by their edge: a pen along that arc leaves other ink than they do.

Signals: the view, and a corner in what was felt, in; whether there is more to it than was felt, out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.plane import direction
from morfax.tracer.head.plan import Plan
from morfax.tracer.head.slow_cell import rough_mm
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.felt_corner import FeltCorner
from morfax.tracer.sensing.leg import STRAIGHT, Leg
from morfax.tracer.sensing.view import View

REACH_WIDTHS = 1.5  # of the line's width about a place: there a pen that turns leaves other ink
# times what the line beside it leaves unexplained, for grain and noise are the same there; and where the legs
# meet at a clear angle
WORSE, WORSE_AT_ANGLE = 3.0, 1.5
# the same of a way that was laid: arcs on rounds leave 0.9 to 1.7 times as much, on two corners 1 to 2 widths
# apart 2.5 to 10 times
WORSE_AS_LAID = 2.0
# of a pixel: a pen's line is rough by 4 to 8 % in its middle, a felt pen's on rough paper by 15 to 50 %;
# its edges leave more ink unexplained than a corner does
ROUGH_PX = 0.12
ALONG = 16  # places of a leg, which bends little


def hides_corner(view: View, felt: FeltCorner) -> bool:
    """Whether a line that was felt as a round turns more sharply than that."""
    if is_rough(view, felt):
        return False
    incoming, outgoing = felt.legs(view)
    # 1. what a pen along the felt line leaves unexplained at the corner, and beside it
    along = _along(view)
    way = np.vstack([incoming.at(-along[::-1]), felt.rounded, outgoing.at(along)])
    worse = _times_worse(view, felt, (incoming, outgoing), way)
    # 2. less will do where the legs meet at a clear angle
    corner = Corner.of(incoming, outgoing)
    if corner is None or corner.nearest_mm <= view.step_mm or corner.deflection_rad <= STRAIGHT:
        return worse > WORSE
    return worse > WORSE_AT_ANGLE


def is_laid_beside(view: View, felt: FeltCorner, plan: Plan) -> bool:
    """Whether a pen along a way that was laid round a corner leaves other ink than is there."""
    if is_rough(view, felt):
        return False
    incoming, outgoing = felt.legs(view)[0], plan.leg
    way, along = np.vstack(plan.stretches), _along(view)
    come = incoming.at(-along[::-1])
    come = come[(come - way[0]) @ direction(incoming.heading_rad) < 0]
    places = np.vstack([come, way, outgoing.at(along)])
    return _times_worse(view, felt, (incoming, outgoing), places) > WORSE_AS_LAID


def is_rough(view: View, felt: FeltCorner) -> bool:
    """Whether a line's edges leave more ink unexplained than a corner does, or it is an edge."""
    return view.on_edge or rough_mm(felt.seen) > ROUGH_PX * view.parted * view.pitch_mm


def _along(view: View) -> Array:
    """How far along a leg, mm, places are that are held against the ink."""
    return np.linspace(0.0, 3 * REACH_WIDTHS * view.width_mm, ALONG)


def _times_worse(view: View, felt: FeltCorner, legs: tuple[Leg, Leg], way: Array) -> float:
    """How many times as much a pen along a way (n, 2) mm leaves unexplained at a corner as beside it."""
    # most lines have nothing to be held against the ink
    from morfax.tracer.tangles.likeness import Patch, Pen

    (incoming, outgoing), reach_mm = legs, REACH_WIDTHS * view.width_mm
    around = felt.place_mm, incoming.at(-reach_mm), outgoing.at(reach_mm)
    pen = Pen.of(view, incoming)
    near, *usual = (Patch.about(view, at, reach_mm, pen).misfit(way) for at in around)
    return near / min(usual)
