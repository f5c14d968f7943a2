"""The head: a cell that swings across the line steers the axis along it.

Signals: the drawing behind the aperture in; positions of the X and Y lead screws out, mm, at the motion rate.

The cell swings across the line one lead ahead of the steering axis. Once a sweep, synchronous detection gives
the side and distance of the line from the middle of the sweep, and the sweep is centred on it for the next
time, so that the measure is a null. The place of the line on the sheet is remembered (a drum of places), and
when the axis comes to a place, as much of the line has been seen ahead of it as behind it: a parabola through
the remembered places about a point just ahead of the axis averages the noise of the paper away, and leaves a
line whose bend changes where it is. For that point the axis steers, on the circle that touches its heading
(pure pursuit), which is the steering law k = 2v/a² of the linear theory and has no error on a circle:

    turn rate = v · 2e / (l² + e²)          l, e: the point along and across the heading, as seen from the axis now

The speed is resolved by sine and cosine of the heading into demands on the two drives; the axis is where
their screws have gone. What the drives owe (lag times speed, from the tachos) is added to the place that
steers, so that their lag turns no corner.

                      drum of places                  cell
      . . . . . . . . .  o-> .  x  . . . . . . . . .  )|(      guards
                       axis   point                         ||
    guard cells    beside the line's edges and on it, a little further ahead: when they see ink beside the line, or none on it, the head cannot trust the
                   swinging cell there; the kernel returns, and `knot` and `course` take the head through
    mean           of a sweep against what it was when the head was tuned: when the line swells or fades, the kernel returns to be tuned anew
    look-ahead     cell 102, a mm ahead of the swinging cell: when the line is not where the sweep's curve leads, the relay slows the head and holds it slow

A head without a drum, as in 1969, steers straight by what the cell sees aside, turn rate = k·e, and has
neither guard cells nor a way through knots.

Source: patent ES 361967, figure 1: cell 101, mount 42, pin 48, motor 45, amplifier FSA, servo M and tacho T,
potentiometer 59, drives DCX and DCY with tachos TX and TY, forward cell 102, relay RL, delay DL, resistor SR,
speed control WC. Questions: the patent gives no figures, no drum and no guard cells. Chosen: see `settings`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from morfax.motion.drive import drive_step
from morfax.tracer.sensing.photocell import TWO_PI, darkness_at

# State of the head, one float each: screws, speeds of the screws, heading, its rate, speed along, the sweep,
# the ink, guard cells, relay, travel, the point that is steered for, the bend there, how many places are on
# the drum, and how far aside the cell of a head without a drum sees the line
X, Y, VX, VY, HEADING, TURN, SPEED, SWEEP, FIRST, MEAN, MIDDLE, SWEPT_X, SWEPT_Y, INK = range(
    14
)
LEFT, AHEAD, RIGHT, SLOW, TRAVEL, POINT_X, POINT_Y, BEND, PLACES, ASIDE = range(14, 24)
STATES = 24
DRUM = 256  # places remembered
LOST = 0.2  # of the ink, over a sweep: the line has gone from under a head without guard cells
BESIDE = 0.4  # of the ink, averaged by the guard cells: there is ink beside the line
# of the ink over a sweep: the line has swollen or faded by so much since the head was tuned to it
ALTERED = 0.2

MORE, KNOT, TIGHT, HOME, CHANGED = range(5)  # why the kernel returned


class Tuning(NamedTuple):
    """Settings of the head as its kernel takes them; mm, s, rad."""

    period_s: float  # of the motion rate
    speed_mm_s: float
    slowed: float  # share of the speed
    slow_periods: float  # how long the relay holds
    acceleration_mm_s2: float
    sweep_periods: int
    lead_mm: float
    point_mm: float  # from the axis to the point that is steered for
    half_window_mm: float  # of the parabola about that point
    tightest_per_mm: float  # a bend beyond this is a knot
    amplitude_mm: float
    along_mm: float  # lengthwise half-axis of the sweep's ellipse
    guard_mm: float  # beside the middle of the line
    guard_lead_mm: float
    look_ahead_mm: float
    slope_per_mm: float  # of the sweep's fundamental at the middle of the line
    mean: float  # darkness over a centred sweep
    drive_gain: float
    drive_change_mm_s: float
    steering_gain: float
    direct_rad_s_mm: (
        float  # turn rate per mm that the cell sees the line aside; 0 for a head with a drum
    )


def owed_s(tuning_gain: float, period_s: float) -> float:
    """Time by which a drive of this gain per period lags its demand, s."""
    return period_s * (1.0 - tuning_gain) / tuning_gain


@njit(cache=True)
def follow(cells, pitch_mm, state, drum, t, home, out):  # type: ignore[no-untyped-def]
    """Follow the line until something happens or `out` (n, 2) is full; (positions written, why).

    `drum` (DRUM, 2) holds the places seen last; `home` is (x, y, heading, travel from which on the head may
    close there).
    """
    for n in range(len(out)):
        _swing(cells, pitch_mm, state, t)
        if state[SWEEP] >= t.sweep_periods:
            _detect(state, drum, t)
            if t.direct_rad_s_mm == 0:
                _fit(state, drum, t)
            why = _look(cells, pitch_mm, state, t)
            if why == MORE and _at_home(state, t, home):
                why = HOME
            if why != MORE:
                return n, why
        _steer(state, t)
        out[n, 0], out[n, 1] = state[X], state[Y]
    return len(out), MORE


@njit(cache=True)
def _swing(cells, pitch_mm, state, t):  # type: ignore[no-untyped-def]
    """One period of the swinging cell: its current into the synchronous detector."""
    phase = TWO_PI * (state[SWEEP] + 0.5) / t.sweep_periods
    swing = math.sin(phase)
    u, ahead = state[MIDDLE] + t.amplitude_mm * swing, t.lead_mm + t.along_mm * math.cos(phase)
    c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
    d = darkness_at(cells, pitch_mm, state[X] + ahead * c - u * s, state[Y] + ahead * s + u * c)
    state[FIRST] += d * swing
    state[MEAN] += d
    state[SWEEP] += 1
    if state[SWEEP] == t.sweep_periods // 2:
        state[SWEPT_X], state[SWEPT_Y] = state[X], state[Y]


@njit(cache=True)
def _detect(state, drum, t):  # type: ignore[no-untyped-def]
    """End of a sweep: the line's place goes onto the drum, and the next sweep is centred on it."""
    mean = state[MEAN] / t.sweep_periods
    state[INK] += 0.1 * (min(max(mean / t.mean, 0.3), 2.0) - state[INK])
    aside = 2.0 * state[FIRST] / t.sweep_periods / (t.slope_per_mm * state[INK])
    if t.direct_rad_s_mm > 0:
        state[ASIDE] = aside
        state[AHEAD] = mean / t.mean
        state[MIDDLE] = state[SWEEP] = state[FIRST] = state[MEAN] = (
            0.0  # the mount turns with the head only
        )
        return
    limit = 0.5 * t.amplitude_mm
    state[MIDDLE] += min(max(aside, -limit), limit)
    middle = (
        state[HEADING] - 0.5 * t.sweep_periods * t.period_s * state[TURN]
    )  # as it was in the middle of the sweep
    c, s = math.cos(middle), math.sin(middle)
    if abs(aside) < limit:  # or else the sweep was not on the line
        place = int(state[PLACES]) % DRUM
        drum[place, 0] = state[SWEPT_X] + t.lead_mm * c - state[MIDDLE] * s
        drum[place, 1] = state[SWEPT_Y] + t.lead_mm * s + state[MIDDLE] * c
        state[PLACES] += 1
    state[SWEEP] = state[FIRST] = state[MEAN] = 0.0


