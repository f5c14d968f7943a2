"""Tiles: the sheet in squares of 512 pixels at halved sizes, so that a page shows 35 million pixels smoothly.

Signals in: a picture (rows, columns) uint8, and the numbers of its pixels' lines (uint16). Signals out: PNG
files. Level 0 has the picture's own pixels, each further level half as many a side.

    level 0   ▦▦▦▦▦▦▦▦     level 1   ▦▦▦▦     level 2   ▦▦     until one tile holds the sheet

A tile of lines has the number of a pixel's line in red (low byte) and green (high byte); the page paints it
in colours. A smaller level keeps a line as long as any of its pixels is in the square.
"""

from __future__ import annotations

from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

TILE = 512  # pixels a side
HELD = 512  # tiles that are kept as PNG
QUICK = [cv2.IMWRITE_PNG_COMPRESSION, 1]  # speed before size: the network is this computer


class Pyramid:
    """A picture, halved until it fits a tile."""

    def __init__(self, pixels: NDArray[np.uint8]) -> None:
        self.rows, self.columns = pixels.shape
        self.levels = [np.ascontiguousarray(pixels)]
        while max(self.levels[-1].shape) > TILE:
            rows, columns = self.levels[-1].shape
            half = (max(1, -(-columns // 2)), max(1, -(-rows // 2)))
            self.levels.append(
                np.asarray(
                    cv2.resize(self.levels[-1], half, interpolation=cv2.INTER_AREA), np.uint8
                )
            )
        self.tile = lru_cache(HELD)(self._tile)

    def _tile(self, level: int, column: int, row: int) -> bytes:
        """A tile as PNG; raises IndexError where there is none."""
        return _png(_square(self.levels, level, column, row))


class LineMap:
    """The numbers of the lines, at the same levels."""

    def __init__(self, numbers: NDArray[np.uint16]) -> None:
        self.rows, self.columns = numbers.shape
        self.levels = [numbers]
        while max(self.levels[-1].shape) > TILE:
            self.levels.append(_halved(self.levels[-1]))
        self.tile = lru_cache(HELD)(self._tile)

    def _tile(self, level: int, column: int, row: int) -> bytes:
        """A tile as PNG; raises IndexError where there is none."""
        square = _square(self.levels, level, column, row)
        alpha = np.where(square > 0, 255, 0)
        colours = np.stack([np.zeros_like(square), square >> 8, square & 255, alpha], axis=-1)
        return _png(colours.astype(np.uint8))  # OpenCV's order: blue, green, red, alpha


def _halved(numbers: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """Half as many pixels a side: of four numbers the lowest that is one, so that no line gets lost."""
    rows, columns = numbers.shape
    even = np.zeros((rows + rows % 2, columns + columns % 2), np.uint16)
    even[:rows, :columns] = numbers
    even -= 1  # none becomes the largest
    low = np.minimum(even[::2], even[1::2])
    low = np.minimum(low[:, ::2], low[:, 1::2])
    return np.asarray(low + 1, np.uint16)


def _square(levels: list[NDArray], level: int, column: int, row: int) -> NDArray:  # type: ignore[type-arg]
    """The pixels of a tile; raises IndexError where there is none."""
    if not 0 <= level < len(levels) or column < 0 or row < 0:
        raise IndexError
    top, left = row * TILE, column * TILE
    square = levels[level][top : top + TILE, left : left + TILE]
    if not square.size:
        raise IndexError
    return square


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """Pixels as a PNG file."""
    done, data = cv2.imencode(".png", pixels, QUICK)
    assert done
    return bytes(data)
