"""The cutter: a program whose tool runs beside the lines that were followed, a cutter's radius away, and never nearer to any of them.

Signals: a Trace along the lines' middles and a cutter in; out a Trace along the ways of the cutter's middle, and the places that the cutter cannot reach (mm).

    The tool is on an arm of the cutter's radius across the heading. Where the head swivels on a corner the arm swings the tool round it: the corner
    stays sharp, and the tool's way round. In a corner towards the tool the way turns where the tool touches both legs; what it leaves there is listed.

Side: `left` and `right` are those of the head's travel. `outside` is the outside of the part: of a line that lies in none of the others its outside, of one
in it (a hole) its inside, of one in that its outside, and so on; `inside` (a pocket and its islands) is the other side of each. All lines that are
followed count as the part's edge: where two are nearer to each other than the cutter is wide, it does not go between them.

Source: patent ES 361967, section on use, has the draughtsman draw the contour larger by the cutter's radius; the arm is our own, as on steered copying heads.
Questions: lead lines and marks are drawn with the cutter allowed for, so a drawing that has them is refused. A line that was lost has no sides, and is not cut.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from motion.faults import MotionFault
from motion.feed import run_along
from motion.offset import Guide, Nearest, Way, offset, with_places
from tracer import contours
from tracer.line import Line
from tracer.program import BRAKE_MM_S2, Trace
from tracer.view import Array

Side = Literal["outside", "inside", "left", "right"]

LEFT_MM = 0.002  # less is no place that the cutter cannot reach
EVERY_MM = 0.02  # between the places of a line that are looked at
THINNED = 30  # of the positions one in so many tells where a line is


@dataclass(frozen=True, slots=True)
class Cutter:
    """A cutter, and the side of the lines on which it runs."""

    diameter_mm: float
    side: Side = "outside"

    @property
    def radius_mm(self) -> float:
        """Half of the diameter, mm."""
        return self.diameter_mm / 2


@dataclass(frozen=True, slots=True)
class Unreached:
    """A stretch of a line that the cutter does not touch: where it leaves most, how much that is, and how long the stretch is (mm)."""

    line: int
    place_mm: tuple[float, float]
    left_mm: float
    length_mm: float


def with_cutter(trace: Trace, cutter: Cutter, feed_mm_s: float) -> tuple[Trace, list[Unreached]]:
    """The program of a cutter beside the lines, run at a feed; and what it cannot reach, the most first.

    Raises MotionFault if the cutter goes nowhere, if a line has no such side, or if the drawing has marks or lead lines.
    """
    _refuse_marks(trace)
    lines = [line for line in trace.lines if line.ending != "lost" and len(line.xy_mm) > 1]
    ways = offset(_guides(lines, cutter.side), cutter.radius_mm)
    if lines and not ways:
        raise MotionFault(
            f"a cutter of {cutter.diameter_mm:g} mm goes nowhere {cutter.side} of the lines; give a smaller --cutter, or another --side"
        )
    cut = [_cut(line, way, feed_mm_s, trace.rate_hz) for k, line in enumerate(lines) for way in ways if way.guide == k]
    lost = [replace(line, xy_mm=line.xy_mm[:1]) for line in trace.lines if line.ending == "lost"]
    return replace(trace, lines=(*cut, *lost)), _unreached(lines, ways, cutter.radius_mm)


def _refuse_marks(trace: Trace) -> None:
    """Raise MotionFault if the program stops at marks, or goes along lead or guide lines."""
    halts = any(action.halt.number is not None for actions in trace.actions for action in actions)
    if halts or any(line.goes_back or line.guides for line in trace.lines):
        raise MotionFault(
            "the drawing has stop marks, lead or guide lines, which are drawn with the cutter allowed for; leave --cutter out,"
            " or take them off the drawing (--override all passes over stop marks)"
        )


def _guides(lines: Sequence[Line], side: Side) -> list[Guide]:
    """The lines as guides, each with the side on which the cutter runs."""
    if side in ("left", "right"):
        return [Guide(line.xy_mm, line.ending == "closed", side == "left") for line in lines]
    for line in lines:
        if line.ending != "closed" or not _is_simple(line.xy_mm):
            what = "crosses itself" if line.ending == "closed" else "is open"
            raise MotionFault(f"line {line.number} {what}: it has no {side}; give --side left or right, by its travel")
    thinned = [line.xy_mm[::THINNED] for line in lines]
    depths = contours.nested(thinned, [True] * len(lines)).sum(axis=1)
    return [
        Guide(line.xy_mm, True, _is_left(places, inside=(side == "inside") == (depth % 2 == 0)))
        for line, places, depth in zip(lines, thinned, depths, strict=True)
    ]


def _is_left(places: Array, inside: bool) -> bool:
    """Whether the inside, or the outside, of a closed line lies to its left."""
    x, y = (places - places[0]).T
    counterclockwise = bool(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0)
    return counterclockwise == inside


def _is_simple(xy_mm: Array) -> bool:
    """Whether a closed line turns once round in all, as one that does not cross itself."""
    places = with_places(xy_mm, 1.0)[::THINNED] if len(xy_mm) < 4 * THINNED else xy_mm[::THINNED]
    ways = np.diff(np.vstack([places, places[:1]]), axis=0)
    headings = np.arctan2(*ways[np.hypot(*ways.T) > EVERY_MM / 10].T[::-1])
    turned = np.angle(np.exp(1j * np.diff(np.r_[headings, headings[:1]]))).sum()
    return bool(round(abs(turned) / (2 * np.pi)) == 1)


def _cut(line: Line, way: Way, feed_mm_s: float, rate_hz: float) -> Line:
    """A way of the cutter as a line of the program."""
    xy_mm = run_along(way.points_mm, feed_mm_s, BRAKE_MM_S2, rate_hz)
    length_mm = float(np.hypot(*np.diff(way.points_mm, axis=0).T).sum())
    return Line(xy_mm, "closed" if way.closed else "ended", line.width_mm, length_mm, number=line.number)


def _unreached(lines: Sequence[Line], ways: Sequence[Way], radius_mm: float) -> list[Unreached]:
    """The stretches of the lines that are further from every way than the cutter reaches."""
    if not ways:
        return []
    near = Nearest([way.points_mm for way in ways], radius_mm)
    found = []
    for line in lines:
        places = with_places(line.xy_mm, EVERY_MM)
        left_mm = near.distances_mm(places) - radius_mm
        if line.ending == "closed":
            first = int(np.argmin(left_mm))  # no stretch is parted where the line begins
            places, left_mm = np.roll(places, -first, axis=0), np.roll(left_mm, -first)
        edges = np.flatnonzero(np.diff(np.r_[False, left_mm > LEFT_MM, False].astype(np.int8))).reshape(-1, 2)
        for a, b in edges:
            at = a + int(np.argmax(left_mm[a:b]))
            length_mm = float(np.hypot(*np.diff(places[a:b], axis=0).T).sum())
            place_mm = float(places[at, 0]), float(places[at, 1])
            found.append(Unreached(line.number, place_mm, float(left_mm[at]), length_mm))
    return sorted(found, key=lambda stretch: -stretch.left_mm)
