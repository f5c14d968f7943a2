"""Lines that come within their own width of themselves: spikes, bays and coasts are followed whole, and marks
are not taken for spikes.

Bounds: 30 um for 95 % of the path, as the issue allows where lines come within a width of each other. Where
inks have run together nothing but the sum of both tells where each was: one width, 0.5 mm, for the whole.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.contour import distance, length_mm
from morfax.tracer.following.line import Line
from morfax.tracer.operator.operator import Operator
from morfax.tracer.program.trace import trace
from tests.tracer.inked import UM, WIDTH_MM, inked, polyline

SEEDS = pytest.mark.parametrize("seed", [None, 1, 2])
MOST_RUN_TOGETHER_MM = WIDTH_MM


def followed_whole(
    line: Array,
    *others: Array,
    seed: int | None = None,
    start_mm: tuple[float, float] | None = None,
) -> Line:
    """The line as followed, held to what was drawn: on it, and all of it, and no longer."""
    run = trace(inked(line, *others, seed=seed), start_mm).lines[0]
    apart = distance(run.xy_mm[::4], line)
    assert run.fault is None
    assert apart.path_to_reference.p95_mm < 30 * UM
    assert apart.path_to_reference.max_mm < MOST_RUN_TOGETHER_MM
    assert apart.reference_to_path.max_mm < MOST_RUN_TOGETHER_MM
    assert run.length_mm == pytest.approx(length_mm(line), rel=0.02)
    return run


def ragged(seed: int) -> Array:
    """A closed line of 70 vertices about 2 mm apart, each up to 2.5 mm in or out: capes, bays and spikes of a
    few degrees.
    """
    random = np.random.default_rng(seed)
    angle = np.sort((np.arange(70) + random.uniform(-0.3, 0.3, 70)) * math.tau / 70)
    radius = 22 + random.uniform(-2.5, 2.5, 70)
    places = np.column_stack([28 + radius * np.cos(angle), 28 + radius * np.sin(angle)])
    return polyline(*places, places[0])


@pytest.mark.parametrize("seed", range(4))
def test_a_ragged_coast_is_one_closed_path(seed: int) -> None:
    assert followed_whole(ragged(seed), seed=seed).ending == "closed"


SPIKES = {
    "beside a straight line": polyline((4, 10), (14, 10), (14.2, 7.8), (14.6, 10.1), (44, 10)),
    "of 22 degrees": polyline((4, 10), (14, 10), (13.2, 11.8), (14.7, 10.2), (44, 10)),
    "at a corner": polyline((4, 10), (14, 10), (11.5, 11.2), (14.4, 10.9), (14.4, 40)),
    "one after the other": polyline(
        (4, 10), (12, 10), (12.3, 7.6), (12.9, 10), (13.6, 12.4), (14.0, 10), (44, 10)
    ),
}


@SEEDS
@pytest.mark.parametrize("line", SPIKES.values(), ids=SPIKES)
def test_a_spike_is_followed_out_and_back(line: Array, seed: int | None) -> None:
    assert followed_whole(line, seed=seed).ending == "ended"


@SEEDS
@pytest.mark.parametrize("width_mm", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("slant_degrees", [0, 25])
def test_a_tick_is_no_spike(width_mm: float, slant_degrees: float, seed: int | None) -> None:
    """The line goes straight on; 30 um for what the tick's ink does to it."""
    line, slant = polyline((4, 10), (24, 10)), math.radians(90 - slant_degrees)
    half = 1.5 * np.array([math.cos(slant), math.sin(slant)])
    middle = np.array([14.0, 10.0])
    tick = polyline(middle - half, middle + half)
    run = trace(
        inked(line, tick, width_mm=width_mm, seed=seed), operator=Operator(marks="on")
    ).lines[0]
    assert distance(run.xy_mm[::4], line).path_to_reference.max_mm < 30 * UM
    assert [mark.kind for mark in run.marks] == ["tick"]


BAY = polyline(
    (10, 10),
    (30, 10),
    (30, 18),
    (23.2, 18.2),
    (25, 22),
    (20, 24),
    (17, 21),
    (22.7, 18.6),
    (14, 14),
    (10, 18),
    (10, 10),
)  # the mouth of the bay at (23, 18.4) is narrower than the line


@SEEDS
def test_a_bay_with_a_mouth_narrower_than_the_line_is_followed(seed: int | None) -> None:
    assert followed_whole(BAY, seed=seed).ending == "closed"


def test_a_line_with_a_tip_that_touches_it_is_left_alone() -> None:
    """Two lines touch at the tip of the one: each is followed by itself, straight on."""
    line, other = (
        polyline((4, 10), (34, 10)),
        polyline((19, 10.3), (25, 18), (13, 18), (19, 10.3)),
    )
    followed_whole(line, other, start_mm=(6, 10))
    assert followed_whole(other, line, start_mm=(19, 18)).ending == "closed"


def test_two_lines_that_cross_as_an_eight_are_each_followed_straight_on() -> None:
    first, second = (
        polyline((5, 5), (20, 5), (20, 20), (5, 20), (5, 5)),
        polyline((12, 12), (28, 12), (28, 28), (12, 28), (12, 12)),
    )
    assert followed_whole(first, second, start_mm=(5, 10)).ending == "closed"
    assert followed_whole(second, first, start_mm=(28, 20)).ending == "closed"
