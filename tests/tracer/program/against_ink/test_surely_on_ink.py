"""What is surely on its ink is below its limit, and the proof is as sharp as the judgement itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from morfax.tracer.program.against_ink import surely_on_ink
from morfax.tracer.program.against_ink.pen_on_ink import PenOnInk, Room, Ways, over_at
from morfax.tracer.program.against_ink.surely_on_ink import _in_boxes_about, may_be_over
from tests.tracer.inked import Points

SHAPE = (60, 90)
NOISE = 0.03  # of the paper
SIDE = 5


def part(aside_px: float, seed: int) -> tuple[Points, Ways, PenOnInk, Points]:
    """A line of 4 px in a noisy picture along row 30, with a dot of ink beside it, and a way that leaves it
    aside over 20 px; a pen, and stations.
    """
    rows, columns = np.mgrid[0 : SHAPE[0], 0 : SHAPE[1]].astype(float)
    noise = np.random.default_rng(seed).normal(0, NOISE, SHAPE)
    dot = np.hypot(rows - 33, columns - 70) < 2
    seen = np.clip(2.5 - np.abs(rows - 30), 0, 1).clip(dot) + noise
    along = np.arange(90.0)
    beside = np.where((along > 20) & (along < 40), 30 + aside_px, 30.0)
    places = np.column_stack([along, beside]).astype(np.float32)
    ways = Ways(places, np.zeros(90, np.int32), np.array([2.0]), np.array([True]))
    pen = PenOnInk(2.0, 0.5, 5.0, 0.5 * NOISE**2, (0.8, 0.9, 1.0, 1.1, 1.25), 0.0)
    stations = np.round(places[::3]).astype(int)
    return seen.astype(np.float32), ways, pen, stations


@pytest.mark.parametrize("aside_px", [0.0, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("limit", [0.015, 0.05, 0.2])
def test_what_is_not_over_by_the_proof_is_not_over_by_all_pens(
    aside_px: float, limit: float
) -> None:
    for seed in range(3):
        seen, ways, pen, stations = part(aside_px, seed)
        room = Room.of(seen.size, pen)
        may = np.empty(len(stations), bool)
        over = over_at(seen, ways, stations, pen, room)
        may_be_over(seen, ways, stations, np.full(len(over), limit), pen, room, may)
        # boxes whose middle is beyond the picture are looked at as well: no station is near its rim in rows
        inner = (stations[:, 0] >= SIDE) & (stations[:, 0] < SHAPE[1] - SIDE)
        assert may[inner].tolist() == (over[inner] > limit).tolist()
        assert not room.number.any() and not room.spread.any()


def test_a_right_way_is_surely_on_its_ink_and_a_wrong_one_is_not() -> None:
    """The kernel's plain Python; the dot beside the line is ink that no pen draws, and is no fault."""
    for aside_px, is_over in ((0.0, False), (3.0, True)):
        seen, ways, pen, stations = part(aside_px, 1)
        room, may = Room.of(seen.size, pen), np.empty(len(stations), bool)
        limits = np.full(len(stations), 0.05)
        may_be_over.py_func(seen, ways, stations, limits, pen, room, may)
        assert may.any() == is_over


def test_only_where_much_is_wrong_boxes_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    seen, ways, pen, stations = part(3.0, 1)
    looked_at = list[int]()

    def counted(*given: Any) -> None:
        looked_at.append(int(given[1][0]))
        _in_boxes_about(*given)

    monkeypatch.setattr(surely_on_ink, "_in_boxes_about", counted)
    room, may = Room.of(seen.size, pen), np.empty(len(stations), bool)
    may_be_over.py_func(seen, ways, stations, np.full(len(stations), 0.05), pen, room, may)
    assert 30 in looked_at and not {0, 3, 6, 51, 54, 57} & {
        *looked_at
    }  # wrong in columns 21 to 39
    assert may.any()


