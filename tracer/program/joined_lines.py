"""Lines that are joined to another: the other lines of a patch of ink on which one line has been followed.

Signals: a patch and the line followed on it in; out further lines of the patch, each followed from end to end
or round about.

    ╭─────╮                  one patch of ink, three lines: from any place the head goes straight
    │   ╭─┼───╮              on over the crossings, and comes round, or to the ends
    ╰───┼─╯   │
    ────┼─────┼────
        ╰─────╯

The head is put down on the plainest place that no run has passed yet, and next on places that have not been
tried, until none is left. A run is a line if it closes, or ends at both ends, and most of its way is new. A
run that ends in another line (a guide line, an arrow, hatching), or is lost, is no line. Such a run has tried
only its way to the first junction: beyond that it may have gone along a whole line, which is followed from
there later.

Source: our own; the patent has one contour to a tape. Questions: ink that no run has covered is not a line;
the report lists its length.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.neighbours import those_near
from morfax.motion.polyline import nearest_mm
from morfax.tracer.corrections.on_sheet import StopAt
from morfax.tracer.drawing.strokes import Stroke
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.line import Line
from morfax.tracer.following.plain_places import stance_near, view_of
from morfax.tracer.limits import CLEAR_WIDTHS, OWN_WIDTHS
from morfax.tracer.program.against_ink.left_ink import LeftInk
from morfax.tracer.program.head_runs import followed_through
from morfax.tracer.program.lines.selection import LETTER_MM, NEW, Contour, least_mm
from morfax.tracer.program.setup import Setup

# All limits below were chosen by trial on the test drawings.
# ink nearer to a way is that way's; where that is all of it, a line may run close beside: then so near
CLOSE_WIDTHS = 1.2
RUNS = 60  # tried on a patch, ...
TRIED_MM = 1500.0  # ... and travel, besides the length of its ink, in runs that are no lines


class _Found:
    """What the runs on a patch came to: its lines, what was tried of the ink, and travel spent in vain."""

    def __init__(self, line: Line, stroke: Stroke, beside_widths: float) -> None:
        """A patch along which one line has been followed."""
        beside_mm = beside_widths * stroke.width_mm
        self.lines, self.spent_mm = [line], 0.0
        self._tried, self._in_vain = LeftInk(stroke, beside_mm), LeftInk(stroke, beside_mm)
        self._tried.pass_by(line.places_mm)

    def left(self) -> Stroke:
        """The ink that no run has tried."""
        return self._tried.left()

    def left_by_all(self) -> Stroke:
        """The ink that no run has passed."""
        return self._tried.left(self._in_vain.away_mm)

    def tries(self, place_mm: tuple[float, float]) -> None:
        """Note that the head is put down at a place."""
        self._tried.pass_by(np.array([place_mm]))

    def take(self, runs: list[Followed], stops: tuple[StopAt, ...]) -> None:
        """Take in the runs from one stance: the last is a line of its own, with the stops that the operator
        told, or all were in vain.
        """
        lines = [Line.bare(run) for run in runs]
        if _is_line(lines[-1], self.lines):
            self.lines.append(Line.of(runs[-1], stops=stops))
            self._tried.pass_by(lines[-1].places_mm)
            return
        self.spent_mm += sum(line.length_mm for line in lines)
        for line in lines:
            self._tried.pass_by(line.own_mm)
            self._in_vain.pass_by(line.places_mm)


def joined_to(
    line: Line, contour: Contour, setup: Setup, strokes: list[Line] | None = None
) -> tuple[list[Line], float]:
    """Further lines of a contour's patch, besides the one followed on it, and the length of ink left, mm;
    among its other `strokes`, where all are known.
    """
    if strokes is not None:
        return _lines_among(strokes, line, contour)
    stroke, settings = contour.stroke, setup.settings
    if setup.sheet.drawing.edges_mm:  # every edge is a line of its own
        return [], 0.0
    shortest_mm = float(least_mm(stroke.width_mm))
    for beside in (CLEAR_WIDTHS, CLOSE_WIDTHS):
        found = _Found(line, stroke, beside)
        left = found.left()
        if left.length_mm >= shortest_mm:
            break
    else:
        return [], 0.0
    view = view_of(setup.sheet, settings.aperture_mm, settings.line_width_mm or stroke.width_mm)
    for _ in range(RUNS):
        # 1. put the head down on ink that is left, and run
        place_mm = replace(contour, stroke=left).starts_mm[0]
        found.tries(place_mm)
        stance = stance_near(view, left, place_mm)
        if stance is not None:
            found.take(followed_through(setup, stance), setup.sheet.drawing.told_stops)
        # 2. ink that no run has passed, or else that none has tried
        left = found.left_by_all()
        if left.length_mm < shortest_mm:
            left = found.left()
        if left.length_mm < shortest_mm or found.spent_mm > TRIED_MM + stroke.length_mm:
            break
    return found.lines[1:], _left_over_mm(stroke, found.lines, beside)


def _lines_among(strokes: list[Line], line: Line, contour: Contour) -> tuple[list[Line], float]:
    """Which further strokes of a contour's patch are lines, and the length of ink left, mm."""
    lines = [line]
    for stroke in strokes:
        # the ways of a net are new by its stretches: a hole may touch an outline along much of its own
        if _is_whole(stroke) and (stroke.ending == "closed" or _is_new(stroke, lines)):
            lines.append(stroke)
    return lines[1:], _left_over_mm(contour.stroke, lines, CLEAR_WIDTHS)


def _left_over_mm(stroke: Stroke, lines: list[Line], beside_widths: float) -> float:
    """The length of a patch's ink beside which no line runs, mm."""
    ink = LeftInk(stroke, beside_widths * stroke.width_mm)
    ink.pass_by(np.vstack([line.places_mm for line in lines]))
    return ink.left().length_mm


def _is_line(line: Line, others: list[Line]) -> bool:
    """Whether a run is a line of its own: from end to end or round about, no mark, and most of it new."""
    return _is_whole(line) and _is_new(line, others)


def _is_whole(line: Line) -> bool:
    """Whether a run is a line from end to end or round about, and no mark."""
    shortest_mm = float(least_mm(line.width_mm)) if line.ending == "closed" else LETTER_MM
    return line.ending in ("closed", "ended") and line.length_mm >= shortest_mm


def _is_new(line: Line, others: list[Line]) -> bool:
    """Whether most of a line is no other's."""
    same_mm = OWN_WIDTHS * line.width_mm
    near = list(those_near([other.places_mm for other in others], line.places_mm, same_mm))
    if not near:
        return True
    return bool(np.mean(nearest_mm(line.places_mm, np.vstack(near)) >= same_mm) > NEW)
