"""Settling: the vertices of a way move to where the pen leaves the ink that is there."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.tangles import distances, pen, settling
from morfax.tracer.tangles.pen import Drawn, Ink
from morfax.tracer.tangles.sketch import softness_of
from tests.tracer.inked import WIDTH_MM, inked, polyline

HALF_MM, SOFT_MM = 0.25, 0.06
PLACES_MM = np.stack(np.meshgrid(np.arange(0, 4, 0.11), np.arange(0, 3, 0.11)), -1).reshape(
    -1, 2
)
POSES = np.array([[0.2, 1.0, 0.3], [3.8, 1.2, 3.0], [1.0, 2.9, -1.4], [2.9, 0.1, 1.7]])
# vertices of the first strand, then of the second, then two of a stroke
VERTICES_MM = np.array(
    [
        [1.0, 1.4],
        [1.8, 1.3],
        [2.7, 1.6],
        [2.0, 2.2],
        [0.6, 0.4],
        [1.5, 0.7],
        [3.0, 2.4],
        [3.5, 2.6],
    ]
)
KNOWN_MM = np.hypot(*(PLACES_MM - [0.0, 1.0]).T)


def drawn(*counts: int) -> Drawn:
    """Two strands with so many vertices, and strokes of the vertices that are left."""
    strokes = (len(VERTICES_MM) - sum(counts)) // 2
    return Drawn(POSES.reshape(2, 2, 3), np.array(counts, np.int64), strokes)


def darkness(way: Drawn, vertices: Array) -> Array:
    """What the pen leaves at each place, place by place."""
    lines = np.empty((4, pen.most_pieces(way, vertices)))
    distance, out = KNOWN_MM.copy(), np.empty(len(KNOWN_MM))
    distances.away(PLACES_MM, lines, pen.pieces(way, vertices, lines), distance)
    pen.ink(distance, HALF_MM, SOFT_MM, out)
    return out


@pytest.mark.parametrize("counts", [(0, 2), (1, 1), (3, 1), (2, 0), (4, 2)])
def test_what_each_vertex_changes_is_found_from_the_pieces_that_it_moves(
    counts: tuple[int, int],
) -> None:
    """Held against all pieces drawn anew; distances differ by rounding, 1e-15 mm, over a nudge of 10 um."""
    way, paper = drawn(*counts), np.zeros(len(PLACES_MM))
    ink = Ink(PLACES_MM, paper, KNOWN_MM, HALF_MM, SOFT_MM)
    lines = np.empty((4, pen.most_pieces(way, VERTICES_MM)))
    now, places = np.empty((2, len(paper))), PLACES_MM.T.copy()
    settling._wrong(ink, places, way, VERTICES_MM, lines, now)
    changes = settling._changes(ink, places, way, VERTICES_MM.copy(), now)
    before = darkness(way, VERTICES_MM)
    for i, change in enumerate(changes):
        moved = VERTICES_MM.copy()
        moved[i // 2, i % 2] += settling.NUDGE_MM
        whole = (darkness(way, moved) - before) / settling.NUDGE_MM
        assert np.abs(whole).max() > 0.1
        np.testing.assert_allclose(change, whole, atol=1e-10)


def test_vertices_go_back_to_where_the_ink_was_drawn() -> None:
    way = drawn(3, 1)
    ink = Ink(PLACES_MM, darkness(way, VERTICES_MM), KNOWN_MM, HALF_MM, SOFT_MM)
    moved = VERTICES_MM + np.random.default_rng(1).normal(0, 0.03, VERTICES_MM.shape)
    left = settling.settle(ink, way, moved, 30)
    assert left < 0.01  # of ink without noise
    assert np.abs(moved - VERTICES_MM)[:4].max() < 0.02  # mm


@pytest.mark.parametrize("stations", [1, 3, 4, 20])
def test_a_leg_of_few_stations_shows_how_soft_its_edges_are(stations: int) -> None:
    """As a long one does, within the steps in which it is tried; of three stations one is looked at."""
    view = view_of(inked(polyline((4, 4), (16, 12))).sheet, None, WIDTH_MM)
    heading, along = np.arctan2(8, 12), 0.1 * np.arange(20)
    places = [10, 8] - along[::-1, None] * [np.cos(heading), np.sin(heading)]
    seen = np.column_stack([places, np.full(20, WIDTH_MM)])
    leg, few = (Leg(places[-1], heading, 0.0, WIDTH_MM, seen[-n:]) for n in (20, stations))
    assert softness_of(view, few) == pytest.approx(softness_of(view, leg), rel=0.3)
