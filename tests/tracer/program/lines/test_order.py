"""The order of lines: the decisions of plain loops over all stretches, and never outer before inner."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.plane import NOTHING_MM
from morfax.tracer.program.lines import order


def legs(way: list[int], idle_mm: Array, i: int, j: int) -> float:
    """Idle way between two places of an order; none before the first and after the last."""
    return 0.0 if i < 0 or j >= len(way) else float(idle_mm[way[i], way[j]])


def may_come(way: list[int], before: NDArray[np.bool_]) -> bool:
    """Whether each line comes after those that are cut before it."""
    return not any(before[b, a] for k, a in enumerate(way) for b in way[k + 1 :])


def improved(way: list[int], idle_mm: Array, before: NDArray[np.bool_]) -> list[int]:
    """Stretches turned round and lines moved, for as long as one of these is a gain."""
    better = True
    while better:
        better = False
        for i in range(len(way) - 1):
            there = back = 0.0
            for j in range(i + 1, len(way)):
                there, back = (
                    there + idle_mm[way[j - 1], way[j]],
                    back + idle_mm[way[j], way[j - 1]],
                )
                was = legs(way, idle_mm, i - 1, i) + there + legs(way, idle_mm, j, j + 1)
                now = legs(way, idle_mm, i - 1, j) + back + legs(way, idle_mm, i, j + 1)
                turned = way[:i] + way[i : j + 1][::-1] + way[j + 1 :]
                if was - now > NOTHING_MM and may_come(turned, before):
                    way, there, back, better = turned, back, there, True
        moved = first_move(way, idle_mm, before)
        way, better = moved or way, better or moved is not None
    return way


def first_move(way: list[int], idle_mm: Array, before: NDArray[np.bool_]) -> list[int] | None:
    """The order with the first lines moved whose move is a gain."""
    for i in range(len(way)):
        for j in range(i, min(i + order.MOVED, len(way))):
            rest, part = way[:i] + way[j + 1 :], way[i : j + 1]
            for k in [*range(-1, i - 1), *range(j + 1, len(way))]:
                out = legs(way, idle_mm, i - 1, i) + legs(way, idle_mm, j, j + 1)
                out -= legs(way, idle_mm, i - 1, j + 1)
                into = 0.0 if k < 0 else float(idle_mm[way[k], way[i]])
                into += legs(way, idle_mm, j, k + 1) - legs(way, idle_mm, k, k + 1)
                at = k + 1 if k < i else k - len(part) + 1
                moved = rest[:at] + part + rest[at:]
                if out - into > NOTHING_MM and may_come(moved, before):
                    return moved
    return None


@pytest.mark.parametrize("lines", [1, 2, 3, 5, 12, 20])
@pytest.mark.parametrize("nested", [False, True])
def test_an_order_is_improved_as_by_plain_loops(lines: int, nested: bool) -> None:
    random = np.random.default_rng(lines)
    idle_mm = random.uniform(1.0, 100.0, (lines, lines))
    depth = random.integers(0, 3, lines)
    before = (depth[:, None] < depth) & nested
    pairs = np.ascontiguousarray(np.argwhere(before))
    way = np.argsort(depth, kind="stable")
    wanted = improved(way.tolist(), idle_mm, before)
    found = order._improved(way.copy(), idle_mm, idle_mm.T.copy(), pairs)
    assert found.tolist() == wanted
    assert may_come(wanted, before)
    assert order.idle_way_mm(found, idle_mm) <= order.idle_way_mm(way, idle_mm)


@pytest.mark.parametrize("plain", [False, True])
def test_the_best_turn_is_that_of_plain_loops(
    plain: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So no stretch is passed over whose turn is a gain."""
    for name in ("_saved", "_best_turn", "_lay_out") if plain else ():
        monkeypatch.setattr(order, name, getattr(order, name).py_func)
    random, lines = np.random.default_rng(4), 40
    idle_mm, way = random.uniform(1.0, 100.0, (lines, lines)), random.permutation(lines)
    laid = order._Legs(idle_mm, idle_mm.T.copy(), *np.zeros((2, lines + 1)))
    order._lay_out(way, laid)
    for i in range(1, lines - 1):
        gains = []
        for j in range(i + 1, lines):
            turned = np.concatenate([way[:i], way[i : j + 1][::-1], way[j + 1 :]])
            gains.append(order.idle_way_mm(way, idle_mm) - order.idle_way_mm(turned, idle_mm))
        best = order._best_turn(way, laid, order._saved(laid), i)
        assert best == pytest.approx(max(gains), abs=NOTHING_MM / 2)


def test_an_order_is_made_once_where_no_line_may_be_turned(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made, whole = list[int](), order.in_order
    monkeypatch.setattr(
        order, "in_order", lambda *given: made.append(len(given)) or whole(*given)
    )
    places = np.random.default_rng(1).uniform(0.0, 100.0, (12, 2))
    free = np.zeros((12, 12), bool)
    order.in_order_and_turned(places, places, free, np.zeros(12, bool))
    assert len(made) == 1
