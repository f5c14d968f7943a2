"""Own motion: ranges of axes and of their differences, over blocks; rows that are no number tell nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.recorder.tape import own_motion as organ


@pytest.fixture(params=[False, True], ids=["kernel", "plain"])
def own(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> organ.OwnMotion:
    """Ranges by a compiled kernel, and by plain Python."""
    if request.param:
        for name in ("_widen", "_widen_apart"):
            monkeypatch.setattr(organ, name, getattr(organ, name).py_func)
    return organ.OwnMotion(3)


def test_ranges_are_those_of_all_blocks(own: organ.OwnMotion) -> None:
    cycles = np.cumsum(np.random.default_rng(3).normal(size=(200, 3)), axis=0)
    for first in range(0, 200, 60):
        own.feed(cycles[first : first + 60])
    assert np.allclose(own.range_cycles, np.ptp(cycles, axis=0), rtol=1e-12)
    assert np.allclose(own.above_cycles, cycles.max(axis=0) - cycles[0], rtol=1e-12)
    assert np.allclose(own.below_cycles, cycles[0] - cycles.min(axis=0), rtol=1e-12)


def test_axes_that_run_alike_and_one_that_stands_are_told(own: organ.OwnMotion) -> None:
    way = np.linspace(0, 40, 100)
    own.feed(np.column_stack([way, way + 0.2 * np.sin(way), np.full(100, 7.0)]))
    still, alike = own.told(("x", "y", "z"))
    assert still == () and alike == ("x", "y")


def test_a_block_with_a_gap_in_an_axis_leaves_its_range(own: organ.OwnMotion) -> None:
    cycles = np.zeros((10, 3))
    cycles[:, 0] = np.arange(10)
    own.feed(cycles)
    cycles[5, 0] = math.nan
    cycles[:, 0] += 100
    own.feed(cycles)
    assert own.range_cycles[0] == 9
