"""The cutter: a program whose tool runs beside the lines that were followed, a cutter's radius away, and
never nearer to any of them.

Signals: a Trace along the lines' middles and a cutter in; out a Trace along the ways of the cutter's middle,
and the places that the cutter cannot reach (mm).

    The tool is on an arm of the cutter's radius across the heading. Where the head swivels on a corner the
    arm swings the tool round it: the corner stays sharp, and the tool's way round. In a corner towards the
    tool the way turns where the tool touches both legs; what it leaves there is listed.

Side: `left` and `right` are those of the head's travel. `outside` is the outside of the part: of a line that
lies in none of the others its outside, of one in it (a hole) its inside, of one in that its outside, and so
on; `inside` (a pocket and its islands) is the other side of each. All lines that are followed count as the
part's edge: where two are nearer to each other than the cutter is wide, it does not go between them. A line
of which it can touch nothing, such as a hole that is too small, is left out and listed.

What is drawn besides contours is carried over to the ways (see `carried`). Neither lead nor guide lines count
as edges, and no hole is moved.

Source: patent ES 361967, section on use, has the draughtsman draw the contour larger by the cutter's radius;
the arm is our own, as on steered copying heads. Questions: a line that was lost is open so far as it was
traced: it is cut on the left or the right of its travel, and has no outside. A card may have the tool down
where no line is cut; what would cut into a contour is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault, MotionFault
from morfax.motion.offset import Guide, Way, offset
from morfax.motion.polyline import WITHIN_MM, Nearest, plain, with_places
from morfax.tracer.cutter import sides as edges
from morfax.tracer.cutter.contour import Beside, Cut
from morfax.tracer.cutter.transfer import Feed, carried
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import Trace

Side = Literal["outside", "inside", "left", "right"]

LEFT_MM = 0.002  # less is reached,
LISTED_MM = 0.01  # and where nowhere more is left, nothing is listed: so much the head wavers
EVERY_MM = 0.02  # between the places of a line that are looked at
GOUGE_MM = 0.005  # nearer to a line than the radius
GOUGES = 10  # of the positions one in so many is looked at


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
    """A stretch of a line that the cutter does not touch: where it leaves most, how much that is, how long
    the stretch is, and the line (mm).
    """

    line: int
    place_mm: tuple[float, float]
    left_mm: float
    length_mm: float
    of_mm: float


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A line of which the cutter touches nothing: how long it is (mm), its stops, and how much room there is
    beside it, if it is shut in.
    """

    line: int
    length_mm: float
    stops: tuple[int, ...]
    room: edges.Room | None


@dataclass(frozen=True, slots=True)
class Left:
    """What the cutter leaves: stretches of lines, that of which most is left first, and whole lines, by
    number.
    """

    stretches: list[Unreached] = field(default_factory=list)
    lines: list[LeftOut] = field(default_factory=list)


def with_cutter(trace: Trace, cutter: Cutter, feed_mm_s: float) -> tuple[Trace, Left]:
    """The program of a cutter beside the lines, run at a feed; and what it cannot reach.

    Raises MotionFault if the cutter goes nowhere, if a line has no such side, or if the tool would be in the
    work nearer to a line than its radius; LineFault if all lines were lost, and have no such side.
    """
    planned = _planned(trace, cutter.side)
    cuts = [cut for _, cut in planned if cut is not None]
    if not cuts:
        return replace(trace, lines=tuple(line for line, _ in planned)), Left()
    guides = _guides(cuts, cutter.side)
    ways = offset(guides, cutter.radius_mm)
    if not ways:
        raise _goes_nowhere(guides, cutter)
    left = _left(cuts, guides, ways, cutter.radius_mm)
    near = Nearest([edges.closed_up(guide) for guide in guides], cutter.radius_mm)
    feed, made = Feed(feed_mm_s, trace.rate_hz), list[Line]()
    for line, cut in planned:
        if cut is None:
            made.append(line)
            continue
        k = next(k for k, other in enumerate(cuts) if other is cut)
        own = [way for way in ways if way.guide == k]
        if all(line.number != out.line for out in left.lines) and _has_ways(cut, own, cutter):
            made += carried(
                Beside(cut, guides[k].left, cutter.radius_mm, own), near.distances_mm, feed
            )
    beside = replace(trace, lines=tuple(made))
    _refuse_gouges(beside, near, cutter)
    return beside, left


