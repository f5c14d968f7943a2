"""The transfer: a drawn program moved from its contour to the cutter's paths beside it: lead line, stops,
guide lines, and the way back.

Signals: a line as it was followed, and the paths of the cutter along its contour, in; out the lines that are
run instead, mm at the motion rate, each with its lead line, marks and guide lines.

    reference ──tick──┐ path of the cutter         reference ──────── contour
                      │   ─── contour                            tick   │   raised over the contour,
                      └──                                               └──▶ down on the path
       the lead line meets the path                the cutter runs on the other side of the contour

    lead line   as drawn, to where it first crosses the path after the last tick, or last crosses it before
                the tick; else to its end, and from there straight to the foot of where it joins. The
                tool goes down at the tick if no place of the lead line from there on is nearer to a contour
                than the radius; else where the path begins.
    stop mark   at its foot on the path (see `contour`)
    guide line  as drawn, from where it crosses the path; else from its foot, straight to where the drawn one
                left the contour. Drilled holes are not moved.
    start       where the lead line joins, else where the path itself begins or `start_places` has it begin

The numbers of the stops stay those of the drawing, also where the cutter comes to them in another order.

Source: our own. The patent's draughtsman allows for the cutter himself (ES 361967, section on use).
Questions: if the cutter's path is in pieces, the contour has one lead line. The other pieces are run before
it, from the reference point, so that the program ends there; the tool is raised from piece to piece.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm, lengths_mm
from morfax.tracer.cutter.contour import Beside, PathPlace
from morfax.tracer.cutter.leads import CLEAR_MM
from morfax.tracer.cutter.runs import Detour, FeedRate, LeadRun, PathRun
from morfax.tracer.cutter.start_places import StartPlaces
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine

# radii along a guide line: where it crosses a path later, it has come to another part; by trial
OBLIQUE = 2.0


def transferred(
    beside: Beside,
    away_mm: Callable[[Array], Array],
    feed: FeedRate,
    starts: StartPlaces | None = None,
) -> list[Line]:
    """The lines that the cutter runs for a line: one for each path, the one with the lead line last.

    `away_mm` gives the distances of places from all contours, `starts` where the paths begin.
    """
    # 1. the lead line, and the paths from where it joins
    cut = beside.cut
    lead = _lead(beside, away_mm, feed) if cut.first > 0 else None
    joins = {lead.place.path: lead.place.at} if lead is not None else {}
    starts = starts or StartPlaces()
    begins = [starts.begin(beside, k, joins.get(k)) for k in range(len(beside.paths))]
    runs = [
        PathRun.along(path.points_mm, begin, feed)
        for path, begin in zip(beside.paths, begins, strict=True)
    ]
    # 2. marks on the contour, and guide lines
    _put_marks(beside, runs, has_lead=lead is not None)
    detours: dict[int, list[Detour]] = {}
    for guide in cut.line.guides:
        if guide.leave > cut.first:
            path, detour = _detour(beside, guide, runs, feed)
            detours.setdefault(path, []).append(detour)
    for path, off_it in detours.items():
        runs[path].put_in(off_it)
    return _lines(beside, runs, lead)


def _put_marks(beside: Beside, runs: list[PathRun], *, has_lead: bool) -> None:
    """Put the marks of the contour on the paths beside it; those of lead and guide lines are left."""
    cut = beside.cut
    for mark in cut.line.marks:
        on_contour = mark.at > cut.first or not has_lead
        if on_contour and _guide_at(cut.line, mark.at) is None:
            place = beside.foot(np.array(mark.place_mm))
            runs[place.path].at[mark.at] = runs[place.path].position(place)


def _lead(beside: Beside, away_mm: Callable[[Array], Array], feed: FeedRate) -> LeadRun:
    """The lead line, as far as it is run, and on to the path."""
    cut, line = beside.cut, beside.cut.line
    rows = line.xy_mm[: cut.first + 1]
    end, place = _joins(beside, rows)
    # 1. positions, at rest at the tips of guide lines and at the end
    drawn = [guide for guide in line.guides if guide.back <= cut.first]
    xy_mm, moved = feed.resting(rows, [*(guide.tip for guide in drawn), end])
    if end == cut.first:
        xy_mm = np.vstack([xy_mm, feed.run(np.vstack([rows[-1], beside.mm(place)]))])
    last = len(xy_mm) - 1
    # 2. the drawn marks and tips
    at = dict[float, float]()
    for mark in line.marks:
        if mark.at <= cut.first:
            at[mark.at] = last if mark.at >= end else moved(mark.at)
    if cut.down_at is not None and not _is_clear(beside, rows, end, away_mm):
        at[cut.down_at] = last
    at |= {guide.tip: moved(guide.tip) for guide in drawn}
    guides = [GuideLine(*(round(moved(at)) for at in (g.leave, g.tip, g.back))) for g in drawn]
    return LeadRun(xy_mm, place, at, guides)


def _is_clear(
    beside: Beside, rows: Array, end: float, away_mm: Callable[[Array], Array]
) -> bool:
    """Whether the tool can go down at the lead line's tick: from there on no contour is too near."""
    down_at = beside.cut.down_at
    if not beside.radius_mm:  # without a cutter the tool goes down at the tick, as drawn
        return True
    if down_at is None or not down_at <= end < beside.cut.first:
        return False
    nearest_mm = away_mm(rows[int(down_at) : int(end) + 1]).min()
    return bool(nearest_mm > beside.radius_mm - CLEAR_MM)


