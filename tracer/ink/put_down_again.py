"""Put down again: the head on the parts of a sheet's ink along which no stroke has run.

Signals: the sheet as it was felt, its thinned ink and its strokes in; further strokes out.

    ════════════╗               two lines run together and part; what was felt of both was the stretch's, and
    ════════════╩────────       the rest of it had no stroke: ink that is left is one line's, as wide as it is
                 ↑ left         felt there

A stroke that begins or ends beside others begins or ends on their middle. Ink in the reach of strokes on both
its sides is theirs: its middle is no line's.

Source: our own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.plane import direction, left_of_headings
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Bare, Thinned, places_along
from morfax.tracer.ink.felt import judged, usual_width_mm, whole
from morfax.tracer.ink.net import COVERED
from morfax.tracer.ink.pieces import NOTHING, Piece
from morfax.tracer.ink.run import Run
from morfax.tracer.ink.stretches import FeltSheet, with_width
from morfax.tracer.ink.track import InkStroke, along_pieces
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.sensing.probe import end_of

# All limits below were chosen by trial on fetched sheets, and are widths of the line where none is said.
KNOWN = 0.5  # of the stations tell a width
# where the ink across a station is looked at, of its width
ACROSS = np.array([-0.35, 0.0, 0.35])
MOST = 0.8  # of the ink looked at is not theirs
AHEAD = np.arange(0.0, 3.0, 0.1)  # from the end of what was felt: there a line is looked for
ON = 0.2  # from the middle of a line: it has come to that line
# from the end of what was felt: so far off lies the middle of a line beside it ...
BESIDE = 1.5
BESIDE_COS = 0.5  # ... and there it turns by no more than 60 degrees


def put_down_again(
    felt: FeltSheet, thinned: Thinned, strokes: list[InkStroke], settings: Settings
) -> Iterator[InkStroke]:
    """The strokes along what ink the strokes have left."""
    if not strokes:
        return
    run = places_along(stroke.way_mm for stroke in strokes)
    there = _There(felt, run, Neighbours(run), settings)
    for part in thinned.bare(felt.graph, thinned.near(run)):
        if (stroke := there.stroke(part)) is not None:
            yield stroke


@dataclass(frozen=True, slots=True)
class _There:
    """A sheet as it was felt, and places along its strokes, (n, 2) mm."""

    felt: FeltSheet
    run: Array
    near: Neighbours
    settings: Settings

    def stroke(self, part: Bare) -> InkStroke | None:
        """The stroke along a part that is left; None if that is too short, too broad, or others' ink."""
        stations = self._stations(part)
        width_mm = usual_width_mm(stations)
        if (
            stations.length_mm < CLEAR_WIDTHS * width_mm
            or np.mean(np.isfinite(stations.widths_mm)) < KNOWN
            or not self._is_left(stations, width_mm)
        ):
            return None
        own = with_width(stations, width_mm)
        runs, parted = judged(own, width_mm).runs()
        runs, parted = (runs, parted) if runs else ([whole(own)], [])
        pieces = [
            Piece(run, places) for run, places in zip(runs, [NOTHING, *parted], strict=True)
        ]
        begin, heading_rad = self._onto(runs[0].turned_round())
        begins = begin, heading_rad + math.pi
        return along_pieces(pieces, begins, self._onto(runs[-1]), self.settings)

    def _stations(self, part: Bare) -> Run:
        """What was felt along a part."""
        all_of_it = self.felt.felt[part.stretch]
        pixels = len(self.felt.graph.stretches[part.stretch].pixels) - 1
        first, last = (
            round(at / pixels * (len(all_of_it) - 1)) for at in (part.first, part.last - 1)
        )
        return all_of_it.part(first, last + 1)

    def _is_left(self, stations: Run, width_mm: float) -> bool:
        """Whether the ink along stations is no stroke's, on both sides of the middle."""
        normals = left_of_headings(stations.headings_rad)
        places = stations.places_mm[None] + width_mm * ACROSS[:, None, None] * normals
        away_mm = self.near.nearest(places.reshape(-1, 2))[0]
        return bool(np.mean(away_mm > COVERED * width_mm) > MOST)

    def _onto(self, run: Run) -> tuple[Array, float]:
        """Place and heading where a stroke ends behind its last run: on the line ahead or beside it, or where
        the pen was lifted.
        """
        leg, width_mm = run.leg_in(), run.view.width_mm
        # 1. onto the line that it comes to straight on
        aheads_mm = AHEAD * width_mm
        ahead = np.array([leg.at(ahead_mm) for ahead_mm in aheads_mm])
        away_mm, nearest = self.near.nearest(ahead)
        met = np.flatnonzero(away_mm < ON * width_mm)
        if len(met):
            return self.run[nearest[met[0]]], leg.heading_at(aheads_mm[met[0]])
        # 2. onto the line beside it
        onto = self.run[nearest[0]]
        way = onto - leg.end_mm
        if away_mm[0] < BESIDE * width_mm:
            is_ahead = way @ direction(leg.heading_rad) > BESIDE_COS * away_mm[0]
            return (
                (onto, math.atan2(way[1], way[0]))
                if is_ahead
                else (leg.end_mm, leg.heading_rad)
            )
        end_mm = max(0.0, end_of(run.view, leg) or 0.0)
        return leg.at(end_mm), leg.heading_at(end_mm)
