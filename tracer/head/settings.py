"""Settings of the head, and the tuning that follows from them and from the line that it stands on.

The sweep's amplitude is 0.6 of the line's width, so that its ends stand just outside the edges; the slope of
the fundamental and the mean darkness are measured on the line itself, with the sweep set a little to one side
and to the other.

Source: patent ES 361967 gives no figures. Chosen for the precise head: a lead of 0.5 mm on a line of 0.5 mm;
averaging along two leads is what beats the noise of a scan, and the error on a changing bend grows with the
cube of the lead.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from morfax.motion.drive import Drive
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import Tuning
from morfax.tracer.sensing.photocell import sweep

OF_DRIVE = "drive_"  # what the name of a setting of the drives begins with


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a setting may hold, in the unit that its name ends with, and what it is."""

    least: float
    most: float
    what: str


def _within(usual: float | None, least: float, most: float, what: str) -> Any:
    """A setting with its usual value; what is None follows from the line."""
    return field(default=usual, metadata={"bounds": Bounds(least, most, what)})


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of the head: by default the precise set. What is None follows from the line."""

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
        0.0, 0, 50, "how far ahead a line that is lost is looked for; 0: it stays lost"
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


BOUNDS: dict[str, Bounds] = {
    **{f.name: f.metadata["bounds"] for f in fields(Settings) if f.name != "drive"},
    "drive_lag_s": Bounds(0, 1, "lag of the X and Y drives (DCX, DCY)"),
    "drive_acceleration_mm_s2": Bounds(1, 1_000_000, "what the drives' amplifiers allow"),
}


def choose(head: str = "precise", changes: Mapping[str, object] | None = None) -> Settings:
    """A named set of settings with changes by name; `drive_lag_s` and `drive_acceleration_mm_s2` reach the
    drives.

    Raises ValueError for a head or a setting that there is not, and for a value that is no number or out of
    bounds.
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
    """What a setting holds, by its name; None if it follows from the line."""
    if name.startswith(OF_DRIVE):
        return float(getattr(settings.drive, name.removeprefix(OF_DRIVE)))
    value = getattr(settings, name)
    return None if value is None else float(value)


def allowed(name: str) -> str:
    """What a setting may hold, in words."""
    return f"a number from {BOUNDS[name].least:g} to {BOUNDS[name].most:g}, in the unit that its name ends with"


def _number(name: str, value: object) -> float:
    """A value of a setting; raises ValueError if it is none."""
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
        return replace(
            settings, drive=replace(settings.drive, **{name.removeprefix(OF_DRIVE): number})
        )
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
        steering_gain=1 - math.exp(-1 / rate_hz / settings.steering_lag_s)
        if settings.steering_lag_s > 0
        else 1.0,
        direct_rad_s_mm=settings.direct_rad_s_mm,
    )


def _calibrate(stance: Stance, amplitude_mm: float) -> tuple[float, float]:
    """Slope of the sweep's fundamental (per mm) and mean darkness, over a few stations of the line under the
    stance.
    """
    view, aside = stance.view, 0.1 * stance.view.width_mm
    c, s = math.cos(stance.heading_rad), math.sin(stance.heading_rad)
    slopes, means = 0.0, 0.0
    stations = 8
    for k in range(stations):
        place = stance.place_mm + view.step_mm * k * np.array([c, s])
        left = sweep(view.cells, place, stance.heading_rad, (-aside, amplitude_mm), 24)
        right = sweep(view.cells, place, stance.heading_rad, (aside, amplitude_mm), 24)
        slopes += (left[0] - right[0]) / (2 * aside) / stations
        means += (left[1] + right[1]) / 2 / stations
    return max(slopes, 0.2), means
