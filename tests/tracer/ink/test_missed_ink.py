"""Ink on one side of a stroke that no stroke runs along is found, where the thinned ink shows one middle."""

from __future__ import annotations

import numpy as np
import pytest

from morfax.motion.arrays import Array
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import evenly
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.bare import Thinned
from morfax.tracer.ink.ledger import Balance, balance
from morfax.tracer.ink.left_out import ink_left
from morfax.tracer.ink.missed_ink import Missed, missed_ink
from morfax.tracer.ink.stretches import FeltSheet
from tests.tracer.inked import Points, inked, polyline

WIDTH_MM, STEP_MM = 0.5, 0.002
# 1.15 widths apart: the ink of both is joined
UPPER, LOWER = polyline((6, 10.575), (30, 10.575)), polyline((4, 10), (32, 10))
BAR = polyline((6, 4), (46, 4), (46, 26), (6, 26), (6, 4))


def found(lines: list[Points], ways: list[Points]) -> list[Missed]:
    """The missed ink of lines of which ways were run."""
    sheet = inked(*lines, width_mm=WIDTH_MM, seed=1).sheet
    widths_mm = np.full(sheet.patches.count, WIDTH_MM)
    run = np.vstack([evenly(way, 0.1) for way in ways])
    return list(missed_ink(sheet, ink_left(sheet), run, widths_mm))


def test_the_part_of_a_line_beside_another_that_no_stroke_runs_along_is_found() -> None:
    parts = [polyline((6, 10.575), (18, 10.575)), polyline((21, 10.575), (30, 10.575))]
    (piece,) = found([UPPER, LOWER, BAR], [*parts, LOWER, BAR])
    assert piece.places_mm.mean(axis=0) == pytest.approx((19.5, 10.62), abs=0.1)
    # the pen's round ends reach into the gap, and the other line's pen to half of its ink
    assert 0.7 < piece.length_mm < 3.0


def test_of_lines_that_were_followed_nothing_is_missed() -> None:
    assert found([UPPER, LOWER, BAR], [UPPER, LOWER, BAR]) == []


def test_ink_on_both_sides_of_a_stroke_is_a_broad_line() -> None:
    sides = [polyline((6, y), (30, y)) for y in (9.6, 10.0, 10.4)]
    assert found([*sides, BAR], [LOWER, BAR]) == []
    assert len(found([*sides, BAR], [sides[0], BAR])) == 1  # and at its rim it is not


def test_some_pixels_at_a_time_are_the_same_as_all(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = [polyline((6, 10.575), (18, 10.575)), polyline((21, 10.575), (30, 10.575))]
    (whole,) = found([UPPER, LOWER, BAR], [*parts, LOWER, BAR])
    looked, nearest = list[int](), Neighbours.nearest

    def counted(self: Neighbours, places: Array, within: float = np.inf) -> tuple[Array, Array]:
        looked.append(len(places))
        return nearest(self, places, within)

    monkeypatch.setattr(Neighbours, "nearest", counted)
    monkeypatch.setattr("morfax.tracer.ink.missed_ink.LOOKED_PX", 1000)
    (piece,) = found([UPPER, LOWER, BAR], [*parts, LOWER, BAR])
    assert np.array_equal(piece.places_mm, whole.places_mm)
    assert len(looked) > 5 and max(looked) < 2000


def ledger(*ways: Points) -> Balance:
    """The balance of the two lines and a bar, of which ways were run."""
    sheet = inked(UPPER, LOWER, BAR, width_mm=WIDTH_MM, seed=1).sheet
    left = ink_left(sheet)
    felt = FeltSheet.of(left.drawing, Settings(), left.ink, None, are_strokes=True)
    thinned = Thinned.of(sheet, felt.graph, left)
    return balance(sheet, felt, thinned, left, [evenly(way, STEP_MM) for way in ways])


def test_the_ledger_counts_missed_ink_as_left_and_lists_its_place() -> None:
    all_of_it = ledger(UPPER, LOWER, BAR)
    assert all_of_it.left_mm == pytest.approx(0, abs=0.05) and all_of_it.lost == ()
    parts = polyline((6, 10.575), (18, 10.575)), polyline((21, 10.575), (30, 10.575))
    some = ledger(*parts, LOWER, BAR)
    assert some.left_mm > 0.7 and some.followed_mm < all_of_it.followed_mm - 0.7
    ((x, y, _),) = some.lost
    assert (x, y) == pytest.approx((19.5, 10.6), abs=0.2)


def test_a_part_of_a_line_that_no_stroke_runs_along_is_listed_however_long_the_line_is() -> (
    None
):
    beyond = polyline((6, 20), (6, 4), (46, 4), (46, 26), (6, 26), (6, 25))
    some = ledger(UPPER, LOWER, beyond)
    ((x, y, long_mm),) = some.lost
    # ink nearer to a way than 0.7 of its width is that way's
    assert (x, y) == pytest.approx((6, 22.5), abs=0.2) and long_mm == pytest.approx(
        4.0, abs=0.3
    )
    assert some.left_mm == pytest.approx(long_mm, abs=0.5)
