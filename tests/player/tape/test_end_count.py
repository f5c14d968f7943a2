"""The end's count: the one set of whole cycles that dropouts can have lost, or a fault."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from morfax.motion.faults import LockFault, TapeFault
from morfax.player.tape.bridges import Bridge
from morfax.player.tape.end_count import _candidates, _sets, lost_cycles
from morfax.recorder.tape.format import TapeFormat

FMT = TapeFormat()
ROW = FMT.motion_rate_hz  # a second on


def gap(reach: float, off: float = 0.0, misfit: float = 0.0) -> Bridge:
    """A bridge whose motion may have gone so far aside."""
    return Bridge(0.0, off, reach, 0.0, misfit)


@pytest.mark.parametrize(
    ("found", "numbers"),
    [
        (gap(0.5), [0]),
        (gap(0.95), [-1, 0, 1]),  # a tenth is left for noise
        (gap(0.85), [0]),
        (gap(0.85, misfit=0.1), [-1, 0, 1]),
        (gap(0.85, off=0.2), [-1, 0]),
        (gap(0.85, off=-0.2), [0, 1]),
        (gap(2.0), [-2, -1, 0, 1, 2]),
    ],
)
def test_what_a_dropout_can_have_lost_is_what_the_motion_could_go_in_it(
    found: Bridge, numbers: list[int]
) -> None:
    assert list(_candidates(found)) == numbers


@given(
    st.lists(st.tuples(st.integers(-3, 3), st.integers(0, 3)), max_size=5), st.integers(-8, 8)
)
def test_sets_are_those_of_all_ways_to_make_the_sum(
    rows: list[tuple[int, int]], total: int
) -> None:
    candidates = [range(low, low + many) for low, many in rows]
    every = [way for way in itertools.product(*candidates) if sum(way) == total]
    found = _sets(candidates, total)
    assert len(found) == min(2, len(every)) and set(found) <= set(every)


def test_one_way_is_told_by_axis_and_dropout() -> None:
    first, second = round(1 * ROW), round(2 * ROW)
    doubtful = {(second, 0): gap(0.3), (first, 0): gap(1.2), (first, 1): gap(0.5)}
    assert lost_cycles(doubtful, np.array([1.1, -0.1, 0.0]), FMT) == {
        (first, 0): 1,
        (second, 0): 0,
        (first, 1): 0,
    }


@pytest.mark.parametrize(
    ("gaps", "cycles", "said"),
    [
        ({}, 2.0, "X ends +2 cycles off, and there is no dropout that could have lost them"),
        ({1.0: 0.5}, 2.0, "+2 cycles off, and the dropouts at 1.000 s are too short for it"),
        (
            {1.0: 1.2, 2.5: 1.2},
            1.0,
            "+1 cycles off, and the 2 dropouts at 1.000 s, 2.500 s could have",
        ),
        (
            {1.0: 1.2, 2.5: 1.2},
            0.0,
            "what one of the 2 dropouts at 1.000 s, 2.500 s lost another",
        ),
    ],
)
def test_an_end_that_no_dropout_explains_or_several_do_is_a_fault(
    gaps: dict[float, float], cycles: float, said: str
) -> None:
    doubtful = {(round(s * ROW), 0): gap(reach) for s, reach in gaps.items()}
    with pytest.raises(TapeFault, match=re.escape(said)):
        lost_cycles(doubtful, np.array([cycles, 0.0, 0.0]), FMT)


@pytest.mark.parametrize(
    ("cycles", "is_whole"), [(1.24, True), (0.76, True), (1.26, False), (0.74, False)]
)
def test_an_end_off_by_no_whole_number_within_a_quarter_is_a_fault_of_the_lock(
    cycles: float, is_whole: bool
) -> None:
    doubtful = {(round(ROW), 1): gap(1.2)}
    missing = np.array([0.0, cycles, 0.0])
    if is_whole:
        assert lost_cycles(doubtful, missing, FMT) == {(round(ROW), 1): 1}
    else:
        with pytest.raises(
            LockFault, match=rf"Y ends \+{cycles:.2f} cycles off, which is no whole"
        ) as met:
            lost_cycles(doubtful, missing, FMT)
        assert met.value.axis == "y" and met.value.error_cycles == cycles
