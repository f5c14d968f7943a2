"""Crossings of straight pieces against all pairs of them, one by one."""

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.crossings import BOXED, CELL_MM, Ints, crossings_of


def _plain(points: Array, pieces: Ints) -> Array:
    """The same in plain Python: each piece against each later one, in the order of the grid's cells."""
    longest_mm = max(float(np.hypot(*(points[i + 1] - points[i]))) for i in pieces)
    cell_mm = max(CELL_MM, 2 * longest_mm)
    found = []
    for m, i in enumerate(pieces.tolist()):
        for j in pieces[m + 1 :].tolist():
            p, q, w = (
                points[i + 1] - points[i],
                points[j + 1] - points[j],
                points[j] - points[i],
            )
            cross = p[0] * q[1] - p[1] * q[0]
            if j == i + 1 or cross == 0.0:
                continue
            u, v = (w[0] * q[1] - w[1] * q[0]) / cross, (w[0] * p[1] - w[1] * p[0]) / cross
            if 0.0 <= u < 1.0 and 0.0 <= v < 1.0:
                cells = [(*np.floor(points[k] / cell_mm).tolist(), k) for k in (i, j)]
                found.append((cells, i + u, j + v))
    return np.array([each[1:] for each in sorted(found)]).reshape(-1, 2)


@pytest.mark.parametrize("seed", range(6))
def test_crossings_of_some_pieces_of_a_way_are_those_of_all_pairs(seed: int) -> None:
    """A way of several boxes that crosses itself often, of which some pieces are left out."""
    rng = np.random.default_rng(seed)
    way = np.cumsum(rng.normal(size=(6 * BOXED + seed, 2)), axis=0)
    if seed % 2:
        way = np.round(way)  # pieces that touch, lie on each other, and stand in one line
    pieces = np.flatnonzero(rng.random(len(way) - 1) < 0.9)
    found = crossings_of(way, pieces)
    assert len(found) > 10
    assert np.array_equal(found, _plain(way, pieces))


def test_one_long_piece_meets_all_that_it_crosses() -> None:
    """A piece far longer than the others, as a laid one is, crosses each of their turns and the way up."""
    waves = np.column_stack([0.05 * np.arange(400), np.tile([0.0, 0.1, 0.0, -0.1], 100)])
    way = np.vstack([waves, [[30.0, 5.0], [-1.0, 5.0], [-1.0, 0.003], [30.0, 0.003]]])
    found = crossings_of(way, np.arange(len(way) - 1))
    assert len(found) == 200 + 1
    assert np.array_equal(found, _plain(way, np.arange(len(way) - 1)))