@njit(cache=True)
def _fit(state, drum, t):  # type: ignore[no-untyped-def]
    """Parabola through the drum's places about the point ahead of the axis: where the line is there, and its
    bend.

    Weights fall to nothing at the window's ends (1 - (x/h)²). The sums solve for y = p0 + p1·x + p2·x² from
    the point.
    """
    c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
    x0, y0 = state[X] + t.point_mm * c, state[Y] + t.point_mm * s
    s0 = s1 = s2 = s3 = s4 = b0 = b1 = b2 = 0.0
    for k in range(min(int(state[PLACES]), DRUM)):
        dx, dy = drum[k, 0] - x0, drum[k, 1] - y0
        x, y = dx * c + dy * s, dy * c - dx * s
        if abs(x) < t.half_window_mm and abs(y) < t.half_window_mm:
            w = 1.0 - (x / t.half_window_mm) ** 2
            xx = x * x
            s0, s1, s2, s3, s4 = (
                s0 + w,
                s1 + w * x,
                s2 + w * xx,
                s3 + w * xx * x,
                s4 + w * xx * xx,
            )
            b0, b1, b2 = b0 + w * y, b1 + w * x * y, b2 + w * xx * y
    d0, d1, d2 = s2 * s4 - s3 * s3, s2 * s3 - s1 * s4, s1 * s3 - s2 * s2
    det = s0 * d0 + s1 * d1 + s2 * d2
    if det < 1e-9 * s0 * s2 * s4 or s0 == 0.0:
        return
    p0 = (d0 * b0 + d1 * b1 + d2 * b2) / det
    p1 = (d1 * b0 + (s0 * s4 - s2 * s2) * b1 + (s1 * s2 - s0 * s3) * b2) / det
    p2 = (d2 * b0 + (s1 * s2 - s0 * s3) * b1 + (s0 * s2 - s1 * s1) * b2) / det
    state[POINT_X], state[POINT_Y] = x0 - p0 * s, y0 + p0 * c
    state[BEND] = 2.0 * p2 / (1.0 + p1 * p1) ** 1.5


