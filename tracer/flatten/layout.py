"""The sheet with marks: which mark stands where, where the bar and the grid are, and where one draws.

Signals out: places in mm from the lower-left corner of the paper, Y up. Every mark of the dictionary stands
on one format of paper and at one place only, so that any few of them tell both.

    ┌─────────────────┐
    │ ▣   ▣   ▣   ▣   │   marks 10 mm, 8 mm from the edge of the paper: printers leave up to 6.4 mm white
    │   ┌─────────┐   │
    │ ▣ │  grid   │ ▣ │   numbers run clockwise from the upper left
    │   └─────────┘   │
    │   ├── bar ──┤   │
    │ ▣   ▣   ▣   ▣   │
    └─────────────────┘

Source: OpenCV's predefined dictionary DICT_4X4_50 (50 marks of 4 x 4 squares inside a black border).
Questions: 50 marks are enough for three formats; a sheet of another format has none.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.flatten.formats import FORMATS, Format

MARK_MM, MARGIN_MM = 10.0, 8.0  # side of a mark; from the edge of the paper
SQUARES = 6  # of a mark, along its side: four, and the border
QUIET_MM = 2.0  # white about a mark; one square is asked for (1.7 mm)
BAR_MM = 100.0  # as printed at 100 %
BAR_THICK_MM, BAR_END_MM = 0.6, 3.0  # the bar, and the strokes at its ends
BAR_CLEAR_MM = 0.8  # white below the bar
BAND_MM = 7.0  # height of the band with the bar and its words, above the lower marks
BESIDE_BAR_MM = 8.0  # of the band: the words are longer than the bar
GRID_MM = 10.0
# of each format: its first mark, and how many stand along the upper edge and down one side
FIRST = {"a4": (0, 4, 5), "letter": (14, 4, 5), "a3": (28, 5, 6)}

Box = tuple[float, float, float, float]  # left, bottom, right, top, mm


def dictionary() -> cv2.aruco.Dictionary:
    """The dictionary of the marks."""
    return cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)


def pattern(number: int) -> NDArray[np.bool_]:
    """The squares (rows from the top, columns) of a mark: where it is black."""
    return np.asarray(cv2.aruco.generateImageMarker(dictionary(), number, SQUARES) < 128)


@dataclass(frozen=True)
class Layout:
    """A sheet with marks on a format of paper."""

    paper: Format

    @classmethod
    def of(cls, name: str) -> Layout:
        """The sheet of a format; raises ValueError for one without marks."""
        if name not in FIRST:
            raise ValueError(f"{name!r} has no marks; give {', '.join(FIRST)}")
        return cls(FORMATS[name])

    @cached_property
    def marks_mm(self) -> dict[int, Array]:
        """The corners (4, 2) of each mark by its number, clockwise from the upper left, mm."""
        first, along, down = FIRST[self.paper.name]
        xs = np.linspace(MARGIN_MM, self.paper.width_mm - MARGIN_MM - MARK_MM, along)
        tops = np.linspace(self.paper.height_mm - MARGIN_MM, MARGIN_MM + MARK_MM, down)
        round_ = [
            *((x, tops[0]) for x in xs),
            *((xs[-1], top) for top in tops[1:]),
            *((x, tops[-1]) for x in xs[-2::-1]),
            *((xs[0], top) for top in tops[-2:0:-1]),
        ]
        corners = np.array([(0, 0), (MARK_MM, 0), (MARK_MM, -MARK_MM), (0, -MARK_MM)])
        return {first + k: corners + place for k, place in enumerate(round_)}

    @property
    def band_mm(self) -> Box:
        """The band in which the bar stands."""
        bottom = MARGIN_MM + MARK_MM + QUIET_MM
        middle = self.paper.width_mm / 2
        half = BAR_MM / 2 + BESIDE_BAR_MM
        return middle - half, bottom, middle + half, bottom + BAND_MM

    @property
    def bar_mm(self) -> Array:
        """The two ends (2, 2) of the bar: the outer edges of the strokes there, mm."""
        middle = self.paper.width_mm / 2
        y = self.band_mm[1] + BAR_CLEAR_MM + BAR_END_MM / 2
        return np.array([(middle - BAR_MM / 2, y), (middle + BAR_MM / 2, y)])

    @property
    def frame_mm(self) -> Box:
        """Where one draws: whole squares of the grid."""
        inset = MARGIN_MM + MARK_MM + QUIET_MM
        bottom = self.band_mm[3]
        top = self.paper.height_mm - inset
        columns = (self.paper.width_mm - 2 * inset) // GRID_MM
        rows = (top - bottom) // GRID_MM
        left = (self.paper.width_mm - columns * GRID_MM) / 2
        return left, top - rows * GRID_MM, left + columns * GRID_MM, top

    def printed_mm(self) -> list[Box]:
        """What is printed in black, with white about it: marks and the band of the bar."""
        boxes = [
            (left - QUIET_MM, low - QUIET_MM, right + QUIET_MM, high + QUIET_MM)
            for (left, high), _, (right, low), _ in self.marks_mm.values()
        ]
        return [*boxes, self.band_mm]


def layout_of(numbers: list[int]) -> Layout | None:
    """The sheet on which most of these marks stand; None without any."""
    counts = {name: len(Layout.of(name).marks_mm.keys() & set(numbers)) for name in FIRST}
    most = max(counts, key=lambda name: counts[name])
    return Layout.of(most) if counts[most] else None
