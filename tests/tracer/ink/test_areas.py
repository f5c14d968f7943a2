"""The areas of a net, when the order of the lines at a junction was felt wrong."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.tracer.head.settings import Settings
from morfax.tracer.ink import areas
from morfax.tracer.ink.chains import Junctions
from morfax.tracer.ink.outlines import _area_mm2
from morfax.tracer.ink.solving import solved
from morfax.tracer.ink.stretches import FeltSheet
from tests.tracer.inked import inked, polyline

# a window of three by three panes: four crossings within, eight bars that end on the frame
FRAME = polyline((4, 4), (28, 4), (28, 28), (4, 28), (4, 4))
BARS = [polyline((k, 4), (k, 28)) for k in (12, 20)] + [
    polyline((4, k), (28, k)) for k in (12, 20)
]
CROSSINGS = 4


@pytest.fixture(scope="module")
def window() -> Junctions:
    """The junctions of a window."""
    drawing = inked(FRAME, *BARS, seed=1)
    patches, (rows, columns) = drawing.sheet.patches, drawing.darkness.shape
    ink = patches.painted(np.ones(patches.count, bool), 0, rows, 0, columns)
    return solved(FeltSheet.of(drawing, Settings(), ink))


def ways(junctions: Junctions) -> set[frozenset[int]]:
    """The ways round its areas, as the numbers of their lines."""
    every = set(range(len(junctions.net.lines)))
    return {frozenset(n for n, _ in way) for way in areas.ways_round(every, junctions)}


def test_a_window_of_three_by_three_panes_has_ten_areas_with_the_paper_all_round(
    window: Junctions,
) -> None:
    assert len(ways(window)) == 10


def test_each_pane_is_as_large_as_drawn_and_the_paper_all_round_is_gone_about_the_other_way(
    window: Junctions,
) -> None:
    every = set(range(len(window.net.lines)))
    sizes = sorted(_area_mm2(way, window) for way in areas.ways_round(every, window))
    corners_mm2 = 0.025 * 32  # a line is felt within 25 um near corners, round 32 mm of a pane
    assert sizes == pytest.approx([-(24.0**2), *[8.0**2] * 9], abs=3 * corners_mm2)


@pytest.mark.parametrize("junction", range(CROSSINGS))
def test_neighbours_in_the_wrong_order_are_exchanged(
    window: Junctions, monkeypatch: pytest.MonkeyPatch, junction: int
) -> None:
    right, felt = ways(window), areas._orders

    def wrong(left: set[int], junctions: Junctions) -> areas.Orders:
        orders = felt(left, junctions)
        at = [edges for edges in orders.values() if len(edges) > 3][junction]
        # as near to each other as two legs that are felt the wrong way about
        (angle, one), (_, other) = at[0], at[1]
        at[:2] = [(angle, other), (angle + 0.01, one)]
        return orders

    monkeypatch.setattr(areas, "_orders", wrong)
    assert ways(window) == right


@pytest.mark.parametrize("seed", range(20))
def test_exchanged_neighbours_part_a_way_where_counting_all_ways_says_so(seed: int) -> None:
    rng = np.random.default_rng(seed)
    orders: areas.Orders = {}
    for line in range(12):
        for back in (False, True):
            leaving = orders.setdefault(int(rng.integers(4)), [])
            leaving.append((float(rng.uniform(-3, 3)), (line, back)))
    for number, k in ((n, k) for n in orders if len(orders[n]) > 2 for k in range(-2, 2)):
        before = areas._ways(areas._onto(orders))
        rounds, tried = areas._Rounds(orders, before), {**orders, number: [*orders[number]]}
        tried[number][k - 1], tried[number][k] = tried[number][k], tried[number][k - 1]
        after = areas._ways(areas._onto(tried))
        assert rounds.exchanged(number, k) == (len(after) > len(before))
        assert len(areas._ways(rounds._onto)) == max(len(after), len(before))