def _joins(beside: Beside, rows: Array) -> tuple[float, PathPlace]:
    """The last position of a lead line, and where it comes onto the path: after all that is drilled on it."""
    cut, line = beside.cut, beside.cut.line
    last = float(len(rows) - 1)
    # 1. onto an open path at its beginning
    if not cut.closed:
        begins = [PathPlace(k, 0.0) for k in range(len(beside.paths))]
        away = [float(np.hypot(*(beside.mm(place) - rows[-1]))) for place in begins]
        return last, begins[int(np.argmin(away))]
    # 2. where the lead line crosses a path, if nothing is drilled after that
    met = [(at, place) for at, place in beside.met(rows) if _guide_at(line, at) is None]
    after = [(at, place) for at, place in met if cut.down_at is not None and at >= cut.down_at]
    drilled: list[float] = [guide.back for guide in line.guides]
    drilled += [mark.at for mark in line.marks if mark.kind == "dot"]
    if met:
        end, place = after[0] if after else met[-1]
        if end != last and not any(end < at <= cut.first for at in drilled):
            return end, place
    # 3. from its end to the foot
    return last, beside.foot(rows[-1])


def _detour(
    beside: Beside, guide: GuideLine, runs: list[PathRun], feed: FeedRate
) -> tuple[int, Detour]:
    """A guide line off the path of a cutter, and which path that is."""
    line, xy_mm = beside.cut.line, beside.cut.line.xy_mm
    on_guide = [mark for mark in line.marks if guide.leave < mark.at < guide.back]
    drilled = [mark.at for mark in on_guide if mark.kind == "dot"]
    # 1. where the guide line crosses a path before the first hole; else the foot
    out = xy_mm[guide.leave : round(min([*drilled, guide.tip])) + 1]
    out_mm, near_mm = lengths_mm(out), OBLIQUE * beside.radius_mm
    crossed = [(at, place) for at, place in beside.met(out) if out_mm[int(at)] < near_mm]
    begin, end = guide.leave, guide.back
    if crossed:
        at, place = crossed[0]
        begin += int(at) + 1
        back = xy_mm[guide.tip : guide.back + 1]
        end = guide.tip + int(np.argmin(np.hypot(*(back - xy_mm[begin]).T)))
    else:
        place = beside.foot(xy_mm[guide.leave])
    # 2. out to it, along it and back
    run = runs[place.path]
    row = round(run.position(place))
    here = run.xy_mm[row]
    rests = [0, guide.tip - begin, end - begin]
    drawn, moved = feed.resting(xy_mm[begin : end + 1], rests)
    to_it = feed.run(np.vstack([here, drawn[0]]))
    from_it = feed.run(np.vstack([drawn[-1], here]))
    # 3. the positions of its marks and its tip
    at_old = [*(mark.at for mark in on_guide), guide.tip]
    new = {old: len(to_it) + moved(min(max(old, begin), end) - begin) for old in at_old}
    return place.path, Detour(row, np.vstack([to_it, drawn, from_it]), guide.tip, new)


def _lines(beside: Beside, runs: list[PathRun], lead: LeadRun | None) -> list[Line]:
    """The runs as lines of the program, the one with the lead line last."""
    main = len(runs) - 1 if lead is None else lead.place.path
    lines = list[Line]()
    for k, run in enumerate(runs):
        if k != main:
            lines.append(_with_stops(beside, run, _other_line(beside, k)))
    return [*lines, _with_stops(beside, runs[main], _main_line(beside, runs[main], main, lead))]


def _other_line(beside: Beside, number: int) -> Line:
    """The line of a path without the lead line, not yet with its positions."""
    line = beside.cut.line
    ending = "closed" if beside.paths[number].closed else "ended"
    reference_mm = line.reference_mm if beside.cut.closed else None
    return replace(
        line, fault=None, loop_from=None, guides=(), ending=ending, reference_mm=reference_mm
    )


def _main_line(beside: Beside, run: PathRun, number: int, lead: LeadRun | None) -> Line:
    """The line of the path with the lead line, not yet with its positions; puts the lead line first."""
    cut, line = beside.cut, beside.cut.line
    ending = "closed" if beside.paths[number].closed else "ended"
    if lead is not None or line.fault is not None:
        ending = line.ending
    if lead is None:
        return replace(line, loop_from=None, guides=(), ending=ending)
    run.put_after(lead)
    if not cut.closed:
        run.at[len(line.xy_mm) - 1] = len(run.xy_mm) - 1
    loop_from = len(lead.xy_mm) if line.is_lead else None
    return replace(line, loop_from=loop_from, guides=tuple(lead.guides), ending=ending)


def _with_stops(beside: Beside, run: PathRun, line: Line) -> Line:
    """A line with the positions of its run, and with the guide lines, marks and stops that are on it."""
    drawn, stops = beside.cut.line, beside.cut.stops
    guides = (*line.guides, *run.guides)
    line = replace(line, xy_mm=run.xy_mm, guides=guides, leads=run.leads)
    marks = [replace(mark, at=run.at[mark.at]) for mark in drawn.marks if mark.at in run.at]
    marks = [replace(mark, place_mm=line.place(mark.at)) for mark in marks]
    on_run = [stop for stop in stops if stop.at in run.at]
    here = sorted((run.at[stop.at], stop.number or 0) for stop in on_run)
    return replace(
        line,
        marks=tuple(marks),
        length_mm=length_mm(run.xy_mm),
        numbers=tuple(number for _, number in here),
    )


def _guide_at(line: Line, at: float) -> GuideLine | None:
    """The guide line on which a position is."""
    return next((guide for guide in line.guides if guide.leave < at < guide.back), None)
