"""The sheet with marks, to be printed: in true size, vectors in a PDF or SVG.

Signals in: a layout (see `tracer.flatten.layout`). Out: a file, whole or not at all.

Squares of a mark are drawn as bars along and down, so that no hair of white is left between two of them.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.files import written_beside
from morfax.motion.units import MM_PER_INCH, POINTS_PER_INCH
from morfax.reports.canvas import new_figure
from morfax.tracer.flatten import layout as marked
from morfax.tracer.flatten.layout import Box, Layout

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

BLACK = "#000000"
CYAN = "#cdf3fc"  # hardly dark in green and blue light, in which a sheet with marks is read
GRID_LINE_MM = 0.15
POINTS_PER_MM = POINTS_PER_INCH / MM_PER_INCH
WORDS_PT = 6.0
PNG_DPI = 600.0
TOLD = (
    "morfax {name}: print at 100 %, then measure this bar; "
    "if it is not 100 mm long, give its length with --bar"
)


def write_sheet(layout: Layout, file: FilePath, *, grid: bool = True) -> None:
    """Write the sheet as .pdf, .svg or .png (600 dpi)."""
    kind = file.suffix[1:].lower()
    dated: dict[str, Any] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
    made = io.BytesIO()
    sheet(layout, grid=grid).savefig(made, format=kind, dpi=PNG_DPI, metadata=dated.get(kind))
    with written_beside(file) as unfinished:
        unfinished.write_bytes(made.getvalue())


def picture(layout: Layout, dpi: float) -> NDArray[np.uint8]:
    """The sheet as pixels (rows from the top, columns, 3)."""
    from PIL import Image

    made = io.BytesIO()
    sheet(layout).savefig(made, format="png", dpi=dpi)
    with Image.open(made) as image:
        return np.array(image.convert("RGB"))


def sheet(layout: Layout, *, grid: bool = True) -> Figure:
    """The sheet as a figure in true size."""
    paper = layout.paper
    figure = new_figure(paper.width_mm / MM_PER_INCH, paper.height_mm / MM_PER_INCH, "none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, paper.width_mm), ylim=(0, paper.height_mm))
    axes.set_axis_off()
    if grid:
        _grid(axes, layout.frame_mm)
    for number, corners_mm in layout.marks_mm.items():
        left, top = corners_mm[0]
        for x0, y0, x1, y1 in _black(marked.pattern(number)):
            _filled(axes, [left + x0, top - y1, left + x1, top - y0])
    _bar(axes, layout)
    return figure


def _grid(axes: Axes, frame_mm: Box) -> None:
    """Draw the faint grid."""
    left, bottom, right, top = frame_mm
    style: dict[str, Any] = {
        "colors": CYAN,
        "linewidth": GRID_LINE_MM * POINTS_PER_MM,
        "zorder": 0,
    }
    axes.vlines(np.arange(left, right + 1e-6, marked.GRID_MM), bottom, top, **style)
    axes.hlines(np.arange(bottom, top + 1e-6, marked.GRID_MM), left, right, **style)


def _bar(axes: Axes, layout: Layout) -> None:
    """Draw the bar with the strokes at its ends, and what to do with it."""
    (left, y), (right, _) = layout.bar_mm
    thick, half = marked.BAR_THICK_MM, marked.BAR_END_MM / 2
    _filled(axes, [left, y - thick / 2, right, y + thick / 2])
    for a, b in ((left, left + thick), (right - thick, right)):
        _filled(axes, [a, y - half, b, y + half])
    said = TOLD.format(name=layout.paper.name.upper())
    middle = (left + right) / 2
    top = layout.band_mm[3]
    axes.text(middle, top - 0.5, said, fontsize=WORDS_PT, ha="center", va="top", color=BLACK)


def _filled(axes: Axes, box: Any) -> None:
    """Fill a box: left, bottom, right, top, mm."""
    from matplotlib.patches import Rectangle

    left, bottom, right, top = box
    size = (float(right - left), float(top - bottom))
    axes.add_patch(
        Rectangle((float(left), float(bottom)), *size, color=BLACK, linewidth=0, snap=False)
    )


def _black(squares: NDArray[np.bool_]) -> Iterator[Box]:
    """Bars along and down that cover the black squares of a mark: left, top, right, bottom, mm."""
    side = marked.MARK_MM / marked.SQUARES
    for row, line in enumerate(squares):
        for a, b in _runs(line):
            yield a * side, row * side, b * side, (row + 1) * side
    for column, line in enumerate(squares.T):
        for a, b in _runs(line):
            yield column * side, a * side, (column + 1) * side, b * side


def _runs(line: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Where runs of True begin and end."""
    for black, run in groupby(range(len(line)), key=lambda k: bool(line[k])):
        numbers = list(run)
        if black:
            yield numbers[0], numbers[-1] + 1
