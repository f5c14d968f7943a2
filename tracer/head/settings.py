"""Settings of the head, and the tuning that follows from them and from the line that it stands on.

Signals: settings by name, a stance and the motion rate in; the tuning that the kernels take out.

The sweep's amplitude is 0.6 of the line's width, so that its ends stand just outside the edges. The slope of
the fundamental and the mean darkness are measured on the line itself, with the sweep set a little to one side
and to the other.

Source: patent ES 361967 gives no figures. Chosen for the precise head: half a window of 0.65 mm on a line of
0.5 mm. Averaging along the line is what beats the noise of a scan, and the error on a changing bend grows
with the cube of the window. The historic set is our own, within what the patent says.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, NamedTuple

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.drive import Drive
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Tuning
from morfax.tracer.sensing.photocell import TWO_PI, sweep
from morfax.tracer.sensing.view import View

OF_DRIVE = "drive_"  # the names of the drives' settings begin so

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
NARROW_LEGS = 0.3  # of a leg: half of the narrowest window, which averages as stations do
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


@dataclass(frozen=True, slots=True)
class Bounds:
    """The values that a setting may hold, in the unit that its name ends with, and what the setting is."""

    least: float
    most: float
    what: str


def _within(usual: float | None, least: float, most: float, what: str) -> Any:
    """A setting with its usual value; None follows from the line."""
    return field(default=usual, metadata={"bounds": Bounds(least, most, what)})


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of the head, by default the precise set; a setting that is None follows from the line."""

    speed_mm_s: float = _within(10.0, 0.01, 1000, "tracing speed (WC)")
    slowed: float = _within(
        0.3, 0.01, 1, "share of the speed while the look-ahead relay holds (SR)"
    )
    slow_s: float = _within(0.1, 0, 10, "how long the relay holds (DL)")
    acceleration_mm_s2: float = _within(500.0, 1, 100_000, "of the tracing speed")
    sweep_hz: float = _within(250.0, 1, 750, "how often the cell swings (motor 45)")
    aperture_mm: float | None = _within(
        None, 0, 10, "spot through which a cell sees the drawing"
    )
    steering_lag_s: float = _within(0.001, 0, 1, "lag of the steering servo (M, T)")
    swivel_rad_s: float = _within(20.0, 0.1, 1000, "turn rate of the swivel at a sharp corner")
    gap_mm: float = _within(0.5, 0, 20, "widest gap that the head goes across")
    recatch_mm: float = _within(
        0.0, 0, 50, "how far ahead the head looks for a line that it lost; 0: not at all"
    )
    line_width_mm: float | None = _within(None, 0.01, 20, "width of the line")
    lead_mm: float | None = _within(
        None, 0.01, 20, "how far the cell is ahead of the steering axis"
    )
    amplitude_mm: float | None = _within(None, 0.01, 20, "of the swing to either side")
    look_ahead_mm: float | None = _within(
        None, 0.01, 100, "how far cell 102 is ahead of the steering axis"
    )
    direct_rad_s_mm: float = _within(
        0.0,
        0,
        10_000,
        "steer straight by the swinging cell, turn rate per mm aside; 0: by the drum",
    )
    cell_gain: float = _within(
        1.0, 0, 10, "of the swinging cell's current: 1 as it should be, 0 a blind cell"
    )
    detector_gain: float = _within(
        1.0,
        -10,
        10,
        "of the synchronous detector (FSA): 1 as it should be, -1 wired the wrong way",
    )
    cell_noise: float = _within(
        0.0, 0, 10, "of the cell's current, standard deviation as a share of the ink's"
    )
    drive: Drive = field(default_factory=Drive)


HISTORIC = Settings(
    speed_mm_s=10.0,
    sweep_hz=50.0,
    aperture_mm=0.3,
    steering_lag_s=0.03,
    lead_mm=2.0,
    amplitude_mm=1.0,
    look_ahead_mm=6.0,
    direct_rad_s_mm=5.0,  # 2v/a²: damped to 0.71
)
HEADS = {"precise": Settings(), "historic": HISTORIC}


BOUNDS: dict[str, Bounds] = {
    **{f.name: f.metadata["bounds"] for f in fields(Settings) if f.name != "drive"},
    "drive_lag_s": Bounds(0, 1, "lag of the X and Y drives (DCX, DCY)"),
    "drive_acceleration_mm_s2": Bounds(1, 1_000_000, "that the drives' amplifiers allow"),
}


