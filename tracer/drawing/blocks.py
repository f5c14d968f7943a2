"""Blocks: a sheet in squares of some pixels, of which most hold paper alone and cost one look.

Signals in: grey levels or darkness, (rows, columns). Signals out: mean, lightest and darkest of each block;
and the runs of pixels that are darker than a level behind a small spot, looked for only in the blocks that
are near something dark.

    ┌──┬──┬──┬──┐      a spot is no wider than a block: what it sees of a block (+) is between the lightest
    │  │. │+ │. │      and the darkest of that block and of the blocks about it (.); where none of these is
    │  │. │. │. │      dark enough, no pixel of it can be

Large sheets are worked on by two threads; the kernels let go of Python's lock.

Source: our own.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.compiled import njit
from morfax.tracer.drawing.components import Mask, Numbers
from morfax.tracer.drawing.spot import (
    column_of_spot,
    mirrored,
    row_of_spot,
    weights_of,
    with_mirrored,
)
from morfax.tracer.effort import FEW_PX

BLOCK_PX = 16  # of a sheet of darkness; by trial
GAP_PX = 64  # between stretches: a shorter one costs less than to begin anew; by trial
ABOUT = np.ones((3, 3), np.uint8)  # a block and those about it

Picture = NDArray[Any]
Levels = NDArray[np.float32]
Near = NDArray[np.uint8]
Runs = tuple[Numbers, Numbers, Numbers]


class Blocks(NamedTuple):
    """Mean, lowest and highest level of each block of `by` pixels; float32, (rows, columns) of blocks."""

    mean: Levels
    low: Levels
    high: Levels
    by: int

    @classmethod
    def of(cls, grey: Picture, by: int) -> Blocks:
        """The blocks of a picture; beyond the picture its last pixels are repeated."""
        shape = tuple(-(-side // by) for side in grey.shape)
        mean, low, high = (np.empty(shape, np.float32) for _ in range(3))
        blocks = cls(mean, low, high, by)
        sums = np.uint32 if grey.dtype == np.uint8 else np.float32
        row = np.empty(grey.shape[1], sums)
        in_parts(grey.size, shape[0], lambda a, b: _of_blocks(grey, blocks, row.copy(), a, b))
        return blocks


def in_parts(pixels: int, count: int, work: Callable[[int, int], Any]) -> list[Any]:
    """Work on rows 0 … count of a sheet of so many pixels, the two halves of a large one at the same time."""
    if pixels < FEW_PX or count < 2:
        return [work(0, count)]
    done, faults = list[Any](), list[BaseException]()

    def second_half() -> None:
        try:
            done.append(work(count // 2, count))
        except BaseException as fault:  # raised again below, in the thread that asked
            faults.append(fault)

    other = threading.Thread(target=second_half)
    other.start()
    try:
        first = work(0, count // 2)
    finally:
        other.join()
    if faults:
        raise faults[0]
    return [first, *done]


def darkest(darkness: Levels, by: int = BLOCK_PX) -> Levels:
    """The darkest pixel of each block of a sheet."""
    most = np.empty(tuple(-(-side // by) for side in darkness.shape), np.float32)
    in_parts(darkness.size, len(most), lambda a, b: _darkest(darkness, most, by, a, b))
    return most


def near(dark: NDArray[np.bool_]) -> Near:
    """Some blocks, and those about them."""
    return np.asarray(cv2.dilate(dark.view(np.uint8), ABOUT), np.uint8)


def runs_behind_spot(
    darkness: Levels, blocks: Near, by: int, spread_px: float, level: float
) -> Runs:
    """Row, begin and end of the runs in some blocks that are darker than a level behind a spot.

    `spread_px` is the standard deviation of the spot, which is no wider than a block to each side.
    """
    weights = weights_of(spread_px)
    assert len(weights) // 2 <= by
    found = in_parts(
        darkness.size,
        len(blocks),
        lambda a, b: _runs(darkness, blocks, by, weights, np.float32(level), a, b),
    )
    row, begin, end = (np.concatenate(part) for part in zip(*found, strict=True))
    return row, begin, end


def runs_in(darkness: Levels | Mask, level: float) -> Runs:
    """Row, begin and end of the runs of a picture that are darker than a level."""
    row, begin, end = _runs_in(np.ascontiguousarray(darkness), np.float32(level))
    return row, begin, end


@njit(cache=True, nogil=True)
def _of_blocks(grey, blocks, total, first, last):  # type: ignore[no-untyped-def]
    """Fill in some rows of blocks; `total` is a row of sums to work in."""
    rows, columns = grey.shape
    by, share = blocks.by, np.float32(1.0 / (blocks.by * blocks.by))
    low, high = grey[0].copy(), grey[0].copy()
    for i in range(first, last):
        total[:] = grey[i * by]
        low[:] = grey[i * by]
        high[:] = grey[i * by]
        for k in range(1, by):
            line = grey[min(i * by + k, rows - 1)]
            for j in range(columns):
                total[j] += line[j]
                low[j] = min(low[j], line[j])
                high[j] = max(high[j], line[j])
        for block in range(blocks.mean.shape[1]):
            begin, end = block * by, min(block * by + by, columns)
            whole, least, most = total[begin], low[begin], high[begin]
            for j in range(begin + 1, end):
                whole += total[j]
                least, most = min(least, low[j]), max(most, high[j])
            whole += total[columns - 1] * (begin + by - end)
            blocks.mean[i, block] = np.float32(whole) * share
            blocks.low[i, block], blocks.high[i, block] = least, most


@njit(cache=True, nogil=True)
def _darkest(darkness, most, by, first, last):  # type: ignore[no-untyped-def]
    """Fill in the darkest pixels of some rows of blocks."""
    rows, columns = darkness.shape
    dark = np.empty(columns, darkness.dtype)
    for i in range(first, last):
        dark[:] = darkness[i * by]
        for k in range(i * by + 1, min(i * by + by, rows)):
            line = darkness[k]
            for j in range(columns):
                dark[j] = max(dark[j], line[j])
        for block in range(most.shape[1]):
            most[i, block] = dark[block * by : block * by + by].max()


@njit(cache=True, nogil=True, fastmath={"contract"})
def _runs(darkness, blocks, by, weights, level, first, last):  # type: ignore[no-untyped-def]
    """The runs of some rows of blocks."""
    rows, columns = darkness.shape
    reach = len(weights) // 2
    across = np.empty((by + 2 * reach, columns), np.float32)
    line, seen = np.empty(columns + 2 * reach, np.float32), np.empty(columns, np.float32)
    crossings, found, count = np.empty(columns + 1, np.int64), np.empty((64, 3), np.int32), 0
    for i in range(first, last):
        top, bottom = i * by, min(i * by + by, rows)
        stretches = stretches_of(blocks[i], by, columns)
        # 1. the row of the spot, over the stretches of blocks that are near something dark
        for k in range(top - reach, bottom + reach):
            for stretch in stretches:
                begin, end = stretch[0], stretch[1]
                part = line[: end - begin + 2 * reach]
                with_mirrored(darkness[mirrored(k, rows)], begin - reach, part)
                row_of_spot(part, weights, across[k - top + reach, begin:end])
        # 2. its column, and where the level is crossed
        for k in range(top, bottom):
            for stretch in stretches:
                begin, end = stretch[0], stretch[1]
                part = seen[: end - begin]
                column_of_spot(across, begin, k - top + reach, weights, part)
                crossed = _crossed(part, level, crossings)
                found, count = _added(found, count, (k, begin), crossings[:crossed])
    return found[:count, 0].copy(), found[:count, 1].copy(), found[:count, 2].copy()


@njit(cache=True, nogil=True)
def _runs_in(seen, level):  # type: ignore[no-untyped-def]
    """The runs of all rows."""
    crossings, found, count = (
        np.empty(seen.shape[1] + 1, np.int64),
        np.empty((64, 3), np.int32),
        0,
    )
    for k in range(len(seen)):
        crossed = _crossed(seen[k], level, crossings)
        found, count = _added(found, count, (k, 0), crossings[:crossed])
    return found[:count, 0].copy(), found[:count, 1].copy(), found[:count, 2].copy()


@njit(cache=True, nogil=True)
def _added(found, count, place, crossings):  # type: ignore[no-untyped-def]
    """Runs with those of a row from a place (row, column) on, and how many there are then."""
    row, column = place
    if count + len(crossings) // 2 > len(found):
        more = np.empty((2 * (count + len(crossings)), 3), np.int32)
        more[:count] = found[:count]
        found = more
    for c in range(0, len(crossings), 2):
        found[count, 0] = row
        found[count, 1], found[count, 2] = column + crossings[c], column + crossings[c + 1]
        count += 1
    return found, count


@njit(cache=True, nogil=True)
def stretches_of(blocks, by, columns):  # type: ignore[no-untyped-def]
    """First and last + 1 pixel of the stretches of blocks that are set in a row, with short gaps; (n, 2)."""
    stretches, count = np.empty((len(blocks) // 2 + 1, 2), np.int64), 0
    for k in range(len(blocks)):
        if not blocks[k]:
            continue
        if count == 0 or k * by - stretches[count - 1, 1] > GAP_PX:
            stretches[count, 0] = k * by
            count += 1
        stretches[count - 1, 1] = min(k * by + by, columns)
    return stretches[:count]


@njit(cache=True, nogil=True)
def _crossed(seen, level, crossings):  # type: ignore[no-untyped-def]
    """Fill in where a line gets darker than a level, and lighter, in turn; returns how many places.

    Most pixels are as the one before: they are told in vectors.
    """
    inside, count = False, 0
    for begin in range(0, len(seen), GAP_PX):
        part = seen[begin : begin + GAP_PX]
        differs = False
        for j in range(len(part)):
            differs |= (part[j] > level) != inside
        if not differs:
            continue
        for j in range(len(part)):
            if (part[j] > level) != inside:
                crossings[count] = begin + j
                inside, count = not inside, count + 1
    if inside:
        crossings[count] = len(seen)
        count += 1
    return count
