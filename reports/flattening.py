"""How a photograph was made flat, as a picture: what was found in it, how far off, and the flat sheet.

Left the photograph, with the sheet's outline and, at each mark or stretch of an edge, an arrow that shows how
far it lies off, enlarged; right the sheet as the head sees it, with axes in mm.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from morfax.motion.arrays import NOT_ZERO
from morfax.motion.units import drawn_length_mm
from morfax.reports.canvas import LIGHT, WIDE_IN, WIDTH_IN, new_figure, save, show_drawing
from morfax.reports.looks import GRID, WORDS_PT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.flatten.flat import Flattening

OUTLINE, ARROW = "#1f5fa8", "#c1121f"
LONGEST_SHARE = 0.08  # of the photograph: the longest arrow
OUTLINE_PLACES = 40  # on a side of the sheet, so that the lens shows
ARROW_WIDTH = 0.004  # of the picture


def draw_flattening(drawing: Drawing, file: FilePath) -> None:
    """Write the picture of a drawing that was made flat."""
    made = drawing.flattening
    if made is None:
        return
    figure = new_figure(WIDE_IN, WIDTH_IN)
    photo, flat = figure.subplots(1, 2)
    _draw_photograph(photo, made)
    extent = show_drawing(flat, drawing, (0.0, drawing.width_mm, 0.0, drawing.height_mm), LIGHT)
    flat.set(xlim=extent[:2], ylim=extent[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    finest_mm, coarsest_mm = (drawn_length_mm(pixel_mm) for pixel_mm in made.mm_per_px)
    flat.set_title(
        f"flat: {made.told}; a pixel is {finest_mm} to {coarsest_mm}", fontsize=WORDS_PT
    )
    flat.grid(**GRID)
    save(figure, file)


def _draw_photograph(axes: Axes, made: Flattening) -> None:
    """Draw the photograph with the sheet's outline and what is off."""
    size = made.projection.photo
    assert made.reduced is not None
    axes.imshow(made.reduced, extent=(0, size.width, size.height, 0))
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)], float)
    shares = np.linspace(0, 1, OUTLINE_PLACES, endpoint=False)[:, None]
    around = np.vstack([a + shares * (b - a) for a, b in pairwise(corners)])
    sheet = made.projection.sheet
    x, y = made.projection.to_photo(
        np.vstack([around, corners[:1]]) * (sheet.width, sheet.height)
    ).T
    axes.plot(x, y, color=OUTLINE, linewidth=1)
    title = f"tilt {math.degrees(made.tilt_rad):.1f} degrees"
    if made.fit is not None:
        title += _draw_residual(axes, made)
    axes.set(
        xlim=(0, size.width), ylim=(size.height, 0), xlabel="px", ylabel="px", aspect="equal"
    )
    axes.set_title(title, fontsize=WORDS_PT)


def _draw_residual(axes: Axes, made: Flattening) -> str:
    """Draw an arrow for each mark or stretch that is off; how far they are, in words."""
    assert made.fit is not None
    fit, projection = made.fit, made.projection
    middles_px, off_mm = fit.displaced
    step = 1e-3
    at = projection.to_sheet(middles_px)
    off_px = (projection.to_photo(at + step * off_mm) - middles_px) / step
    diagonal = math.hypot(projection.photo.width, projection.photo.height)
    longest = max(float(np.hypot(*off_px.T).max()), NOT_ZERO)
    enlarged = 10 ** math.floor(math.log10(max(1.0, LONGEST_SHARE * diagonal / longest)))
    x, y = middles_px.T
    axes.quiver(
        x,
        y,
        *(enlarged * off_px).T,
        angles="xy",
        scale_units="xy",
        scale=1,
        color=ARROW,
        width=ARROW_WIDTH,
    )
    rms, largest = (drawn_length_mm(off * made.scale) for off in (fit.rms_mm, fit.max_mm))
    return f"; {made.seen} off {rms} RMS, {largest} at most (arrows: {enlarged} times)"
