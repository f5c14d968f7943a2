"""Settings of the head: two named sets, and changes by name within bounds.

Signals: names and values in; settings out, in which None follows from the line (see `tuning`).

Source: patent ES 361967 gives no figures. The precise set is chosen by trial; the historic set is our own,
within what the patent says.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

from morfax.motion.drive import Drive
from morfax.motion.usual import ACCELERATION_MM_S2, FASTEST_MM_S, FEED_MM_S, SLOWEST_MM_S

OF_DRIVE = "drive_"  # the names of the drives' settings begin so


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

    speed_mm_s: float = _within(FEED_MM_S, SLOWEST_MM_S, FASTEST_MM_S, "tracing speed (WC)")
    slowed: float = _within(
        0.3, 0.01, 1, "share of the speed while the look-ahead relay holds (SR)"
    )
    slow_s: float = _within(0.1, 0, 10, "how long the relay holds (DL)")
    acceleration_mm_s2: float = _within(ACCELERATION_MM_S2, 1, 100_000, "of the tracing speed")
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
