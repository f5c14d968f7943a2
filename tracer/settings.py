"""Settings of the head, and the tuning that follows from them and from the line that it stands on.

The sweep's amplitude is 0.6 of the line's width, so that its ends stand just outside the edges; the slope of the fundamental and the mean darkness are
measured on the line itself, with the sweep set a little to one side and to the other.

Source: patent ES 361967 gives no figures. Chosen for the precise head: a lead of 0.5 mm on a line of 0.5 mm; averaging along two leads is what beats the
noise of a scan, and the error on a changing bend grows with the cube of the lead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace

import numpy as np

from motion.drive import Drive
from tracer.head import Tuning
from tracer.photocell import sweep
from tracer.stance import Stance


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of the head: by default the precise set. What is None follows from the line."""

    speed_mm_s: float = 10.0
    slowed: float = 0.3  # share of the speed while the look-ahead relay holds
    slow_s: float = 0.1
    acceleration_mm_s2: float = 500.0
    sweep_hz: float = 250.0
    aperture_mm: float | None = None
    steering_lag_s: float = 0.001
    swivel_rad_s: float = 20.0
    gap_mm: float = 0.5
    line_width_mm: float | None = None
    lead_mm: float | None = None
    amplitude_mm: float | None = None
    look_ahead_mm: float | None = None
    direct_rad_s_mm: float = 0.0  # steer straight by the swinging cell, turn rate per mm aside; 0: by the drum
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
)  # our own figures within what the patent says
HEADS = {"precise": Settings(), "historic": HISTORIC}


def choose(head: str = "precise", changes: Mapping[str, object] | None = None) -> Settings:
    """A named set of settings with changes by name; `drive_lag_s` and `drive_acceleration_mm_s2` reach the drives.

    Raises ValueError for a head or a setting that there is not, and for a value that is no number or less than 0.
    """
    if head not in HEADS:
        raise ValueError(f"there is no head {head!r}; give one of {', '.join(HEADS)}")
    settings = HEADS[head]
    for name, value in (changes or {}).items():
        settings = _changed(settings, name, value)
    return settings


def _changed(settings: Settings, name: str, value: object) -> Settings:
    """Settings with one of them set to a number."""
    own = [f.name for f in fields(Settings) if f.name != "drive"]
    of_drive = [f"drive_{f.name}" for f in fields(Drive)]
    if name not in own + of_drive:
        raise ValueError(f"the head has no setting {name!r}; it has {', '.join(own + of_drive)}")
    try:
        number = float(str(value))
    except ValueError:
        number = math.nan
    if not (math.isfinite(number) and number >= 0):
        raise ValueError(f"{name} is {value!r}; it must be a number of at least 0, in the unit that its name ends with")
    if name in of_drive:
        return replace(settings, drive=replace(settings.drive, **{name.removeprefix("drive_"): number}))
    return replace(settings, **{name: number})  # type: ignore[arg-type]


def tune(stance: Stance, settings: Settings, rate_hz: float) -> Tuning:
    """What the kernel needs to follow the line under a stance."""
    width, pitch = stance.view.width_mm, stance.view.pitch_mm
    half_window = max(0.35 + 0.6 * width, 7 * pitch)
    point = max(0.12, 1.2 * pitch)
    lead = settings.lead_mm or half_window + point + 2 * settings.speed_mm_s / settings.sweep_hz
    amplitude = settings.amplitude_mm or max(0.6 * width, 1.5 * pitch)
    slope, mean = _calibrate(stance, amplitude)
    guard = 0.5 * width + max(0.17, 2 * pitch)
    return Tuning(
        period_s=1 / rate_hz,
        speed_mm_s=settings.speed_mm_s,
        slowed=settings.slowed,
        slow_periods=settings.slow_s * rate_hz,
        acceleration_mm_s2=settings.acceleration_mm_s2,
        sweep_periods=max(8, round(rate_hz / settings.sweep_hz)),
        lead_mm=lead,
        point_mm=point,
        half_window_mm=half_window,
        tightest_per_mm=0.23
        / half_window,  # the window then turns by a quarter of a radian, which a parabola still follows
        amplitude_mm=amplitude,
        along_mm=0.1 * amplitude,
        guard_mm=guard,
        guard_lead_mm=lead + max(0.15, 1.5 * pitch),
        look_ahead_mm=settings.look_ahead_mm or lead + 1.0,
        slope_per_mm=slope,
        mean=mean,
        drive_gain=settings.drive.gain(1 / rate_hz),
        drive_change_mm_s=settings.drive.acceleration_mm_s2 / rate_hz,
        steering_gain=1 - math.exp(-1 / rate_hz / settings.steering_lag_s) if settings.steering_lag_s > 0 else 1.0,
        direct_rad_s_mm=settings.direct_rad_s_mm,
    )


def _calibrate(stance: Stance, amplitude_mm: float) -> tuple[float, float]:
    """Slope of the sweep's fundamental (per mm) and mean darkness, over a few stations of the line under the stance."""
    view, aside = stance.view, 0.1 * stance.view.width_mm
    c, s = math.cos(stance.heading_rad), math.sin(stance.heading_rad)
    slopes, means = 0.0, 0.0
    stations = 8
    for k in range(stations):
        place = stance.place_mm + view.step_mm * k * np.array([c, s])
        left = sweep(view.cells, view.pitch_mm, place, stance.heading_rad, -aside, amplitude_mm, 24)
        right = sweep(view.cells, view.pitch_mm, place, stance.heading_rad, aside, amplitude_mm, 24)
        slopes += (left[0] - right[0]) / (2 * aside) / stations
        means += (left[1] + right[1]) / 2 / stations
    return max(slopes, 0.2), means
