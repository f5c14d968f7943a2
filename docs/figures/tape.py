"""Draw the figure of `tape-format.md` with the recorder itself: what each pick-up puts on a track."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.recorder.tape.carrier import Carrier, PickUp
from morfax.recorder.tape.pickups import PICK_UPS, Sensor

BLUE, RED, GREY = "#1f5fa8", "#c1121f", "#888888"
# on a tape of 48 kHz: 113 harmonics, the wave as the pick-up gives it
SLOW_REFERENCE_HZ = 200.0
SPEEDS_MM_S = (-90.0, 0.0, 90.0)
DPI = 95


def track(
    sensor: Sensor, reference_hz: float, speed_mm_s: float, cycles_per_mm: float
) -> Array:
    """Some frames of the track of an axis at an even speed."""
    positions = speed_mm_s * np.arange(2000)[:, None] / MOTION_RATE_HZ
    pick_up = PickUp(reference_hz, cycles_per_mm, level=0.5, sensor=sensor)
    return Carrier(pick_up, positions[0]).frames(positions)[8:, 1].astype(float)


def draw_waves(file: Path) -> None:
    """Left the whole wave on a slow carrier, right the samples on a tape at three speeds."""
    figure, rows = plt.subplots(
        len(PICK_UPS),
        4,
        figsize=(11, 8),
        sharey=True,
        constrained_layout=True,
        width_ratios=(1.6, 1, 1, 1),
    )
    for (name, sensor), (whole, *at_speeds) in zip(PICK_UPS.items(), rows, strict=True):
        wave = track(sensor, SLOW_REFERENCE_HZ, 0.0, 1.0)[:480]
        whole.plot(np.arange(480) / 240, wave, color=BLUE)
        whole.set(ylabel=name, xlim=(0, 2), ylim=(-0.75, 0.75))
        for axes, speed_mm_s in zip(at_speeds, SPEEDS_MM_S, strict=True):
            samples = track(sensor, 6000.0, speed_mm_s, 20.0)[:49]
            axes.plot(np.arange(49) / 48, samples, ".-", color=RED, linewidth=0.6, markersize=4)
            axes.set(xlim=(0, 1))
    rows[0, 0].set_title("the wave: standstill, 200 Hz", fontsize=9)
    for axes, speed_mm_s in zip(rows[0, 1:], SPEEDS_MM_S, strict=True):
        axes.set_title(
            f"on the tape: {speed_mm_s:g} mm/s, {6 + 0.02 * speed_mm_s:g} kHz", fontsize=9
        )
    rows[-1, 0].set_xlabel("cycles")
    for axes in rows[-1, 1:]:
        axes.set_xlabel("ms")
    figure.savefig(file, dpi=DPI)
    plt.close(figure)


def main(folder: Path) -> None:
    """Draw it into a folder."""
    draw_waves(folder / "pickups.png")
