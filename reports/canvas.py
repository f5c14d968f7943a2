"""The canvas of pictures: a figure of matplotlib, the drawing in grey, a file that is whole or absent.

matplotlib takes most of a second to import: nothing here does it before a picture is asked for.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.files import printable, written_beside
from morfax.motion.polyline import UM
from morfax.reports.plate import Ground, View

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from morfax.tracer.drawing.drawing import Drawing

UM_PER_MM = 1 / UM
SMALLEST_UM = 0.01  # that a scale shows
WIDTH_IN = 8.0  # of what is drawn
WIDE_IN = 11.0  # a figure of several pictures
PANEL_IN = 1.8  # height of a curve over time or way
ROOM_IN = 0.75  # beside axes, for the numbers along them and their names
NUMBERS_IN = 2 * ROOM_IN
LIGHT = 2.5  # ink is so much lighter, for a path to lie on
FLATTEST, TALLEST = 0.2, 1.4  # height to width of what is drawn
DPI = 130
LARGEST_IMAGE_PX = 2000  # a larger drawing is reduced for the picture
REFERENCE = "#555555"
# from no darkness to all: "Greys" of matplotlib
GREYS = 255, 240, 217, 189, 150, 115, 82, 37, 0
COMPRESSION = 3  # of zlib: a fifth larger than with 6, in two fifths of the time


def new_figure(
    width_in: float = WIDTH_IN, height_in: float = WIDTH_IN, layout: str = "constrained"
) -> Figure:
    """An empty figure that needs no screen."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), layout=layout, dpi=DPI)  # type: ignore[arg-type]
    FigureCanvasAgg(figure)
    return figure


def sheet_figure(width_mm: float, height_mm: float) -> Figure:
    """An empty figure for a sheet with its axes' numbers and a title."""
    high = min(max(height_mm / width_mm, FLATTEST), TALLEST)
    return new_figure(WIDTH_IN, NUMBERS_IN + high * WIDTH_IN, "compressed")


def save(figure: Figure, file: FilePath, *, trim: bool = True) -> None:
    """Write a figure whole or not at all; `trim`: cut to what is drawn, for which it is drawn twice."""
    from matplotlib.text import Text

    for words in figure.findobj(Text) if trim else _own_words(figure):
        assert isinstance(words, Text)
        words.set_text(printable(words.get_text()))  # a file's name may hold any bytes
        words.set_parse_math(False)
    made = io.BytesIO()  # since not every kind of picture notices a full disk
    kind = file.suffix[1:].lower()
    how: dict[str, Any] = {"bbox_inches": "tight", "pad_inches": 0.15} if trim else {}
    if kind == "png":
        how["pil_kwargs"] = {"compress_level": COMPRESSION}
    figure.savefig(made, format=kind, dpi=DPI, **how)
    write(made.getvalue(), file)


def write(picture: bytes, file: FilePath) -> None:
    """Write a picture whole or not at all."""
    with written_beside(file) as unfinished:
        unfinished.write_bytes(picture)


def _own_words(figure: Figure) -> Iterator[Any]:
    """All words of a figure but the numbers along its axes: `findobj` would make those a second time."""
    for axes in figure.axes:
        legend = axes.get_legend()
        yield from (axes.title, *axes.texts, *(legend.get_texts() if legend else ()))


def show_drawing(axes: Axes, drawing: Drawing, view: View, darkest: float) -> View:
    """Draw the part of the drawing in a view, ink as 1 / `darkest`; the part of the sheet that is shown."""
    darkness, extent = _cut_out(drawing, view)
    axes.imshow(
        darkness,
        extent=extent,
        cmap="Greys",
        vmin=0,
        vmax=darkest,
        interpolation="nearest",
        zorder=0,
    )
    return extent


def grey(drawing: Drawing, view: View, darkest: float) -> Ground:
    """The part of the drawing in a view as a grey picture, ink as 1 / `darkest`."""
    darkness, extent = _cut_out(drawing, view)
    steps = np.linspace(0, 1 / darkest, 256)
    shown = np.interp(steps, np.linspace(0, 1, len(GREYS)), GREYS).round().astype(np.uint8)
    return Ground(shown[np.clip(darkness * 255, 0, 255).astype(np.uint8)], extent)


def _cut_out(drawing: Drawing, view: View) -> tuple[Any, View]:
    """The part of the drawing within the view, not larger than needed, and its extent in sheet mm."""
    pitch_mm, (rows, columns) = drawing.pitch_mm, drawing.darkness.shape
    across_px = [view[0] / pitch_mm, view[1] / pitch_mm + 1]
    down_px = [rows - view[3] / pitch_mm, rows - view[2] / pitch_mm + 1]
    left, right = np.clip(across_px, 0, columns).astype(int)
    top, bottom = np.clip(down_px, 0, rows).astype(int)
    part: Any = drawing.darkness[top:bottom, left:right]
    low_mm = (rows - bottom) * pitch_mm
    high_mm = (rows - top) * pitch_mm
    extent = (float(left * pitch_mm), float(right * pitch_mm), float(low_mm), float(high_mm))
    if max(part.shape) > LARGEST_IMAGE_PX:
        import cv2

        scale = LARGEST_IMAGE_PX / max(part.shape)
        part = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return part, extent
