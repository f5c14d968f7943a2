"""The numbered sheet: each line in a colour with its number, what has no number in grey.

Signals in: the result of the job `lines`. Out: a picture; its axes are sheet coordinates in mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from morfax.motion.units import POINTS_PER_INCH
from morfax.reports import corrected, labels, vector
from morfax.reports.canvas import DPI, LARGEST_IMAGE_PX, REFERENCE, save, sheet_figure
from morfax.reports.looks import BESIDE_PT, LINE_PT, SPOT_PT, TITLE_PT, WORDS_PT
from morfax.reports.plate import Caption, Mark, Plate, Polyline, Spot, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.jobs.lines import LinesResult
    from morfax.tracer.program.survey import Entry, Survey

COLOURS = (
    "#1f5fa8",
    "#c1121f",
    "#2a8f4f",
    "#8a3fa0",
    "#d9822b",
    "#0f8b8d",
    "#b5338a",
    "#6b4f1d",
)
LEFT_OUT = "#b0b0b0"
LETTERING = "#e0b000"
PAPER = 255


def draw_numbered(result: LinesResult) -> None:
    """Draw the sheet with its lines in colours, and their numbers."""
    if result.picture is None:
        return
    drawing, seen = result.drawing, result.survey
    width_mm, height_mm = drawing.width_mm, drawing.height_mm
    figure = sheet_figure(width_mm, height_mm)
    axes = figure.add_subplot()
    extent = (0.0, width_mm, 0.0, height_mm)
    image = _painted(seen)
    axes.imshow(image, extent=extent, interpolation="nearest", zorder=0)
    for line in seen.lines:
        colour = _colour(line.number)
        axes.plot(*line.places_mm.T, color=colour, linewidth=LINE_PT, zorder=2)
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    if drawing.corrected is not None:
        for mark in corrected.marks(drawing.corrected):
            vector.put(axes, mark)
    _legend(axes, seen)
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)  # which gives the axes their size
    _put_numbers(axes, seen, _inked(image, extent), extent)
    name = drawing.file.name if drawing.file else "drawing"
    axes.set_title(f"{name}: numbers for --lines", fontsize=TITLE_PT)
    save(figure, result.picture)


def _colour(number: int) -> str:
    """The colour of a number."""
    return COLOURS[(number - 1) % len(COLOURS)]


def _painted(seen: Survey) -> NDArray[np.uint8]:
    """The sheet's ink in colours, reduced to a size for a picture; (rows, columns, 3)."""
    patches = seen.sheet.patches
    rows, columns = seen.sheet.drawing.darkness.shape
    of_patch = np.full((patches.count, 3), _rgb(LEFT_OUT), np.uint8)
    of_patch[list(seen.lettering)] = _rgb(LETTERING)
    for entry in seen.entries:
        if entry.joined_to is None and entry.is_in_contours and not entry.is_lettering:
            of_patch[entry.patch] = _rgb(LEFT_OUT if seen.lines else _colour(entry.number))
    down = max(1, -(-max(rows, columns) // LARGEST_IMAGE_PX))
    image = np.full((-(-rows // down), -(-columns // down), 3), 255, np.uint8)
    for row, begin, end, patch in zip(
        patches.row // down,
        patches.begin // down,
        -(-patches.end // down),
        patches.patch,
        strict=True,
    ):
        image[row, begin:end] = of_patch[patch]
    return image


def _rgb(colour: str) -> tuple[int, ...]:
    """Red, green and blue of #rrggbb."""
    return tuple(int(colour[at : at + 2], 16) for at in (1, 3, 5))


def _number(entry: Entry) -> Iterator[Mark]:
    """The number beside a place of its line, and the ring of a dot."""
    colour = _colour(entry.number) if entry.is_in_contours else REFERENCE
    if entry.kind == "dot":
        yield Spot(entry.place_mm, "o", SPOT_PT, colour)
    text = str(entry.number) if entry.is_in_contours else f"({entry.number})"
    yield Caption(entry.place_mm, text, WORDS_PT, colour, BESIDE_PT, ring=colour)


def _inked(image: NDArray[np.uint8], extent: View) -> Polyline:
    """The ink of a painted sheet, as places that numbers keep clear of."""
    rows, columns = np.nonzero(image.min(axis=2) < PAPER)
    places = np.full((2 * len(rows), 2), np.nan)  # with a gap behind each
    places[::2, 0] = (columns + 0.5) / image.shape[1] * extent[1]
    places[::2, 1] = (1 - (rows + 0.5) / image.shape[0]) * extent[3]
    return Polyline(places, LEFT_OUT, LINE_PT)


def _put_numbers(axes: Axes, seen: Survey, ink: Polyline, view: View) -> None:
    """Write the numbers, each where it hides neither another nor the ink."""
    plate = Plate(view, marks=[mark for entry in seen.entries for mark in _number(entry)])
    plate.add(ink)
    box = axes.get_window_extent()
    pt_per_px = POINTS_PER_INCH / DPI
    labels.spread(plate, box.width * pt_per_px, box.height * pt_per_px)
    for mark in plate.marks:
        if mark is not ink:
            vector.put(axes, mark)


def _legend(axes: Axes, seen: Survey) -> None:
    """Say what the two further colours are."""
    if seen.left_out or seen.lines:
        axes.plot([], [], color=LEFT_OUT, linewidth=4, label="left out, or not a line")
    if seen.lettering:
        axes.plot([], [], color=LETTERING, linewidth=4, label="likely lettering")
    if axes.get_legend_handles_labels()[0]:
        axes.figure.legend(loc="outside lower right", ncols=2, fontsize=WORDS_PT)
