"""The path of the head by its length: what numpy interpolates, to the bit, in one block or in many."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from morfax.motion import long_array
from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.tracer.marks import head_path as organ

STEP_MM = 0.085


def positions(count: int) -> Array:
    """A head that goes to and fro, and stands now and then."""
    steps = np.random.default_rng(5).normal(0, 0.01, (count, 2))
    steps[count // 3 : count // 2] = 0.0
    return 40.0 + np.cumsum(steps, axis=0)


def in_parts(rows: Array, before: int = 0) -> Iterator[Array]:
    """Blocks of seven rows."""
    for first in range(0, len(rows), 7):
        yield rows[max(0, first - before) : first + 7]


def check(path: organ.HeadPath, places: Array) -> None:
    """Hold a path against what numpy makes of all of its lengths."""
    come_mm = lengths_mm(places)
    at_mm = STEP_MM * np.arange(np.ceil(come_mm[-1] / STEP_MM))
    moved = np.r_[0, np.flatnonzero(np.diff(come_mm) > 0) + 1]
    assert np.array_equal(path.at_mm, at_mm)
    expected = [np.interp(at_mm, come_mm, column) for column in places.T]
    assert np.array_equal(path.places, np.column_stack(expected))
    assert np.array_equal(path.position, np.interp(at_mm, come_mm[moved], moved))


@pytest.mark.parametrize("count", [2, 60, 3000])
def test_places_and_positions_are_those_between_the_head_s_own(count: int) -> None:
    places = positions(count)
    check(organ.HeadPath(places, STEP_MM), places)


def test_a_path_in_blocks_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    places = positions(300)
    monkeypatch.setattr(organ, "blocks", in_parts)
    check(organ.HeadPath(places, STEP_MM), places)


def test_a_long_path_is_kept_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hundred metres of line have 5 million places, each with a direction."""
    monkeypatch.setattr(long_array, "IN_MEMORY_BYTES", 1000)
    places = positions(3000)
    path = organ.HeadPath(places, STEP_MM)
    check(path, places)
    assert all(map(long_array.is_mapped, (path.places, path.along, path.position)))


def test_plain_python_walks_the_same_way(monkeypatch: pytest.MonkeyPatch) -> None:
    places = positions(300)
    for name in ("_walk", "_end_mm"):
        monkeypatch.setattr(organ, name, getattr(organ, name).py_func)
    check(organ.HeadPath(places, STEP_MM), places)


def test_a_head_that_stands_has_no_path() -> None:
    path = organ.HeadPath(np.full((50, 2), 3.0), STEP_MM)
    assert len(path.at_mm) == len(path.places) == len(path.position) == 0
