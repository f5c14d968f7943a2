"""Pulse control and monitored servos: recirculations, periods and lines of program in a second.

The interpolator runs a line on three axes and a quarter turn, with feed control; the pulse servo follows
three axes of it. The monitored servo is the position servo with its monitor over ten seconds of demand on
three axes. The program is 100 000 lines, three fifths of them arcs and lines with all their words, read
beside merely finding its numbers. Best of three in turn, kernels compiled before; time of this process only,
as other work may share the machine.
"""

from __future__ import annotations

import re
import time

import numpy as np

from benchmarks.rows import Row, best_s, tell
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.motion.ramp import positions_mm
from morfax.player.gcode.feed_control import feed_number
from morfax.player.gcode.pulse_servo import PulseServos
from morfax.player.gcode.residues import COUNTER_CLOCKWISE, Feed, ResidueInterpolator
from morfax.player.gcode.rs274 import parse_rs274
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Monitor
from morfax.player.monitor.position_servo import PositionServos

RECIRCULATIONS_HZ = 8 * MOTION_RATE_HZ
PROGRAM_LINES = 100_000
AXES = 3


def line() -> np.ndarray:
    """Pulses of a line of 37 mm on three axes at 10 mm/s."""
    return ResidueInterpolator().line(
        (30_000, 20_000, 10_000), Feed(feed_number(10_000, RECIRCULATIONS_HZ))
    )


def quarter() -> np.ndarray:
    """Pulses of a quarter turn of 20 mm at 10 mm/s."""
    feed = Feed(feed_number(10_000, RECIRCULATIONS_HZ))
    return ResidueInterpolator((20_000, 0, 0)).arc(
        (0, 20_000, 0), (0, 0), COUNTER_CLOCKWISE, feed
    )


def watched_servo(demand: np.ndarray) -> int:
    """The servo over all of a demand, and its monitor; rows that were sound."""
    actual = PositionServos(demand[0]).follow(demand)
    return Monitor("xyz", MOTION_RATE_HZ, FollowingLimit.linear(settle_s=0.06)).watch(
        demand, actual
    )


def program() -> list[str]:
    """Lines of a program as a CAM system writes them."""
    lines = ["G17 G21 G90 G94", "G0 X0 Y0 Z2", "G1 Z-1 F300"]
    for i in range(PROGRAM_LINES // 5):
        x, y = i % 977 / 10, i % 1013 / 10
        lines += [
            f"G1 X{x:.4f} Y{y:.4f} F600",
            f"X{x + 1:.4f} Y{y:.4f}",
            f"N{i} G3 X{x + 2:.4f} Y{y:.4f} I0.5 J0",
            f"G2 X{x + 2:.4f} Y{y + 2:.4f} R1.25",
            f"G1 X{x + 1:.4f}",
        ]
    return [*lines, "M2"]


def numbers_only(lines: list[str]) -> int:
    """Find the words of all lines and make numbers of them; no program is read in less."""
    word = re.compile(r"([A-Z])([-+.\d]+)")
    return sum(len([float(text) for _, text in word.findall(text)]) for text in lines)


def rows() -> list[Row]:
    """All figures of this benchmark."""
    demand = np.tile(positions_mm([0.0], [100.0], 10.0), (1, AXES))
    pulses, turn, lines = line(), quarter(), program()
    took = best_s(
        {
            "line": line,
            "quarter": quarter,
            "servo": lambda: PulseServos(np.zeros(AXES, np.int64), RECIRCULATIONS_HZ).follow(
                pulses
            ),
            "watched": lambda: watched_servo(demand),
            "read": lambda: parse_rs274(lines),
            "numbers": lambda: numbers_only(lines),
        },
        time.process_time,
    )
    return [
        Row("lines, three axes", len(pulses) / took["line"] / 1e6, "million recirculations/s"),
        Row("arcs", len(turn) / took["quarter"] / 1e6, "million recirculations/s"),
        Row(
            "pulse servo, lag and unit circuit",
            AXES * len(pulses) / took["servo"] / 1e6,
            "million periods/s/axis",
        ),
        Row(
            "monitored servo",
            AXES * len(demand) / took["watched"] / 1e6,
            "million periods/s/axis",
        ),
        Row(
            "G-code",
            len(lines) / took["read"] / 1e3,
            "thousand lines/s",
            took["read"] / took["numbers"],
            "its numbers",
        ),
    ]


def main() -> None:
    """Print the figures as a table."""
    tell("pulse control: three axes, 48 kHz recirculations, feed control", rows())


if __name__ == "__main__":
    main()
