"""The cutter: a program whose tool runs beside the lines that were followed, a cutter's radius away, and
never nearer to any of them.

Signals: a Trace along the lines' middles and a cutter in; out a Trace along the offset paths of the cutter's
middle, and the stretches that the cutter cannot reach (mm).

    The tool is on an arm of the cutter's radius across the heading. Where the head swivels on a corner the
    arm swings the tool round it: the corner stays sharp, and the tool's path round. In a corner towards the
    tool the path turns where the tool touches both legs; what the tool leaves there is listed.

Side: `left` and `right` are those of the head's travel. `outside` is outside the part's outline and inside
its holes: of a line that lies in no other its outside, of a line in that one its inside, of a line in that
one its outside, and so on; `inside` (a pocket and its islands) is the other side of each. All lines that are
followed count as the part's edge: where two are nearer to each other than the cutter is wide, it does not go
between them. A line of which the cutter can touch nothing, such as a hole that is too small, is skipped and
listed.

What is drawn besides contours is transferred to the paths (see `transfer`). Lead and guide lines do not count
as edges, and no drilled hole is moved.

Source: patent ES 361967, section on use, has the draughtsman draw the contour larger by the cutter's radius;
the arm is our own, as on steered copying heads. Questions: a line that was lost is open so far as it was
traced: it is cut on the left or the right of its travel, and has no outside. Nor has a line round which the
lost one may go, as nobody knows whether it is a hole. A card may have the tool down
where no line is cut; a move that would cut into a contour is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import MotionFault
from morfax.motion.nesting import lies_inside
from morfax.motion.offset import DriveCurve, OffsetPath, offset
from morfax.motion.polyline import APART_MM, WITHIN_MM, Nearest, length_mm, plain, with_places
from morfax.tracer.cutter import sides
from morfax.tracer.cutter.contour import Beside, Cut
from morfax.tracer.cutter.contouring import (
    AS_FOLLOWED,
    Contouring,
    refuse_open,
    refuse_without_room,
    turned_round,
)
from morfax.tracer.cutter.gouges import refuse_gouges
from morfax.tracer.cutter.leads import Scrap
from morfax.tracer.cutter.lost_lines import CutterSide, with_sides
from morfax.tracer.cutter.runs import FeedRate
from morfax.tracer.cutter.start_places import StartPlaces
from morfax.tracer.cutter.transfer import transferred
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace

LEFT_MM = 0.002  # where no more than this is left, the cutter has touched the line, ...
# ... and a stretch where no more is left is not listed: the head wavers as much
LISTED_MM = 0.01
OPEN = "is open"  # and so has neither outside nor inside


@dataclass(frozen=True, slots=True)
class Cutter:
    """A cutter, and the side of the lines on which it runs."""

    diameter_mm: float
    side: CutterSide = "outside"

    @property
    def radius_mm(self) -> float:
        """Half of the diameter, mm."""
        return self.diameter_mm / 2


@dataclass(frozen=True, slots=True)
class Unreached:
    """A stretch of a line that the cutter does not touch, mm: where it leaves most, how much, and the lengths
    of the stretch and of the line.
    """

    line: int
    place_mm: tuple[float, float]
    left_mm: float
    length_mm: float
    of_mm: float


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A line that the cutter does not touch: length (mm), stops, and the room beside it if shut in."""

    line: int
    length_mm: float
    stops: tuple[int, ...]
    room: sides.Clearance | None


@dataclass(frozen=True, slots=True)
class Left:
    """What the cutter leaves: stretches of lines, the most left first, and whole lines, by number."""

    stretches: list[Unreached] = field(default_factory=list)
    lines: list[LeftOut] = field(default_factory=list)


def with_cutter(
    trace: Trace,
    cutter: Cutter,
    feed_mm_s: float,
    contouring: Contouring = AS_FOLLOWED,
    in_lost: Mapping[int, int] | None = None,
) -> tuple[Trace, Left]:
    """The program of a cutter beside the lines, run at a feed; and what the cutter cannot reach.

    `in_lost` has the lines round which a lost line may go, by their numbers: they have no side either.
    Raises MotionFault if the cutter goes nowhere, if a line has no such side, if the tool would be in the
    work nearer to a line than its radius, or if nothing can be contoured as is asked for; LineFault if all
    lines were lost, and have no such side.
    """
    # 1. contours and drive curves
    lines = with_sides(trace, cutter.side, in_lost or {})
    cuts = [cut for _, cut in lines if cut is not None]
    if not cuts:
        return replace(trace, lines=tuple(line for line, _ in lines)), Left()
    refuse_open(cuts, trace.lines, contouring)
    if trace.fault is not None:  # what lies inside a line that was lost is not known
        contouring = AS_FOLLOWED
    curves = _drive_curves(cuts, cutter.side)
    # 2. offset paths, and what they leave
    paths = offset(curves, cutter.radius_mm)
    if not paths:
        raise _goes_nowhere(curves, cutter)
    left = _left(cuts, curves, paths, cutter.radius_mm)
    # 3. the drawn program transferred to the paths
    near = Nearest([sides.whole(curve) for curve in curves], cutter.radius_mm)
    feed = FeedRate(feed_mm_s, trace.rate_hz)
    left_out = {out.line for out in left.lines}
    made, number = list[Line](), 0
    starts = StartPlaces(contouring, Scrap(curves, cutter.radius_mm, near))
    for line, cut in lines:
        if cut is None:
            made.append(line)
            continue
        own = [path for path in paths if path.guide == number]
        if line.number not in left_out and _has_paths(cut, own, cutter):
            side = Beside(cut, curves[number].left, cutter.radius_mm, own)
            side = turned_round(side, contouring)
            made += transferred(side, near.distances_mm, feed, starts)
        number += 1
    refuse_without_room(made, contouring)
    beside = replace(trace, lines=tuple(made))
    refuse_gouges(beside, near, cutter.diameter_mm)
    return beside, left


