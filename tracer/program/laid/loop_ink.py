"""The ink of a patch that may be a loop, and whether a pen along the loop's way draws it, place by place.

Signals: a sheet and a patch of ink, and a loop's core, in; the ink and the paper about it, and whether the
pen would draw on paper, or leave ink, anywhere, out.

Source: our own (see `tangles.seen_ink`).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.compiled import njit
from morfax.motion.polyline import evenly
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.limits import FADES
from morfax.tracer.program.against_ink.off_ink import ABOUT
from morfax.tracer.program.against_ink.own_ink import STATION_WIDTHS, SURE
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles import beside_itself
from morfax.tracer.tangles.compass import Core
from morfax.tracer.tangles.seen_ink import SeenInk

# widths about a place of a way, and of ink there that the pen does not draw: a line that joins a loop leaves
# a half; of 50 right loops of all shapes the worst leaves 0.15
ABOUT_LEFT, MOST_LEFT = 1.0, 0.25
MOST_PLACES = 900  # enough to place a circle within 5 um, and each end of a slot within 10


def ink_of(
    sheet: Sheet, patch: int, width_mm: float, most_places: int = MOST_PLACES
) -> SeenInk:
    """The ink of a patch, and the paper about it and within, as far as that is no other patch's, at so many
    places at the most.
    """
    drawing, patches = sheet.drawing, sheet.patches
    rows, columns = drawing.darkness.shape
    about = 2 + math.ceil(FADES * drawing.noise.softness_px)
    top, bottom, left, right = patches.boxes[patch].tolist()
    top, bottom = max(top - about, 0), min(bottom + about, rows)
    left, right = max(left - about, 0), min(right + about, columns)
    # what is nearer to this ink than so far, and to no other
    is_own = patches.alone(patch)
    reach = np.ones((2 * about + 1,) * 2, np.uint8)
    own, others = (
        cv2.dilate(patches.painted(chosen, top, bottom, left, right), reach)
        for chosen in (is_own, ~is_own)
    )
    i, j = np.nonzero((own > 0) & (others == 0))
    every = 1 + len(i) // most_places
    i, j = i[::every] + top, j[::every] + left
    known_mm = np.full(len(i), math.inf)  # nothing else is drawn there
    return SeenInk.of(drawing, (i, j), known_mm, width_mm, every)


def is_drawn(ink: SeenInk, core: Core) -> bool:
    """Whether there is ink wherever a pen along a core's way would leave it, but for specks of paper: a line
    that goes round but for its last side is no loop.
    """
    # no more than the pen of a long line: of 22 right slots 21 leave 0.01 at most and one 0.08, lines that
    # are open at one end 0.1
    paper = _most_about(ink, core, ABOUT, lambda drawn: drawn - ink.darkness)
    return paper < max(SURE.over, SURE.specks_px2 * ink.area_mm2 / ink.width_mm**2)


def leaves_none(ink: SeenInk, core: Core) -> bool:
    """Whether there is no ink beside a pen's along a core's way: what another line joins is no loop alone."""
    return _most_about(ink, core, ABOUT_LEFT, lambda drawn: ink.darkness - drawn) < MOST_LEFT


def is_single(core: Core) -> bool:
    """Whether a core's way comes nowhere beside itself, as one does that runs out along a line and back."""
    step_mm = STEP_WIDTHS * 2 * core.half_mm
    way = evenly(np.vstack(core.stretches()), step_mm)
    return not beside_itself.stretches(way, step_mm, 2 * core.half_mm)


def _most_about(
    ink: SeenInk, core: Core, about: float, excess: Callable[[Array], Array]
) -> float:
    """The most by which a pen's darkness (n,) is wrong within so many widths of a station along a core's way,
    in squares of the width.
    """
    way = np.vstack(core.stretches())
    wrong = np.maximum(excess(ink.drawn_along(way, core.half_mm)), 0.0) ** 2
    stations = evenly(way, STATION_WIDTHS * ink.width_mm)
    most = _most_near(stations, ink.places_mm, wrong, about * ink.width_mm)
    return float(most) * ink.area_mm2 / ink.width_mm**2


@njit(cache=True, _nrt=False)
def _most_near(stations, places, wrong, about_mm):  # type: ignore[no-untyped-def]
    """The most of what is wrong (n,) at places (n, 2) that are nearer than that to one of some stations."""
    most = 0.0
    for k in range(len(stations)):
        near = 0.0
        for n in range(len(places)):
            dx, dy = places[n, 0] - stations[k, 0], places[n, 1] - stations[k, 1]
            if dx * dx + dy * dy < about_mm * about_mm:
                near += wrong[n]
        most = max(most, near)
    return most
