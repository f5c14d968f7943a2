"""Bent stretches: where the head ran from memory beside its ink, it runs along a spline that explains that.

    ────╮  ╭────     the relief of an inner corner, a step with a round, an arc that begins at a corner: a
        ╰──╯         bend shorter than a leg is felt as an average, and the way bulges or cuts it short

Wherever the swinging cell did not lead along a closed line, or an open one between its ends, the pen's ink
along the way is held against the sheet's, place by place. Where it leaves more than noise does, a spline is
laid by the ink (see `tangles.spline`) between clean places of the way on either side, with the corners of the
way, or some more or fewer. If it explains the ink, and the head's own way does not, the head runs along it
from memory.

Signals: the sheet and lines in; the lines with those stretches bent onto their ink out.

Source: our own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm, lengths_mm, nearest_mm
from morfax.motion.usual import THINNED
from morfax.tracer.following.line import Line
from morfax.tracer.head.leaders import CELL
from morfax.tracer.limits import AS_WIDE
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines
from morfax.tracer.program.against_ink.off_ink import (
    OFF,
    REACH,
    Clean,
    UsualPen,
    felt_at,
    goes_on,
    ink_about,
    without_lone_pixels,
    wrong_about,
)
from morfax.tracer.program.laid.bay_run import Bay
from morfax.tracer.program.laid.laid_way import LaidWay
from morfax.tracer.program.laid.line_parts import (
    LEGS,
    OF_LOOP,
    STILL_LEFT,
    is_bare,
    is_clear,
)
from morfax.tracer.program.laid.spline_fit import (
    CORNER_RAD,
    MAYBE_RAD,
    PRICE,
    about_corners,
    explained,
    left_by,
    turns_rad,
)
from morfax.tracer.program.laid.way_ink import WayInk
from morfax.tracer.program.setup import Setup
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.seen_ink import SeenInk

# In widths of the line, chosen by trial on parts with reliefs and on racks of teeth, drawn with known truth:
LONGEST = 18.0  # a stretch is no longer, legs apart
LONGER = 0.15  # than a way that does not turn: it goes out along a burr and comes back
TURNS_OVER = 1.0  # on either side of a place, by how much the way turns there
MOST_ASIDE = 0.5  # that a spline lies off the way: further is out along a tick, or round a bay


def bent(setup: Setup, lines: Sequence[Line]) -> list[Line]:
    """The lines with the head run along splines where it ran beside its ink."""
    lines = list(lines)
    if not is_clear(setup.sheet.drawing) or setup.operator.reads_marks(lines):
        return lines
    beside = BoxedLines.of(lines)
    ways = {k: _Way(setup, line, beside) for k, line in enumerate(lines)}
    ways = {k: way for k, way in ways.items() if way.may_be_off}
    while ways:
        # lines of about one width are one pen's
        width_mm = next(iter(ways.values())).line.width_mm
        like = {k for k, way in ways.items() if abs(way.line.width_mm / width_mm - 1) < AS_WIDE}
        clean = [Clean(ways[k].way, np.flatnonzero(ways[k].by_cell)) for k in like]
        felt = felt_at(setup.sheet.drawing, clean, width_mm)
        for k in like:
            way = ways.pop(k)
            lines[k] = way.line if felt is None else way.bent(felt)
            setup.come(len(lines) - len(ways), len(lines))
    return lines


@dataclass(frozen=True, eq=False)
class _Way(WayInk):
    """The way of one of some lines, and the ink about it."""

    @cached_property
    def by_cell(self) -> NDArray[np.bool_]:
        """Whether the swinging cell led to each place."""
        line = self.line
        _, leaders = line.led.thinned(line.xy_mm, THINNED)
        lengths = lengths_mm(line.places_mm)
        at = np.searchsorted(lengths, np.arange(len(self.way)) * self.step_mm)
        return np.asarray(leaders[np.minimum(at, len(leaders) - 1)] == CELL)

    @cached_property
    def turning(self) -> NDArray[np.bool_]:
        """Whether the way turns at each place."""
        over = round(TURNS_OVER / STEP_WIDTHS)
        beyond = ((over, over), (0, 0))
        way = np.pad(self.way, beyond, mode="wrap" if self.is_closed else "edge")
        return np.asarray(turns_rad(way, TURNS_OVER)[over:-over] > MAYBE_RAD)

    @cached_property
    def corners(self) -> list[int]:
        """The places at which it turns sharply; of a closed way those a round before and behind, too."""
        count, rounds = len(self.way), (-1, 0, 1) if self.is_closed else (0,)
        return [at + k * count for at in self.corners_at() for k in rounds]

    @property
    def may_be_off(self) -> bool:
        """Whether it is a line without marks along which the swinging cell did not lead all along."""
        line = self.line
        if not is_bare(line) or line.as_told or line.length_mm < 4 * LEGS[0] * line.width_mm:
            return False
        return not self.by_cell.all()

    def bent(self, felt: UsualPen) -> Line:
        """The line as it is, or along the splines that explain its ink better."""
        bays = [bay for off in self._off(felt) if (bay := self._bay(*off, felt)) is not None]
        return self.along(bays).line

    def _off(self, felt: UsualPen) -> Iterator[tuple[int, int]]:
        """The stretches that are off their ink, from which place to which."""
        leg = round(LEGS[0] / STEP_WIDTHS)
        off = np.zeros(len(self.way), bool)
        for first, last in runs_of(self._between_ends(~self.by_cell), leg, self.is_closed):
            if not self.turning[np.arange(first, last + 1) % len(off)].any():
                continue  # straight on over a crossing, it is on its ink
            for begin in range(first, last + 1, round(LONGEST / STEP_WIDTHS)):
                end = min(begin + round(LONGEST / STEP_WIDTHS), last + 1)
                ink, own = self._seen(begin - leg, end + leg, felt)
                wrong = wrong_about(ink, own, about_corners(own), STEP_WIDTHS)[leg:-leg]
                off[np.arange(begin, end + 1) % len(off)] |= wrong > felt.limit
        yield from runs_of(off, leg, self.is_closed)

    def _between_ends(self, chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Those of some places (n,) that are a leg and a step from the ends of an open way."""
        leg = round(LEGS[0] / STEP_WIDTHS) + 1
        return chosen if self.is_closed else np.pad(chosen[leg:-leg], leg)

    def _seen(self, first: int, last: int, felt: UsualPen) -> tuple[SeenInk, Array]:
        """The ink about a stretch, as the line's pen left it, and the stretch."""
        way, drawing = self.way, self.setup.sheet.drawing
        own = way[np.arange(first, last + 1) % len(way)]
        reach_mm = 2 * REACH * self.line.width_mm
        low, high = own.min(axis=0) - reach_mm, own.max(axis=0) + reach_mm
        near = [(part, 0.0) for part in self.rest_within(first, last, low, high)]
        for line, part in self.lines.parts(low, high, self.line):
            near.append((part, 0.5 * (line.width_mm - self.line.width_mm)))
        ink = felt.pen.sees(ink_about(drawing, own, self.line.width_mm, REACH, near))
        return without_lone_pixels(ink, own, drawing.pitch_mm), own

    def _bay(self, first: int, last: int, felt: UsualPen) -> Bay | None:
        """The spline along a stretch that is off its ink, if that explains the ink and the way does not."""
        count, leg = len(self.way), round(LEGS[0] / STEP_WIDTHS)
        first = _off_corners(first - leg, self.corners, -1)
        last = _off_corners(last + leg, self.corners, 1)
        if last - first > min(2 * leg + LONGEST / STEP_WIDTHS, OF_LOOP * count):
            return None
        if not self.is_closed and not 0.5 * leg < first < last < count - 0.5 * leg:
            return None
        ink, own = self._seen(first, last, felt)
        if goes_on(ink, own, REACH):
            return None
        spline = explained(ink, own, self.step_mm, felt.limit)
        if spline is None:
            return None
        left = left_by(ink, own, about_corners(own))
        if spline.worst > felt.limit and spline.misfit > STILL_LEFT * left:
            return None
        gain, width_mm = left - spline.cost, self.line.width_mm
        longer_mm = length_mm(spline.way) - length_mm(own)
        if longer_mm > LONGER * width_mm and turns_rad(own, TURNS_OVER).max() < CORNER_RAD:
            return None
        # an open stroke may turn within the ink of another, which a spline explains as well
        least = PRICE if self.is_closed else OFF
        if gain < least or nearest_mm(spline.way, own).max() > MOST_ASIDE * width_mm:
            return None
        rule = LaidWay(spline.stretches(), 0.5 * self.line.width_mm, spline.misfit)
        return self.as_bay(first, last, rule, gain)


def runs_of(
    chosen: NDArray[np.bool_], apart: int, is_closed: bool
) -> Iterator[tuple[int, int]]:
    """From which place of a way to which some are chosen, nearer than twice so many places to one another;
    the last of a closed way may be over the end.
    """
    found, count = np.flatnonzero(chosen), len(chosen)
    if not len(found):
        return
    if is_closed:
        gaps = np.diff(np.r_[found, found[0] + count])
        if gaps.max() <= 2 * apart:
            yield int(found[0]), int(found[0]) + count - 1
            return
        begin = int(np.argmax(gaps)) + 1
        found = np.r_[found[begin:], found[:begin] + count]
    for run in np.split(found, np.flatnonzero(np.diff(found) > 2 * apart) + 1):
        yield int(run[0]), int(run[-1])


def _off_corners(at: int, corners: Sequence[int], away: int) -> int:
    """A place moved away from corners, so that the way there is clean."""
    leg = round(LEGS[0] / STEP_WIDTHS)
    for corner in sorted(corners, reverse=away < 0):
        if abs(at - corner) < 0.5 * leg:
            at = corner + away * leg
    return at
