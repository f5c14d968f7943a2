"""The head: a cell that swings across the line steers the axis along it.

Signals: the drawing behind the aperture in; positions of the X and Y lead screws out, mm, at the motion rate.

The cell swings across the line one lead ahead of the steering axis. Once a sweep, synchronous detection gives
the side and distance of the line from the middle of the sweep, and the next sweep is centred on the line, so
that the measure is a null. A drum remembers the place of the line on the sheet. When the axis comes to a
place, the drum holds as much of the line ahead of it as behind it: a parabola through the remembered places
about a point just ahead of the axis averages the noise of the paper away, and leaves a line whose bend
changes where it is. The axis steers for that point, on the circle that touches its heading (pure pursuit).
This is the steering law k = 2v/a² of the linear theory, and it has no error on a circle:

    turn rate = v · 2e / (l² + e²)          l, e: the point along and across the heading, from the axis now

The speed is resolved by sine and cosine of the heading into demands on the two drives; the axis is where
their screws have gone. What the drives owe (lag times speed, from the tachos) is added to the place that
steers, so that their lag turns no corner.

                      drum of places                  cell
      . . . . . . . . .  o-> .  x  . . . . . . . . .  )|(      guards
                       axis   point                         ||
    guard cells    beside the line's edges and on it, a little further ahead: when they see ink beside the
                   line, or no ink on it, the head cannot trust the swinging cell there; the kernel returns,
                   and the rooms `junctions` and `tangles` plan the way through
    mean           of a sweep against what it was when the head was tuned: when the line swells or fades, the
                   kernel returns to be tuned anew
    look-ahead     cell 102, ahead of the swinging cell: when the line is not where the sweep's curve leads,
                   the relay slows the head and holds it slow

A head without a drum, as in 1969, steers straight by what the cell sees aside, turn rate = k·e, and has
neither guard cells nor a way through junctions.

Source: patent ES 361967, figure 1: cell 101, mount 42, pin 48, motor 45, amplifier FSA, servo M and tacho T,
potentiometer 59, drives DCX and DCY with tachos TX and TY, forward cell 102, relay RL, delay DL, resistor SR,
speed control WC. Questions: the patent gives no figures, no drum and no guard cells. Chosen: see `settings`.
"""

from __future__ import annotations

import math

from morfax.motion.compiled import njit
from morfax.motion.moments import NO_PLACES, bend_of, parabola_of, with_place
from morfax.tracer.head.screws import move, owed_s
from morfax.tracer.head.state import CHANGED, DRUM, HOME, JUNCTION, MORE, TIGHT
from morfax.tracer.head.swinging import detect, seen, swing, way_of
from morfax.tracer.limits import AHEAD_RAD, FOLLOWS

# Shares of the line's ink; all chosen by trial on the test drawings.
LOST = 0.2  # less over a sweep: the line has gone from under a head without guard cells
BESIDE = 0.4  # more under a guard cell at the side: there is ink beside the line
BLANK = 0.5  # less under a cell on the line: there is paper
ALTERED = 0.2  # over a sweep: the line has swollen or faded since the head was tuned to it

GUARD_FOLLOWS = 0.5  # share by which a guard cell follows what it sees, sweep by sweep
HOME_ASIDE = 0.3  # of the lead: home is on the line
HOME_COSINE = math.cos(AHEAD_RAD)  # of the angle between the heading and home's
SHORTEST = 0.2  # of the distance to the point: the axis may have come so near to it


@njit(cache=True, _nrt=False)
def follow(cells, state, t, home, out):  # type: ignore[no-untyped-def]
    """Follow the line until something happens or `out` (n, 2) is full; (positions written, why)."""
    way = way_of(state)  # a sine and a cosine take as long as two looks of a cell
    for n in range(len(out)):
        swing(cells, state, t, way)
        if state.sweep_periods >= t.sweep_periods:
            detect(state, t)
            if t.direct_rad_s_mm == 0:
                _fit(state, t)
            why = _look(cells, state, t)
            if why == MORE and _at_home(state, t, home):
                why = HOME
            if why != MORE:
                return n, why
        way = _steer(state, t, way)
        out[n, 0], out[n, 1] = state.x_mm, state.y_mm
    return len(out), MORE


