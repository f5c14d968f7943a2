"""The whole sheet with a grid, so that a place on it can be read off its axes."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.reports.canvas import LIGHT, REFERENCE, save, sheet_figure, show_drawing
from morfax.reports.looks import GRID, SEE_THROUGH, SPOT_PT, WORDS_PT

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

MARKS = (("x", "#c1121f"), ("+", "#1f5fa8"))


def draw_sheet(
    drawing: Drawing, places_mm: dict[str, tuple[float, float]], file: FilePath
) -> None:
    """Write a picture of the whole sheet, with a grid and with named places as far as they lie on it."""
    width_mm, height_mm = drawing.width_mm, drawing.height_mm
    figure = sheet_figure(width_mm, height_mm)
    axes = figure.add_subplot()
    extent = show_drawing(axes, drawing, (0.0, width_mm, 0.0, height_mm), LIGHT)
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    axes.grid(color=REFERENCE, **GRID)
    for (name, (x, y)), (marker, colour) in zip(places_mm.items(), MARKS, strict=False):
        if extent[0] <= x <= extent[1] and extent[2] <= y <= extent[3]:
            label = f"{name} {x:.1f},{y:.1f}"
            style = {"markersize": 2 * SPOT_PT, "linestyle": "none"}
            axes.plot(x, y, marker, color=colour, label=label, **style)  # type: ignore[arg-type]
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper right", fontsize=WORDS_PT, framealpha=SEE_THROUGH)
    save(figure, file)
