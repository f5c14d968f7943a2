"""Tiles: the darkness of a large sheet in bytes, of which only the tiles with ink are kept.

Signals: bytes by tiles in; the darkness of any part of the sheet out: float32, 0 = paper, 1 = ink.

      .  .  .  .  .       a tile is 32 pixels square; `number` says where each stands among those that are
      .  ▓  ▓  .  .       kept, and -1 where there is paper, which is 0 everywhere
      .  .  ▓  ▓  .

    darkness = byte · unit          unit = 1 / contrast of the ink: 1/200 on a usual scan

A sheet of A0 at 600 dpi has 558 million pixels, and a line of 10 m on it takes 15 MB.

Source: our own. Questions: 200 steps of darkness move the head by less than 0.01 um (measured on smooth
outlines: 1.842 and 1.846 um RMS). Paper between the tiles has lost its noise.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit

TILE_PX = 32
# of a pixel's number: its tile, and where it is in it
SHIFT, WITHIN = TILE_PX.bit_length() - 1, TILE_PX - 1
PAPER = -1  # in the place of a tile's number
BAND_PX = 256  # rows that are looked at together

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Tiles:
    """Darkness of a sheet (rows from the top, columns): numbers of its tiles, and the bytes of those."""

    shape: tuple[int, int]
    number: NDArray[np.int32]  # (rows of tiles, tiles in a row)
    kept: NDArray[np.uint8]  # (n, TILE_PX, TILE_PX)
    unit: float  # darkness of one step

    @property
    def size(self) -> int:
        """How many pixels the sheet has."""
        return self.shape[0] * self.shape[1]

    def __len__(self) -> int:
        """How many rows the sheet has."""
        return self.shape[0]

    def window(self, top: int, bottom: int, left: int, right: int) -> Floats:
        """The darkness of some rows and columns."""
        out = np.zeros((max(bottom - top, 0), max(right - left, 0)), np.float32)
        _window(self.number, self.kept, self.unit, (top, left), out)
        return out

    def __getitem__(self, key: Any) -> Floats:
        """The darkness of rows, of rows and columns (slices without steps), or of places (two arrays)."""
        rows, columns = key if isinstance(key, tuple) else (key, slice(None))
        if isinstance(rows, slice) and isinstance(columns, slice):
            top, bottom, down = rows.indices(self.shape[0])
            left, right, along = columns.indices(self.shape[1])
            if down == along == 1:
                return self.window(top, bottom, left, right)
        elif not isinstance(rows, slice) and not isinstance(columns, slice):
            return self.at(np.asarray(rows), np.asarray(columns))
        raise TypeError(
            f"the tiles of a large sheet have no part {key}; ask for slices or for places"
        )

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """All of the darkness: 4 bytes for each pixel of the sheet."""
        return np.asarray(self.window(0, self.shape[0], 0, self.shape[1]), dtype)

    def copy(self) -> Floats:
        """All of the darkness, to be changed."""
        return np.asarray(self)

    def at(self, rows: NDArray[Any], columns: NDArray[Any]) -> Floats:
        """The darkness of pixels; that of the nearest one beyond the sheet."""
        i = np.clip(rows, 0, self.shape[0] - 1).astype(np.int64)
        j = np.clip(columns, 0, self.shape[1] - 1).astype(np.int64)
        number = self.number[i >> SHIFT, j >> SHIFT]
        byte = self.kept[np.maximum(number, 0), i & WITHIN, j & WITHIN]
        return np.where(number == PAPER, np.float32(0), byte * np.float32(self.unit))

    def between(self, rows: Array, columns: Array) -> Array:
        """The darkness between pixels."""
        i, j = np.floor(rows), np.floor(columns)
        down, along = rows - i, columns - j
        above = self.at(i, j) * (1 - along) + self.at(i, j + 1) * along
        below = self.at(i + 1, j) * (1 - along) + self.at(i + 1, j + 1) * along
        return np.asarray(above * (1 - down) + below * down, float)

    def darker_px(self, than: float) -> int:
        """How many pixels are darker than this."""
        return int(np.count_nonzero(self.kept > than / self.unit))

    def shrunk(self, by: int) -> Floats:
        """The mean darkness of each square of so many pixels; of whole squares only."""
        out = np.zeros((self.shape[0] // by, self.shape[1] // by), np.float32)
        _shrunk(self.number, self.kept, self.unit / by**2, by, out)
        return out

    def bands(self) -> Iterator[tuple[int, int, slice]]:
        """First row and last row + 1 of each band that has ink, and the columns with ink."""
        rows, columns = self.shape
        for top in range(0, rows, BAND_PX):
            bottom = min(rows, top + BAND_PX)
            inked = self.number[top >> SHIFT : -(-bottom >> SHIFT)] != PAPER
            found = np.flatnonzero(inked.any(axis=0))
            if len(found):
                left, right = int(found[0]) * TILE_PX, int(found[-1] + 1) * TILE_PX
                yield top, bottom, slice(left, min(columns, right))


Kept = NDArray[np.float32] | Tiles  # the darkness of a sheet, large or not


def paper_like(darkness: Tiles, pixels: tuple[slice, NDArray[np.bool_]]) -> None:
    """Make pixels of some rows paper: a mask (rows, columns), in place."""
    rows, mask = pixels
    i, j = np.nonzero(mask)
    i = i + rows.start
    number = darkness.number[i >> SHIFT, j >> SHIFT]
    own = number != PAPER
    darkness.kept[number[own], i[own] & WITHIN, j[own] & WITHIN] = 0


@njit(cache=True)
def _window(number, kept, unit, corner, out):  # type: ignore[no-untyped-def]
    """Fill zeros with the darkness from a corner (row, column) on."""
    rows, columns = out.shape
    top, left = corner
    for i in range(rows):
        a = (top + i) & WITHIN
        j = 0
        while j < columns:
            b = (left + j) & WITHIN
            wide = min(TILE_PX - b, columns - j)
            tile = number[(top + i) >> SHIFT, (left + j) >> SHIFT]
            if tile >= 0:
                for k in range(wide):
                    out[i, j + k] = kept[tile, a, b + k] * unit
            j += wide


@njit(cache=True)
def _shrunk(number, kept, share, by, out):  # type: ignore[no-untyped-def]
    """Add the shares of all pixels to the squares that they lie in."""
    for up in range(number.shape[0]):
        for along in range(number.shape[1]):
            tile = number[up, along]
            if tile < 0:
                continue
            for a in range(TILE_PX):
                i = (up * TILE_PX + a) // by
                for b in range(TILE_PX):
                    j = (along * TILE_PX + b) // by
                    if i < out.shape[0] and j < out.shape[1]:
                        out[i, j] += kept[tile, a, b] * share