def _goes_nowhere(guides: Sequence[Guide], cutter: Cutter) -> MotionFault:
    """The fault of a cutter that has room beside no line, with the widest that has."""
    rooms = [
        room for room in (edges.room(guides, k) for k in range(len(guides))) if room is not None
    ]
    most_mm = max((room.passes_mm for room in rooms), default=0.0)
    smaller = (
        f"a smaller --cutter, up to {most_mm:g} mm," if most_mm > 0 else "a smaller --cutter,"
    )
    return MotionFault(
        f"a cutter of {cutter.diameter_mm:g} mm goes nowhere {cutter.side} of the lines; give {smaller} or another --side"
    )


def _planned(trace: Trace, side: Side) -> list[tuple[Line, Cut | None]]:
    """The lines with the numbers of their stops, each with what is cut of it; a line that was lost has no
    outside and no inside.
    """
    planned, first = list[tuple[Line, Cut | None]](), 1
    for line in trace.lines:
        halts = trace.operator.stops(line, first)
        line = replace(line, numbers=tuple(halt.number or 0 for halt in halts))
        if line.ending == "lost" and side in ("outside", "inside"):
            planned.append((_not_cut(line, side), None))
        else:
            planned.append((line, Cut.of(line, trace.operator, first)))
        first += len(halts)
    if planned and all(line.ending == "lost" and cut is None for line, cut in planned):
        raise replace(trace, lines=tuple(line for line, _ in planned)).fault or LineFault(
            "no line was followed"
        )
    return planned


def _not_cut(line: Line, side: Side) -> Line:
    """A line that was lost, with nothing of it to be run, and its fault that says so."""
    fault = line.fault
    told = LineFault(
        f"{fault}; what was traced of it is open and has no {side}, so it is not cut: --side left or right would, by its travel",
        x_mm=fault.x_mm if fault else None,
        y_mm=fault.y_mm if fault else None,
        heading_rad=fault.heading_rad if fault else None,
    )
    return replace(
        line, xy_mm=line.xy_mm[:1], loop_from=None, marks=(), guides=(), numbers=(), fault=told
    )


def _has_ways(cut: Cut, ways: Sequence[Way], cutter: Cutter) -> bool:
    """Whether the cutter runs along a line; raises MotionFault if it only comes by, and something is to be
    done there, or if a lead line comes to no round.
    """
    what = f"a cutter of {cutter.diameter_mm:g} mm {cutter.side} of line {cut.line.number}"
    if not ways and (cut.stops or cut.first > 0):
        raise MotionFault(
            f"{what} only comes by it on its way along another, and the line has stops or a lead line; give a smaller --cutter, or another --side"
        )
    if cut.first > 0 and cut.closed and not all(way.closed for way in ways):
        raise MotionFault(
            f"{what} runs on along an open line that is nearer than it is wide, and the line has a lead line; give a smaller --cutter, or the lines by --lines"
        )
    return bool(ways)


