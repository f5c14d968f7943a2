"""Rounds: the head is put down on the ink that is left, again and again, until every line has been followed.

Signals: a ledger and the head's settings in; out strokes, each a run of the head from end to end or round
about, (n, 2) sheet mm at the motion rate.

    ──────┬──────     round 1   one line of each patch, straight on through crossings; its ink is struck off
          │           round 2   one line of each patch that is left, and so on

In each round the head begins at an open end of a patch if it has one, or else at its plainest place. It goes
across what has been struck off as it goes across a gap; where the paper was white before, the stroke ends.

Source: our own; the patent has one contour to a tape. Questions: a patch on which the head can nowhere be put
down is left. So are the rims of filled shapes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain, islice

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import length_mm, lengths_mm
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.attempts import Attempts
from morfax.tracer.following.direction import turned_about
from morfax.tracer.following.followed import THINNED, Followed
from morfax.tracer.following.open_ends import stances_at
from morfax.tracer.following.plain_places import places_of, plainness, stances
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.ink.ledger import Ledger, Patch
from morfax.tracer.ink.meeting import InkStroke, led_on
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
ROUNDS = 100
ACROSS_WIDTHS = 3.0  # a line as wide is crossed at 20 degrees
LEAST_MM, LEAST_WIDTHS = 1.0, 2.5  # shorter patches are fringes, burrs and specks: the larger
FRINGE = (
    0.45  # of the usual width: a thinner patch beside a way is what the line's edge has left
)
STILL_LEFT = 0.5  # of a patch: less was struck off in this round by a run on another patch
ENDS, PLACES = 3, 4  # open ends, and plain places, that are tried
GOES_FAR = 0.5  # of a patch: after a run as long the head is not put down elsewhere
LONGEST, LONGEST_MM = (
    4.0,
    20.0,
)  # times all the ink, and this: a longer run is going round in circles


@dataclass(slots=True)
class Rounds:
    """The head on a sheet, with the ledger of what it has followed."""

    ledger: Ledger
    settings: Settings
    _in_vain: set[Patch] = field(
        default_factory=set
    )  # patches on which the head cannot be put down

    def strokes(self) -> Iterator[InkStroke]:
        """Strokes of the sheet, those of the longest patches first, until the head finds no more."""
        for _ in range(ROUNDS):
            sheet, followed = self.ledger.sheet(), 0
            for stroke in () if sheet is None else self._patches(sheet):
                found = self._follow(stroke)
                if found is None:
                    self._in_vain.add(_key(stroke))
                    continue
                followed += 1
                yield found
            if not followed:
                return

    def lost(self) -> tuple[Patch, ...]:
        """The patches on which the head could not be put down and no other run has passed, longest first."""
        places_mm = np.array([patch[:2] for patch in self._in_vain]).reshape(-1, 2)
        away_mm, _ = self.ledger.nearest_way(places_mm)
        left = [
            p for p, mm in zip(self._in_vain, away_mm, strict=True) if mm > self.ledger.usual_mm
        ]
        return tuple(sorted(left, key=lambda patch: -patch[2]))

    def _patches(self, sheet: Sheet) -> Iterator[Stroke]:
        """The patches that are to be followed in a round, the longest first."""
        least_mm = np.maximum(LEAST_MM, LEAST_WIDTHS * sheet.widths_mm)
        long_enough = (sheet.lengths_mm > least_mm) & ~sheet.are_solid
        patches = np.flatnonzero(long_enough)
        for patch in patches[np.argsort(-sheet.lengths_mm[patches], kind="stable")]:
            stroke = sheet.stroke(int(patch))
            if not len(stroke.middles_mm) or _key(stroke) in self._in_vain:
                continue
            is_left = np.mean(self.ledger.is_left(stroke.middles_mm)) > STILL_LEFT
            if is_left and not self._is_fringe(stroke):
                yield stroke

    def _is_fringe(self, stroke: Stroke) -> bool:
        """Whether a patch is what the edge of a line has left beside its way."""
        usual_mm = self.ledger.usual_mm
        if stroke.width_mm > FRINGE * usual_mm:
            return False
        away_mm, _ = self.ledger.nearest_way(stroke.middles_mm)
        return bool(np.median(away_mm) < usual_mm)

    def _follow(self, stroke: Stroke) -> InkStroke | None:
        """The head's best run along a patch, struck off; None if the head can be put down nowhere on it."""
        run = self._best_run(stroke)
        if run is None:
            return None
        way = self._on_ink(run.positions_mm)
        if length_mm(way) < LEAST_MM:
            return None
        closed = run.ending == "closed" and len(way) == len(run.positions_mm)
        way = way if closed else led_on(way, self.ledger, self.settings.speed_mm_s)
        self.ledger.strike_off(way[::THINNED], run.view)
        return InkStroke(way, closed, run.view.width_mm)

    def _best_run(self, stroke: Stroke) -> Followed | None:
        """The longest run along a patch from some of its ends and places, or the first that goes far."""
        gap_mm = max(self.settings.gap_mm, ACROSS_WIDTHS * self.ledger.usual_mm)
        settings = replace(self.settings, gap_mm=gap_mm)
        longest_mm = LONGEST * self.ledger.ink_mm + LONGEST_MM
        attempts = Attempts(self.ledger.left, settings, longest_mm, other_turns=False)
        view = self.ledger.view(settings.line_width_mm or stroke.width_mm, settings.aperture_mm)
        best: Followed | None = None
        for stance in _stances(view, stroke, gap_mm):
            run = _run(attempts, stance)
            if run is not None and (best is None or run.travel_mm > best.travel_mm):
                best = run
            if best is not None and _is_enough(best, stroke):
                break
        return best

    def _on_ink(self, way: Array) -> Array:
        """A way as far as it runs on ink.

        The head may have gone across a gap in the paper, which it took for a piece that was struck off.
        """
        places = way[::THINNED]
        inked, come_mm = self.ledger.was_ink(places), lengths_mm(places)
        edges = np.flatnonzero(np.diff(np.r_[True, inked, True]))
        for begin, end in edges.reshape(-1, 2):
            if come_mm[min(end, len(places) - 1)] - come_mm[begin] > self.settings.gap_mm:
                return way[: max(1, begin - 1) * THINNED + 1]
        return way


