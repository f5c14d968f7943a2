"""Rounds: the head is put down on the ink that is left, again and again, until every line has been followed.

Signals: a drawing and the head's settings in; out strokes, each followed by the head from end to end or round
about, and the length of ink that it left.

    ──────┬──────         round 1: the long line, straight on over everything; its ink is struck off
          │               round 2: what is left of the others, which cross the struck piece as a gap; a line that
          │                        ends there is led on to the middle of the line that it meets

In each round the head follows one line of each patch of ink that is left, from an open end if there is one.
It crosses what has been struck off as it crosses a gap. Where the paper was white before, the stroke ends.

Source: our own; the patent has one contour to a tape.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion import ramp
from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.polyline import lengths_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.attempts import Attempts, longest_mm
from morfax.tracer.following.direction import turned_about
from morfax.tracer.following.followed import THINNED, Followed
from morfax.tracer.following.line import Line
from morfax.tracer.following.open_ends import stances_at
from morfax.tracer.following.plain_places import ABOUT_WIDTHS, plainness, places_of, stances
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance, turned_round
from morfax.tracer.ink.ledger import Ledger

# All limits below were chosen by trial on drawings of nets.
ROUNDS = 60
ACROSS_WIDTHS = 3.0  # a line of the usual width is crossed at 20 degrees
LEAST_MM, LEAST_WIDTHS = 1.0, 2.5  # shorter patches are fringes, burrs and specks: the larger
THIN = 0.45  # of the usual width: a thinner patch beside a way is what its edge has left
ENDS = 3  # open ends that are tried
PLACES = 4  # plain places that are tried
GOES_FAR = 0.5  # of a patch: a run as long as this is not tried again from elsewhere
MEETS_WIDTHS = 1.6  # a stroke that ends so near to a line ends on that line


@dataclass(frozen=True, slots=True)
class InkFollowed:
    """The strokes of a sheet, and the length of ink that no stroke runs along, mm."""

    lines: list[Line]
    left_mm: float
    specks: int


@dataclass(slots=True)
class Rounds:
    """The head on a sheet, with its ledger."""

    ledger: Ledger
    settings: Settings
    usual_mm: float  # width of the line

    def strokes(self) -> Iterator[Line]:
        """Strokes of the sheet, the longest patches first, until nothing is left that can be followed."""
        in_vain, number = set[tuple[float, ...]](), 0
        for _ in range(ROUNDS):
            sheet, followed = self.ledger.sheet(), 0
            for stroke, key in self._to_follow(sheet, in_vain):
                line = self._follow(stroke, number + 1)
                if line is None:
                    in_vain.add(key)
                    continue
                number, followed = number + 1, followed + 1
                yield line
            if not followed:
                return

    def _to_follow(
        self, sheet: Sheet | None, in_vain: set[tuple[float, ...]]
    ) -> Iterator[tuple[Stroke, tuple[float, ...]]]:
        """The patches that are to be followed in a round, the longest first, each with what it is known by."""
        if sheet is None:
            return
        least_mm = np.maximum(LEAST_MM, LEAST_WIDTHS * sheet.widths_mm)
        long_enough = (sheet.lengths_mm > least_mm) & ~sheet.are_solid
        for patch in np.argsort(-sheet.lengths_mm):
            if not long_enough[patch]:
                continue
            key = (*np.round(sheet.middle_mm(patch), 1), round(sheet.lengths_mm[patch], 1))
            if key in in_vain:
                continue
            stroke = sheet.stroke(int(patch))
            if np.mean(self.ledger.is_left(stroke.middles_mm)) > 0.5 and not self._is_fringe(
                stroke
            ):
                yield stroke, key

    def _is_fringe(self, stroke: Stroke) -> bool:
        """Whether a patch is what the edge of a line has left beside its way."""
        if stroke.width_mm > THIN * self.usual_mm:
            return False
        away, _ = self.ledger.nearest_way(stroke.middles_mm)
        return bool(np.median(away) < self.usual_mm)

    def _follow(self, stroke: Stroke, number: int) -> Line | None:
        """The head's best run along a patch, struck off; None if the head can be put down nowhere on it."""
        width_mm = self.settings.line_width_mm or stroke.width_mm
        gap_mm = max(self.settings.gap_mm, ACROSS_WIDTHS * self.usual_mm)
        attempts = Attempts(
            self.ledger.left,
            replace(self.settings, gap_mm=gap_mm),
            self._longest_mm(stroke),
            other_turns=False,
        )
        best: Followed | None = None
        for stance in self._stances(stroke, width_mm, gap_mm):
            run = self._run(attempts, stance)
            if run is not None and (best is None or run.travel_mm > best.travel_mm):
                best = run
            if best is not None and (
                best.ending == "closed" or best.travel_mm > GOES_FAR * stroke.length_mm
            ):
                break
        if best is None:
            return None
        way = self._on_ink(best.positions_mm)
        if len(way) < 2 * THINNED or lengths_mm(way)[-1] < LEAST_MM:
            return None
        closed = best.ending == "closed" and len(way) == len(best.positions_mm)
        whole = way if closed else self._led_on(way)
        self.ledger.strike_off(whole[::THINNED], best.view)
        return Line(
            whole,
            "closed" if closed else "ended",
            best.view.width_mm,
            float(lengths_mm(whole)[-1]),
            number=number,
            ink_mm=stroke.length_mm,
        )

    def _longest_mm(self, stroke: Stroke) -> float:
        """How far a run may go before it is going round in circles."""
        return longest_mm(self.ledger.left, self.usual_mm)

    def _stances(self, stroke: Stroke, width_mm: float, gap_mm: float) -> Iterator[Stance]:
        """Where the head is put down on a patch: at its open ends, then at its plainest places."""
        view = self.ledger.view(width_mm, self.settings.aperture_mm)
        ends = stances_at(view, stroke.ends_mm(), gap_mm)
        for _, stance in zip(range(ENDS), ends, strict=False):
            yield stance
        places = places_of(stroke, None)
        found = stances(view, places)
        found.sort(key=plainness, reverse=True)
        for scored in found[:PLACES]:
            yield scored.stance

    def _run(self, attempts: Attempts, stance: Stance) -> Followed | None:
        """A run from a stance; from a place in the middle of an open line from end to end."""
        try:
            run = attempts.run(stance)
            if stance.at_end or run.ending == "closed":
                return run
            if run.ending == "ended":
                back = turned_round(run.positions_mm[-1], run.heading_rad, run.view)
                other = attempts.run(back)
            else:
                other = attempts.run(turned_about(stance))
        except LineFault:
            return None
        return max(run, other, key=lambda some: some.travel_mm)

    def _on_ink(self, way: Array) -> Array:
        """A way as far as it runs on ink: it may have gone over a gap in the paper for what was struck off."""
        places = way[::THINNED]
        inked = self.ledger.was_ink(places)
        if inked.all():
            return way
        come_mm = lengths_mm(places)
        begins = np.flatnonzero(np.diff(np.r_[False, ~inked]) & ~inked)
        for begin in begins:
            inked_on = np.flatnonzero(inked[begin:])
            last = begin + (inked_on[0] if len(inked_on) else len(inked) - 1 - begin)
            if come_mm[last] - come_mm[begin] > self.settings.gap_mm:
                return way[: max(1, begin - 1) * THINNED + 1]
        return way

    def _led_on(self, way: Array) -> Array:
        """A way led on, at both its ends, to the middle of a line that was followed before and is met there."""
        way = self._led_on_from_end(way)
        return self._led_on_from_end(way[::-1])[::-1]

    def _led_on_from_end(self, way: Array) -> Array:
        """A way led on, at its end, straight to the middle of the line that it meets."""
        end = way[-1]
        reach_mm = MEETS_WIDTHS * self.usual_mm
        # 1. straight ahead, as the way comes
        behind = way[np.hypot(*(way - end).T) > self.usual_mm]
        if not len(behind):
            return way
        heading = (end - behind[-1]) / np.hypot(*(end - behind[-1]))
        steps = np.arange(0.0, reach_mm, 0.1 * self.usual_mm)
        ahead = end + steps[:, None] * heading
        away, met = self.ledger.nearest_way(ahead)
        nearest = int(np.argmin(away))
        if away[nearest] > 0.5 * self.usual_mm:
            return way
        # 2. as long as there was ink
        there = met[nearest]
        between = end + np.linspace(0, 1, 12)[:, None] * (there - end)
        if np.mean(self.ledger.was_ink(between)) < 0.8 or math.dist(end, there) < 1e-6:
            return way
        on = ramp.positions_mm(end, there, self.settings.speed_mm_s, rate_hz=MOTION_RATE_HZ)
        return np.vstack([way, on[1:]])


def all_ink(drawing: Drawing, settings: Settings) -> InkFollowed:
    """Follow every stretch of line on a drawing."""
    ledger = Ledger(drawing)
    sheet = Sheet.of(drawing)
    usual = float(np.average(sheet.widths_mm, weights=sheet.lengths_mm))
    rounds = Rounds(ledger, settings, settings.line_width_mm or usual)
    lines = list(rounds.strokes())
    rest = ledger.sheet()
    left_mm = 0.0 if rest is None else float(rest.lengths_mm.sum())
    return InkFollowed(lines, left_mm, 0 if rest is None else rest.patches.count)
