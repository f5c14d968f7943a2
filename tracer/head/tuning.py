"""The head's tuning: what follows from its settings and from the line that it stands on.

Signals: settings, a stance and the motion rate in; the tuning that the kernels take out.

The sweep's amplitude is 0.6 of the line's width, so that its ends stand just outside the edges. The slope of
the fundamental and the mean darkness are measured on the line itself, with the sweep set a little to one side
and to the other.

Source: patent ES 361967 gives no figures. Chosen for the precise head: half a window of 0.65 mm on a line of
0.5 mm. Averaging along the line is what beats the noise of a scan, and the error on a changing bend grows
with the cube of the window.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.tracer.head.course import FELT_LEGS
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Tuning
from morfax.tracer.limits import DETAIL_PX
from morfax.tracer.sensing.photocell import TWO_PI, sweep
from morfax.tracer.sensing.view import View

# The head's own sizes: so many mm, widths of the line and pixels. Chosen by trial on the test drawings.
WINDOW_MM, WINDOW_WIDTHS = 0.35, 0.6  # half the window of the parabola
POINT_MM = 0.12  # from the axis to the point that it steers for
LEAD_SWEEPS = 2  # beyond window and point: a place is on the drum before the window needs it
SWING_ALONG = 0.1  # of the amplitude: lengthwise half-axis of the eccentric pin's ellipse
GUARD_MM = 0.17  # from the line's edge to a guard cell beside it
GUARD_AHEAD_MM = 0.15  # from the swinging cell to the guard cells
LOOK_AHEAD_MM = 1.0  # from the swinging cell to cell 102
# that a line may turn within half the window: a parabola still follows that
TIGHTEST_RAD = 0.23
LEAST_SWEEP_PERIODS = 8  # fewer tell no fundamental


class HeadSizes(NamedTuple):
    """What differs between the head on a line and the head on an edge; pixels where the scan is coarse."""

    window_px: float  # half the window of the parabola, at least
    point_px: float  # from the axis to the point that it steers for, at least
    swing_widths: float  # amplitude of the sweep, widths of the line
    swing_px: float  # and at least
    guard_widths: float  # from the middle to the line's edge, beyond which the guard cells are
    guard_px: float  # from there to a guard cell, at least
    guard_ahead_px: float  # from the swinging cell to the guard cells, at least
    narrowest_rad: float  # that a line turns within the narrowest window
    stations: int  # along which the characteristic is measured: an edge may bend more


LINE = HeadSizes(7, 1.2, 0.6, 1.5, 0.5, 2, 1.5, 0.36, 8)
# an edge is as sharp as the lens: fewer pixels than a line's two edges need, and a shorter swing hears less
# noise for its slope
EDGE = HeadSizes(2, 0.6, 0.25, 1.2, 0.0, 1.6, 0.6, 0.45, 3)

CALIBRATED_ASIDE = 0.1  # of the line's width: the fundamental's slope is measured between these
CALIBRATED_SAMPLES = 24
LEAST_SLOPE_PER_MM = 0.2  # so that a pale line does not make the head wild


class Placed(NamedTuple):
    """Where the head's parts stand on a line, mm."""

    half_window_mm: float
    point_mm: float
    lead_mm: float
    amplitude_mm: float
    guard_mm: float
    guard_ahead_mm: float


def _placed(view: View, settings: Settings) -> Placed:
    """The head's sizes on a line, where the settings leave them to it."""
    width, pitch = view.width_mm, view.pitch_mm
    sizes = EDGE if view.on_edge else LINE
    half_window = max(WINDOW_MM + WINDOW_WIDTHS * width, sizes.window_px * pitch)
    point = max(POINT_MM, sizes.point_px * pitch)
    sweeps_mm = LEAD_SWEEPS * settings.speed_mm_s / settings.sweep_hz
    lead = settings.lead_mm or half_window + point + sweeps_mm
    swing = max(sizes.swing_widths * width, sizes.swing_px * pitch)
    guard = sizes.guard_widths * width + max(GUARD_MM, sizes.guard_px * pitch)
    guard_ahead = max(GUARD_AHEAD_MM, sizes.guard_ahead_px * pitch)
    amplitude = settings.amplitude_mm or swing
    return Placed(half_window, point, lead, amplitude, guard, guard_ahead)


