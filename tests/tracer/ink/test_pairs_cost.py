"""What it costs to pair the legs of a junction: the cheapest pairs are those that are taken."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from morfax.tracer.ink.chains import Chain, Link
from morfax.tracer.ink.closed_ways import only_cross
from morfax.tracer.ink.partners import NOT_JOINED, pairs_cost, partners, without_partner

Pairs = list[tuple[int, int]]


def turnings(legs: int, seed: int) -> np.ndarray:
    """What each two of some legs turn by, rad."""
    half = np.triu(np.random.default_rng(seed).uniform(0.1, 2.0, (legs, legs)), 1)
    return np.asarray(half + half.T)


def every(legs: list[int]) -> Iterator[Pairs]:
    """All ways to pair some legs as far as they go; of an odd number any one is left."""
    if len(legs) < 2:
        yield []
        return
    first, *rest = legs
    for k, other in enumerate(rest):
        yield from ([(first, other), *more] for more in every(rest[:k] + rest[k + 1 :]))
    if len(legs) % 2:
        yield from every(rest)


@pytest.mark.parametrize("legs", [2, 3, 4, 5])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_no_pairs_of_legs_cost_less_than_those_that_are_taken(legs: int, seed: int) -> None:
    costs = turnings(legs, seed)
    taken = partners(costs)
    least = min(pairs_cost(pairs, costs) for pairs in every(list(range(legs))))
    assert pairs_cost(taken, costs) == pytest.approx(least)
    assert len(without_partner(taken, legs)) == legs % 2


def test_a_leg_without_a_partner_costs_half_of_two_that_are_not_joined() -> None:
    """Besides it a pair costs the square of what it turns by, and no more than not to be joined."""
    costs = turnings(5, 1)
    assert pairs_cost([], costs) == pytest.approx(2.5 * NOT_JOINED)
    one = costs[0, 3] ** 2
    assert pairs_cost([(0, 3)], costs) == pytest.approx(one + 1.5 * NOT_JOINED)
    assert pairs_cost([(0, 3)], 9 + costs) == pytest.approx(2.5 * NOT_JOINED)


@pytest.mark.parametrize("shared", [(2,), (1, 2)])
def test_closed_ways_that_share_a_line_do_more_than_cross(shared: tuple[int, ...]) -> None:
    """It is seen from their lines alone; nobody looks at the junctions."""
    ways: Any = [
        SimpleNamespace(chain=Chain([Link(line, back=False) for line in lines], closed=True))
        for lines in ((0, 1, 2), (*shared, 3, 4))
    ]
    nobody: Any = None
    assert not only_cross(ways, nobody)
