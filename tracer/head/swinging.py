"""The swinging cell: one sweep across the line, and its synchronous detector.

Signals: the drawing behind the aperture in; out, once a sweep, the middle of the next sweep (mm to the left
of the heading) and the place of the line on the drum (sheet mm).

    first = 2/N · sum D·sin(phase)      its sign is the side on which the line is
    aside = first / (slope · ink)       how far, by the slope that was measured on the line

On the edge of a filled shape the detector balances dark against light: half of the sweep is dark when its
middle is on the edge. The fundamental tells only that there is an edge at all.

    mean  = 1/N · sum D                 by how much it is over a half is the side, and how far
    aside = (mean - 1/2) / balance      by the slope of the mean that was measured on the edge

Cell and detector may be out of order: their gains, and noise in the cell's current, are settings. `heard`
tells whether they work.

Source: patent ES 361967, figure 1: cell 101, mount 42, pin 48, motor 45, amplifier FSA. The balance is that
of the edge tracers of flame cutters. Questions: see `kernel`.
"""

from __future__ import annotations

import math

from morfax.motion.compiled import njit
from morfax.tracer.head.state import DRUM
from morfax.tracer.limits import FOLLOWS
from morfax.tracer.sensing.photocell import darkness_at

# Shares of the line's ink; chosen by trial on the test drawings.
PALEST, DARKEST = 0.3, 2.0  # a sweep counts as no less and no more of the ink than this
BALANCED = 0.5  # of the sweep is dark, when its middle is on the edge of a shape
# of the lead aside: a line that turns more than 50 degrees is no arc up to there
MOST_ASLANT = 0.5
FARTHEST_ASIDE = 0.5  # of the amplitude: a sweep that is further off is not on the line
# of the random numbers: those of Numerical Recipes, "quick and dirty generators"
NOISE_FACTOR, NOISE_STEP, NOISE_NUMBERS = 1664525, 1013904223, 2**32


@njit(cache=True, inline="always")
def way_of(state):  # type: ignore[no-untyped-def]
    """Unit vector (x, y) along the heading."""
    return math.cos(state.heading_rad), math.sin(state.heading_rad)


@njit(cache=True, inline="always")
def seen(cells, state, towards, ahead, aside):  # type: ignore[no-untyped-def]
    """Darkness under a cell so far ahead of the axis and to the left of its heading, mm."""
    x = state.x_mm + ahead * towards[0] - aside * towards[1]
    y = state.y_mm + ahead * towards[1] + aside * towards[0]
    return darkness_at(cells, x, y)


@njit(cache=True, _nrt=False)
def _hiss(state):  # type: ignore[no-untyped-def]
    """Noise of standard deviation 1: twelve random numbers of a linear congruential generator, summed."""
    hiss = -6.0
    for _ in range(12):
        state.noise_number = (NOISE_FACTOR * state.noise_number + NOISE_STEP) % NOISE_NUMBERS
        hiss += state.noise_number / NOISE_NUMBERS
    return hiss


@njit(cache=True, inline="always")
def swing(cells, state, t, way):  # type: ignore[no-untyped-def]
    """One period of the swinging cell on a way (see `way_of`): its current goes into the detector."""
    sine, cosine = t.pin[state.sweep_periods, 0], t.pin[state.sweep_periods, 1]
    across, along = t.amplitude_mm * sine, t.along_mm * cosine
    turned, straight = _across(state, t)
    aside = state.middle_mm + across * straight + along * turned
    ahead = state.lead_mm + along * straight - across * turned
    darkness = t.cell_gain * seen(cells, state, way, ahead, aside)
    if t.cell_noise > 0.0:
        darkness += t.cell_noise * _hiss(state)
    state.first_sum += darkness * sine
    state.mean_sum += darkness
    state.sweep_periods += 1
    if state.sweep_periods == t.sweep_periods // 2:
        state.swept_x_mm, state.swept_y_mm = state.x_mm, state.y_mm