@pytest.mark.parametrize("side", range(1, 16, 2))
def test_no_box_about_a_pixel_holds_more_than_the_squares_that_it_may_reach_into(
    side: int,
) -> None:
    values = np.random.default_rng(side).random((23, 31))
    half = max(1, side // 2)
    squares = np.zeros([(size + 2 * side) // half + 2 for size in values.shape])
    at = np.indices(values.shape) + side
    np.add.at(squares, tuple(at // half), values)
    about = np.pad(values, 2 * side)
    for column, row in [(0, 0), (30, 22), (17, 11), (5, 20)]:
        boxes = [
            about[top : top + side, left : left + side].sum()
            for top in range(row + side + 1, row + 2 * side + 1)
            for left in range(column + side + 1, column + 2 * side + 1)
        ]
        pixel = np.array([column, row])
        most = surely_on_ink._most_in_squares.py_func(squares, pixel, side, half)
        assert max(boxes) <= most + 1e-9


def test_where_another_line_crosses_no_pens_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    seen, ways, pen, stations = part(0.0, 1)
    seen[:, 44:48] = 1.0
    room = Room.of(seen.size, pen)
    may, most = np.empty(len(stations), bool), list[float]()

    def summed(*given: Any) -> None:
        _in_boxes_about(*given)
        most.append(float(given[3].max()))

    monkeypatch.setattr(surely_on_ink, "_in_boxes_about", summed)
    monkeypatch.setattr(surely_on_ink, "_is_over", None)  # nobody asks for it
    may_be_over.py_func(seen, ways, stations, np.full(len(stations), 0.2), pen, room, may)
    assert max(most) > 0.2 * (2 * pen.half_px) ** 2 and not may.any()


def test_other_pens_are_held_against_the_pixels_of_doubtful_boxes_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A way is beside its ink along 20 of 90 pixels, and near the dot."""
    seen, ways, pen, stations = part(3.0, 1)
    asked, too_dark = list[tuple[int, float]](), surely_on_ink._too_dark

    def counted(band: Any, k: int, share: float, pen: PenOnInk) -> float:
        asked.append((int(band.column[k]), share))
        return float(too_dark.py_func(band, k, share, pen))

    monkeypatch.setattr(surely_on_ink, "_too_dark", counted)
    for plain in ("_is_over", "_best_in", "_on_paper"):
        monkeypatch.setattr(surely_on_ink, plain, getattr(surely_on_ink, plain).py_func)
    room, may = Room.of(seen.size, pen), np.empty(len(stations), bool)
    may_be_over.py_func(seen, ways, stations, np.full(len(stations), 0.05), pen, room, may)
    others = {column for column, share in asked if share == pen.of_width[0]}
    assert may.any() and {20, 30, 40, 70} <= others
    assert not others & {*range(20 - 2 * SIDE), *range(51, 60), *range(81, 90)}
    widest = {column for column, share in asked if share == pen.of_width[-1]}
    assert others <= widest < {*range(20 - 2 * SIDE, 40 + 2 * SIDE), *range(60, 80)}


@pytest.mark.parametrize("pixel", [(10, 8), (0, 0), (19, 14), (2, 13)])
def test_sums_over_the_boxes_about_the_pixels_about_one(pixel: tuple[int, int]) -> None:
    values = np.random.default_rng(1).normal(size=(15, 20))
    boxes, padded = np.empty((SIDE, SIDE)), np.pad(values, 2 * SIDE)
    _in_boxes_about.py_func(values, pixel, np.empty(2 * SIDE - 1), boxes)
    for i in range(SIDE):
        for j in range(SIDE):
            row = pixel[1] + i - SIDE // 2 + 2 * SIDE
            column = pixel[0] + j - SIDE // 2 + 2 * SIDE
            box = padded[row - 2 : row + 3, column - 2 : column + 3]
            assert boxes[i, j] == pytest.approx(box.sum(), abs=1e-12)  # rounding
