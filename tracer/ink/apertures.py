"""Apertures: how the head sees a sheet's stretches, each through an aperture for its pen.

Signals: a sheet and the graph of its ink in; what the cells feel along every stretch out (see `felt`).

The sheet is seen through an aperture for each pen, and each of these pictures is made once:

    ink │     ▂█▅                stretches by their width: those about the commonest are one pen's, then those
        │    ▁███▁      ▁▃▁      about the commonest of what is left; ink broader than any pen, which lines
        └──────────────────      share, has one aperture, too; a stretch of rare width is seen through the
           0.4 mm      0.9 mm    aperture that is nearest to its own

Source: our own.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.motion.plane import left_of, unit
from morfax.motion.polyline import length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.lengths import ONE_PEN
from morfax.tracer.drawing.strokes import Window
from morfax.tracer.following.plain_places import FAINTEST, aperture_for
from morfax.tracer.head.settings import Settings
from morfax.tracer.ink.doubled import LEAST_WIDTHS
from morfax.tracer.ink.felt import feel_along
from morfax.tracer.ink.graph import Graph
from morfax.tracer.ink.run import Run
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import LEVEL
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on drawings of nets.
APERTURES_MM = 0.02  # apertures are whole steps of this
PENS_SHARE = 0.1  # of the ink is drawn by a pen that is worth an aperture of its own
# two lines with a slit between are darker so far beside their middle, of their ink's width, by so much
SLIT, LIGHTER = 0.25, 1.1


class _Seen:
    """The sheet through its cells, made once for each aperture of some."""

    def __init__(self, drawing: Drawing, apertures_mm: Array, window: Window | None) -> None:
        self._parted, self._grainy = drawing.finer, drawing.grainy
        self._cells = {
            mm: photocell.behind_aperture(drawing, mm, window=window)
            for mm in np.unique(apertures_mm).tolist()
        }

    def view(self, guide_mm: Array, width_mm: float, aperture_mm: float) -> View:
        """How the head sees a line along a guide."""
        cells = self._cells[aperture_mm]
        view = View(cells, width_mm, parted=self._parted, grainy=self._grainy)
        some = guide_mm[:: max(1, len(guide_mm) // 50)]
        dark = median(view.darkness_along(some))
        if length_mm(guide_mm) > LEAST_WIDTHS * width_mm:
            beside = _beside(some, SLIT * width_mm)
            lines = min(median(view.darkness_along(places)) for places in beside)
            dark = lines if lines > LIGHTER * dark else dark
        return view.at_level(LEVEL * max(dark, FAINTEST))


def feel_all(
    graph: Graph, drawing: Drawing, settings: Settings, window: Window | None
) -> list[Run]:
    """What the cells feel along every stretch."""
    places, pitch_mm = graph.places_mm(drawing), drawing.pitch_mm
    halves_px = [
        max(median(graph.depths_px[stretch.pixels]) - 0.5, 0.5) for stretch in graph.stretches
    ]
    widths_mm = [2 * half_px * pitch_mm for half_px in halves_px]
    own_mm = np.array([settings.aperture_mm or aperture_for(drawing, mm) for mm in widths_mm])
    apertures_mm = _few(own_mm, [len(stretch.pixels) for stretch in graph.stretches])
    seen, felt = _Seen(drawing, apertures_mm, window), list[Run]()
    for n, stretch in enumerate(graph.stretches):
        guide = _softened(places[stretch.pixels], round(2 * halves_px[n]))
        felt.append(feel_along(seen.view(guide, widths_mm[n], float(apertures_mm[n])), guide))
    return felt


def _few(own_mm: Array, pixels: Sequence[int]) -> Array:
    """The aperture of each stretch, mm: that of its pen, the one for broad ink, or the nearest to its own."""
    if not len(own_mm):
        return own_mm
    # 1. each pen's: the commonest of what is left, and all about it
    steps, inked = np.round(own_mm / APERTURES_MM), np.asarray(pixels, float)
    least, made, left = PENS_SHARE * inked.sum(), list[float](), np.ones(len(steps), bool)
    while not made or inked[left].sum() > least:
        common = float(np.argmax(np.bincount(steps[left].astype(int), inked[left])))
        pen = left & (np.abs(steps - common) < ONE_PEN * max(common, 1.0))
        if made and inked[pen].sum() < least:
            break
        made.append(common)
        left &= ~pen
    # 2. broad ink, which lines share: a small cell feels each pixel of its rims
    if (steps > (1 + ONE_PEN) * max(made)).any():
        made.append(float(steps.max()))
    nearest = np.argmin(np.abs(steps[:, None] - np.array(made)), axis=1)
    return np.asarray(APERTURES_MM * np.array(made)[nearest])


def _softened(places: Array, reach: int) -> Array:
    """Places each averaged with as many before as behind it, fewer near the ends, which stay."""
    count = len(places)
    at = np.arange(count)
    reaches = np.minimum(np.minimum(at, count - 1 - at), reach)
    sums = np.vstack([np.zeros(2), np.cumsum(places, axis=0)])
    return np.asarray(
        (sums[at + reaches + 1] - sums[at - reaches]) / (2 * reaches + 1)[:, None]
    )


def _beside(places: Array, aside_mm: float) -> tuple[Array, Array]:
    """Places (n, 2) mm so far to the left and to the right of others along a line."""
    if len(places) < 2:
        return places, places
    ways = np.gradient(places, axis=0)
    aside = aside_mm * unit(left_of(ways))
    return places + aside, places - aside