def tune(stance: Stance, settings: Settings, rate_hz: float) -> Tuning:
    """What the kernels need to follow the line under a stance."""
    view = stance.view
    placed = _placed(view, settings)
    narrow_mm = FELT_LEGS * view.leg_mm  # half of the narrowest window averages as stations do
    narrowest_rad = (EDGE if view.on_edge else LINE).narrowest_rad
    slope, mean, balance = _calibrate(stance, placed.amplitude_mm)
    # no cell parts the edges of a line that is thinner, and steps of pixels bend it more than it is bent
    is_thin = bool(view.width_mm < DETAIL_PX * view.pitch_mm)
    pin = _pin(max(LEAST_SWEEP_PERIODS, round(rate_hz / settings.sweep_hz)))
    return Tuning(
        period_s=1 / rate_hz,
        speed_mm_s=settings.speed_mm_s,
        slowed=settings.slowed,
        slow_periods=settings.slow_s * rate_hz,
        acceleration_mm_s2=settings.acceleration_mm_s2,
        sweep_periods=len(pin),
        pin=pin,
        lead_mm=placed.lead_mm,
        point_mm=placed.point_mm,
        half_window_mm=placed.half_window_mm,
        narrow_mm=min(placed.half_window_mm, narrow_mm),
        narrowest_per_mm=narrowest_rad / narrow_mm,
        tightest_per_mm=TIGHTEST_RAD / placed.half_window_mm,
        amplitude_mm=placed.amplitude_mm,
        along_mm=SWING_ALONG * placed.amplitude_mm,
        guard_mm=placed.guard_mm,
        guard_lead_mm=placed.lead_mm + placed.guard_ahead_mm,
        look_ahead_mm=settings.look_ahead_mm or placed.lead_mm + LOOK_AHEAD_MM,
        slope_per_mm=slope,
        mean=mean,
        balance_per_mm=balance,
        drive_gain=settings.drive.gain(1 / rate_hz),
        drive_change_mm_s=settings.drive.acceleration_mm_s2 / rate_hz,
        steering_gain=_steering_gain(settings.steering_lag_s, rate_hz),
        square=view.square,
        square_on_clean=not view.on_edge and not is_thin,
        direct_rad_s_mm=settings.direct_rad_s_mm,
        cell_gain=settings.cell_gain,
        detector_gain=settings.detector_gain,
        cell_noise=settings.cell_noise,
    )


def _steering_gain(lag_s: float, rate_hz: float) -> float:
    """Share of what is left to turn that the steering servo turns in a period."""
    return 1 - math.exp(-1 / rate_hz / lag_s) if lag_s > 0 else 1.0


@cache
def _pin(periods: int) -> Array:
    """Where the eccentric pin stands in each period of a sweep: sine and cosine of its phase, (n, 2)."""
    phases = [TWO_PI * (period + 0.5) / periods for period in range(periods)]
    return np.array([(math.sin(phase), math.cos(phase)) for phase in phases])


def tuned_along(view: View) -> int:
    """The number of stations along which a line or an edge is measured."""
    return (EDGE if view.on_edge else LINE).stations


def _calibrate(stance: Stance, amplitude_mm: float) -> tuple[float, float, float]:
    """Slope of the sweep's fundamental (per mm), its mean darkness and 0, over a few stations ahead.

    On the edge of a shape: the slope, the size of the fundamental, and the slope of the mean (per mm).
    """
    view, heading = stance.view, stance.heading_rad
    stations = tuned_along(view)
    aside = CALIBRATED_ASIDE * view.width_mm
    x_mm, y_mm = stance.place_mm.tolist()
    pose = x_mm, y_mm, float(heading)
    sizes_mm = float(aside), float(amplitude_mm), float(view.step_mm)
    slopes, means, firsts, balances = _swept(view.cells, pose, sizes_mm, stations)
    slope = max(slopes, LEAST_SLOPE_PER_MM)
    if not view.on_edge:
        return slope, means, 0.0
    return slope, firsts, math.copysign(max(abs(balances), LEAST_SLOPE_PER_MM), balances)


@njit(cache=True)
def _swept(cells, pose, sizes_mm, stations):  # type: ignore[no-untyped-def]
    """Means over stations ahead of a pose: slope of the fundamental (per mm), darkness, size of the
    fundamental, slope of the darkness (per mm). `sizes_mm`: how far aside, amplitude, distance of stations.
    """
    (x_mm, y_mm, heading), (aside, amplitude_mm, step_mm) = pose, sizes_mm
    c, s, place = math.cos(heading), math.sin(heading), np.empty(2)
    slopes = means = firsts = balances = 0.0
    for k in range(stations):
        place[0], place[1] = x_mm + step_mm * k * c, y_mm + step_mm * k * s
        left = sweep(cells, place, heading, (-aside, amplitude_mm), CALIBRATED_SAMPLES)
        right = sweep(cells, place, heading, (aside, amplitude_mm), CALIBRATED_SAMPLES)
        slopes += (left[0] - right[0]) / (2 * aside) / stations
        means += (left[1] + right[1]) / 2 / stations
        firsts += abs(left[0] + right[0]) / 2 / stations
        balances += (left[1] - right[1]) / (2 * aside) / stations
    return slopes, means, firsts, balances