@njit(cache=True)
def _look(cells, pitch_mm, state, t):  # type: ignore[no-untyped-def]
    """The guard cells and the look-ahead cell, read once a sweep; why the head must stop following, if it
    must.
    """
    c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
    ahead = t.guard_lead_mm
    curve = state[MIDDLE] / (t.lead_mm * t.lead_mm)
    slant = math.hypot(1.0, 2.0 * curve * ahead)
    for k in range(3 if t.direct_rad_s_mm == 0 else 0):
        u = curve * ahead * ahead + (1 - k) * t.guard_mm * slant
        d = darkness_at(
            cells, pitch_mm, state[X] + ahead * c - u * s, state[Y] + ahead * s + u * c
        )
        state[LEFT + k] += 0.5 * (d / state[INK] - state[LEFT + k])
    far = t.look_ahead_mm
    u = curve * far * far
    if (
        darkness_at(cells, pitch_mm, state[X] + far * c - u * s, state[Y] + far * s + u * c)
        < 0.5 * state[INK]
    ):
        state[SLOW] = t.slow_periods
    if t.direct_rad_s_mm > 0:
        return KNOT if state[AHEAD] < LOST else MORE
    if max(state[LEFT], state[RIGHT]) > BESIDE or state[AHEAD] < 0.5:
        return KNOT
    if max(abs(state[BEND]), 2 * abs(curve)) > t.tightest_per_mm:
        return TIGHT
    return CHANGED if abs(state[INK] - 1.0) > ALTERED else MORE


@njit(cache=True)
def _at_home(state, t, home):  # type: ignore[no-untyped-def]
    """Whether home lies just ahead on the line."""
    if state[TRAVEL] < home[3]:
        return False
    dx, dy = home[0] - state[X], home[1] - state[Y]
    c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
    along, aside = dx * c + dy * s, dy * c - dx * s
    return (
        0.0 < along < t.lead_mm
        and abs(aside) < 0.3 * t.lead_mm
        and math.cos(home[2] - state[HEADING]) > 0.8
    )


