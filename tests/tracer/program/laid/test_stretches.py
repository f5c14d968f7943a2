"""Stretches of a line's way: as long as asked for, over a closed way's beginning, and not up to an end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from morfax.tracer.program.laid.line_parts import OF_LOOP, REACH
from morfax.tracer.program.laid.smooth_ways import smooth_ways
from morfax.tracer.program.laid.way_ink import LONGEST, WayInk
from tests.tracer.inked import WIDTH_MM, polyline
from tests.tracer.program.laid.ways import run_along

SQUARE = polyline((5, 5), (25, 5), (25, 25), (5, 25), (5, 5))
BAR = polyline((5, 5), (45, 5))


def along(way: np.ndarray, ending: str = "closed") -> WayInk:
    """The way of a line, without ink about it."""
    nothing: Any = None
    return WayInk(nothing, run_along(way, ending), nothing)


@pytest.mark.parametrize("long_mm", [1.0, 3.0, 12.0])
def test_a_stretch_is_as_long_as_asked_for_about_its_place(long_mm: float) -> None:
    ink = along(SQUARE)
    first, last = ink.stretch(400, long_mm)
    assert first + last == 2 * 400
    assert (last - first) * ink.step_mm == pytest.approx(long_mm, abs=2 * ink.step_mm)
    assert ink.stretch(400, 0.0) == (399, 401)  # it is never of one place


def test_stretches_go_over_a_closed_ways_beginning_and_never_to_an_open_ones_ends() -> None:
    ring, bar = along(SQUARE), along(BAR, "ended")
    over = ring.own(-20, 30)
    assert over is not None and len(over) == 51
    apart_mm = np.hypot(*np.diff(over, axis=0).T)
    assert apart_mm.max() < 2.5 * ring.step_mm
    assert np.hypot(*(over[20] - [5, 5])) < 2 * ring.step_mm
    assert bar.own(-1, 30) is None and bar.own(0, 30) is None
    assert bar.own(1, 30) is not None
    count = len(bar.way)
    assert bar.own(count - 30, count - 1) is None
    assert bar.own(count - 30, count - 2) is not None


def test_a_stretch_is_no_longer_than_a_share_of_its_way_nor_than_so_many_widths() -> None:
    ring = along(SQUARE)
    most = int(min(OF_LOOP * len(ring.way), LONGEST * WIDTH_MM / ring.step_mm))
    assert ring.own(10, 10 + most) is not None
    assert ring.own(10, 10 + most + 1) is None


@pytest.mark.parametrize("width_mm", [0.3, 0.5, 1.0])
def test_a_smooth_way_is_of_a_pen_as_broad_as_the_line(width_mm: float) -> None:
    x = np.arange(0.0, 20.0, 0.1 * width_mm)
    one, other = np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + width_mm])
    both = smooth_ways(one, other, 2.0, width_mm, lambda *_: 0.0, may_exchange=False)
    assert both.one.half_mm == both.other.half_mm == pytest.approx(0.5 * width_mm)


def test_only_places_near_to_what_was_laid_since_are_looked_at_again() -> None:
    """All of them, where nothing was laid yet."""
    ink, reach_mm = along(BAR, "ended"), REACH * WIDTH_MM
    assert ink.are_near(None).all()
    near = ink.are_near(np.array([[20.0, 5.0]]))
    away_mm = np.abs(ink.way[:, 0] - 20.0)
    assert near[away_mm < 0.99 * reach_mm].all() and near.any()
    assert not near[away_mm > 1.01 * reach_mm].any()
