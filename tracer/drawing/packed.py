"""A mask at a bit to the pixel, for one that lasts: an eighth of the memory.

Signals: a mask (rows, columns) in; the same, or what it says of some pixels, out.

Source: our own. Questions: none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import Mask
from morfax.tracer.drawing.thinning import Indices


class PackedMask(NamedTuple):
    """A mask whose pixels are bits, eight columns to a byte."""

    bits: NDArray[np.uint8]
    columns: int

    @classmethod
    def of(cls, mask: Mask) -> PackedMask:
        """Pack a mask."""
        return cls(np.packbits(mask, axis=1), mask.shape[1])

    @property
    def shape(self) -> tuple[int, int]:
        """How many rows and columns it has."""
        return len(self.bits), self.columns

    def any(self) -> bool:
        """Whether any pixel is in it."""
        return bool(self.bits.any())

    def mask(self) -> Mask:
        """The mask, made anew."""
        return np.unpackbits(self.bits, axis=1, count=self.columns)

    def at(self, rows: Indices, columns: Indices) -> NDArray[np.bool_]:
        """Whether some pixels are in it."""
        return np.asarray(self.bits[rows, columns >> 3] & (128 >> (columns & 7)) > 0)
