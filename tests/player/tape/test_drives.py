"""The drives under their monitor: one kernel does what drives and monitor do by themselves."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.drive import SOUND, Condition
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.monitor import Monitor
from morfax.player.tape import drives as organ
from morfax.player.tape.drives import Drives, following_limit
from morfax.player.tape.phase_lock import PhaseLock
from tests.player.carriers import MOTION_RATE_HZ, circle

Q_MM = 0.05
AXES = ("x", "y", "z")
LIMIT = following_limit(PhaseLock(), Q_MM, MOTION_RATE_HZ)
ZERO_CYCLES, REST_MM = np.array([0.25, -3.0, 0.0]), np.array([40.0, 12.0, 2.0])


def phases(rows: int) -> np.ndarray:
    """A circle at 40 mm/s from the place at rest on, as a tape of another zero has it, cycles."""
    t_s = np.maximum(np.arange(rows) - 100, 0) / MOTION_RATE_HZ
    return circle(3.0, 40.0)(t_s) / Q_MM - ZERO_CYCLES


def run(condition: Condition, steps: int, together: bool) -> list[object]:
    """What drives, one of them broken, and monitor tell of a run in two blocks."""
    drives = Drives(3, Q_MM, MOTION_RATE_HZ, steps=steps)
    drives.conditions = [SOUND, condition, SOUND]
    chart = Chart(0.002)
    monitor, told = Monitor(AXES, MOTION_RATE_HZ, LIMIT, chart=chart), phases(3000)
    out: list[object] = []
    for block in (told[:1000], told[1000:]):
        if together:
            places_mm, rows = drives.follow_watched(block, (ZERO_CYCLES, REST_MM), monitor)
        else:
            cycles = block + ZERO_CYCLES
            places_mm = drives.follow(cycles) + REST_MM
            demand_mm = cycles[: len(places_mm)] * Q_MM + REST_MM
            rows = monitor.watch(demand_mm, places_mm)
        out += [places_mm.tobytes(), rows]
    out += [str(fault) for fault in monitor.warnings]
    out += [monitor.largest_error_mm.tolist(), monitor.largest_share.tolist()]
    return [*out, monitor.rows_seen, chart.error_mm.tobytes(), chart.limit_mm.tobytes()]


@pytest.mark.parametrize("steps", [1, 3])
@pytest.mark.parametrize(
    ("condition", "faults"),
    [(SOUND, 0), (Condition(stuck=True), 1), (Condition(gain_share=0.1), 1)],
)
def test_together_they_do_what_they_do_one_after_the_other(
    condition: Condition, faults: int, steps: int
) -> None:
    together = run(condition, steps, together=True)
    assert together == run(condition, steps, together=False)
    assert sum("does not follow" in str(each) for each in together) == faults


def test_the_compiled_kernel_is_the_plain_one(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = run(Condition(gain_share=0.1), 2, together=True)
    monkeypatch.setattr(organ, "_follow", organ._follow.py_func)
    assert run(Condition(gain_share=0.1), 2, together=True) == compiled
