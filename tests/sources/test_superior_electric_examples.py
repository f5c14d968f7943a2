"""Patent ES 443122 (Superior Electric, 1975): its worked examples."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from morfax.motion.motion import join
from morfax.player.steps.ring_memory import ring_memory
from morfax.player.steps.stepping import (
    play_steps,
    pulse_ticks,
)
from morfax.recorder.steps.file import (
    TICKS,
    StepFormat,
    write_program,
)
from morfax.recorder.steps.rings import RINGS
from morfax.recorder.steps.steps import encode
from tests.sources.step_orders import (
    SAME,
    X_UP,
    Y_DOWN,
    counts,
    program,
    pulses_in,
)

Vectors = Callable[[str], Any]


def test_figures_7_and_8_give_the_printed_counts_in_all_15_intervals(vectors: Vectors) -> None:
    orders = vectors("se_fig8")["orders"]
    rows = [int(order["tape5"], 2) for order in orders]
    assert len(orders) == 15
    assert [order["mode"] for order in orders] == [
        "axis" if row & 0b10000 else "vec" for row in rows
    ]
    assert counts(rows) == [[order["count_x"], order["count_y"]] for order in orders]
    assert pulses_in(rows) == [[order["steps_x"], order["steps_y"]] for order in orders]
    assert np.cumsum(pulses_in(rows), axis=0).tolist() == [
        [order["sum_x"], order["sum_y"]] for order in orders
    ]


def test_figure_8_ends_at_53_and_minus_9_after_93_75_ms(
    vectors: Vectors, tmp_path: Path
) -> None:
    rows = [int(order["tape5"], 2) for order in vectors("se_fig8")["orders"]]
    write_program(program(rows, end_mm=(0.53, -0.09, 0)), tmp_path / "fig8.steps")
    motion = join(play_steps(tmp_path / "fig8.steps"))
    assert motion.times_s[-1] == pytest.approx(0.09375)
    assert motion.positions_mm[-1] == pytest.approx([0.53, -0.09, 0])


def test_the_recorder_punches_figure_8_as_it_is_printed(vectors: Vectors) -> None:
    orders = vectors("se_fig8")["orders"]
    lengths = np.array([[order["steps_x"], order["steps_y"], 0] for order in orders])
    rows = encode(lengths, np.zeros(15, bool), StepFormat(vectors=1, channels=5))
    assert [f"{row:05b}" for row in rows] == [order["tape5"] for order in orders]


def test_the_example_of_the_memory(vectors: Vectors) -> None:
    example = vectors("se_fig8")["rom_example"]
    x, y = example["counts"]
    memory = ring_memory()
    for direction, name in ((1, "next"), (0, "previous")):
        out = int(memory[x << 5 | y << 1 | direction])
        moved = [x + (out & 1) - (out >> 1 & 1), y + (out >> 2 & 1) - (out >> 3 & 1)]
        assert moved == example[name]


def test_the_rings_are_those_of_figures_5_and_10(vectors: Vectors) -> None:
    """The vectors run towards +Y; figure 8, and so the rings here, towards -Y."""
    told = vectors("se_series")
    for speed, ring in told["series"].items():
        ours = [[x, -y] for x, y in RINGS[int(speed)]]
        assert ours == ring["vectors"]
        along = np.cumsum(ours, axis=0)
        assert np.ptp(along[:, 0]) / 2 == ring["radius_half_extent"]
        lengths = np.hypot(*np.array(ours).T)
        assert lengths.sum() / (2 * np.pi) == pytest.approx(ring["radius_perimeter"], abs=0.005)
        assert ours[: len(ring["octant"])] == ring["octant"] and len(ours) == ring["n"]
        assert [lengths.min(), lengths.max()] == pytest.approx(
            [ring["len_min"], ring["len_max"]], abs=1e-4
        )
    assert sum(map(len, RINGS.values())) == told["total_vectors"]


def test_the_clock_and_the_printed_pulses(vectors: Vectors) -> None:
    told = vectors("se_clock")
    for case in told["cases"]:
        fmt = StepFormat(oscillator_hz=case["oscillator_hz"])
        assert (
            fmt.interval_s == pytest.approx(case["interval_s"]) and fmt.rate_hz == case["K_hz"]
        )
        assert fmt.acceleration_steps_s2 == case["accel_steps_s2"]
        assert case["divide"] == TICKS
        if "speed_6_steps_in_per_s" in case:  # of 0.001 in
            assert 6 * fmt.rate_hz * 0.001 == pytest.approx(case["speed_6_steps_in_per_s"])
    for rate, ticks in told["pulse_counts_printed"].items():
        assert list(pulse_ticks(int(rate[0]))) == ticks
    ticks = pulse_ticks(3)
    assert sorted(np.diff([*ticks, ticks[0] + 64]).tolist()) == told["gaps_3K"]


def test_the_guards_of_figure_4(vectors: Vectors) -> None:
    assert len(vectors("se_clock")["guards"]) == 3
    assert counts([X_UP] * 20)[-1] == [15, 8]  # UP barred at 15
    assert counts([Y_DOWN] * 20)[-1] == [8, 1]  # DOWN barred at 1
    assert counts([0b10011, 0b11100, SAME]) == [[8, 8]] * 3  # 00 and 11 change nothing
