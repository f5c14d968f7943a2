"""The speed gauge: the largest speeds are numpy's, and the first that is too fast is told."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.faults import MotionFault
from morfax.recorder.tape import speed_gauge as organ
from morfax.recorder.tape.format import TapeFormat

FORMAT = TapeFormat()


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def gauge(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> organ.SpeedGauge:
    """A gauge whose kernel is compiled, and one in plain Python."""
    if request.param:
        monkeypatch.setattr(organ, "_speeds", organ._speeds.py_func)
    return organ.SpeedGauge(FORMAT)


def positions(count: int) -> np.ndarray:
    """A motion of three axes, at less than the largest speed."""
    step_mm = 0.1 * FORMAT.largest_speed_mm_s / FORMAT.motion_rate_hz
    return np.cumsum(np.random.default_rng(7).normal(0, step_mm, (count, 3)), axis=0)


def test_the_largest_speeds_are_those_of_all_blocks(gauge: organ.SpeedGauge) -> None:
    places = positions(300)
    gauge.feed(places[:100], places[0], 0)
    gauge.feed(places[100:], places[99], 100)
    speeds = np.abs(np.diff(places, axis=0)) * FORMAT.motion_rate_hz
    assert np.array_equal(gauge.largest_mm_s, speeds.max(axis=0))


def test_a_speed_at_the_limit_is_let_through_and_a_larger_one_is_told(
    gauge: organ.SpeedGauge,
) -> None:
    step_mm = FORMAT.largest_speed_mm_s / FORMAT.motion_rate_hz
    places = np.zeros((50, 3))
    places[20:, 1] = step_mm
    gauge.feed(places, places[0], 0)
    places[30:, 2] = -1.01 * step_mm
    with pytest.raises(MotionFault) as fault:
        gauge.feed(places, places[0], 1000)
    assert fault.value.axis == FORMAT.axes[2]
    assert fault.value.time_s == 1030 / FORMAT.motion_rate_hz
