"""Hidden corners: whether a line that was felt as a round turns sharply all the same.

A line is felt over a length that rounds its corners, and the lens rounds the edge of a corner's ink. So a
round that is neither a vertex nor an arc by its edge is a corner, or a step of several, where its legs meet
at a clear angle ahead of them both, or where a pen along the felt line leaves other ink than is there.

Signals: the view, and a corner in what was felt, in; whether there is more to it than was felt, out.

Source: our own.
"""

from __future__ import annotations

import numpy as np

from morfax.tracer.junctions.corner import SLIGHT, Corner
from morfax.tracer.junctions.felt_corner import FeltCorner
from morfax.tracer.sensing.view import View

REACH_WIDTHS = 1.5  # of the line's width about a place: there a pen that turns leaves other ink
WORSE = (
    3.0  # times what the line before it leaves unexplained: grain and noise are the same there
)
ALONG = 16  # places of a leg, which bends little


def hides_corner(view: View, felt: FeltCorner) -> bool:
    """Whether a line that was felt as a round turns more sharply than that."""
    if view.on_edge:
        return False
    incoming, outgoing = felt.legs(view)
    corner = Corner.of(incoming, outgoing)
    if (
        corner is not None
        and corner.nearest_mm > view.step_mm
        and corner.deflection_rad > SLIGHT
    ):
        return True
    from morfax.tracer.tangles.likeness import Patch

    reach_mm = REACH_WIDTHS * view.width_mm
    along = np.linspace(0.0, 3 * reach_mm, ALONG)
    places = np.vstack([incoming.at(-along[::-1]), felt.rounded, outgoing.at(along)])
    near, usual = (
        Patch.about(view, place, reach_mm, incoming).misfit(places)
        for place in (felt.place_mm, incoming.at(-reach_mm))
    )
    return near > WORSE * usual
