"""The distance of places from a way, as the pen takes it."""

import math

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import UM
from morfax.tracer.tangles import distances, pen
from morfax.tracer.tangles.within_reach import are_within


def spiral(places: int) -> Array:
    """A way that comes by its own side again and again, (n, 2) mm."""
    turned = np.linspace(0.5, 12 * math.pi, places)
    return 20 + 0.4 * np.column_stack([turned * np.cos(turned), turned * np.sin(turned)])


@pytest.mark.parametrize(
    "pieces",
    [distances.LONG - 1, distances.LONG, 5 * distances.BOXED + 1, 40 * distances.BOXED],
)
def test_a_way_is_as_far_off_as_its_nearest_piece_however_long_it_is(pieces: int) -> None:
    """Of a long way only the pieces about a place are looked at: none that is nearer is passed over."""
    way, rng = spiral(pieces + 1), np.random.default_rng(pieces)
    places = rng.uniform(0, 40, (300, 2))
    steps = np.diff(way, axis=0)
    along = np.einsum("pkx,kx->pk", places[:, None] - way[None, :-1], steps)
    share = np.clip(along / np.sum(steps**2, axis=1), 0, 1)
    nearest = way[None, :-1] + share[..., None] * steps
    true_mm = np.hypot(*(places[:, None] - nearest).transpose(2, 0, 1)).min(axis=1)
    assert np.abs(distances.away_from(places, way) - true_mm).max() < 0.001 * UM


def test_a_bend_is_drawn_place_by_place() -> None:
    pose, shares = np.array([1.0, 2.0, 0.3]), np.linspace(0, 1, 40)
    places = np.empty((40, 2))
    pen.bend_at(pose, 4.0, 2.5, shares, places)
    assert places.tolist() == [list(pen.bend.py_func(pose, 4.0, 2.5, t)) for t in shares]
    assert places[[0, -1]].tolist() == [[1.0, 2.0], [4.0, 2.5]]


@pytest.mark.parametrize("reach_mm", [0.01, 0.3, 2.0, 100.0])
def test_places_within_a_reach_are_those_whose_distance_is_less(reach_mm: float) -> None:
    way = spiral(4 * distances.BOXED)
    places = np.random.default_rng(4).uniform(-20, 60, (4000, 2))
    expected = distances.away_from(places, way) < reach_mm
    assert np.array_equal(are_within(places, way, reach_mm), expected)
    # one that is just as far off is not within
    assert not are_within(places[:1], way, float(distances.away_from(places[:1], way)[0])).any()
