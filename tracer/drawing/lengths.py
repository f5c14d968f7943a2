"""Lengths: how long the lines of a sheet are, by the ink of each patch.

    length = area of the patch over the width of its line; less the two round ends of an open line, which
             are ink beyond its length

All lines that one pen may have drawn have one width: a scan measures a width of three pixels a little
differently at each angle. The depth of pixels, by which patches have their widths, makes a slanting line up
to half a pixel too narrow, and so up to a tenth too long. That is near enough to put lines in order; whoever
reads of a length is told it by the width that profiles across the lines show, and of an edge of a filled
shape by its own places.

Signals: a sheet's patches of ink in; their lengths, mm, out.

Source: our own. Questions: the ink of a net's junctions counts once, so that a net is told a little short.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.profiles import FEWEST_PROFILES, STEP_PX, profiles_of
from morfax.tracer.drawing.weighing import CAPS

if TYPE_CHECKING:
    from morfax.tracer.drawing.strokes import Sheet

# lines whose widths are within this share of the usual width are one pen's; by trial
ONE_PEN = 0.3
PARTS = 8  # of a step between two samples of a profile: a sixteenth of a pixel


def one_pen_mm(sheet: Sheet) -> Array:
    """Lengths of the patches, mm, by one width for all that one pen may have drawn."""
    return sheet.lengths_mm * sheet.widths_mm / _pens_mm(sheet)


def told_mm(sheet: Sheet) -> Array:
    """Lengths of the patches, mm, as a reader is told them: true to 2 %, or 3 % of lines of three pixels."""
    if sheet.drawing.edges_mm:
        return _of_edges_mm(sheet)
    pens_mm = _pens_mm(sheet) * _seen_share(sheet)
    # areas less wide than the line are flaws of its ink
    widths_px = sheet.widths_mm / sheet.drawing.pitch_mm
    is_open = sheet.patches.enclosure.loops(widths_px**2) == 0
    lengths_mm = sheet.lengths_mm * sheet.widths_mm / pens_mm - is_open * CAPS * pens_mm
    return np.maximum(lengths_mm, pens_mm)  # a dot is as long as it is wide


def _of_edges_mm(sheet: Sheet) -> Array:
    """Lengths of the patches along edges of filled shapes, mm: the picture shows the edges themselves."""
    edges = sheet.drawing.edges_mm
    patches = [sheet.patch_at(edge[0]) for edge in edges]
    lengths_mm = [length_mm(edge) for edge in edges]
    return np.asarray(np.bincount(patches, lengths_mm, sheet.patches.count), float)


def _usual_mm(sheet: Sheet) -> float:
    """The width that half of all ink has or less, mm."""
    areas_mm2 = sheet.lengths_mm * sheet.widths_mm
    order = np.argsort(sheet.widths_mm)
    sums = np.cumsum(areas_mm2[order])
    return float(sheet.widths_mm[order[np.searchsorted(sums, 0.5 * sums[-1])]])


def _is_one_pen(widths_mm: Array, usual_mm: float) -> NDArray[np.bool_]:
    """Which widths may be those of the pen that has drawn most."""
    return np.abs(widths_mm / usual_mm - 1) < ONE_PEN


def _pens_mm(sheet: Sheet) -> Array:
    """The width of each patch's pen, mm."""
    usual_mm = _usual_mm(sheet)
    return np.where(_is_one_pen(sheet.widths_mm, usual_mm), usual_mm, sheet.widths_mm)


def _seen_share(sheet: Sheet) -> float:
    """How wide the usual lines are where profiles cross them, in times of their width by depths."""
    profiles = profiles_of(sheet.drawing.darkness)
    if profiles is None:
        return 1.0
    usual_mm = _usual_mm(sheet)
    wide_mm = _wide_px(profiles.seen) * sheet.drawing.pitch_mm
    usual = wide_mm[_is_one_pen(wide_mm, usual_mm)]
    return float(np.mean(usual)) / usual_mm if len(usual) >= FEWEST_PROFILES else 1.0


def _wide_px(seen: Array) -> Array:
    """How wide the ink of profiles (n, k) is, with straight lines between their samples, pixels."""
    shares = (np.arange(PARTS) + 0.5) / PARTS
    ink = [(1 - share) * seen[:, :-1] + share * seen[:, 1:] > INK for share in shares]
    return np.asarray(np.mean(ink, axis=0).sum(axis=1) * STEP_PX)
