"""Windows: the part of a sheet about some places, in its own pixels and in mm, and what cells see of it.

Signals: a drawing and places (n, 2) mm in; rows and columns, or a view, out.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.plain_places import view_of
from morfax.tracer.sensing.view import View


class SheetWindow(NamedTuple):
    """A part of a sheet: its first row and column, the one after its last, and what makes pixels of mm."""

    top: int
    left: int
    bottom: int
    right: int
    rows: int
    pitch_mm: float

    @classmethod
    def about(cls, drawing: Drawing, places: Array, reach_mm: float) -> SheetWindow:
        """About some places (n, 2) mm, as far as that."""
        pitch_mm, (rows, columns) = drawing.pitch_mm, drawing.darkness.shape
        low, high = places.min(axis=0) - reach_mm, places.max(axis=0) + reach_mm
        left, top = max(int(low[0] / pitch_mm), 0), max(int(rows - high[1] / pitch_mm), 0)
        right = min(int(high[0] / pitch_mm) + 1, columns)
        bottom = min(int(rows - low[1] / pitch_mm) + 1, rows)
        return cls(top, left, bottom, right, rows, pitch_mm)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.bottom - self.top, self.right - self.left

    def grid(self) -> NDArray[np.int64]:
        """Row and column on the sheet of all its pixels, (2, n)."""
        rows, columns = slice(self.top, self.bottom), slice(self.left, self.right)
        return np.mgrid[rows, columns].reshape(2, -1)

    def of(self, pixels: NDArray[np.generic]) -> NDArray[np.generic]:
        """The part of all pixels of the sheet."""
        return pixels[self.top : self.bottom, self.left : self.right]

    def pixels(self, places: Array) -> NDArray[np.int32]:
        """Column and row (n, 2) of places (n, 2) mm on the sheet, from its own left top corner."""
        column = (places[:, 0] / self.pitch_mm).astype(np.int32) - self.left
        row = (self.rows - places[:, 1] / self.pitch_mm).astype(np.int32) - self.top
        return np.column_stack([column, row])

    def place_mm(self, column: float, row: float) -> tuple[float, float]:
        """The place on the sheet of the middle of a pixel within it."""
        x_px, y_px = self.left + column + 0.5, self.rows - self.top - row - 0.5
        return x_px * self.pitch_mm, y_px * self.pitch_mm


def view_about(
    sheet: Sheet, aperture_mm: float | None, width_mm: float, places: Array, reach_mm: float
) -> View:
    """What is about some places (n, 2) mm, as far as that, through cells for a line of a width: of a sheet no
    more than that is made.
    """
    if sheet.window is None:
        window = SheetWindow.about(sheet.drawing, places, reach_mm)
        edges = window.top, window.left, window.bottom, window.right
        sheet = replace(sheet, window=edges)
    return view_of(sheet, aperture_mm, width_mm)
