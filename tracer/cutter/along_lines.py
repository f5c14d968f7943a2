"""Along the lines: a program without a cutter, whose closed lines are turned round, begun elsewhere and
given leads.

Signals: a Trace along the lines' middles and what is asked for in; out a Trace along the same lines.

The scrap is outside of the part's outline and inside its holes, by nesting. A line that is cut as the head
followed it keeps the head's own motion; any other is run anew at the feed. Open lines, and lines that cross
themselves, stay as they are; what is drawn besides contours comes along as with a cutter (see `transfer`).

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from morfax.motion.arm import PLAIN
from morfax.motion.arrays import Array
from morfax.motion.offset import DriveCurve, OffsetPath
from morfax.motion.polyline import closed_up, plain, steps_mm
from morfax.tracer.cutter import sides
from morfax.tracer.cutter.contour import Beside, Cut, planned
from morfax.tracer.cutter.contouring import (
    Contouring,
    refuse_open,
    refuse_without_room,
    turned_round,
)
from morfax.tracer.cutter.leads import Scrap
from morfax.tracer.cutter.runs import FeedRate
from morfax.tracer.cutter.start_places import StartPlaces
from morfax.tracer.cutter.transfer import transferred
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace


def contoured(trace: Trace, contouring: Contouring, feed_mm_s: float) -> Trace:
    """The program along the lines as is asked for, run at a feed where it is not as the head followed.

    Raises MotionFault if no line is closed, or if none has room for a lead.
    """
    # 1. contours, each with the scrap on its left or right
    lines = planned(trace)
    cuts = [cut for _, cut in lines if cut is not None]
    refuse_open(cuts, trace.lines, contouring)
    if trace.fault is not None:  # what lies inside a line that was lost is not known
        return trace
    curves = _curves(cuts)
    # 2. in the direction, from the place, with the leads that are asked for
    feed = FeedRate(feed_mm_s, trace.rate_hz)
    starts = StartPlaces(contouring, Scrap(curves) if contouring.has_leads else None)
    made, number = list[Line](), 0
    for line, cut in lines:
        if cut is None:
            made.append(line)
            continue
        if _is_changed(cut, curves[number], contouring):
            path = OffsetPath(_closed_path(cut.places_mm), True, number)
            beside = Beside(cut, curves[number].left, 0.0, [path])
            made += transferred(turned_round(beside, contouring), _on_line, feed, starts)
        else:
            made.append(line)
            starts.tool_mm = np.array(line.end_mm)
        number += 1
    refuse_without_room(made, contouring)
    return replace(trace, lines=tuple(made))


def _curves(cuts: Sequence[Cut]) -> list[DriveCurve]:
    """The contours with the side on which the scrap is; open: lines that are open or cross themselves."""
    # 1. what may have something inside: closed lines, loops with a stem, lines with a gap
    stems = [not cut.closed and cut.line.loop_from is not None for cut in cuts]
    gaps = [cut.line.gap_mm is not None for cut in cuts]
    places = [
        cut.line.loop_mm if has_stem else sides.thinned(cut.places_mm)
        for cut, has_stem in zip(cuts, stems, strict=True)
    ]
    crossed = sides.crossing(places)
    crosses_itself = crossed.diagonal()
    plainly = [cut.closed for cut in cuts] & ~crosses_itself
    closed = np.flatnonzero((plainly | stems | gaps) & ~crosses_itself)
    # 2. the side of each by its depth among them
    among = crossed[np.ix_(closed, closed)]
    left = np.zeros(len(cuts), bool)
    left[closed] = sides.tool_left([places[k] for k in closed], among)
    return [
        DriveCurve(cut.places_mm, bool(is_plain), bool(on_left))
        for cut, is_plain, on_left in zip(cuts, plainly, left, strict=True)
    ]


def _is_changed(cut: Cut, curve: DriveCurve, contouring: Contouring) -> bool:
    """Whether a line is cut otherwise than the head followed it; a drawn lead line says where it begins."""
    if not curve.closed:
        return False
    if cut.line.as_told:  # where it begins and which way it goes are the operator's
        return contouring.has_leads
    if cut.first > 0:
        return contouring.turns(curve.left) or contouring.lead_out is not None
    return contouring.turns(curve.left) or contouring.moves_start


def _closed_path(places_mm: Array) -> Array:
    """Places of a closed contour that show where it runs, the first once more at the end, (n, 2) mm."""
    path = closed_up(plain(np.ascontiguousarray(places_mm), PLAIN))
    return path[np.r_[True, steps_mm(path) > PLAIN]]


def _on_line(places_mm: Array) -> Array:
    """Without a cutter the tool may be on the lines wherever it is down: no place is too near, mm."""
    return np.full(len(places_mm), np.inf)
