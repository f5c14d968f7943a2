"""The order of strokes: each once, and an idle way that no turned stretch makes shorter."""

from __future__ import annotations

from itertools import combinations, permutations, product

import numpy as np
import pytest

from morfax.tracer.program.lines import stroke_order
from morfax.tracer.program.lines.stroke_order import in_order

NEAR_BEST = 1.1  # 2-opt with turning, of a few strokes, against the best of all orders


def idle_mm(begins: np.ndarray, ends: np.ndarray, way: np.ndarray, turned: np.ndarray) -> float:
    first = np.where(turned[:, None], ends[way], begins[way])
    last = np.where(turned[:, None], begins[way], ends[way])
    return float(np.hypot(*(first[1:] - last[:-1]).T).sum())


def strokes(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(0, 100, (count, 2)), rng.uniform(0, 100, (count, 2))


def test_few_strokes_are_near_the_best_of_all_orders() -> None:
    ratios = []
    for seed in range(12):
        begins, ends = strokes(5, seed)
        best = min(
            idle_mm(begins, ends, np.array(way), np.array(turned))
            for way in permutations(range(5))
            for turned in product([False, True], repeat=5)
        )
        ratios.append(idle_mm(begins, ends, *in_order(begins, ends)) / best)
    assert np.mean(ratios) < NEAR_BEST


def test_dashes_of_a_line_are_run_one_after_the_other() -> None:
    at = np.arange(0, 60, 2.0)
    begins = np.column_stack([at, np.zeros(30)])
    ends = begins + np.array([1.0, 0.0])
    mixed = np.random.default_rng(1).permutation(30)
    swapped = np.arange(30) % 3 == 0
    some = np.where(swapped[:, None], ends[mixed], begins[mixed])
    others = np.where(swapped[:, None], begins[mixed], ends[mixed])
    way, turned = in_order(some, others)
    assert sorted(way) == list(range(30))
    assert idle_mm(some, others, way, turned) == pytest.approx(29, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_no_stretch_that_is_turned_makes_the_order_shorter(seed: int) -> None:
    begins, ends = strokes(40, seed)
    way, turned = in_order(begins, ends)
    found_mm = idle_mm(begins, ends, way, turned)
    for i, j in combinations(range(41), 2):
        other, flipped = way.copy(), turned.copy()
        other[i:j], flipped[i:j] = way[i:j][::-1], ~turned[i:j][::-1]
        assert idle_mm(begins, ends, other, flipped) > found_mm - 1e-6  # rounding


def test_the_plain_kernel_says_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    begins, ends = strokes(9, 3)
    compiled = in_order(begins, ends)
    for name in ("_on_to_nearest", "_turn_stretches", "_lay_out", "_apart"):
        monkeypatch.setattr(stroke_order, name, getattr(stroke_order, name).py_func)
    plain = in_order(begins, ends)
    assert all(np.array_equal(a, b) for a, b in zip(compiled, plain, strict=True))


def test_one_stroke() -> None:
    way, turned = in_order(*strokes(1, 0))
    assert way.tolist() == [0] and turned.tolist() == [False]