@njit(cache=True, _nrt=False)
def _fit(state, t):  # type: ignore[no-untyped-def]
    """Lay a parabola through the drum's places about the point ahead of the axis: where the line is there,
    and its bend.

    Weights fall to nothing at the window's ends: 1 - (x/h)².
    """
    # 1. the moments of the places, x along the heading and y across it, from the point
    c, s = way_of(state)
    x0, y0 = state.x_mm + t.point_mm * c, state.y_mm + t.point_mm * s
    half = _half_window(state, t)
    sums = NO_PLACES
    for k in range(min(state.places, DRUM)):
        dx, dy = state.drum_mm[k, 0] - x0, state.drum_mm[k, 1] - y0
        x, y = dx * c + dy * s, dy * c - dx * s
        if abs(x) < half and abs(y) < half:
            sums = with_place(sums, 1.0 - (x / half) ** 2, x, y)
    # 2. the parabola
    is_one, p0, p1, p2 = parabola_of(sums)
    if not is_one:
        return
    # 3. the point on it, and the bend there
    state.point_x_mm, state.point_y_mm = x0 - p0 * s, y0 + p0 * c
    state.bend_per_mm = bend_of(p1, 2.0 * p2)


@njit(cache=True, inline="always")
def _bend(state, t):  # type: ignore[no-untyped-def]
    """The larger bend of the line at the point and of the sweep's curve, 1/mm."""
    return max(
        abs(state.bend_per_mm), 2.0 * abs(state.middle_mm) / (state.lead_mm * state.lead_mm)
    )


@njit(cache=True, inline="always")
def _is_trusted(state):  # type: ignore[no-untyped-def]
    """Whether the cell goes on past what the guard cells say."""
    return state.travel_mm < state.trusted_mm


@njit(cache=True, _nrt=False)
def _half_window(state, t):  # type: ignore[no-untyped-def]
    """Half of the parabola's window, mm: narrower in tight bends of a line that was felt clean."""
    bend = state.usual_bend_per_mm
    may_narrow = _is_trusted(state) or t.balance_per_mm != 0.0
    if not may_narrow or bend <= t.tightest_per_mm:
        return t.half_window_mm
    return max(t.half_window_mm * (t.tightest_per_mm / bend) ** 2, t.narrow_mm)


@njit(cache=True, _nrt=False)
def _look_at_edge(cells, state, t):  # type: ignore[no-untyped-def]
    """The same on the edge of a shape: the guard cells see the shape on one side, and paper on the other."""
    way, curve = way_of(state), state.middle_mm / (state.lead_mm * state.lead_mm)
    inward = -math.copysign(t.guard_mm, t.balance_per_mm)  # to the left
    # 1. cell 102 and its relay
    far = t.look_ahead_mm
    inside = seen(cells, state, way, far, curve * far * far + inward)
    outside = seen(cells, state, way, far, curve * far * far - inward)
    if inside - outside < BLANK:
        state.slow_periods = t.slow_periods
    # 2. the guard cells
    ahead = t.guard_lead_mm
    on_edge = curve * ahead * ahead
    beside = inward * math.hypot(1.0, 2.0 * curve * ahead)
    inside = seen(cells, state, way, ahead, on_edge + beside)
    outside = seen(cells, state, way, ahead, on_edge - beside)
    state.guard_ahead += GUARD_FOLLOWS * (inside - state.guard_ahead)
    state.guard_left += GUARD_FOLLOWS * (outside - state.guard_left)
    state.guard_right = state.guard_left
    # 3. what they say, and whether the swinging cell sees an edge
    if state.swept_ink < LOST:
        return JUNCTION
    if t.direct_rad_s_mm > 0:
        return MORE
    state.usual_bend_per_mm += FOLLOWS * (_bend(state, t) - state.usual_bend_per_mm)
    if state.usual_bend_per_mm > t.narrowest_per_mm:
        return TIGHT
    if not _is_trusted(state) and (state.guard_left > BESIDE or state.guard_ahead < BLANK):
        return JUNCTION
    return MORE