def choose(head: str = "precise", changes: Mapping[str, object] | None = None) -> Settings:
    """A named set of settings with changes by name.

    Raises ValueError for an unknown head or setting, and for a value that is no number or out of bounds.
    """
    if head not in HEADS:
        raise ValueError(f"there is no head {head!r}; give one of {', '.join(HEADS)}")
    settings = HEADS[head]
    for name, value in (changes or {}).items():
        if name not in BOUNDS:
            raise ValueError(f"the head has no setting {name!r}; it has {', '.join(BOUNDS)}")
        settings = _changed(settings, name, _number(name, value))
    return settings


def value_of(settings: Settings, name: str) -> float | None:
    """Value of a setting by its name; None if it follows from the line."""
    if name.startswith(OF_DRIVE):
        return float(getattr(settings.drive, name.removeprefix(OF_DRIVE)))
    value = getattr(settings, name)
    return None if value is None else float(value)


def allowed(name: str) -> str:
    """The values that a setting may hold, in words."""
    bounds = BOUNDS[name]
    return f"a number from {bounds.least:g} to {bounds.most:g}, in the unit that its name ends with"


def _number(name: str, value: object) -> float:
    """A setting's value as a number; raises ValueError if it is none, or out of bounds."""
    try:
        number = float(str(value))
    except ValueError:
        number = math.nan
    if not BOUNDS[name].least <= number <= BOUNDS[name].most:
        raise ValueError(f"{name} is {value!r}; it must be {allowed(name)}")
    return number


def _changed(settings: Settings, name: str, number: float) -> Settings:
    """Settings with one of them set."""
    if name.startswith(OF_DRIVE):
        drive = replace(settings.drive, **{name.removeprefix(OF_DRIVE): number})
        return replace(settings, drive=drive)
    return replace(settings, **{name: number})  # type: ignore[arg-type]


def tune(stance: Stance, settings: Settings, rate_hz: float) -> Tuning:
    """What the kernels need to follow the line under a stance."""
    width, pitch = stance.view.width_mm, stance.view.pitch_mm
    # 1. sizes, where the settings leave them to the line
    sizes = EDGE if stance.view.on_edge else LINE
    half_window = max(WINDOW_MM + WINDOW_WIDTHS * width, sizes.window_px * pitch)
    point = max(POINT_MM, sizes.point_px * pitch)
    sweeps_mm = LEAD_SWEEPS * settings.speed_mm_s / settings.sweep_hz
    lead = settings.lead_mm or half_window + point + sweeps_mm
    swing = max(sizes.swing_widths * width, sizes.swing_px * pitch)
    amplitude = settings.amplitude_mm or swing
    guard = sizes.guard_widths * width + max(GUARD_MM, sizes.guard_px * pitch)
    guard_ahead = max(GUARD_AHEAD_MM, sizes.guard_ahead_px * pitch)
    # 2. the detector's characteristic, as measured on the line
    slope, mean, balance = _calibrate(stance, amplitude)
    # 3. gains per period
    steering_gain = 1.0
    if settings.steering_lag_s > 0:
        steering_gain = 1 - math.exp(-1 / rate_hz / settings.steering_lag_s)
    pin = _pin(max(LEAST_SWEEP_PERIODS, round(rate_hz / settings.sweep_hz)))
    return Tuning(
        period_s=1 / rate_hz,
        speed_mm_s=settings.speed_mm_s,
        slowed=settings.slowed,
        slow_periods=settings.slow_s * rate_hz,
        acceleration_mm_s2=settings.acceleration_mm_s2,
        sweep_periods=len(pin),
        pin=pin,
        lead_mm=lead,
        point_mm=point,
        half_window_mm=half_window,
        narrow_mm=min(half_window, NARROW_LEGS * stance.view.leg_mm),
        narrowest_per_mm=sizes.narrowest_rad / (NARROW_LEGS * stance.view.leg_mm),
        tightest_per_mm=TIGHTEST_RAD / half_window,
        amplitude_mm=amplitude,
        along_mm=SWING_ALONG * amplitude,
        guard_mm=guard,
        guard_lead_mm=lead + guard_ahead,
        look_ahead_mm=settings.look_ahead_mm or lead + LOOK_AHEAD_MM,
        slope_per_mm=slope,
        mean=mean,
        balance_per_mm=balance,
        drive_gain=settings.drive.gain(1 / rate_hz),
        drive_change_mm_s=settings.drive.acceleration_mm_s2 / rate_hz,
        steering_gain=steering_gain,
        square=False,
        direct_rad_s_mm=settings.direct_rad_s_mm,
        cell_gain=settings.cell_gain,
        detector_gain=settings.detector_gain,
        cell_noise=settings.cell_noise,
    )


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
