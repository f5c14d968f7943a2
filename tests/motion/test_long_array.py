"""Long arrays: what is in a file is what would be in memory, and memory is given back."""

from __future__ import annotations

import copy
import pickle
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from morfax.motion import long_array
from morfax.motion.faults import FileFault
from morfax.motion.long_array import (
    LongArray,
    blocks,
    bounds_by_blocks,
    filed,
    is_mapped,
    one_in,
)
from morfax.motion.polyline import lengths_by_blocks, lengths_mm

ROWS = np.random.default_rng(1).normal(size=(2000, 2))
LIMIT_ROWS = 100  # in memory, in these tests


@pytest.fixture(autouse=True)
def short_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hundred rows are long, and 70 of them a block."""
    monkeypatch.setattr(long_array, "IN_MEMORY_BYTES", 16 * LIMIT_ROWS)
    monkeypatch.setattr(long_array, "BLOCK_ROWS", 70)


def grown(rows: int = len(ROWS), parts: int = 37) -> LongArray:
    """A long array of some rows, that came in parts."""
    array = LongArray()
    for part in np.array_split(ROWS[:rows], parts):
        array.add(part)
    return array


@pytest.mark.parametrize("rows", [0, 1, 99, 101, 2000])
def test_all_rows_are_there_in_memory_or_mapped(rows: int) -> None:
    array = grown(rows)
    assert np.array_equal(array.whole(), ROWS[:rows]) and len(array) == rows
    assert is_mapped(array.whole()) == (rows > LIMIT_ROWS)
    if rows:
        assert np.array_equal(array.last, ROWS[rows - 1])
        assert np.array_equal(array.since(rows // 2), ROWS[rows // 2 : rows])


def test_what_comes_is_copied() -> None:
    array, part = LongArray(), ROWS[:50].copy()
    array.add(part)
    part[:] = 0
    assert np.array_equal(array.whole(), ROWS[:50])


def test_rows_in_memory_are_put_together_once() -> None:
    kept = LongArray()
    kept.add(np.ones((3, 2)))
    kept.add(np.zeros((2, 2)))
    whole = kept.whole()
    assert len(whole) == 5 and kept.whole() is whole
    kept.add(np.ones((1, 2)))
    assert len(kept.whole()) == 6 and len(whole) == 5


def test_copies_share_the_rows_that_one_of_them_puts_together() -> None:
    """The head is copied before each junction: the rows of its way were kept twice, in pieces and whole."""
    array = LongArray()
    for part in np.split(ROWS[:60], 6):
        array.add(part)
    copied = copy.deepcopy(array)
    array.add(ROWS[60:70])
    whole = array.whole()
    assert np.shares_memory(copied._newest[-1].rows, whole)
    assert np.array_equal(copied.whole(), ROWS[:60])
    copied.add(ROWS[:5])
    assert np.array_equal(whole, ROWS[:70])


@settings(max_examples=30)
@given(first=st.integers(0, 2000), then=st.integers(0, 300), other=st.integers(0, 2000))
def test_copies_go_on_by_themselves_also_when_rows_are_cut(
    first: int, then: int, other: int
) -> None:
    array = grown()
    copied = copy.deepcopy(array)
    array.cut(first)
    copied.cut(other)
    for each in (array, copied):
        each.add(ROWS[:then])
    assert np.array_equal(array.whole(), np.vstack([ROWS[:first], ROWS[:then]]))
    assert np.array_equal(copied.whole(), np.vstack([ROWS[:other], ROWS[:then]]))


def test_another_process_has_all_rows() -> None:
    assert np.array_equal(pickle.loads(pickle.dumps(grown())).whole(), ROWS)


@pytest.mark.parametrize("before", [0, 1, 2])
def test_blocks_are_the_rows_with_those_before(before: int) -> None:
    found = list(map(np.copy, blocks(grown().whole(), before)))
    assert len(found) == 29 and max(map(len, found)) == 70 + before
    assert np.array_equal(np.vstack([found[0], *(some[before:] for some in found[1:])]), ROWS)
    assert len(list(blocks(ROWS, before))) == 1


@pytest.mark.parametrize("every", [1, 7, 30])
def test_one_in_so_many_is_a_slice(every: int) -> None:
    thinned = one_in(grown().whole()[5:], every)
    assert np.array_equal(thinned, ROWS[5::every]) and not is_mapped(thinned)


@pytest.mark.parametrize("rows", [1, 99, 2000])
def test_bounds_by_blocks_are_the_lowest_and_the_highest(rows: int) -> None:
    low, high = bounds_by_blocks(grown(rows).whole())
    assert np.array_equal(low, ROWS[:rows].min(axis=0))
    assert np.array_equal(high, ROWS[:rows].max(axis=0))


def test_lengths_by_blocks_are_the_lengths_to_the_last_bit() -> None:
    found = list(lengths_by_blocks(grown().whole()))
    firsts = [first for first, _, _ in found]
    assert firsts[:3] == [0, 69, 139]  # each begins with the last place of the one before
    whole = np.concatenate([found[0][2], *(lengths[1:] for _, _, lengths in found[1:])])
    assert np.array_equal(whole, lengths_mm(ROWS))


def resident_bytes() -> int:
    """What this process holds of files without a name, that are mapped."""
    held, counts = 0, False
    for line in Path("/proc/self/smaps").read_text().splitlines():
        if "-" in line.split(" ")[0]:
            counts = "(deleted)" in line and tempfile.gettempdir() in line
        elif counts and line.startswith("Rss:"):
            held += 1024 * int(line.split()[1])
    return held


def through_blocks(rows: np.ndarray) -> None:
    """Go through all rows block by block."""
    for block in blocks(rows):
        block.sum()


def through_one_in(rows: np.ndarray) -> None:
    """Take one row in thirty."""
    one_in(rows, 30)


@pytest.mark.parametrize("through", [through_blocks, through_one_in, bounds_by_blocks])
def test_memory_is_given_back(
    through: Callable[[np.ndarray], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 32 MB that were gone through no more is held than of two blocks of 3.2 MB."""
    monkeypatch.setattr(long_array, "BLOCK_ROWS", 200_000)
    array = LongArray()
    array.add(np.ones((2_000_000, 2)))
    rows, before = array.whole(), resident_bytes()
    rows.sum()
    assert resident_bytes() - before >= 30e6
    through(rows)
    assert resident_bytes() - before <= 6.4e6


def test_a_folder_without_room_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def full() -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    with pytest.raises(FileFault, match=r"No space left on device; .* set TMPDIR") as told:
        grown()
    assert "\n" not in str(told.value)


def test_arrays_behind_each_other_in_a_file_are_the_same_rows() -> None:
    """Each is mapped, also a part of one without a row, and is one block of its own."""
    parts = [np.arange(2.0 * count).reshape(-1, 2) - count for count in (1, 7, 3)]
    kept = filed(parts)
    for part, rows in zip(parts, kept, strict=True):
        assert is_mapped(rows) and np.array_equal(rows, part)
        assert np.array_equal(np.vstack(list(blocks(rows))), part)
        assert np.array_equal(one_in(rows[::-1], 2), part[::-2])
        assert (
            one_in(rows[:0], 2).shape == (0, 2) and not np.vstack(list(blocks(rows[:0]))).size
        )
    assert filed([]) == []
