"""The head's two screws: one period of their drives, and the courses that the head runs from memory.

Signals: demands in mm/s, or a course (n, 2) mm with a speed for each of its places, in; positions of the
screws (n, 2) mm at the motion rate out.

The demand moves on a course exactly, and the screws follow it by the lag of their drives. What the drives
owe is their lag times the speed.

Source: patent ES 361967, figure 1: drives DCX and DCY with tachos TX and TY, motors 17 and 12.
"""

from __future__ import annotations

import math

from morfax.motion.compiled import njit
from morfax.motion.drive import drive_step

# of the tracing speed: a head that starts from rest gets away within a few periods
SLOWEST = 0.02


@njit(cache=True, inline="always")
def owed_s(gain, period_s):  # type: ignore[no-untyped-def]
    """Time by which a drive of this gain per period lags its demand, s."""
    return period_s * (1.0 - gain) / gain


@njit(cache=True, inline="always")
def move(state, t, demand_x_mm_s, demand_y_mm_s):  # type: ignore[no-untyped-def]
    """One period of the two drives: their screws turn, and the head moves with them."""
    state.vx_mm_s = drive_step(state.vx_mm_s, demand_x_mm_s, t.drive_gain, t.drive_change_mm_s)
    state.vy_mm_s = drive_step(state.vy_mm_s, demand_y_mm_s, t.drive_gain, t.drive_change_mm_s)
    dx, dy = state.vx_mm_s * t.period_s, state.vy_mm_s * t.period_s
    state.x_mm += dx
    state.y_mm += dy
    # hypot, with its care for the largest and the smallest numbers, takes as long as a look of a cell
    state.travel_mm += math.sqrt(dx * dx + dy * dy)


@njit(cache=True, _nrt=False)
def run(state, t, points, speeds, out):  # type: ignore[no-untyped-def]
    """Run along a course (n, 2) mm, at each point at most at its speed (n,) mm/s; positions written."""
    owed = owed_s(t.drive_gain, t.period_s)
    # where the demand stands
    x, y = state.x_mm + owed * state.vx_mm_s, state.y_mm + owed * state.vy_mm_s
    leg, last = 0, len(points) - 1
    for n in range(len(out)):
        if leg >= last:
            return n
        # 1. how far to go in this period
        gap = math.hypot(points[leg + 1, 0] - x, points[leg + 1, 1] - y)
        _hasten(state, t, gap, speeds[leg], speeds[leg + 1])
        step = state.speed_mm_s * t.period_s
        # 2. the demand goes that far along the course, round its points
        old_x, old_y = x, y
        while leg < last and step >= gap:
            x, y = points[leg + 1, 0], points[leg + 1, 1]
            step -= gap
            leg += 1
            if leg < last:
                gap = math.hypot(points[leg + 1, 0] - x, points[leg + 1, 1] - y)
        if leg < last:
            x += (points[leg + 1, 0] - x) * step / gap
            y += (points[leg + 1, 1] - y) * step / gap
        # 3. the screws follow
        move(state, t, (x - old_x) / t.period_s, (y - old_y) / t.period_s)
        out[n, 0], out[n, 1] = state.x_mm, state.y_mm
    return len(out)


@njit(cache=True, _nrt=False)
def _hasten(state, t, gap_mm, speed_mm_s, next_mm_s):  # type: ignore[no-untyped-def]
    """Bring the speed towards what braking for the next point, the course and the relay allow."""
    change = t.acceleration_mm_s2 * t.period_s
    braking = math.sqrt(next_mm_s**2 + 2 * t.acceleration_mm_s2 * gap_mm)
    held = t.speed_mm_s * (t.slowed if state.slow_periods > 0 else 1.0)
    state.slow_periods = max(state.slow_periods - 1, 0)
    by_relay = max(held, state.speed_mm_s - change)
    allowed = min(braking, max(speed_mm_s, next_mm_s), by_relay)
    state.speed_mm_s = max(min(state.speed_mm_s + change, allowed), SLOWEST * t.speed_mm_s)


@njit(cache=True, _nrt=False)
def stand(state, t, out):  # type: ignore[no-untyped-def]
    """Stand for the length of `out` while the drives come to rest."""
    state.speed_mm_s = 0.0
    for n in range(len(out)):
        move(state, t, 0.0, 0.0)
        out[n, 0], out[n, 1] = state.x_mm, state.y_mm
    return len(out)
