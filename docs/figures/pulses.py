"""Draw the figures of `pratt-whitney.md` and `alfred-herbert.md` with the controls themselves."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.drive import Condition
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import Ramp, positions_mm
from morfax.player.gcode.feed_control import feed_number
from morfax.player.gcode.residues import Feed, ResidueInterpolator
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Monitor
from morfax.player.monitor.position_servo import PositionServos

BLUE, RED, GREEN, GREY = "#1f5fa8", "#c1121f", "#2a7f3f", "#888888"
RECIRCULATIONS_HZ = 8 * MOTION_RATE_HZ
DPI = 95


def held(direction: Array, true_norm: bool) -> float:
    """Speed along a line over the programmed one, off the approach to its end."""
    feed = Feed(feed_number(10_000, RECIRCULATIONS_HZ), true_norm=true_norm)
    pulses = ResidueInterpolator().line(np.rint(direction * 15_000).astype(np.int64), feed)
    half = len(pulses) // 2
    return float(np.linalg.norm(pulses[:half].sum(axis=0)) / half * RECIRCULATIONS_HZ / 10_000)


def draw_speed(file: Path) -> None:
    """True speed over the programmed one by the direction, by the patent's weights and by a true norm."""
    figure, axes = plt.subplots(figsize=(8, 3.6), constrained_layout=True)
    angles = np.arange(91)
    flat = np.column_stack([np.cos(np.radians(angles)), np.sin(np.radians(angles)), 0 * angles])
    up = flat * np.cos(np.radians(25)) + [0, 0, np.sin(np.radians(25))]
    for directions, name, line in (
        (flat, "in the plane X Y", "-"),
        (up, "25° out of it", "--"),
    ):
        for true_norm, norm, colour in ((False, "weights", BLUE), (True, "--norm true", GREEN)):
            speeds = [100 * held(direction, true_norm) for direction in directions]
            axes.plot(angles, speeds, line, color=colour, label=f"{norm}, {name}")
    axes.axhspan(
        89.4, 101.9, color=GREY, alpha=0.15, label="what the weights allow, -10.6 … +1.9 %"
    )
    axes.set(
        xlabel="direction from X to Y, degrees",
        ylabel="speed, % of the programmed one",
        xlim=(0, 90),
    )
    figure.legend(fontsize=8, ncols=3, loc="outside upper center")  # the curves fill the axes
    figure.savefig(file, dpi=DPI)
    plt.close(figure)


def draw_following(file: Path) -> None:
    """Following error against its limit: a move at low speed, then a fast one; the drive loses gain on the
    way.
    """
    slow = positions_mm([0.0], [3.0], 1.0, Ramp(acceleration_mm_s2=20))
    fast = positions_mm([3.0], [43.0], 20.0, Ramp(acceleration_mm_s2=100))
    demand = np.vstack([slow, np.full((3000, 1), 3.0), fast, np.full((3000, 1), 43.0)])
    sound, broken = PositionServos(demand[0]), PositionServos(demand[0])
    good = sound.follow(demand)
    half = len(slow) // 2
    bad = broken.follow(demand[:half])
    broken.conditions = [Condition(gain_share=0.3)]
    bad = np.vstack([bad, broken.follow(demand[half:])])
    chart = Chart(every_s=0)
    watch = Monitor(
        "x", MOTION_RATE_HZ, FollowingLimit.linear(settle_s=0.06), stop=False, chart=chart
    )
    watch.watch(demand, bad)
    t_s = np.arange(len(demand)) / MOTION_RATE_HZ
    figure, axes = plt.subplots(figsize=(8, 3.6), constrained_layout=True)
    axes.plot(t_s, chart.limit_mm[:, 0], color=RED, label="limit: lag · speed + 0.1 mm")
    axes.axhline(1.3, color=GREY, linestyle=":", label="one limit for 20 mm/s")
    axes.plot(t_s, np.abs(demand - good)[:, 0], color=GREEN, label="error, sound drive")
    axes.plot(t_s, np.abs(demand - bad)[:, 0], color=BLUE, label="error, gain lost at 1.5 s")
    found_s = watch.warnings[0].time_s
    axes.annotate(
        f"fault at {found_s:.2f} s",
        (found_s, watch.warnings[0].limit_mm),
        (found_s, 2.0),
        arrowprops={"arrowstyle": "->"},
    )
    axes.set(xlabel="s", ylabel="mm", ylim=(0, 4.6))
    axes.legend(fontsize=8, loc="upper left")
    figure.savefig(file, dpi=DPI)
    plt.close(figure)


def main(folder: Path) -> None:
    """Draw both into a folder."""
    draw_speed(folder / "pulse-speed.png")
    draw_following(folder / "following-error.png")
