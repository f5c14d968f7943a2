"""A drawn program carried over from its contour to the ways of the cutter beside it: lead line, stops, guide
lines, and the way back.

Signals: a line as it was followed, and the ways of the cutter along its contour, in; out the lines that are
run instead, mm at the motion rate, each with its lead line, marks and guide lines where they are then.

    reference ──tick──┐ way of the cutter          reference ──────── contour
                      │   ─── contour                            tick   │   raised over the contour,
                      └──                                               └──▶ down on the way
       it is met on this side                      it is not met: the cutter runs on the other side

    lead line   as drawn, to where it first crosses the way after the last tick, or last crosses it before that; else to its end, and from
                there straight to the foot of the place where it joins. The tool goes down at the tick if from there on no place of the lead line
                is nearer to a contour than the radius; else where the way begins.
    stop mark   at its foot on the way (see `beside`)
    guide line  as drawn, from where it crosses the way; else from its foot, straight to where it was drawn from. Nothing drilled is moved.

The numbers of the stops stay those of the drawing, also where the cutter comes to them in another order.

Source: our own. The patent's draughtsman allows for the cutter himself (ES 361967, section on use).
Questions: a contour of which the cutter's way is in pieces has one lead line. The other pieces are run before
it, from the reference point, so that the program ends there; the tool is raised from piece to piece.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.feed import run_along
from morfax.motion.polyline import lengths_mm
from morfax.tracer.cutter.contour import Beside, Place
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.program import braking as stops
from morfax.tracer.program.program import BRAKE_MM_S2

CLEAR_MM = 0.001  # a place is clear if it is no nearer to a contour than the radius less this
NOTHING_MM = 1e-6
# radii along a guide line: where it crosses the way later than this, it comes to another part of it
OBLIQUE = 2.0

Distances = Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Feed:
    """How fast the ways are run, and the motion rate."""

    mm_s: float
    rate_hz: float

    def run(self, way_mm: Array) -> Array:
        """Positions along a way (n, 2) mm from rest to rest."""
        if np.hypot(*np.diff(way_mm, axis=0).T).sum() < NOTHING_MM:
            return way_mm[-1:]
        return run_along(way_mm, self.mm_s, BRAKE_MM_S2, self.rate_hz)

    def resting(
        self, rows_mm: Array, at: Sequence[float]
    ) -> tuple[Array, Callable[[float], float]]:
        """Positions (n, 2) mm that come to rest at some of them, fractions included, the last of which ends
        them; and where each is then.
        """
        pieces = stops.pieces(rows_mm, at, BRAKE_MM_S2, self.rate_hz)[: len(at)]
        rested = np.vstack([pieces[0], *(piece[1:] for piece in pieces[1:])])
        rests = [len(pieces[0]) - 1, *(len(piece) - 1 for piece in pieces[1:])]
        was, now = lengths_mm(rows_mm), lengths_mm(rested)
        knots = [
            np.r_[0.0, np.interp(at, np.arange(len(was)), was)],
            np.r_[0.0, now[np.cumsum(rests)]],
        ]
        return rested, lambda old: _position(
            rested, float(np.interp(np.interp(old, np.arange(len(was)), was), *knots))
        )


@dataclass(frozen=True, slots=True)
class _Lead:
    """The lead line to a way: positions (n, 2) mm, the last at rest on the way, and where that is; those for
    the drawn marks, and guide lines.
    """

    xy_mm: Array
    place: Place
    at: dict[float, float]
    guides: list[GuideLine]


@dataclass(slots=True)
class _Run:
    """A way as it is run, from one of its places on: positions (n, 2) mm, and for positions of the drawn line
    those that stand for them.
    """

    xy_mm: Array
    way_mm: Array
    begin_mm: float  # along the way
    at: dict[float, float] = field(default_factory=dict)
    guides: list[GuideLine] = field(default_factory=list)

    @classmethod
    def along(cls, way_mm: Array, begin: float, feed: Feed) -> _Run:
        """Run a way; a closed one from and to a place between its points."""
        k = int(begin)
        place = way_mm[k] + (begin - k) * (way_mm[min(k + 1, len(way_mm) - 1)] - way_mm[k])
        points = (
            np.vstack([place, way_mm[k + 1 :], way_mm[1 : k + 1], place])
            if begin > 0
            else way_mm
        )
        return cls(
            feed.run(points),
            way_mm,
            float(np.interp(begin, np.arange(len(way_mm)), lengths_mm(way_mm))),
        )

    def position(self, place: Place) -> float:
        """Which position is at a place of the way, fractions included, before any guide line is put in."""
        along = lengths_mm(self.way_mm)
        mm = float(np.interp(place.at, np.arange(len(along)), along)) - self.begin_mm
        mm = mm if mm >= 0 else mm + along[-1]
        return _position(self.xy_mm, mm / along[-1] * lengths_mm(self.xy_mm)[-1])

    def put_in(self, detours: list[_Detour]) -> None:
        """Leave the way for guide lines, and come back to it."""
        for detour in sorted(detours, key=lambda detour: -detour.leave):
            shift = len(detour.xy_mm) + 1
            self.at = {drawn: at + shift * (at > detour.leave) for drawn, at in self.at.items()}
            self.guides = [_shifted(guide, shift) for guide in self.guides]
            self.xy_mm = np.vstack(
                [self.xy_mm[: detour.leave + 1], detour.xy_mm, self.xy_mm[detour.leave :]]
            )
            self.at |= {drawn: at + detour.leave + 1 for drawn, at in detour.at.items()}
            tip = round(self.at[detour.tip])
            self.guides.insert(0, GuideLine(detour.leave, tip, detour.leave + shift))

    def put_after(self, lead: _Lead) -> None:
        """Come to the way by a lead line."""
        self.at = {**lead.at, **{drawn: at + len(lead.xy_mm) for drawn, at in self.at.items()}}
        self.guides = [_shifted(guide, len(lead.xy_mm)) for guide in self.guides]
        self.xy_mm = np.vstack([lead.xy_mm, self.xy_mm])


@dataclass(frozen=True, slots=True)
class _Detour:
    """A guide line off a way: the way's position where it leaves, positions (n, 2) mm, the drawn tip, and
    which stand for the drawn ones.
    """

    leave: int
    xy_mm: Array
    tip: float
    at: dict[float, float]


def carried(beside: Beside, away_mm: Distances, feed: Feed) -> list[Line]:
    """The lines that the cutter runs for a line: one for each way, that to which the lead line comes the
    last.

    `away_mm` tells how far places are from all contours.
    """
    cut = beside.cut
    lead = _lead(beside, away_mm, feed) if cut.first > 0 else None
    begins = {lead.place.way: lead.place.at} if lead is not None else {}
    runs = [
        _Run.along(way.points_mm, begins.get(k, 0.0), feed) for k, way in enumerate(beside.ways)
    ]
    for mark in cut.line.marks:
        if (mark.at > cut.first or lead is None) and _guide_at(cut.line, mark.at) is None:
            place = beside.foot(np.array(mark.place_mm))
            runs[place.way].at[mark.at] = runs[place.way].position(place)
    detours: dict[int, list[_Detour]] = {}
    for guide in cut.line.guides:
        if guide.leave > cut.first:
            way, detour = _detour(beside, guide, runs, feed)
            detours.setdefault(way, []).append(detour)
    for way, off_it in detours.items():
        runs[way].put_in(off_it)
    return _lines(beside, runs, lead)


def _lead(beside: Beside, away_mm: Distances, feed: Feed) -> _Lead:
    """The lead line, as far as it is run, and on to the way."""
    cut, line = beside.cut, beside.cut.line
    rows = line.xy_mm[: cut.first + 1]
    end, place = _joins(beside, rows)
    guides = [guide for guide in line.guides if guide.back <= cut.first]
    xy_mm, moved = feed.resting(rows, [*(guide.tip for guide in guides), end])
    guides = [
        GuideLine(*(round(moved(at)) for at in (guide.leave, guide.tip, guide.back)))
        for guide in guides
    ]
    if end == cut.first:
        xy_mm = np.vstack([xy_mm, feed.run(np.vstack([rows[-1], beside.mm(place)]))])
    last = len(xy_mm) - 1
    at = {
        mark.at: last if mark.at >= end else moved(mark.at)
        for mark in line.marks
        if mark.at <= cut.first
    }
    if cut.down_at is not None:
        clear = (
            cut.down_at <= end < cut.first
            and away_mm(rows[int(cut.down_at) : int(end) + 1]).min()
            > beside.radius_mm - CLEAR_MM
        )
        at[cut.down_at] = at[cut.down_at] if clear else last
    at |= {guide.tip: moved(guide.tip) for guide in line.guides if guide.back <= cut.first}
    return _Lead(xy_mm, place, at, guides)


def _joins(beside: Beside, rows: Array) -> tuple[float, Place]:
    """Which position of a lead line is its last, and where it comes onto the way: not before what is drilled
    on it.
    """
    cut, line = beside.cut, beside.cut.line
    last = float(len(rows) - 1)
    if not cut.closed:
        begins = [Place(k, 0.0) for k in range(len(beside.ways))]
        return last, min(
            begins, key=lambda place: float(np.hypot(*(beside.mm(place) - rows[-1])))
        )
    met = [(at, place) for at, place in beside.met(rows) if _guide_at(line, at) is None]
    after = [(at, place) for at, place in met if cut.down_at is not None and at >= cut.down_at]
    end, place = (after[:1] or met[-1:] or [(last, Place(0, 0.0))])[0]
    drilled = [mark.at for mark in line.marks if mark.kind == "dot"] + [
        guide.back for guide in line.guides
    ]
    if end == last or any(end < at <= cut.first for at in drilled):
        return last, beside.foot(rows[-1])
    return end, place


def _detour(
    beside: Beside, guide: GuideLine, runs: list[_Run], feed: Feed
) -> tuple[int, _Detour]:
    """A guide line off the way of a cutter, and which way that is."""
    line, xy_mm = beside.cut.line, beside.cut.line.xy_mm
    at = {mark.at: mark.at for mark in line.marks if guide.leave < mark.at < guide.back} | {
        guide.tip: guide.tip
    }
    drilled = [mark.at for mark in line.marks if mark.at in at and mark.kind == "dot"]
    out = xy_mm[guide.leave : round(min([*drilled, guide.tip])) + 1]
    crossed = [
        (at, place)
        for at, place in beside.met(out)
        if lengths_mm(out)[int(at)] < OBLIQUE * beside.radius_mm
    ]
    place = crossed[0][1] if crossed else beside.foot(xy_mm[guide.leave])
    row = round(runs[place.way].position(place))
    begin, end = guide.leave, guide.back
    if crossed:
        begin += int(crossed[0][0]) + 1
        end = guide.tip + int(
            np.argmin(np.hypot(*(xy_mm[guide.tip : guide.back + 1] - xy_mm[begin]).T))
        )
    here = runs[place.way].xy_mm[row]
    drawn, moved = feed.resting(xy_mm[begin : end + 1], [0, guide.tip - begin, end - begin])
    to_it, from_it = (
        feed.run(np.vstack([here, drawn[0]])),
        feed.run(np.vstack([drawn[-1], here])),
    )
    at = {old: len(to_it) + moved(min(max(old, begin), end) - begin) for old in at}
    return place.way, _Detour(row, np.vstack([to_it, drawn, from_it]), guide.tip, at)


def _lines(beside: Beside, runs: list[_Run], lead: _Lead | None) -> list[Line]:
    """The runs as lines of the program, with the stops that are on each."""
    cut, line = beside.cut, beside.cut.line
    main = len(runs) - 1 if lead is None else lead.place.way
    lines = []
    for k in sorted(range(len(runs)), key=lambda k: k == main):
        run = runs[k]
        ending = "closed" if beside.ways[k].closed else "ended"
        plain = replace(line, fault=None, loop_from=None, guides=(), ending=ending)
        if k == main:
            plain = replace(
                plain, ending=line.ending if lead or line.fault else ending, fault=line.fault
            )
        elif not cut.closed:
            plain = replace(plain, reference_mm=None)
        if lead is not None and k == main:
            run.put_after(lead)
            plain = replace(
                plain,
                guides=tuple(lead.guides),
                loop_from=len(lead.xy_mm) if line.is_lead else None,
            )
            if not cut.closed:
                run.at[len(line.xy_mm) - 1] = len(run.xy_mm) - 1
        marks = [replace(mark, at=run.at[mark.at]) for mark in line.marks if mark.at in run.at]
        made = replace(plain, xy_mm=run.xy_mm, guides=(*plain.guides, *run.guides))
        made = replace(
            made, marks=tuple(replace(mark, place_mm=made.place(mark.at)) for mark in marks)
        )
        ours = sorted(
            (run.at[stop.at], stop.number or 0) for stop in cut.stops if stop.at in run.at
        )
        lines.append(
            replace(
                made,
                length_mm=float(lengths_mm(run.xy_mm)[-1]),
                numbers=tuple(n for _, n in ours),
            )
        )
    return lines


def _guide_at(line: Line, at: float) -> GuideLine | None:
    """The guide line on which a position is."""
    return next((guide for guide in line.guides if guide.leave < at < guide.back), None)


def _shifted(guide: GuideLine, positions: int) -> GuideLine:
    return GuideLine(guide.leave + positions, guide.tip + positions, guide.back + positions)


def _position(xy_mm: Array, mm: float) -> float:
    """Which position of a run has come so far, fractions included."""
    lengths = lengths_mm(xy_mm)
    moving = np.flatnonzero(np.r_[True, np.diff(lengths) > 0])
    return float(np.interp(mm, lengths[moving], moving))