def _refuse_gouges(beside: Trace, near: Nearest, cutter: Cutter) -> None:
    """Raise MotionFault if the tool moves in the work nearer to a line than its radius, as where a card has
    it go down on the way to a contour.
    """
    for block in beside:
        moves = np.flatnonzero(np.any(np.diff(block.positions_mm[:, :2], axis=0) != 0, axis=1))
        cutting = block.positions_mm[moves][block.positions_mm[moves, 2] < 0, :2][::GOUGES]
        away_mm = near.distances_mm(cutting) if len(cutting) else np.array([np.inf])
        if away_mm.min() < cutter.radius_mm - GOUGE_MM:
            x, y = cutting[int(np.argmin(away_mm))]
            raise MotionFault(
                f"a cutter of {cutter.diameter_mm:g} mm would cut into the part at {x:.1f},{y:.1f} mm, where a stop's moves leave it in the work;"
                " have it up on the card there, or pass the stop by with --stop-override"
            )


def _guides(cuts: Sequence[Cut], side: Side) -> list[Guide]:
    """What is cut as guides, each with the side on which the cutter runs."""
    if side in ("left", "right"):
        return [Guide(cut.places_mm, cut.closed, side == "left") for cut in cuts]
    places = [edges.thinned(cut.places_mm) for cut in cuts]
    crossed = edges.crossing(places)
    wrong = {
        cut.line.number: "is open" if not cut.closed else "crosses itself"
        for cut, own in zip(cuts, crossed.diagonal(), strict=True)
        if own or not cut.closed
    }
    if wrong:
        raise _without_side(
            wrong, [cut.line.number for cut in cuts if cut.line.number not in wrong], side
        )
    return [
        Guide(
            cut.places_mm,
            True,
            edges.is_counterclockwise(line) == ((side == "inside") == (depth % 2 == 0)),
        )
        for cut, line, depth in zip(cuts, places, edges.depths(places, crossed), strict=True)
    ]


def _without_side(wrong: dict[int, str], others: Sequence[int], side: Side) -> MotionFault:
    """The fault of lines that have no outside and no inside, with the numbers of those that have."""
    number = min(wrong)
    alone = (
        f", or {side} of the others alone by --lines {','.join(map(str, sorted(others)))}"
        if others
        else ""
    )
    return MotionFault(
        f"line {number} {wrong[number]}: it has no {side}; give --side left or right, by its travel{alone}"
    )


def _left(
    cuts: Sequence[Cut], guides: Sequence[Guide], ways: Sequence[Way], radius_mm: float
) -> Left:
    """The stretches of the lines that are further from every way than the cutter reaches, and the lines that
    are so all along.
    """
    near, left = Nearest([way.points_mm for way in ways], radius_mm), Left()
    for k, cut in enumerate(cuts):
        places = with_places(plain(cut.places_mm, WITHIN_MM), EVERY_MM)
        left_mm = near.distances_mm(places) - radius_mm
        if left_mm.min() > LEFT_MM:
            stops = tuple(stop.number for stop in cut.stops if stop.number is not None)
            left.lines.append(
                LeftOut(cut.line.number, cut.length_mm, stops, edges.room(guides, k))
            )
        else:
            left.stretches.extend(_stretches(cut, places, left_mm))
    left.stretches.sort(key=lambda stretch: -stretch.left_mm)
    left.lines.sort(key=lambda out: out.line)
    return left


def _stretches(cut: Cut, places: Array, left_mm: Array) -> Iterator[Unreached]:
    """The stretches of a line of whose places (n, 2) mm more than nothing is left."""
    if cut.closed:
        first = int(np.argmin(left_mm))  # no stretch is parted where the line begins
        places, left_mm = np.roll(places, -first, axis=0), np.roll(left_mm, -first)
    ends = np.flatnonzero(
        np.diff(np.r_[False, left_mm > LEFT_MM, False].astype(np.int8))
    ).reshape(-1, 2)
    for a, b in ends:
        at = a + int(np.argmax(left_mm[a:b]))
        if left_mm[at] > LISTED_MM:
            length_mm = float(np.hypot(*np.diff(places[a:b], axis=0).T).sum())
            place_mm = float(places[at, 0]), float(places[at, 1])
            yield Unreached(
                cut.line.number, place_mm, float(left_mm[at]), length_mm, cut.length_mm
            )
