"""Lines near a place are found without the others, and no more of them than is near."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.tracer.program.against_ink.boxed_lines import BoxedLines, reaching, within
from tests.tracer.inked import polyline
from tests.tracer.program.laid.ways import run_along


def test_of_lines_that_reach_into_a_box_the_parts_within_it_are_found() -> None:
    """A line that leaves the box and comes back has two; one that only passes has none."""
    bay = run_along(polyline((0, 5), (10, 5), (10, 20), (12, 20), (12, 5), (30, 5)), "ended")
    far, passing = (
        run_along(polyline((0, y), (x, 9), (30, y)), "ended") for x, y in ((15, 40), (4, 9.5))
    )
    lines = BoxedLines.of([bay, far, passing])
    low, high = np.array([8.0, 3.0]), np.array([14.0, 9.05])
    found = list(lines.parts(low, high))
    assert [line is bay for line, _ in found] == [True, True]
    for _, part in found:
        assert (part > low).all() and (part < high).all()
    inside = (bay.places_mm > low) & (bay.places_mm < high)
    assert sum(len(part) for _, part in found) == np.count_nonzero(inside.all(axis=1))
    assert not list(lines.parts(low, high, but=bay))
    # around the box the same line has more of its way
    around = [part for line, part in lines.parts(low, high, around_mm=1.0) if line is bay]
    about = (bay.places_mm > low - 1.0) & (bay.places_mm < high + 1.0)
    assert sum(map(len, around)) == np.count_nonzero(about.all(axis=1))


@pytest.mark.parametrize("ending", ["ended", "closed"])
def test_the_stretches_that_reach_into_a_box_draw_there_what_the_whole_line_does(
    ending: str,
) -> None:
    """Lines go in and out of the box, past a corner of it too, and one comes round through it."""
    rng = np.random.default_rng(3)
    ways = [np.cumsum(rng.normal(0, 2.0, (60, 2)), axis=0) + 20 for _ in range(6)]
    lines = BoxedLines.of([run_along(way, ending) for way in ways])
    low, high = np.array([12.0, 14.0]), np.array([26.0, 24.0])
    whole, some, wide_px = np.zeros((120, 160), np.uint8), np.zeros((120, 160), np.uint8), 5
    reach = 0.5  # of the pen, and of rounding, in tenths of mm
    for line in lines.lines:
        way_px = ((line.places_mm - low) * 10).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(whole, [way_px], line.comes_round, 1, wide_px)
    found = list(lines.stretches(low - reach, high + 2 + reach))
    for way in found:
        cv2.polylines(
            some, [((way - low) * 10).astype(np.int32).reshape(-1, 1, 2)], False, 1, 5
        )
    assert whole.any() and not whole.all()
    assert np.array_equal(whole, some)
    assert sum(map(len, found)) < sum(len(line.places_mm) for line in lines.lines)


def test_the_kernels_find_what_numpy_does() -> None:
    """The same places and stretches, of open ways and of those that come round, and of none."""
    rng = np.random.default_rng(5)
    for count in (0, 1, 2, 3, 60):
        way = np.cumsum(rng.normal(0, 2.0, (count, 2)), axis=0) + 20
        for low, high in zip(
            rng.uniform(10, 20, (9, 2)), rng.uniform(18, 30, (9, 2)), strict=True
        ):
            inside = ((way > low) & (way < high)).all(axis=1)
            assert np.array_equal(within(way, low, high), np.flatnonzero(inside))
            for comes_round in (False, True):
                found = list(reaching(way, low, high, comes_round=comes_round))
                expected = _reaching(
                    np.vstack([way, way[:1]]) if comes_round else way, low, high
                )
                assert len(found) == len(expected)
                assert all(map(np.array_equal, found, expected))


def _reaching(way: Array, low: Array, high: Array) -> list[Array]:
    """The stretches of a way whose boxes reach into another, without a kernel."""
    first, second = way[:-1], way[1:]
    reach = (np.minimum(first, second) < high) & (np.maximum(first, second) > low)
    edges = np.flatnonzero(np.diff(np.r_[0, reach.all(axis=1), 0]))
    return [way[a : b + 1] for a, b in edges.reshape(-1, 2).tolist()]