@njit(cache=True, _nrt=False)
def _look(cells, state, t):  # type: ignore[no-untyped-def]
    """Read the guard cells and the look-ahead cell, once a sweep; why the head must stop following."""
    if t.balance_per_mm != 0.0:
        return _look_at_edge(cells, state, t)
    way, curve = (
        way_of(state),
        state.middle_mm / (state.lead_mm * state.lead_mm),
    )  # aside = curve · ahead²
    # 1. cell 102 and its relay
    far = t.look_ahead_mm
    if seen(cells, state, way, far, curve * far * far) < BLANK * state.ink:
        state.slow_periods = t.slow_periods
    if t.direct_rad_s_mm > 0:
        return JUNCTION if state.swept_ink < LOST else MORE
    # 2. the guard cells
    ahead = t.guard_lead_mm
    on_line = curve * ahead * ahead
    beside = t.guard_mm * math.hypot(1.0, 2.0 * curve * ahead)
    left = seen(cells, state, way, ahead, on_line + beside) / state.ink
    on = seen(cells, state, way, ahead, on_line) / state.ink
    right = seen(cells, state, way, ahead, on_line - beside) / state.ink
    state.guard_left += GUARD_FOLLOWS * (left - state.guard_left)
    state.guard_ahead += GUARD_FOLLOWS * (on - state.guard_ahead)
    state.guard_right += GUARD_FOLLOWS * (right - state.guard_right)
    # 3. what they say, and whether the swinging cell sees a line
    if state.swept_ink < LOST:
        return JUNCTION
    bend = _bend(state, t)
    state.usual_bend_per_mm += FOLLOWS * (bend - state.usual_bend_per_mm)
    if _is_trusted(state):
        return TIGHT if state.usual_bend_per_mm > t.narrowest_per_mm else MORE
    if max(state.guard_left, state.guard_right) > BESIDE or state.guard_ahead < BLANK:
        return JUNCTION
    if bend > t.tightest_per_mm:
        return TIGHT
    return CHANGED if abs(state.ink - 1.0) > ALTERED else MORE


@njit(cache=True, _nrt=False)
def _at_home(state, t, home):  # type: ignore[no-untyped-def]
    """Whether home lies just ahead on the line."""
    x_mm, y_mm, heading_rad, from_travel_mm = home
    if state.travel_mm < from_travel_mm:
        return False
    dx, dy = x_mm - state.x_mm, y_mm - state.y_mm
    c, s = way_of(state)
    along, aside = dx * c + dy * s, dy * c - dx * s
    on_it = 0.0 < along < t.lead_mm and abs(aside) < HOME_ASIDE * t.lead_mm
    return on_it and math.cos(heading_rad - state.heading_rad) > HOME_COSINE


@njit(cache=True, inline="always")
def _steer(state, t, way):  # type: ignore[no-untyped-def]
    """One period of relay, steering servo, sine and cosine, and the two drives; the way it then goes."""
    # 1. speed, as the relay has it
    if state.slow_periods > 0:
        state.slow_periods -= 1
    wanted = t.speed_mm_s * (t.slowed if state.slow_periods > 0 else 1.0)
    change = t.acceleration_mm_s2 * t.period_s
    state.speed_mm_s += min(max(wanted - state.speed_mm_s, -change), change)
    # 2. turn rate, from where the screws will be when the drives have made good what they owe
    owed = owed_s(t.drive_gain, t.period_s)
    dx = state.point_x_mm - state.x_mm - owed * state.vx_mm_s
    dy = state.point_y_mm - state.y_mm - owed * state.vy_mm_s
    c, s = way
    along, aside = max(dx * c + dy * s, SHORTEST * t.point_mm), dy * c - dx * s
    demand = state.speed_mm_s * 2.0 * aside / (along * along + aside * aside)
    if t.direct_rad_s_mm > 0:
        demand = t.direct_rad_s_mm * state.aside_mm
    state.turn_rad_s += t.steering_gain * (demand - state.turn_rad_s)
    state.heading_rad += state.turn_rad_s * t.period_s
    # 3. potentiometer 59 resolves the speed for the drives
    way = way_of(state)
    move(state, t, state.speed_mm_s * way[0], state.speed_mm_s * way[1])
    return way
