"""Lines that are joined to another: what is left of a patch of ink when one of its lines has been followed.

Signals: a patch and the lines followed on it in; out further lines of the patch, each followed from end to
end or round about.

    ╭─────╮                  one patch of ink, three lines: from any place the head goes straight
    │   ╭─┼───╮              on over the crossings, and comes round, or to the ends
    ╰───┼─╯   │
    ────┼─────┼────
        ╰─────╯

The head is put down on the plainest place that no run has come by, and then on those that have not been
tried, until there is none. A run counts if it closes, or ends at both ends, and most of its way is new; one
that ends in another line (a guide line, an arrow, hatching) or is lost, does not. Of such a run no more has
been tried than the way to its first junction: beyond that it may have gone along a whole line, which it would
follow from there.

Source: our own; the patent has one contour to a tape. Questions: what of ink that no such run comes by? It is
no line, and is told of.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from morfax.motion.arrays import Array
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.line import Line
from morfax.tracer.following.start import stance_near, view_of
from morfax.tracer.head.settings import Settings
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.selection import LEAST_MM, LEAST_WIDTHS, LETTER_MM, Contour
from morfax.tracer.program.trace import followed_through

NEW = 0.6  # of a line's way: the rest may be another's too
BESIDE = 1.5  # widths: ink nearer to a way than this is that way's
RUNS = 60  # tried on a patch,
TRIED_MM = 1500.0  # and travel, besides the length of its ink, in runs that are no lines


def joined_to(
    line: Line, contour: Contour, sheet: Sheet, settings: Settings, operator: Operator
) -> tuple[list[Line], float]:
    """Further lines of the patch that a contour is, besides the line followed on it, and the length of the
    ink that is left, mm.
    """
    stroke, found, tried, in_vain = (
        contour.stroke,
        list[Line](),
        [line.places_mm],
        list[Array](),
    )
    left = _left(stroke, tried)
    if left.length_mm < _least_mm(stroke):
        return [], 0.0
    view = view_of(sheet, settings.aperture_mm, settings.line_width_mm or stroke.width_mm)
    spent_mm = -stroke.length_mm
    for _ in range(RUNS):
        place_mm = replace(contour, stroke=left).starts_mm()[0]
        tried.append(np.array([place_mm]))
        stance = stance_near(view, left, place_mm)
        if stance is not None:
            runs = followed_through(sheet, stance, settings, operator)
            if _is_line(runs[-1], [line, *found]):
                found.append(runs[-1])
                tried.append(runs[-1].places_mm)
            else:
                spent_mm += sum(run.length_mm for run in runs)
                tried += [run.own_mm for run in runs]
                in_vain += [run.places_mm for run in runs]
        left = _left(stroke, [*tried, *in_vain])
        if left.length_mm < _least_mm(stroke):
            left = _left(stroke, tried)
        if left.length_mm < _least_mm(stroke) or spent_mm > TRIED_MM:
            break
    return found, _left(stroke, [some.places_mm for some in (line, *found)]).length_mm


def _is_line(line: Line, others: list[Line]) -> bool:
    """Whether a run is a line of its own: from end to end or round about, no mark, and most of it new."""
    least_mm = (
        max(LEAST_MM, LEAST_WIDTHS * line.width_mm) if line.ending == "closed" else LETTER_MM
    )
    if line.ending not in ("closed", "ended") or line.length_mm < least_mm:
        return False
    near = [
        _nearest_mm(line.places_mm, other.places_mm) < 0.7 * line.width_mm for other in others
    ]
    return bool(np.mean(~np.any(near, axis=0)) > NEW)


def _left(stroke: Stroke, ways: list[Array]) -> Stroke:
    """The part of a stroke that none of some ways comes by."""
    near = np.any(
        [_nearest_mm(stroke.middles_mm, way) < BESIDE * stroke.width_mm for way in ways], axis=0
    )
    return replace(
        stroke,
        middles_mm=stroke.middles_mm[~near],
        filled=stroke.filled[~near],
        length_mm=stroke.length_mm * float(np.average(~near, weights=1 / _crowded(stroke))),
    )


def _crowded(stroke: Stroke) -> Array:
    """How many middle places of a stroke are within its width of each: a line along the rows has two abreast,
    and a sloping one has one.
    """
    tree = cKDTree(stroke.middles_mm)
    return np.asarray(
        tree.query_ball_point(stroke.middles_mm, stroke.width_mm, return_length=True), float
    )


def _least_mm(stroke: Stroke) -> float:
    """Ink that is left is no line if it is shorter than this, mm."""
    return max(LEAST_MM, LEAST_WIDTHS * stroke.width_mm)


def _nearest_mm(places_mm: Array, others_mm: Array) -> Array:
    """Distance of each place from the nearest of others, mm."""
    return np.asarray(cKDTree(others_mm).query(places_mm)[0])
