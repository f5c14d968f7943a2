"""The known edges near a place, and what is worked out of all edges of a sheet at once."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.polyline import with_places
from morfax.tracer.drawing.known_edges import KnownEdges
from morfax.tracer.drawing.shapes import pen_along
from morfax.tracer.drawing.sharpening import Edge, most_turned
from morfax.tracer.drawing.spacing import Pairs, _legs_of_corners


def rings(count: int, seed: int = 1) -> list[Array]:
    """Closed rings of several sizes anywhere on a sheet of 60 x 60, pixels or mm."""
    rng, round_rad = np.random.default_rng(seed), np.linspace(0.0, 2 * np.pi, 40)
    ring = np.column_stack([np.cos(round_rad), np.sin(round_rad)])
    ring[-1] = ring[0]
    return [rng.uniform(12, 48, 2) + rng.uniform(1, 9) * ring for _ in range(count)]


def test_the_nearest_edge_is_the_one_with_the_nearest_place() -> None:
    edges = rings(30)
    known = KnownEdges(edges)
    for place in np.random.default_rng(2).uniform(0, 60, (100, 2)):
        away = [np.hypot(*(edge - place).T).min() for edge in edges]
        assert known.nearest(place) is edges[int(np.argmin(away))]


def test_all_edges_that_come_near_are_among_those_near() -> None:
    edges = rings(30)
    known = KnownEdges(edges)
    places = np.array([[20.0, 20.0], [24.0, 22.0]])
    near = known.near(places, 1.5)
    assert [edge for edge in edges if any(edge is other for other in near)] == near
    assert 0 < len(near) < len(edges)
    for edge in edges:
        if np.hypot(*(edge[:, None] - places).transpose(2, 0, 1)).min() <= 1.5:
            assert any(edge is other for other in near)
    assert KnownEdges(()).near(places, 1.5) == []


@pytest.mark.parametrize("width_px", [2.0, 4.7, 18.9])
def test_a_pen_along_edges_is_as_dark_as_the_nearest_place_tells(width_px: float) -> None:
    edges = rings(3)
    places = np.vstack([with_places(edge, 0.1) for edge in edges])
    rows, columns = np.mgrid[:60, :60]
    away = np.hypot(rows[..., None] - places[:, 0], columns[..., None] - places[:, 1]).min(
        axis=2
    )
    expected = np.clip(0.5 * width_px - away + 0.5, 0, 1)
    assert np.abs(pen_along(edges, (60, 60), width_px) - expected).max() < 1e-6  # of float32


def test_places_that_turn_most_lie_further_apart_than_asked() -> None:
    turned = np.random.default_rng(3).uniform(0, 1, 400)
    found = list[int]()
    for k in np.argsort(-turned):
        away = np.abs(k - np.array(found))
        if turned[k] >= 0.6 and np.all(np.minimum(away, 400 - away) > 7):
            found.append(int(k))
    assert most_turned(turned, 0.6, 7) == found
    assert len(most_turned(turned, 0.6, 400)) == 1


def test_a_pair_is_on_legs_of_a_corner_of_its_own_edge_only() -> None:
    square = 10.0 * np.array([[0.0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
    edges = [Edge(square + 30.0 * k, np.array([0, 1, 2, 3])) for k in range(3)]
    # about a corner, about one of another edge, from a side to the opposite one, from edge to edge
    places = np.array(
        [
            [[60.0, 68], [60, 69]],
            [[39, 30], [40, 31]],
            [[60, 61], [69, 61]],
            [[60, 68], [39, 30]],
        ]
    )
    owner = np.array([[2, 2], [1, 1], [2, 2], [2, 1]])
    along = np.array([[32.0, 31.0], [9.0, 11.0], [39.0, 11.0], [32.0, 9.0]])
    legs = _legs_of_corners(edges, Pairs(places, owner, along, np.full(4, 2.0)))
    assert legs.tolist() == [True, True, False, False]
