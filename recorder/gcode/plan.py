"""The plan of a program: a motion as blocks, before any machine's words.

Signals in: a motion, a tolerance in mm, and how finely places are written. Signals out: blocks (rapids,
lines, arcs, dwells) with places in mm and feeds in mm/s. Programs (`recorder.gcode.blocks`) and drawings
(`recorder.drawings`) are written from the same plan.

The path is cut into stretches (`recorder.gcode.stretches`). A stretch in a plane is fitted with lines and
arcs (`recorder.gcode.arcs`), a slope with lines alone; an upright one is one line. The feed of a stretch is
the speed at which most of its length is run, unless the operator gives feeds; a stretch above the work, or
straight up, is a rapid.

Source: none of the patents says how the blocks of a program are found in a motion; chosen here. Questions: a
motion has a speed at every place and a program a feed for each block; the control slows down before corners
by its own rules. Depths that are whole counts of the Z unit are written as such.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.faults import MotionFault
from morfax.motion.segments import Source, as_path
from morfax.motion.usual import COUNT_MM
from morfax.recorder.gcode.arcs import fit
from morfax.recorder.gcode.machine import DECIMALS, TOLERANCE_MM
from morfax.recorder.gcode.program_text import Block
from morfax.recorder.gcode.spline import LineOrArc
from morfax.recorder.gcode.stretches import FeedStretch, stretches

# of an arc: its centre has to lie within the travel of the machine, +-2 m; a flatter one becomes lines
_LARGEST_RADIUS_MM = 1000.0
FLAT_SHARE = 0.05  # of the tolerance, kept for the chords of such an arc
# of the tolerance, at most 2 um: a depth as near to a whole count is written as that count
COUNT_SHARE = 0.25
# three times what thinning takes off the place where one move of Z ends and one begins
COUNT_REACH_MM = 0.002
# a plunge as long has reached its feed: at 200 mm/s², that of the Z unit, up to 10 mm/s
FELT_PLUNGE_MM = 0.5
SHORT_MM = 0.1  # a shorter line does not show how steep a slope is


@dataclass(frozen=True, slots=True)
class Feeds:
    """Feeds that the operator gives, mm/s; None: those of the motion."""

    cut_mm_s: float | None = None
    plunge_mm_s: float | None = None
    down_slopes_mm_s: float = math.inf  # of Z on a slope, at most

    def with_plunge_of(self, parts: Sequence[FeedStretch]) -> Feeds:
        """The feeds with that of Z on slopes: no more than what is asked for, or any straight plunge has."""
        speeds_mm_s = (part.speed_mm_s for part in parts if part.plunge_mm >= FELT_PLUNGE_MM)
        slowest_mm_s = min(speeds_mm_s, default=math.inf)
        return replace(self, down_slopes_mm_s=self.plunge_mm_s or slowest_mm_s)


@dataclass(frozen=True, slots=True)
class Writing:
    """How finely a program is written: distance from the motion at most, mm, decimals of a mm, arcs or lines
    only.
    """

    tolerance_mm: float = TOLERANCE_MM
    decimals: int = DECIMALS
    arcs: bool = True

    @property
    def last_digit_mm(self) -> float:
        """The step of the last decimal, mm."""
        return 10.0**-self.decimals


@dataclass(frozen=True, slots=True)
class BlockPlan:
    """Where a program starts, its blocks, the stretches that they stand for, and how well."""

    start_mm: Array
    blocks: list[Block]
    parts: list[FeedStretch]
    duration_s: float
    deviation_mm: float

    def count(self, *codes: str) -> int:
        """How many blocks bear one of some codes."""
        return sum(block.code in codes for block in self.blocks)


def plan(stream: Source, writing: Writing, feeds: Feeds | None = None) -> BlockPlan:
    """The blocks of a motion, which stay within the tolerance of it.

    Raises MotionFault for a motion that stands still, ValueError for a tolerance that cannot be written.
    """
    if not 2 * writing.last_digit_mm <= writing.tolerance_mm < math.inf:
        raise ValueError(
            f"a tolerance of {writing.tolerance_mm} mm cannot be written with {writing.decimals} decimals; "
            f"give {2 * writing.last_digit_mm:g} mm or more"
        )
    path = as_path(stream)
    parts = list(stretches(path, writing.tolerance_mm))
    if not parts:
        raise MotionFault(
            "the motion stands still at one place; a program needs at least two different places: look at "
            "the path, or trace the drawing again"
        )
    planner = _Planner(path.positions_mm[0], writing, (feeds or Feeds()).with_plunge_of(parts))
    for part in parts:
        planner.stretch(part)
    return BlockPlan(
        planner.start_mm, planner.blocks, parts, planner.duration_s, planner.deviation_mm
    )


class _Planner:
    """The blocks of a program so far, and the place that they have reached."""

    def __init__(self, start_mm: Array, writing: Writing, feeds: Feeds) -> None:
        self.writing, self.feeds = writing, feeds
        self.last_digit_mm = writing.last_digit_mm
        self.tolerance_mm = writing.tolerance_mm - self.last_digit_mm
        self.count_reach_mm = min(COUNT_REACH_MM, COUNT_SHARE * writing.tolerance_mm)
        self.blocks: list[Block] = []
        self.duration_s = self.deviation_mm = 0.0
        self.start_mm = self.place = self._written(start_mm)

    def stretch(self, stretch: FeedStretch) -> None:
        """BlockPlan a stretch, and the dwell before it."""
        if stretch.dwell_s:
            self.blocks.append(Block("G4", tuple(self.place), dwell_s=stretch.dwell_s))
        points = np.vstack([self.place, stretch.points_mm[1:]])
        feed_mm_s = self._feed_mm_s(stretch)
        is_fitted = stretch.kind == "plane" and self.writing.arcs and not stretch.rapid
        kept, off_mm = ([], 0.0) if is_fitted else _straightest(points, self.tolerance_mm)
        if stretch.kind == "slope" and not stretch.rapid:
            feed_mm_s = min(feed_mm_s, self.feeds.down_slopes_mm_s / _slope(points[kept]))
        length_mm = float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=1)).sum())
        self.duration_s += length_mm / feed_mm_s + stretch.dwell_s
        self.deviation_mm = max(self.deviation_mm, off_mm)
        for place in points[kept[1:]]:
            self._line(place, feed_mm_s, rapid=stretch.rapid)
        if is_fitted:
            self._fitted(points, feed_mm_s)

    def _fitted(self, points: Array, feed_mm_s: float) -> None:
        """BlockPlan lines and arcs through points in a plane."""
        for chain in fit(points[:, :2], (1 - FLAT_SHARE) * self.tolerance_mm):
            self.deviation_mm = max(self.deviation_mm, chain.deviation_mm + self.last_digit_mm)
            for segment in chain.segments:
                self._segment(segment, feed_mm_s, chain.deviation_mm)

    def _feed_mm_s(self, stretch: FeedStretch) -> float:
        """The feed of a stretch: the operator's, or the motion's."""
        asked_mm_s = (
            self.feeds.plunge_mm_s if stretch.kind == "upright" else self.feeds.cut_mm_s
        )
        return stretch.speed_mm_s if stretch.rapid or asked_mm_s is None else asked_mm_s

    def _segment(self, segment: LineOrArc, feed_mm_s: float, off_mm: float) -> None:
        """BlockPlan a line or an arc; an arc too flat for a centre becomes lines within the tolerance."""
        place: Array = np.array(
            [*np.round(segment.end_mm, self.writing.decimals), self.place[2]]
        )
        half = segment.turned_rad / 2
        dx, dy = (place - self.place)[:2]
        bulge = segment.length_mm / 2 * math.tan(half / 2)
        is_straight = abs(bulge) < self.last_digit_mm or (place == self.place).all()
        if is_straight or abs(segment.curvature_per_mm) * _LARGEST_RADIUS_MM < 1:
            chords = math.ceil(math.sqrt(abs(bulge) / (self.tolerance_mm - off_mm))) or 1
            for k in range(1, chords):
                part = replace(segment, length_mm=segment.length_mm * k / chords)
                self._line(np.array([*part.end_mm, self.place[2]]), feed_mm_s, rapid=False)
            self._line(place, feed_mm_s, rapid=False)
            self.deviation_mm = max(self.deviation_mm, off_mm + abs(bulge) / chords**2)
            return
        out = 0.5 / math.tan(half)
        centre = dx / 2 - out * dy, dy / 2 + out * dx
        code = "G3" if half > 0 else "G2"
        self.blocks.append(Block(code, tuple(place), centre, feed_mm_s))
        self.place = place

    def _line(self, place_mm: Array, feed_mm_s: float, *, rapid: bool) -> None:
        """BlockPlan a line or a rapid, if it goes anywhere."""
        place = self._written(place_mm)
        if (place == self.place).all():
            return
        self.blocks.append(Block("G0" if rapid else "G1", tuple(place), feed_mm_s=feed_mm_s))
        self.place = place

    def _written(self, place_mm: Array) -> Array:
        """A place (x, y, z) as it is written: to the last digit, a depth as the whole count that it nearly
        is.
        """
        place: Array = np.round(place_mm, self.writing.decimals)
        count_mm = round(place_mm[2] / COUNT_MM) * COUNT_MM
        off_mm = abs(float(place_mm[2]) - count_mm)
        if off_mm <= self.count_reach_mm:
            place[2] = round(count_mm, self.writing.decimals)
            self.deviation_mm = max(self.deviation_mm, off_mm)
        return place


def _slope(points: Array) -> float:
    """The steepest of some lines through points (n, 3) mm: Z to the length of the line, at least 1e-9."""
    steps = np.diff(points, axis=0)
    lengths_mm = np.maximum(np.sqrt((steps**2).sum(axis=1)), SHORT_MM)
    return max(float((np.abs(steps[:, 2]) / lengths_mm).max()), NOT_ZERO)


def _straightest(points: Array, tolerance_mm: float) -> tuple[list[int], float]:
    """Points whose chords stay within a tolerance of all others (Douglas, Peucker), and the largest gap."""
    kept = {0, len(points) - 1}
    worst_mm = 0.0
    waiting = [(0, len(points) - 1)]
    while waiting:
        first, last = waiting.pop()
        off_mm = _off_line_mm(points[first : last + 1])
        worst = int(np.argmax(off_mm))
        if off_mm[worst] > tolerance_mm:
            kept.add(first + worst)
            waiting += [(first, first + worst), (first + worst, last)]
        else:
            worst_mm = max(worst_mm, float(off_mm[worst]))
    return sorted(kept), worst_mm


def _off_line_mm(points: Array) -> Array:
    """Distance of each point from the straight piece between first and last."""
    along = points[-1] - points[0]
    off = points - points[0]
    square = float(along @ along)
    share = np.clip(off @ along / square, 0.0, 1.0) if square else np.zeros(len(points))
    return np.sqrt(((off - np.multiply.outer(share, along)) ** 2).sum(axis=1))
