"""Where a closed way comes beside itself, nearer than two lines can be drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly
from morfax.tracer.tangles import beside_itself
from tests.tracer.inked import arc, polyline

WIDTH_MM, STEP_MM = 0.5, 0.05


def found(way: Array) -> list[tuple[int, int]]:
    """The stretches of a way with places a tenth of a width apart."""
    return beside_itself.stretches(evenly(way, STEP_MM), STEP_MM, WIDTH_MM)


def slit(wide_mm: float) -> Array:
    """A plate of 20 x 20 mm with a slit 5 mm deep in the middle of its upper side."""
    left, right = 10 - 0.5 * wide_mm, 10 + 0.5 * wide_mm
    inner = (right, 20), (right, 15), (left, 15), (left, 20)
    return polyline((0, 0), (20, 0), (20, 20), *inner, (0, 20), (0, 0))


def test_a_slit_half_a_line_wide_from_its_mouth_to_its_mouth() -> None:
    """Within three steps: only places so far from each other along the way count as beside each other."""
    ((first, last),) = found(slit(0.25))
    mouth_mm = 20 + 20 + 10 - 0.125
    assert first * STEP_MM == pytest.approx(
        mouth_mm, abs=0.3
    )  # a corner comes beside the other
    assert last * STEP_MM == pytest.approx(mouth_mm + 10.25, abs=0.3)


def test_a_slit_over_the_beginning_of_the_way_is_one_stretch_over_its_end() -> None:
    way = evenly(slit(0.25), STEP_MM)
    begun = np.roll(way, -1100, axis=0)  # in the slit
    ((first, last),) = beside_itself.stretches(begun, STEP_MM, WIDTH_MM)
    assert first < len(way) <= last
    assert (last - first) * STEP_MM == pytest.approx(10.25, abs=0.6)


@pytest.mark.parametrize("wide_mm", [0.31, 0.5, 1.0])
def test_none_of_a_slit_whose_sides_are_six_tenths_of_a_line_apart(wide_mm: float) -> None:
    assert found(slit(wide_mm)) == []


def test_none_of_a_circle_or_of_a_spike_of_30_degrees() -> None:
    half = math.radians(15)
    spike = polyline((0, 0), (10, 0), (10, 10 / math.tan(half) / 2), (0, 0))
    assert found(arc((0, 0), 5)) == [] and found(spike) == []


def test_the_kernel_finds_the_same_partners_as_a_plain_search() -> None:
    way = evenly(slit(0.25), STEP_MM)[::4]
    near_mm, on = 0.3, 6
    cell = np.floor((way - way.min(axis=0)) / near_mm).astype(np.int64) + 1
    partner = np.full(len(way), -1)
    heads = np.full(tuple(cell.max(axis=0) + 2), -1)
    beside_itself._find_partners.py_func(way, cell, near_mm, on, heads, partner)
    between = np.abs(np.subtract.outer(np.arange(len(way)), np.arange(len(way))))
    between = np.minimum(between, len(way) - between)
    away = np.hypot(*(way[:, None] - way[None]).transpose(2, 0, 1))
    near = (away < near_mm) & (between > on)
    assert np.array_equal(partner >= 0, near.any(axis=1)) and near.any()
    assert all(near[k, partner[k]] for k in np.flatnonzero(partner >= 0))
