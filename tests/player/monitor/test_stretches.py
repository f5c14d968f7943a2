"""What the monitor tells of stretches of an axis, and how it finds its place in the table."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.motion import MOTION_RATE_HZ
from morfax.player.monitor import monitor
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.following_limit import (
    FollowingLimit,
    part_at,
)
from morfax.player.monitor.monitor import Monitor


def test_stretches_of_an_axis_tell_what_rows_of_all_axes_tell(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(5)
    demand = np.cumsum(random.normal(0, 5e-4, (700, 3)), axis=0)
    actual = demand + random.normal(0, 2e-3, demand.shape)
    actual[300:310, 1], actual[305:320, 2] = demand[300:310, 1] + 0.2, demand[305:320, 2] - 0.2
    limit = FollowingLimit.table(
        [(0, 0), (2, 0.01), (4, 0.03)], 0.02, settle_s=1e-3, hold_s=2e-3
    )
    told = []
    for by_rows in (False, True):
        if by_rows:
            monkeypatch.setattr(monitor, "_watch", monitor._watch.py_func)
            monkeypatch.setattr(monitor, "_calm", lambda *_: False)
        chart = Chart(0.0)
        watch = Monitor("xyz", MOTION_RATE_HZ, limit, stop=False, chart=chart)
        watch.watch(demand[:333], actual[:333])
        watch.watch(demand[333:], actual[333:])
        figures = watch.largest_error_mm.tolist(), watch.largest_share.tolist()
        told.append((figures, [str(one) for one in watch.warnings], chart.limit_mm.tolist()))
    assert told[0] == told[1]
    assert len(told[0][1]) == 2


def test_the_part_of_the_table_is_found_from_any_other() -> None:
    rows = FollowingLimit.table([(0, 0), (3, 0.02), (4, 0.1), (9, 0.2)], 0.01).rows
    for speed, part in ((0.0, 0), (2.9, 0), (3.0, 1), (3.9, 1), (8.9, 2), (9.0, 3), (50.0, 3)):
        for begun in range(4):
            assert part_at(speed, rows, begun) == part_at.py_func(speed, rows, begun) == part
    assert part_at(np.nan, rows, 3) == 0


def test_a_speed_counts_on_while_the_drive_catches_up_after_a_stop() -> None:
    """10 mm/s explain 1 mm; the drive, 0.4 mm behind, comes up in 10 ms, and the speed is held for 20."""
    t_s = np.arange(1200) / 1000
    demand = 10 * np.minimum(t_s, 0.2)
    stays = demand - np.minimum(4 * t_s, 0.4)
    catching_up = demand - (demand - stays) * np.exp(-np.maximum(t_s - 0.2, 0) / 0.01)
    points = [(0.0, 0.0), (10.0, 1.0)]
    for hold_s, actual, found_at_s in (
        (0.02, catching_up, None),
        (0.0, catching_up, 0.2),
        # the limit of 0.01 + exp(-t / 20 ms) is at 0.4 mm after 20 ms · ln(1 / 0.39)
        (0.02, stays, 0.2 + 0.02 * np.log(1 / 0.39)),
    ):
        limit = FollowingLimit.table(points, 0.01, hold_s=hold_s)
        watch = Monitor("x", 1000, limit)
        rows = watch.watch(demand[:, None], actual[:, None])
        if found_at_s is None:
            assert rows == len(demand)
        else:
            assert rows / 1000 == pytest.approx(found_at_s, abs=0.002)
