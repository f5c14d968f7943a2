"""A ring: a line that comes round by itself and meets no other, followed as a contour is.

Signals: a chain and the junctions of its net in; a stroke out, positions (n, 2) mm at the motion rate; None
where the chain is no ring, or the head does not come round along what was felt.

    ring     nothing ends, forks or turns off: the head sets out from the middle of its longest clean run
             and goes round by its fast cell, from stop to stop in one kernel (see `following.clean_line`)
    chain    any other line: the head is held against what was felt once a second, and goes on by its slow
             cell where a bend is too tight for a cell that looks no further than its guards (see `track`)

The fast cell narrows its window where a bend was felt clean, and stays three times as fast. Its sweep stands
square to the bend, as the slow cell's does: aslant across a line of 0.8 mm on a circle of 2.4 mm the middle
between both edges is 4 um inside the line.

Source: our own. Questions: contours sweep square only where their lines were felt clean and the cells part
their edges; by trial, with a square sweep all along, 7 of 22 paths of hand-drawn sheets went other ways.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.long_array import one_in
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import length_mm, nearest_mm
from morfax.tracer.following.follower import Follower
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.ink.chains import Chain, Junctions, Side
from morfax.tracer.ink.track import LOOKED_AT, InkStroke, Told
from morfax.tracer.limits import NEAR

TWICE = 2.0  # round a ring: a head that has not come home until then never will


def stroke_round(
    chain: Chain, junctions: Junctions, settings: Settings, told: Told | None = None
) -> InkStroke | None:
    """Run the head round a ring; `told` hears the travel, mm."""
    if not _is_ring(chain, junctions):
        return None
    line = junctions.net.lines[chain.links[0].line]
    run = max(line.runs, key=len)
    k, felt = len(run) // 2, np.vstack([*line.parted, line.places_mm])
    view = replace(run.view, square=True)
    stance = Stance(run.places_mm[k], float(run.headings_rad[k]), view)
    followed = Follower(stance, settings, MOTION_RATE_HZ).follow(TWICE * line.length_mm, told)
    way_mm = followed.positions_mm
    if followed.ending != "closed" or followed.junctions_mm:
        return None
    # along what was felt, and back at its start on the same heading: so it has gone round
    if nearest_mm(one_in(way_mm, LOOKED_AT), felt).max() > NEAR * line.width_mm:
        return None
    return InkStroke(way_mm, length_mm(way_mm), True, run.view.width_mm, followed.led)


def _is_ring(chain: Chain, junctions: Junctions) -> bool:
    """Whether a chain is a single line that comes round by itself."""
    first = Side(chain.links[0].line, False)
    is_closed = chain.closed and len(chain.links) == 1
    is_ring = junctions.net.lines[first.line].junctions[0] < 0
    return is_closed and is_ring and len(junctions.at(first).sides) == 2
