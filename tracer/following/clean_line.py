"""The clean line: the head goes on by its cell where the line ahead was felt clean, in one call of a kernel.

    knot ──── stops ── felt clean ── stops ── felt clean ──── knot       one call from knot to knot
              tight    trusts the cell for what was felt

A tight bend, grain or a speck stops the head's kernel every millimetre, on a circle of 6 mm 21 times. Most of
these stops end in the same way: the line is felt clean ahead, the cell stands on it, and goes on (see
`agreement`). That is decided here, with the very steps of `Follower`: what these steps do not settle as
"clean" returns to it, as if nothing had been felt.

Signals: the carriage, the view and the place from which the line is clean in; positions (n, 2) mm at the
motion rate, why the head stopped, and the view with the line's width there out.

Source: our own (see `follower`). Questions: stops on edges, of a head that is watched or told turns, and of
one whose knots are kept, are left to Python.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from morfax.motion.compiled import njit
from morfax.tracer.following.agreement import AGREES, LEFT_LEGS
from morfax.tracer.following.felt_line import FROM_BEHIND, Anchor
from morfax.tracer.following.ways_out import Turns
from morfax.tracer.head import kernel, watched
from morfax.tracer.head.carriage import CHUNK, Carriage
from morfax.tracer.head.screws import owed_s
from morfax.tracer.head.state import JUNCTION, MORE, TIGHT, Home
from morfax.tracer.head.trail import is_near_itself, mark_along, place_back
from morfax.tracer.junctions.felt_corner import AHEAD, LEG_STATIONS
from morfax.tracer.junctions.rings import corner_at, fork_at
from morfax.tracer.limits import FOLLOWS
from morfax.tracer.sensing.gauge import gauge
from morfax.tracer.sensing.leg import FEWEST_STATIONS
from morfax.tracer.sensing.photocell import Cells
from morfax.tracer.sensing.scout import leg_mm, scout, stations_of
from morfax.tracer.sensing.view import View

CHUNKS = 4  # seconds of motion in one call at the most


class Knows(NamedTuple):
    """What the head knows when it sets out: home, the place from which the line is clean, the turns that it
    was told, and the travel up to which it may go on from stop to stop, mm; 0 if it has to report each.
    """

    home: Home
    clean_from: Anchor
    turns: Turns
    longest_mm: float

    def may_go_on(self, view: View, carriage: Carriage) -> bool:
        """Whether a kernel may go on from stop to stop."""
        is_alone = self.longest_mm > 0 and watched.watcher() is None
        has_guards = carriage.tuning.direct_rad_s_mm == 0
        return is_alone and has_guards and not self.turns.at and not view.on_edge

    def line(self, view: View, carriage: Carriage) -> CleanLine:
        """The same for the kernel."""
        (x_mm, y_mm), heading_rad, from_mm = self.clean_from
        clean_from = float(x_mm), float(y_mm), float(heading_rad), float(from_mm)
        memory_mm = -math.inf if self.turns.by_stations else carriage.memory_to_mm
        return CleanLine(self.home, *clean_from, memory_mm, self.longest_mm, view.step_mm)


class CleanLine(NamedTuple):
    """The line as the head knows it when it sets out: home, and where the line begins to be clean (mm, rad,
    travel); up to which travels memory leads, and the head may go; the distance of stations, mm.
    """

    home: Home
    clean_x_mm: float
    clean_y_mm: float
    clean_rad: float
    clean_from_mm: float
    memory_to_mm: float
    longest_mm: float
    step_mm: float


def follow(carriage: Carriage, view: View, knows: Knows) -> tuple[View, int]:
    """Follow up to a stop that is no clean line's; the view of the line there, and why it stopped."""
    if not knows.may_go_on(view, carriage):
        return view, carriage.follow(view, knows.home)
    width_mm = float(view.width_mm)
    gauged = np.array([view.level, width_mm, float(view.usual_mm or width_mm), 0.0])
    out, from_mm = np.empty((CHUNKS * CHUNK, 2)), carriage.travel_mm
    marks = carriage.trail.marks(len(out))
    head, known = (carriage.state, carriage.tuning), (knows.line(view, carriage), marks)
    n, why = _follow(view.cells, head, known, gauged, out)
    carriage.took(out[:n], from_mm, marks)
    if gauged[3] > 0:
        level, width_mm, usual_mm = gauged[:3].tolist()
        cells = view.cells._replace(level=level)
        view = replace(view, cells=cells, width_mm=width_mm, usual_mm=usual_mm)
    return view, int(why)


@njit(cache=True)
def _follow(cells, head, known, gauged, out):  # type: ignore[no-untyped-def]
    """Fill `out` from stop to stop; (positions written, why). `gauged` holds level, width, usual width, and
    whether they are new.
    """
    (state, t), (line, marks), done = head, known, 0
    while True:
        n, why = kernel.follow(cells, state, t, line.home, out[done : done + CHUNK])
        mark_along(marks, out[done : done + n])
        done += n
        if why != TIGHT and why != JUNCTION:
            return done, why
        if is_near_itself(marks, gauged[1]):
            return done, why
        now = Cells(cells.darkness, cells.pitch_mm, gauged[0], cells.tiles, cells.beyond)
        trusted_mm = _felt_clean(now, head, known, gauged)
        if trusted_mm <= 0.0:
            return done, why
        state.trusted_mm = state.travel_mm + trusted_mm
        if state.travel_mm >= line.longest_mm or done + CHUNK > len(out):
            return done, MORE


