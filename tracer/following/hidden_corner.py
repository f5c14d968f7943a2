"""Hidden corners: whether a line that was felt as a round turns sharply all the same.

A line is felt over a length that rounds its corners, and the lens rounds the edge of a corner's ink. So a
round that is neither a vertex nor an arc by its edge is a corner, or a step of several, where a pen along the
felt line leaves other ink than is there.

Signals: the view, and a corner in what was felt, in; whether there is more to it than was felt, out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.motion.arrays import Array
from morfax.tracer.head.slow_cell import rough_mm
from morfax.tracer.junctions.corner import Corner
from morfax.tracer.junctions.felt_corner import FeltCorner
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.leg import STRAIGHT
from morfax.tracer.sensing.view import View

# times what the line beside it leaves unexplained, for grain and noise are the same there; and where the legs
# meet at a clear angle
WORSE, WORSE_AT_ANGLE = 3.0, 1.5
# of a pixel: a pen's line is rough by 4 to 8 % in its middle, a felt pen's on rough paper by 15 to 50 %;
# its edges leave more ink unexplained than a corner does
ROUGH_PX = 0.12
ALONG = 16  # places of a leg, which bends little


def hides_corner(view: View, felt: FeltCorner) -> bool:
    """Whether a line that was felt as a round turns more sharply than that."""
    if is_rough(view, felt.seen):
        return False
    # most lines have nothing to be held against the ink
    from morfax.tracer.tangles.likeness import Patch, Pen

    incoming, outgoing = felt.legs(view)
    # 1. what a pen along the felt line leaves unexplained at the corner, and beside it
    reach_mm = CLEAR_WIDTHS * view.width_mm
    along = np.linspace(0.0, 3 * reach_mm, ALONG)
    places = np.vstack([incoming.at(-along[::-1]), felt.rounded, outgoing.at(along)])
    around = felt.place_mm, incoming.at(-reach_mm), outgoing.at(reach_mm)
    pen = Pen.of(view, incoming)
    near, *usual = (Patch.about(view, at, reach_mm, pen).misfit(places) for at in around)
    # 2. less will do where the legs meet at a clear angle
    corner = Corner.of(incoming, outgoing)
    if corner is None or corner.nearest_mm <= view.step_mm or corner.deflection_rad <= STRAIGHT:
        return near > WORSE * min(usual)
    return near > WORSE_AT_ANGLE * min(usual)


def is_rough(view: View, seen: Array) -> bool:
    """Whether a line's edges leave more ink unexplained than a corner does, or it is an edge."""
    return view.on_edge or rough_mm(seen) > ROUGH_PX * view.parted * view.pitch_mm