def _goes_nowhere(curves: Sequence[DriveCurve], cutter: Cutter) -> MotionFault:
    """The fault of a cutter that has room beside no line, with the widest cutter that has."""
    rooms = [sides.room(curves, k) for k in range(len(curves))]
    fits_mm = [room.passes_mm for room in rooms if room is not None]
    up_to = f", up to {max(fits_mm):g} mm" if any(fits_mm) else ""
    return MotionFault(
        f"a cutter of {cutter.diameter_mm:g} mm has no room {cutter.side} of any line;"
        f" give a smaller --cutter{up_to}, or another --side"
    )


def _has_paths(cut: Cut, paths: Sequence[OffsetPath], cutter: Cutter) -> bool:
    """Whether the cutter runs along a line.

    Raises MotionFault if it only passes the line on its way along another, and the line has stops; or if a
    lead line leads to a path that does not come round.
    """
    what = f"a cutter of {cutter.diameter_mm:g} mm {cutter.side} of line {cut.line.number}"
    if not paths and (cut.stops or cut.first > 0):
        raise MotionFault(
            f"{what} only passes it on its way along another line, and it has stops or a lead line;"
            " give a smaller --cutter, or another --side"
        )
    if cut.first > 0 and cut.closed and not all(path.closed for path in paths):
        raise MotionFault(
            f"{what} runs on along an open line that is nearer than the cutter is wide, and the line has a"
            " lead line; give a smaller --cutter, or the lines by --lines"
        )
    return bool(paths)


def _drive_curves(cuts: Sequence[Cut], side: CutterSide) -> list[DriveCurve]:
    """The contours as drive curves, each with the side on which the cutter runs."""
    if side in ("left", "right"):
        return [DriveCurve(cut.places_mm, cut.closed, side == "left") for cut in cuts]
    places = [sides.thinned(cut.places_mm) for cut in cuts]
    crossed = sides.crossing(places)
    wrong = dict[int, str]()
    for cut, crosses_itself in zip(cuts, crossed.diagonal(), strict=True):
        if not cut.closed:
            wrong[cut.line.number] = OPEN
        elif crosses_itself:
            wrong[cut.line.number] = "crosses itself"
    if wrong:
        raise _without_side(wrong, cuts, side)
    left = sides.tool_left(places, crossed, inside=side == "inside")
    return [
        DriveCurve(cut.places_mm, True, on_left)
        for cut, on_left in zip(cuts, left, strict=True)
    ]


def _without_side(wrong: dict[int, str], cuts: Sequence[Cut], side: CutterSide) -> MotionFault:
    """The fault of lines that have no outside and no inside, with the numbers of those that have."""
    number = min(wrong)
    odd_mm = [cut.places_mm for cut in cuts if cut.line.number in wrong]
    others, shut_in = list[int](), list[int]()
    for cut in cuts:
        if cut.line.number not in wrong:
            may_be_hole = any(lies_inside(cut.places_mm, line_mm) for line_mm in odd_mm)
            (shut_in if may_be_hole else others).append(cut.line.number)
    mend = "close it, on paper or by --gap; or " if wrong[number] == OPEN else ""
    alone = f", or {side} of the others alone by --lines {_listed(others)}" if others else ""
    if shut_in:
        alone += (
            f"; what may be a hole in it, alone by --lines {_listed(shut_in)} --side inside"
        )
    return MotionFault(
        f"line {number} {wrong[number]}: it has no {side}; {mend}give --side left or right, by its travel"
        f"{alone}"
    )


def _listed(numbers: Sequence[int]) -> str:
    """Numbers of lines as --lines takes them."""
    return ",".join(map(str, sorted(numbers)))


def _left(
    cuts: Sequence[Cut],
    curves: Sequence[DriveCurve],
    paths: Sequence[OffsetPath],
    radius_mm: float,
) -> Left:
    """The stretches of lines that the cutter does not reach, and the lines that it nowhere reaches."""
    near, left = Nearest([path.points_mm for path in paths], radius_mm), Left()
    for k, cut in enumerate(cuts):
        places = with_places(plain(cut.places_mm, WITHIN_MM), APART_MM)
        left_mm = near.distances_mm(places) - radius_mm
        if left_mm.min() > LEFT_MM:
            stops = tuple(stop.number for stop in cut.stops if stop.number is not None)
            room = sides.room(curves, k)
            left.lines.append(LeftOut(cut.line.number, cut.length_mm, stops, room))
        else:
            left.stretches.extend(_stretches(cut, places, left_mm))
    left.stretches.sort(key=lambda stretch: -stretch.left_mm)
    left.lines.sort(key=lambda out: out.line)
    return left


def _stretches(cut: Cut, places: Array, left_mm: Array) -> Iterator[Unreached]:
    """The stretches of a line, by its places (n, 2) mm, of which more than nothing is left."""
    if cut.closed:
        first = int(np.argmin(left_mm))  # no stretch is parted where the line begins
        places = np.roll(places, -first, axis=0)
        left_mm = np.roll(left_mm, -first)
    is_left = np.r_[False, left_mm > LEFT_MM, False].astype(np.int8)
    for a, b in np.flatnonzero(np.diff(is_left)).reshape(-1, 2):
        at = a + int(np.argmax(left_mm[a:b]))
        if left_mm[at] > LISTED_MM:
            place_mm = float(places[at, 0]), float(places[at, 1])
            long_mm = length_mm(places[a:b])
            yield Unreached(
                cut.line.number, place_mm, float(left_mm[at]), long_mm, cut.length_mm
            )
