"""Tapes made from closed forms, without the recorder: every track is known exactly at any moment."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array

UM = 1e-3  # mm
RATE_HZ = 48000
REFERENCE_HZ = 6000.0
CYCLES_PER_MM = 20.0
MOTION_RATE_HZ = 6000.0


Course = Callable[[Array], Array]  # times in s -> positions (n, 3) in mm


@dataclass(frozen=True)
class Transport:
    """How a tape runs: level, start phases, speed, flutter (share, Hz), noise in dB below the carrier."""

    level: float = 0.5
    start_cycles: float = 0.0
    track_cycles: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    speed: float = 1.0
    flutter: float = 0.0
    flutter_hz: float = 8.0
    noise_db: float | None = None

    def programme_s(self, tape_s: Array) -> Array:
        """What moment of the recorded programme passes the head at a moment of play."""
        w = 2 * np.pi * self.flutter_hz
        return self.speed * (tape_s + self.flutter * (1 - np.cos(w * tape_s)) / w)


def tracks(
    course: Course, seconds: float, transport: Transport | None = None
) -> NDArray[np.float32]:
    """Frames (n, 4) of a course: reference, X, Y, Z."""
    how = transport or Transport()
    t_s = how.programme_s(np.arange(round(seconds * RATE_HZ)) / RATE_HZ)
    cycles = np.column_stack([np.zeros_like(t_s), course(t_s) * CYCLES_PER_MM])
    cycles += REFERENCE_HZ * t_s[:, None] + how.start_cycles + np.array(how.track_cycles)
    frames = how.level * np.sin(2 * np.pi * cycles)
    if how.noise_db is not None:
        sigma = how.level / np.sqrt(2) * 10 ** (-how.noise_db / 20)
        frames += np.random.default_rng(1969).normal(0, sigma, frames.shape)
    return frames.astype(np.float32)


def swing(t_s: Array) -> Array:
    """Stand for 0.2 s, then round a circle of 5 mm that is gone into smoothly, Z down by 1 mm; 50 mm/s, 0.5
    m/s².
    """
    t = np.clip(t_s - 0.2, 0, None)
    grown = 1 - np.exp(-((t / 0.3) ** 3))
    return np.column_stack([5 * grown * np.sin(8 * t), 5 * grown * np.cos(8 * t), -grown])


def along(
    t_s: Array,
    length_mm: float,
    speed_mm_s: float,
    acceleration_mm_s2: float,
    start_s: float = 0.0,
) -> Array:
    """Way in mm along a path started and stopped with a constant acceleration: 0 before, the whole length
    after.
    """
    rise_s = speed_mm_s / acceleration_mm_s2
    t = np.clip(t_s - start_s, 0, length_mm / speed_mm_s + rise_s)
    left = length_mm / speed_mm_s + rise_s - t
    way = speed_mm_s * (t - rise_s / 2)
    way = np.where(t < rise_s, acceleration_mm_s2 * t**2 / 2, way)
    return np.where(left < rise_s, length_mm - acceleration_mm_s2 * left**2 / 2, way)


def circle(
    radius_mm: float, speed_mm_s: float, acceleration_mm_s2: float = 500.0, start_s: float = 0.3
) -> Course:
    """Once round a circle from rest to rest."""

    def course(t_s: Array) -> Array:
        angle = (
            along(t_s, 2 * np.pi * radius_mm, speed_mm_s, acceleration_mm_s2, start_s)
            / radius_mm
        )
        return np.column_stack(
            [radius_mm * np.sin(angle), radius_mm * (1 - np.cos(angle)), 0 * angle]
        )

    return course


def square(
    side_mm: float, speed_mm_s: float, acceleration_mm_s2: float = 500.0, start_s: float = 0.3
) -> Course:
    """Once round a square, stopping at each corner."""
    leg_s = side_mm / speed_mm_s + speed_mm_s / acceleration_mm_s2

    def course(t_s: Array) -> Array:
        there_x, up, back, down = (
            along(t_s, side_mm, speed_mm_s, acceleration_mm_s2, start_s + i * leg_s)
            for i in range(4)
        )
        return np.column_stack([there_x - back, up - down, 0 * up])

    return course