@njit(cache=True)
def _steer(state, t):  # type: ignore[no-untyped-def]
    """One period of steering servo, sine and cosine, and the two drives."""
    if state[SLOW] > 0:
        state[SLOW] -= 1
    wanted = t.speed_mm_s * (t.slowed if state[SLOW] > 0 else 1.0)
    change = t.acceleration_mm_s2 * t.period_s
    state[SPEED] += min(max(wanted - state[SPEED], -change), change)
    owed = t.period_s * (1.0 - t.drive_gain) / t.drive_gain
    dx = state[POINT_X] - state[X] - owed * state[VX]
    dy = state[POINT_Y] - state[Y] - owed * state[VY]
    c, s = math.cos(state[HEADING]), math.sin(state[HEADING])
    along, aside = max(dx * c + dy * s, 0.2 * t.point_mm), dy * c - dx * s
    demand = state[SPEED] * 2.0 * aside / (along * along + aside * aside)
    if t.direct_rad_s_mm > 0:
        demand = t.direct_rad_s_mm * state[ASIDE]
    state[TURN] += t.steering_gain * (demand - state[TURN])
    state[HEADING] += state[TURN] * t.period_s
    move(
        state,
        t,
        state[SPEED] * math.cos(state[HEADING]),
        state[SPEED] * math.sin(state[HEADING]),
    )


@njit(cache=True)
def move(state, t, demand_x_mm_s, demand_y_mm_s):  # type: ignore[no-untyped-def]
    """One period of the two drives: their screws turn, and the head with them."""
    x, y = state[X], state[Y]
    state[VX] = drive_step(state[VX], demand_x_mm_s, t.drive_gain, t.drive_change_mm_s)
    state[VY] = drive_step(state[VY], demand_y_mm_s, t.drive_gain, t.drive_change_mm_s)
    state[X] += state[VX] * t.period_s
    state[Y] += state[VY] * t.period_s
    state[TRAVEL] += math.hypot(state[X] - x, state[Y] - y)


@njit(cache=True)
def run(state, t, points, speeds, out):  # type: ignore[no-untyped-def]
    """Run along a course (n, 2) mm, at each point at most at its speed (n,) mm/s; positions written.

    The demand moves on the course exactly, and the screws follow by their lag.
    """
    owed = t.period_s * (1.0 - t.drive_gain) / t.drive_gain
    x, y = state[X] + owed * state[VX], state[Y] + owed * state[VY]  # where the demand stands
    change, slowest = t.acceleration_mm_s2 * t.period_s, 0.02 * t.speed_mm_s
    leg, last = 0, len(points) - 1
    for n in range(len(out)):
        if leg >= last:
            return n
        gap = math.hypot(points[leg + 1, 0] - x, points[leg + 1, 1] - y)
        braking = math.sqrt(speeds[leg + 1] ** 2 + 2 * t.acceleration_mm_s2 * gap)
        held = t.speed_mm_s * (t.slowed if state[SLOW] > 0 else 1.0)
        state[SLOW] = max(state[SLOW] - 1, 0)
        allowed = min(
            braking, max(speeds[leg], speeds[leg + 1]), max(held, state[SPEED] - change)
        )
        state[SPEED] = max(min(state[SPEED] + change, allowed), slowest)
        step = state[SPEED] * t.period_s
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
        move(state, t, (x - old_x) / t.period_s, (y - old_y) / t.period_s)
        out[n, 0], out[n, 1] = state[X], state[Y]
    return len(out)


@njit(cache=True)
def stand(state, t, out):  # type: ignore[no-untyped-def]
    """Stand for the length of `out` while the drives come to rest."""
    state[SPEED] = 0.0
    for n in range(len(out)):
        move(state, t, 0.0, 0.0)
        out[n, 0], out[n, 1] = state[X], state[Y]
    return len(out)
