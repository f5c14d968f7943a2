"""Doubts about a drawing's scale: lines as no pen draws them, and a sheet that is almost a known format.

Signals in: a drawing, and the usual width of its lines (mm). Signals out: texts, each with what to do.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from morfax.tracer.drawing import coarse

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

# mm; ISO 128-2 has lines of 0.13 to 2 mm, and a scan may give them somewhat thinner
THINNEST_MM, BROADEST_MM = 0.1, 2.0
ALIKE = 0.007  # share by which the ratio of a format's sides is met: 2 mm on 297; by trial
# share by which both sides are off: a scanner's margin, or a wrong scale; by trial
SAME, NEAR = 0.012, 0.1


def scale_doubts(drawing: Drawing, line_width_mm: float | None) -> Iterator[str]:
    """What makes the scale of a drawing unlikely."""
    if line_width_mm is not None:
        yield from _of_line_width(line_width_mm)
        # of lines of a pixel the drawing's own note tells the resolution that is enough
        if drawing.seen_px >= coarse.SEEN_PX:
            pitch_mm = drawing.pitch_mm * drawing.finer / drawing.enlarged
            yield from _of_pixels(line_width_mm, pitch_mm)
    yield from _of_format(drawing.width_mm, drawing.height_mm)


def _of_line_width(width_mm: float) -> Iterator[str]:
    """A line that is broader or thinner than pens draw."""
    if not THINNEST_MM <= width_mm <= BROADEST_MM:
        yield (
            f"the lines are {width_mm:.2g} mm wide by this scale; pens draw {THINNEST_MM:g} to "
            f"{BROADEST_MM:g} mm: check the scale (--dpi, --width, --known)"
            + (", or give --edge if they are filled shapes" if width_mm > BROADEST_MM else "")
        )


def _of_pixels(width_mm: float, pitch_mm: float) -> Iterator[str]:
    """A line that is too few pixels wide."""
    if width_mm < coarse.FEWEST_PX * pitch_mm:
        wide_px = width_mm / pitch_mm
        # a line of one pixel looks as if it had two
        dpi = coarse.finer_dpi(pitch_mm, 2 * coarse.FEWEST_PX / wide_px)
        told_px = math.floor(10 * wide_px) / 10  # what is too few never reads as enough
        yield (
            f"the lines are {told_px:.1f} pixels wide, and the head wants {coarse.FEWEST_PX:g}: scan at "
            f"{dpi} dpi"
        )


def _of_format(width_mm: float, height_mm: float) -> Iterator[str]:
    """A sheet with the shape of a known format, but a few per cent larger or smaller."""
    from morfax.tracer.flatten.formats import FORMATS

    shorter_mm, longer_mm = sorted((width_mm, height_mm))
    for each in FORMATS.values():
        short_mm, long_mm = sorted((each.width_mm, each.height_mm))
        name = each.name.upper() if each.name[1:].isdigit() else each.name
        times = shorter_mm / short_mm
        alike = abs(longer_mm / shorter_mm / (long_mm / short_mm) - 1) < ALIKE
        if alike and SAME < abs(times - 1) < NEAR:
            across_mm = short_mm if width_mm == shorter_mm else long_mm
            yield (
                f"the sheet is {width_mm:.1f} x {height_mm:.1f} mm, the shape of {name} at "
                f"{100 * times:.1f} %: if it is {name}, give --width {across_mm:g}mm"
            )
