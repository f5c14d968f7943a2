"""The aperture on a large sheet: what a cell sees there is made where the head goes.

Signals: tiles of a large sheet (see `drawing.tiles`) and the spot of a cell in; the darkness behind that
spot, between pixels and in windows, out.

    the sheet's tiles, 32 px, bytes      ░░▓▓░░░░
    made tiles, 16 px, floats               ▒▒      the newest `ROOM` of them: where the head is, and looks

A made tile has one row and one column more, so that the four pixels about any place are in one tile. The
oldest tile gives way to a new one.

Source: our own. Questions: behind the spot the sheet is the same as when it is made as a whole, but for the
rounding of its bytes and the noise of bare paper.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import lasting, njit
from morfax.tracer.drawing import tiles as sheet

SHIFT = 4  # of a pixel's number: its made tile
SIDE_PX = 1 << SHIFT
WITHIN = SIDE_PX - 1
ROOM = 4096  # made tiles that are kept, 5 MB: 2 m of a line at 600 dpi
PAPER, NOT_MADE = -2, -1
# standard deviations of the spot that are looked at to either side: as OpenCV does
SPREADS = 4.0


class MadeTiles(NamedTuple):
    """The sheet's rows and columns (0 for a sheet that is no large one), its tiles and their unit; the spot's
    spread and weights; of each made tile where it stands, and the tiles, whose they are, and the next to go.
    """

    rows: int
    columns: int
    number: NDArray[np.int32]
    kept: NDArray[np.uint8]
    unit: float
    spread_px: float
    weights: Array
    place: NDArray[np.int32]
    made: NDArray[np.float32]
    owner: NDArray[np.int32]
    next: NDArray[np.int64]

    @classmethod
    def of(cls, tiles: sheet.Tiles, spread_px: float) -> MadeTiles:
        """The tiles of a large sheet behind a spot of a standard deviation; 0 is no spot at all."""
        rows, columns = tiles.shape
        return cls(
            rows,
            columns,
            tiles.number,
            tiles.kept
            if len(tiles.kept)
            else np.zeros((1, sheet.TILE_PX, sheet.TILE_PX), np.uint8),
            float(tiles.unit),
            float(spread_px),
            _weights(spread_px),
            np.full((-(-rows // SIDE_PX), -(-columns // SIDE_PX)), NOT_MADE, np.int32),
            np.zeros((ROOM, SIDE_PX + 1, SIDE_PX + 1), np.float32),
            np.full((ROOM, 2), -1, np.int32),
            np.zeros(1, np.int64),
        )

    def wider(self, spread_px: float) -> MadeTiles:
        """The same sheet behind a further spot."""
        shape = self.rows, self.columns
        whole = sheet.Tiles(shape, self.number, self.kept, self.unit)
        return MadeTiles.of(whole, math.hypot(self.spread_px, spread_px))


NONE = lasting(
    MadeTiles(
        0,
        0,
        np.empty((0, 0), np.int32),
        np.empty((0, 0, 0), np.uint8),
        0.0,
        0.0,
        np.empty(0),
        np.empty((0, 0), np.int32),
        np.empty((0, 0, 0), np.float32),
        np.empty((0, 2), np.int32),
        np.zeros(1, np.int64),
    )
)


def window(
    tiles: MadeTiles, top: int, bottom: int, left: int, right: int
) -> NDArray[np.float32]:
    """What cells see at the pixels of some rows and columns of a large sheet; only those on the sheet."""
    bottom = min(bottom, tiles.rows)
    right = min(right, tiles.columns)
    out = np.empty((max(bottom - top, 0), max(right - left, 0)), np.float32)
    _window(tiles, top, left, out)
    return out


def _weights(spread_px: float) -> Array:
    """The weights of a spot along a row or a column; their sum is 1."""
    if spread_px <= 0.0:
        return np.ones(1)
    half = math.ceil(SPREADS * spread_px)
    weights = np.exp(-0.5 * (np.arange(-half, half + 1) / spread_px) ** 2)
    return np.asarray(weights / weights.sum(), float)


@njit(cache=True)
def darkness_at(tiles, x_px, y_px):  # type: ignore[no-untyped-def]
    """Darkness behind the spot at a place in pixels from the sheet's lower-left corner; paper outside."""
    x = x_px - 0.5
    y = tiles.rows - y_px - 0.5
    i, j = math.floor(y), math.floor(x)
    if i < 0 or j < 0 or i >= tiles.rows - 1 or j >= tiles.columns - 1:
        return 0.0
    return between(tiles, int(i), int(j), y - i, x - j)


@njit(cache=True)
def between(tiles, i, j, down, along):  # type: ignore[no-untyped-def]
    """Darkness behind the spot, a share of a pixel down and along from pixel i, j."""
    place = tiles.place[i >> SHIFT, j >> SHIFT]
    if place == NOT_MADE:
        place = _make(tiles, i >> SHIFT, j >> SHIFT)
    if place == PAPER:
        return 0.0
    seen = tiles.made[place]
    a = i & WITHIN
    b = j & WITHIN
    above = seen[a, b] * (1 - along) + seen[a, b + 1] * along
    below = seen[a + 1, b] * (1 - along) + seen[a + 1, b + 1] * along
    return above * (1 - down) + below * down


@njit(cache=True, _nrt=True)
def _make(tiles, up, across):  # type: ignore[no-untyped-def]
    """Make a tile, in the place of the oldest; its place, or PAPER where there is no ink about it."""
    weights, half = tiles.weights, len(tiles.weights) // 2
    size = SIDE_PX + 1 + 2 * half
    top = up * SIDE_PX - half
    left = across * SIDE_PX - half
    # 1. the sheet about it
    part, is_inked = np.zeros((size, size)), False
    for a in range(size):
        row = min(max(top + a, 0), tiles.rows - 1)
        for b in range(size):
            column = min(max(left + b, 0), tiles.columns - 1)
            number = tiles.number[row >> sheet.SHIFT, column >> sheet.SHIFT]
            if number >= 0:
                is_inked = True
                byte = tiles.kept[number, row & sheet.WITHIN, column & sheet.WITHIN]
                part[a, b] = byte * tiles.unit
    if not is_inked:
        tiles.place[up, across] = PAPER
        return PAPER
    # 2. a place for it
    place = tiles.next[0]
    tiles.next[0] = (place + 1) % len(tiles.made)
    if tiles.owner[place, 0] >= 0:
        tiles.place[tiles.owner[place, 0], tiles.owner[place, 1]] = NOT_MADE
    tiles.owner[place, 0], tiles.owner[place, 1] = up, across
    tiles.place[up, across] = place
    # 3. behind the spot: along the rows, then down the columns
    rows = np.zeros((size, SIDE_PX + 1))
    for a in range(size):
        for b in range(SIDE_PX + 1):
            for k in range(len(weights)):
                rows[a, b] += weights[k] * part[a, b + k]
    for a in range(SIDE_PX + 1):
        for b in range(SIDE_PX + 1):
            seen = 0.0
            for k in range(len(weights)):
                seen += weights[k] * rows[a + k, b]
            tiles.made[place, a, b] = seen
    return place


@njit(cache=True)
def _window(tiles, top, left, out):  # type: ignore[no-untyped-def]
    """Fill a window with what is seen at its pixels."""
    for a in range(out.shape[0]):
        for b in range(out.shape[1]):
            out[a, b] = between(tiles, top + a, left + b, 0.0, 0.0)