def _key(stroke: Stroke) -> Patch:
    """What a patch is known by from round to round: where it is, and how long."""
    x, y = np.round(stroke.middles_mm.mean(axis=0), 1)
    return float(x), float(y), round(stroke.length_mm, 1)


def _stances(view: View, stroke: Stroke, gap_mm: float) -> Iterator[Stance]:
    """Where the head is put down on a patch: at its open ends, then at its plainest places."""
    return chain(
        islice(stances_at(view, stroke.ends_mm(), gap_mm), ENDS), _plain_stances(view, stroke)
    )


def _plain_stances(view: View, stroke: Stroke) -> Iterator[Stance]:
    """The plainest stances along a patch, the plainest first."""
    found = sorted(stances(view, places_of(stroke, None)), key=plainness, reverse=True)
    for scored in found[:PLACES]:
        yield scored.stance


def _run(attempts: Attempts, stance: Stance) -> Followed | None:
    """A run from a stance: of a line that does not come round, from end to end or the longer way."""
    try:
        run = attempts.run(stance)
        if stance.at_end or run.ending == "closed":
            return run
        if run.ending == "ended":
            other = attempts.run(turned_round(run.positions_mm[-1], run.heading_rad, run.view))
        else:
            other = attempts.run(turned_about(stance))
    except LineFault:
        return None
    return max(run, other, key=lambda some: some.travel_mm)


def _is_enough(run: Followed, stroke: Stroke) -> bool:
    """Whether a run needs no other tried beside it: it comes round, or goes along most of the patch."""
    return run.ending == "closed" or run.travel_mm > GOES_FAR * stroke.length_mm
