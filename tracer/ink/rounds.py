"""Rounds: the head is put down on the ink that is left, again and again, until every line has been followed.

Signals: a ledger and the head's settings in; out strokes, each a run of the head from end to end or round
about, (n, 2) sheet mm at the motion rate.

    ──────┬──────     round 1   lines of each patch, straight on through crossings; their ink is struck off
          │           round 2   lines of each patch that is left, and so on

In each round the head begins at the open ends of a patch and at plain places that no run has passed. Of runs
that go along each other only the longer is kept. The head goes across what has been struck off as it goes
across a gap; where the paper was white before, the stroke ends.

Source: our own; the patent has one contour to a tape. Questions: a patch on which the head can nowhere be put
down is left. So are the rims of filled shapes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain, islice

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import length_mm, lengths_mm
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.attempts import LONGEST, LONGEST_MM, Attempts
from morfax.tracer.following.direction import turned_about
from morfax.tracer.following.followed import THINNED, Followed
from morfax.tracer.following.open_ends import stances_at
from morfax.tracer.following.plain_places import places_of, plainness, stances
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.ink.ledger import FRINGE_PX, Ledger, Patch
from morfax.tracer.ink.meeting import InkStroke, led_on
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
ROUNDS = 100
ACROSS = 2.9  # widths of a line across which the way is as long, at 20 degrees
AGAIN_WIDTHS = 0.5  # a place nearer to a way has been passed by it
LEAST_MM, LEAST_WIDTHS = 1.0, 2.5  # shorter patches are fringes, burrs and specks: the larger
# of the usual width: a thinner patch beside a way is what the line's edge has left
FRINGE = 0.45
STILL_LEFT = 0.5  # of a patch: less was struck off in this round by a run on another patch
ENDS, PLACES = 24, 12  # open ends, and plain places, that are tried on a patch


@dataclass(slots=True)
class Rounds:
    """The head on a sheet, with the ledger of what it has followed."""

    ledger: Ledger
    settings: Settings
    # patches on which the head cannot be put down
    _in_vain: set[Patch] = field(default_factory=set)
    # places of all runs, and who led the head there
    led: list[tuple[Array, NDArray[np.int8]]] = field(default_factory=list)

    def strokes(self) -> Iterator[InkStroke]:
        """Strokes of the sheet, those of the longest patches first, until the head finds no more."""
        for _ in range(ROUNDS):
            sheet, followed = self.ledger.sheet(), 0
            for stroke in () if sheet is None else self._patches(sheet):
                found = self._follow(stroke)
                if not found:
                    self._in_vain.add(_key(stroke))
                followed += len(found)
                yield from found
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

    def _follow(self, stroke: Stroke) -> list[InkStroke]:
        """The lines of a patch that the head tells apart, struck off; none if it cannot be put down on it."""
        made = list[InkStroke]()
        for run in self._runs(stroke):
            way = self._on_ink(run.positions_mm)
            if length_mm(way) < LEAST_MM or self._goes_again(way):
                continue
            closed = run.ending == "closed" and len(way) == len(run.positions_mm)
            way = way if closed else led_on(way, self.ledger, self.settings.speed_mm_s)
            self.led.append(run.led.thinned(run.positions_mm, THINNED))
            self.ledger.strike_off(way[::THINNED], run.view)
            made.append(InkStroke(way, closed, run.view.width_mm))
        return made

    def _runs(self, stroke: Stroke) -> list[Followed]:
        """Runs along a patch, from its ends and from places that none has passed; closed ones first."""
        gap_mm = max(self.settings.gap_mm, self._across_mm if self.ledger.has_ways else 0.0)
        settings = replace(self.settings, gap_mm=gap_mm)
        longest_mm = LONGEST * self.ledger.ink_mm + LONGEST_MM
        attempts = Attempts(self.ledger.left, settings, longest_mm, other_turns=False)
        view = self.ledger.view(settings.line_width_mm or stroke.width_mm, settings.aperture_mm)
        runs = list[Followed]()
        for stance in _stances(view, stroke, gap_mm):
            if any(_passes(run, stance) for run in runs):
                continue
            run = _run(attempts, stance)
            if run is not None:
                runs.append(run)
        return sorted(runs, key=lambda run: (run.ending != "closed", -run.travel_mm))

    @property
    def _across_mm(self) -> float:
        """How far it is at most across a line that has been struck off."""
        struck_mm = self.ledger.usual_mm + 2 * FRINGE_PX * self.ledger.drawing.pitch_mm
        return ACROSS * struck_mm

    def _goes_again(self, way: Array) -> bool:
        """Whether a way goes along what has been followed for longer than it takes to cross it."""
        places = way[::THINNED]
        away_mm, _ = self.ledger.nearest_way(places)
        come_mm, again = lengths_mm(places), away_mm < AGAIN_WIDTHS * self.ledger.usual_mm
        edges = np.flatnonzero(np.diff(np.r_[False, again, False])).reshape(-1, 2)
        return any(come_mm[b - 1] - come_mm[a] > self._across_mm for a, b in edges)

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


def _passes(run: Followed, stance: Stance) -> bool:
    """Whether a run has passed a stance."""
    away_mm = np.hypot(*(run.positions_mm[::THINNED] - stance.place_mm).T)
    return bool(away_mm.min() < AGAIN_WIDTHS * stance.view.width_mm)