@njit(cache=True)
def _felt_clean(cells, head, known, gauged):  # type: ignore[no-untyped-def]
    """How far ahead the line is clean for the cell, mm, and its new gauge; 0 if the head has to see to it."""
    (state, t), (line, marks) = head, known
    # 1. the line from behind the axis on
    own_mm = leg_mm(gauged[1], cells.pitch_mm)
    back_mm, come_mm = FROM_BEHIND[0] * own_mm, state.travel_mm - line.clean_from_mm
    pose = line.clean_x_mm, line.clean_y_mm, line.clean_rad
    if come_mm > back_mm:
        pose = place_back(marks, back_mm)
    else:
        back_mm = come_mm
    level, width_mm, usual_mm = gauge(
        cells, pose, (gauged[1], gauged[2]), line.step_mm, FOLLOWS
    )
    if math.isnan(level):
        level, width_mm, usual_mm = cells.level, gauged[1], gauged[2]
    now = Cells(cells.darkness, cells.pitch_mm, level, cells.tiles, cells.beyond)
    own_mm = leg_mm(width_mm, cells.pitch_mm)
    long_mm = back_mm + t.guard_lead_mm + own_mm
    seen, more = _felt_ahead(now, pose, (width_mm, own_mm, line.step_mm), long_mm)
    here = _on_its_way(state, t, seen)
    if here < 0 or (len(seen) - here) * line.step_mm <= own_mm:
        return 0.0
    # 2. no fork, no ink beside it, no corner
    if fork_at(now, width_mm, seen, here) >= 0:
        return 0.0
    if max(state.guard_left, state.guard_right) > kernel.BESIDE:
        return 0.0
    if 0 <= corner_at(more, here + AHEAD) <= len(seen) - LEG_STATIONS:
        return 0.0
    # 3. the cell stands on it
    clean_mm = _agreed_mm(state, t, seen, width_mm) - LEFT_LEGS * own_mm
    is_doubtful = state.travel_mm < max(state.trusted_mm, line.memory_to_mm)
    if is_doubtful or clean_mm <= LEFT_LEGS * own_mm or corner_at(seen, here) >= 0:
        return 0.0
    gauged[0], gauged[1], gauged[2], gauged[3] = level, width_mm, usual_mm, 1.0
    return clean_mm


@njit(cache=True)
def _on_its_way(state, t, seen):  # type: ignore[no-untyped-def]
    """The station nearest to where the axis stands; -1 if few were felt, or none ahead of it."""
    if len(seen) < FEWEST_STATIONS:
        return -1
    owed = owed_s(t.drive_gain, t.period_s)
    x, y = state.x_mm + owed * state.vx_mm_s, state.y_mm + owed * state.vy_mm_s
    c, s = math.cos(state.heading_rad), math.sin(state.heading_rad)
    if (seen[-1, 0] - x) * c + (seen[-1, 1] - y) * s < 0.0:
        return -1
    return _nearest(seen, x, y)


@njit(cache=True)
def _nearest(seen, x, y):  # type: ignore[no-untyped-def]
    """The station nearest to a place."""
    best, least = 0, math.inf
    for k in range(len(seen)):
        away = math.hypot(seen[k, 0] - x, seen[k, 1] - y)
        if away < least:
            best, least = k, away
    return best


@njit(cache=True)
def _felt_ahead(cells, pose, sizes_mm, long_mm):  # type: ignore[no-untyped-def]
    """Stations of the line for a length, and those a leg's length further, in which its corners are looked
    for (see `felt_corner`): the same ones, where none is spoilt; else felt anew from the first.
    """
    width_mm, own_mm, step_mm = sizes_mm
    count, further = stations_of(step_mm, long_mm), round(own_mm / step_mm) + 1
    more = scout(cells, pose, width_mm, step_mm, count + further)
    if len(more) == count + further:
        return more[:count], more
    seen = scout(cells, pose, width_mm, step_mm, count)
    if len(seen) < FEWEST_STATIONS:
        return seen, seen
    heading = math.atan2(seen[3, 1] - seen[0, 1], seen[3, 0] - seen[0, 0])
    again = scout(
        cells, (seen[0, 0], seen[0, 1], heading), width_mm, step_mm, len(seen) + further
    )
    return seen, again if len(again) > len(seen) else seen


@njit(cache=True)
def _agreed_mm(state, t, seen, width_mm):  # type: ignore[no-untyped-def]
    """How far the line was felt beyond the guard cells, mm; 0 if the cell is not on it (see `agreement`)."""
    c, s = math.cos(state.heading_rad), math.sin(state.heading_rad)
    x = state.x_mm + owed_s(t.drive_gain, t.period_s) * state.vx_mm_s
    y = state.y_mm + owed_s(t.drive_gain, t.period_s) * state.vy_mm_s
    x += state.lead_mm * c - state.middle_mm * s
    y += state.lead_mm * s + state.middle_mm * c
    near = _nearest(seen, x, y)
    if near == 0 or near >= len(seen) - 1 or not state.swept_ink > kernel.LOST:
        return 0.0
    way_x = seen[near + 1, 0] - seen[near - 1, 0]
    way_y = seen[near + 1, 1] - seen[near - 1, 1]
    off_mm = abs(way_x * (y - seen[near, 1]) - way_y * (x - seen[near, 0]))
    if off_mm / math.hypot(way_x, way_y) > AGREES * width_mm:
        return 0.0
    ahead_mm = 0.0
    for k in range(near, len(seen) - 1):
        ahead_mm += math.hypot(seen[k + 1, 0] - seen[k, 0], seen[k + 1, 1] - seen[k, 1])
    return ahead_mm - (t.guard_lead_mm - t.lead_mm)
