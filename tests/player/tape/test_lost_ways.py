"""Lost ways: which gap lost whole cycles before a count, and how the rows behind it are put right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from morfax.player.tape.bridges import Bound, Bridge, GapEdge
from morfax.player.tape.discriminator import Phases
from morfax.player.tape.gap import Gap
from morfax.player.tape.lost_ways import LostWays, laid

SYMBOL_ROWS = 24.0  # four thousandths of a second
CERTAIN = Bridge(0.0, 0.0, 0.2, 0.0, 0.0)
DOUBTFUL = replace(CERTAIN, reach=2.0)


def gap(first: int, last: int, found: Bridge = CERTAIN, speed: float = 0.05) -> Gap:
    """A gap of the first axis; at a bound of 1 cycle/row² any motion may lie between."""
    still = GapEdge(7.0, 0.0, 0.0, 0.0)
    return Gap(0, first, last, still, still, found, Bound(1.0, speed))


def open_ways(*gaps: Gap) -> LostWays:
    """Gaps that no count has settled yet."""
    ways = LostWays(2, SYMBOL_ROWS)
    ways.take(gaps)
    return ways


@pytest.mark.parametrize("row", [99, 100, 110, 120])
def test_a_row_lies_within_a_gap_from_the_row_before_it_to_the_first_behind_it(
    row: int,
) -> None:
    ways = open_ways(gap(100, 120))
    assert ways.uncovered((0, 1), row) == [1]
    assert ways.uncovered((0, 1), 98) == ways.uncovered((0, 1), 121) == [0, 1]
    assert ways.any_open(0) and not ways.any_open(1)


def test_a_bare_row_is_two_fifths_of_a_symbol_off_each_gap() -> None:
    """9.6 rows."""
    ways = open_ways(gap(100, 120), gap(150, 160))
    assert ways.bare(0, [90.5, 129.5, 129.7, 300.0]) == 129.7
    assert ways.bare(0, [90.3, 200.0]) == 90.3
    assert ways.bare(0, [100.0, 155.0]) is None and ways.bare(1, [110.0]) == 110.0


@pytest.mark.parametrize(
    ("off", "found"),
    [
        (0.0, None),
        (0.24, None),
        (1.0, (100, 120)),
        (-1.2, (100, 120)),
        (0.5, None),
        (1.3, None),
    ],
)
def test_a_certain_gap_lost_its_way_only_where_whole_cycles_are_missing(
    off: float, found: tuple[int, int] | None
) -> None:
    lost = open_ways(gap(100, 120)).lost(0, 500.0, off)
    assert (None if lost is None else (lost.first, lost.last)) == found


def test_doubtful_gaps_before_a_count_are_one_from_the_first_to_the_last() -> None:
    ways = open_ways(
        gap(50, 60), gap(100, 120, DOUBTFUL), gap(150, 160, DOUBTFUL), gap(600, 610, DOUBTFUL)
    )
    lost = ways.lost(0, 500.0, 0.1)
    assert lost is not None and (lost.first, lost.last) == (100, 160)
    alone = ways.lost(0, 130.0, 1.0)
    assert alone is not None and (alone.first, alone.last) == (100, 120)
    assert ways.lost(0, 70.0, 0.1) is None
    at_its_end = ways.lost(0, 120.0, 1.0)
    assert at_its_end is not None and at_its_end.last == 120


def test_what_is_settled_is_dropped_and_all_behind_it_moves_on() -> None:
    ways = open_ways(gap(100, 120), gap(600, 610))
    ways.settle(0, 500.0, 2.0)
    assert ways.shift_cycles.tolist() == [2.0, 0.0] and ways.uncovered((0,), 110) == [0]
    later = ways.lost(0, 1000.0, 1.0)
    assert later is not None and later.before.place == 9.0
    ways.take([gap(800, 810)])
    ways.settle(0, 700.0, 1.0)
    newest = ways.lost(0, 1000.0, 1.0)
    assert newest is not None and newest.before.place == 10.0
    assert ways.shift_cycles.tolist() == [3.0, 0.0]


@pytest.mark.parametrize(
    ("found", "speed", "is_sure"),
    [
        (CERTAIN, 0.05, True),
        (DOUBTFUL, 0.05, False),
        (DOUBTFUL, 0.02, False),
    ],
)
def test_at_the_end_a_gap_stays_in_doubt_that_its_sides_do_not_count(
    found: Bridge, speed: float, is_sure: bool
) -> None:
    left = open_ways(gap(600, 620, found, speed), gap(100, 120, found, speed)).unsettled()
    assert (left is None) == is_sure
    if left is not None:
        assert left.first == 100


@pytest.mark.parametrize("cycles", [0, 1, -2])
def test_a_gap_that_is_laid_anew_moves_all_behind_it(cycles: int) -> None:
    """The gap's rows go from 7 cycles to so many more, in a cubic; those of the other axis stay."""
    rows = Phases(90, np.full((50, 2), 7.0), np.zeros((50, 3)), np.ones((50, 3), np.float32))
    rows.cycles[10:30, 0] = np.nan
    made = laid(rows, gap(100, 120), cycles)
    assert made.first_row == 90 and np.all(made.cycles[:, 1] == 7.0)
    assert np.all(made.cycles[:10, 0] == 7.0) and np.all(made.cycles[30:, 0] == 7.0 + cycles)
    within = made.cycles[10:30, 0]
    u = np.arange(1, 21) / 21
    assert within == pytest.approx(7.0 + cycles * u**2 * (3 - 2 * u))
    assert np.isnan(rows.cycles[10, 0])
