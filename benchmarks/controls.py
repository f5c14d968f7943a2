"""The other controls: the step decoder, and the cubic interpolator against its closed form in numpy.

The step program is ten minutes of vectors of six steps with both axes running, decoded to positions at
eight samples to the interval. The cubic program is 2000 intervals of 64 points on three axes. Best of
five, kernels compiled before.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from morfax.player.cubics.interpolator import CubicInterpolator
from morfax.player.steps.motor import Motors
from morfax.player.steps.stepping import decode, pulses_of, tick_table
from morfax.recorder.steps.file import StepFormat, StepProgram

ROUNDS = 5
STEP_ROWS = 160 * 600  # ten minutes
INTERVALS, POINTS = 2000, 64


def best_s(task: Callable[[], object]) -> float:
    """Shortest time of a task, s; its kernels are compiled before."""
    task()
    times = []
    for _ in range(ROUNDS):
        begun = time.perf_counter()
        task()
        times.append(time.perf_counter() - begun)
    return min(times)


def step_program() -> StepProgram:
    """Speed up to six steps along X, then go round the ring."""
    rows = np.full(STEP_ROWS, 0b00010, np.uint8)
    rows[:6] = 0b10001
    return StepProgram(StepFormat(vectors=1), rows)


def steps_per_second(program: StepProgram) -> float:
    """Rows to positions of the motors, steps/s of all axes together."""
    ticks = tick_table()

    def run() -> int:
        pulses = pulses_of(decode(program)[0], program.format.rates)
        motors = Motors(3, program.format.interval_s)
        motors.run(pulses, ticks, 8)
        return int(np.abs(pulses).sum())

    return run() / best_s(run)


def points_per_second(axes: int) -> float:
    """Words to registers, points/s of each axis."""
    words = np.random.default_rng(1).integers(-(10**6), 10**6, (INTERVALS, axes, 3))
    return (
        INTERVALS
        * POINTS
        / best_s(lambda: CubicInterpolator(np.zeros(axes), POINTS).run(words))
    )


def points_per_second_in_numpy(axes: int) -> float:
    """The same by the closed form in numpy, as one would first write it, points/s of each axis."""
    words = np.random.default_rng(1).integers(-(10**6), 10**6, (INTERVALS, axes, 3))
    n = np.arange(1, POINTS + 1)
    powers = np.stack([n, n * (n - 1) // 2, n * (n - 1) * (n - 2) // 6])

    def run() -> np.ndarray:
        within = words @ powers
        starts = np.cumsum(within[..., -1], axis=0)
        within[1:] += starts[:-1, :, None]
        return np.ascontiguousarray(within.transpose(0, 2, 1)).reshape(-1, axes)

    return INTERVALS * POINTS / best_s(run)


def main() -> None:
    """Print the figures as a table."""
    print("controls")
    print(
        f"  step decoder, pulses and motors   {steps_per_second(step_program()) / 1e6:8.1f} million steps/s"
    )
    ours, numpys = points_per_second(3), points_per_second_in_numpy(3)
    print(
        f"  cubic interpolator, three axes    {ours / 1e6:8.1f} million points/s/axis"
        f"{ours / numpys:8.2f} x numpy"
    )


if __name__ == "__main__":
    main()