@njit(cache=True, inline="always")
def _across(state, t):  # type: ignore[no-untyped-def]
    """Sine and cosine of the angle from the heading to the line where the cell swings: on the arc that
    touches the heading, if the sweep stands square to bends, or does so where the line was felt clean; else
    along the heading.
    """
    if not t.square and (not t.square_on_clean or state.travel_mm >= state.trusted_mm):
        return 0.0, 1.0
    lead = state.lead_mm
    aside = min(max(state.middle_mm, -MOST_ASLANT * lead), MOST_ASLANT * lead)
    square = lead * lead + aside * aside
    return 2.0 * lead * aside / square, (lead * lead - aside * aside) / square


@njit(cache=True, _nrt=False)
def detect(state, t):  # type: ignore[no-untyped-def]
    """End of a sweep: the line's place goes onto the drum, and the next sweep is centred on it."""
    # 1. what the sweep tells
    mean = state.mean_sum / t.sweep_periods
    first = 2.0 * state.first_sum / t.sweep_periods
    if t.balance_per_mm == 0.0:
        state.swept_ink = mean / t.mean
        state.ink += FOLLOWS * (min(max(state.swept_ink, PALEST), DARKEST) - state.ink)
        aside = t.detector_gain * first / (t.slope_per_mm * state.ink)
    else:
        state.swept_ink = abs(first) / t.mean
        aside = t.detector_gain * (mean - BALANCED) / t.balance_per_mm
    aside /= _across(state, t)[1]
    state.sweep_periods = 0
    state.first_sum = state.mean_sum = 0.0
    # 2. without a drum, the mount turns with the head only
    if t.direct_rad_s_mm > 0:
        state.aside_mm = aside
        state.middle_mm = 0.0
        return
    # 3. the line's place, by the heading as it was in the middle of the sweep
    limit = FARTHEST_ASIDE * t.amplitude_mm
    state.middle_mm += min(max(aside, -limit), limit)
    middle = state.heading_rad - 0.5 * t.sweep_periods * t.period_s * state.turn_rad_s
    c, s = math.cos(middle), math.sin(middle)
    if abs(aside) < limit:
        place, on_line = state.places % DRUM, state.middle_mm
        state.drum_mm[place, 0] = state.swept_x_mm + state.lead_mm * c - on_line * s
        state.drum_mm[place, 1] = state.swept_y_mm + state.lead_mm * s + on_line * c
        state.places += 1
    # 4. the mount slides out to its lead by as much as the axis goes in a sweep
    if state.lead_mm < t.lead_mm:
        lead_mm = state.lead_mm + state.speed_mm_s * t.sweep_periods * t.period_s
        lead_mm = min(t.lead_mm, lead_mm)
        state.middle_mm *= (lead_mm / state.lead_mm) ** 2
        state.lead_mm = lead_mm


@njit(cache=True, _nrt=False)
def heard(cells, state, t, off_mm):  # type: ignore[no-untyped-def]
    """By how much a standing head moves its sweep when that is set off to the left by `off_mm`, mm.

    The state is used up. A cell and a detector that work move the sweep back.
    """
    state.middle_mm += off_mm
    set_mm = state.middle_mm
    for _ in range(t.sweep_periods):
        swing(cells, state, t, way_of(state))
    detect(state, t)
    return state.middle_mm - set_mm


@njit(cache=True, _nrt=False)
def goes_back(cells, states, t, how):  # type: ignore[no-untyped-def]
    """By how much a standing head moves its sweep back to the line, summed over places ahead and both sides,
    mm.

    `states`: that of the head, and room for another one. `how`: the number of places, mm between them, and
    how far the sweep is set off, mm.
    """
    stations, step_mm, off_mm = how
    own, tried = states[0], states[1]
    way, back_mm = way_of(own), 0.0
    for k in range(stations):
        for side in (-1.0, 1.0):
            states[1] = states[0]
            tried.x_mm += k * step_mm * way[0]
            tried.y_mm += k * step_mm * way[1]
            back_mm -= side * heard(cells, tried, t, side * off_mm)
    return back_mm
