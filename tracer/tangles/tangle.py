"""A tangle: all the ink about a junction, as far as the clean legs that lead out of it.

Where inks of several lines run together for longer than a corner, no one leg tells the way on. So the head
sends a wave through the ink from its clean incoming leg (see `wavefront`). A branch of it that stays as broad
as the line is, and is felt clean, is a leg, and the wave ends there; a branch that ends is a tip. What is
left between the legs is the tangle's own ink, which `sketch` explains.

Signals: the incoming leg in; the legs (the way in first, its heading into the tangle; the others' out of it)
and the ink out, places in sheet mm.

Source: our own (see `rings`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.junctions.rings import farthest_mm
from morfax.tracer.limits import ABOUT_WIDTHS, USUAL_WIDTH_MM
from morfax.tracer.sensing.leg import FEWEST_STATIONS, LEAST_WIDTHS, Leg, leg_of
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles.wavefront import Fronts, fronts_from

Flags = NDArray[np.bool_]

# Chosen by trial on the test drawings.
BEGIN_WIDTHS = 0.6  # from the start: a leg begins no nearer
# of the line's width, as a mean of so many fronts
LEAST_BROAD, BROAD_FRONTS = 0.6, 3
MOST_BROAD = 2 - LEAST_BROAD
LEAST_LIKE = 0.75  # of the line's width: a leg of it, ...
MOST_LIKE = 2 - LEAST_LIKE  # ... which is as much broader at the most
# the far half of so many stations, in widths of the near half
TAPERED, TAPERED_STATIONS = 0.94, 12
CLEAN_FRONTS = 4  # as broad as the line, one after the other
MOST_PLACES = 700  # enough to place a vertex within 10 um
ABOUT_MM, ABOUT_PX = 0.25, 2  # of paper about the ink belongs to the tangle
DARKEST = 1.05  # of the line's darkness: a place counts for no more


@dataclass(frozen=True, slots=True)
class Tangle:
    """The legs about a junction, and the ink between them: darkness (n,) of places (n, 2), 1 on the line.

    The way in is first; its heading is into the tangle. `whole`: the wave ended in legs and tips.
    """

    legs: list[Leg]
    places_mm: Array
    darkness: Array
    area_mm2: float
    whole: bool


def tangle_ahead(view: View, incoming: Leg) -> Tangle:
    """The tangle that begins at the clean end of an incoming leg."""
    reach_mm = farthest_mm(view)
    fronts = fronts_from(view, incoming.end_mm, incoming.heading_rad, reach_mm)
    if not len(fronts.at):  # no ink joins the leg
        return Tangle([incoming], np.empty((0, 2)), np.empty(0), 0.0, whole=False)
    legs, ended = _legs(view, fronts, reach_mm)
    inside = (fronts.label >= 0) & ~ended[np.maximum(fronts.label, 0)]
    ink = ink_of(view, inside, fronts.corner)
    running = fronts.at * fronts.step_mm > reach_mm - 2 * fronts.step_mm
    return Tangle([incoming, *legs], *ink, not np.any(running & ~ended))


def _legs(view: View, fronts: Fronts, reach_mm: float) -> tuple[list[Leg], Flags]:
    """The legs in which the wave ends, and which fronts lie in one."""
    legs: list[Leg] = []
    tips = _tips(view, fronts, reach_mm)
    come_mm = fronts.at * fronts.step_mm
    clean, ended = np.zeros(len(fronts.at), int), np.zeros(len(fronts.at), bool)
    for k, before in enumerate(fronts.parents):
        # 1. beyond a leg the wave has ended
        if before and all(ended[p] for p in before):
            ended[k] = True
            continue
        # 2. fronts as broad as the line, one after the other
        if _like_line(view, fronts, k):
            clean[k] = clean[before[0]] + 1
        if clean[k] < CLEAN_FRONTS or tips[k] or come_mm[k] < BEGIN_WIDTHS * view.width_mm:
            continue
        # 3. the leg there, if it is felt clean
        leg = _leg_at(view, fronts, k)
        if leg is not None:
            legs.append(leg)
            ended[k] = True
    return legs, ended


def _tips(view: View, fronts: Fronts, reach_mm: float) -> Flags:
    """Which fronts lie in ink that ends soon, within the wave's reach."""
    beyond_mm = fronts.beyond_mm()
    ends_mm = fronts.at * fronts.step_mm + beyond_mm
    # ink that ends sooner is a tip
    soon = beyond_mm < ABOUT_WIDTHS * min(view.width_mm, USUAL_WIDTH_MM)
    return np.asarray(soon & (ends_mm < reach_mm - 2 * fronts.step_mm))


def _like_line(view: View, fronts: Fronts, k: int) -> bool:
    """Whether a front follows one alone, and the latest fronts are as broad as the line is."""
    before = fronts.parents[k]
    if len(before) != 1 or len(fronts.children[before[0]]) != 1:
        return False
    broad = float(np.mean(_latest(fronts, k, BROAD_FRONTS))) / view.width_mm
    return LEAST_BROAD < broad < MOST_BROAD


def _latest(fronts: Fronts, k: int, count: int) -> list[float]:
    """Breadths of a front and of those that it came from: one alone has few pixels, and tells roughly."""
    out = [float(fronts.breadth_mm[k])]
    while len(out) < count and len(fronts.parents[k]) == 1:
        k = fronts.parents[k][0]
        out.append(float(fronts.breadth_mm[k]))
    return out


def _leg_at(view: View, fronts: Fronts, k: int) -> Leg | None:
    """The leg felt outward from the fronts before a front; None if it is not clean there."""
    first = k
    for _ in range(CLEAN_FRONTS - 1):
        first = fronts.parents[first][0]
    way = fronts.places_mm[k] - fronts.places_mm[first]
    heading = math.atan2(way[1], way[0])
    local = view.like(fronts.places_mm[k], heading)
    if not LEAST_LIKE < local.width_mm / view.width_mm < MOST_LIKE:
        return None
    least = max(FEWEST_STATIONS, math.ceil(LEAST_WIDTHS * view.width_mm / view.step_mm))
    for place in (fronts.places_mm[first], fronts.places_mm[k]):
        seen = local.feel(place, heading, local.leg_mm)
        if len(seen) >= least:
            return None if _tapers(seen) else leg_of(seen, False, local.leg_mm)
    return None


def _tapers(seen: Array) -> bool:
    """Whether what was felt grows narrower: two lines that run to a tip."""
    near, far = (median(part) for part in np.array_split(seen[:, 2], 2))
    return len(seen) >= TAPERED_STATIONS and far < TAPERED * near


def ink_of(view: View, inside: Flags, corner: tuple[int, int]) -> tuple[Array, Array, float]:
    """Places, darkness, and area (mm²) of a tangle's ink and of the paper about it.

    `inside`: the pixels of the tangle's ink in a window that begins at a row and column of the sheet. Paper
    near ink that is not the tangle's is left out.
    """
    pitch, (top, left), (rows, columns) = view.pitch_mm, corner, inside.shape
    seen = view.cells.window(top, top + rows, left, left + columns)
    # 1. its pixels
    square = np.ones((3, 3), np.uint8)
    wide = max(ABOUT_PX, round(ABOUT_MM / pitch))
    about = cv2.dilate(inside.view(np.uint8), square, iterations=wide)
    other = ((seen > view.level) & ~inside).view(np.uint8)
    others = cv2.dilate(other, square, iterations=ABOUT_PX)
    i, j = np.nonzero(inside | ((about > 0) & (others == 0)))
    # 2. as places on the sheet
    x = (j + left + 0.5) * pitch
    y = (view.cells.shape[0] - i - top - 0.5) * pitch
    places = np.column_stack([x, y])
    darkness = np.minimum(seen[i, j] / (2 * view.level), DARKEST).astype(float)
    # 3. some of them, if there are many
    if len(places) > MOST_PLACES:
        some = np.random.default_rng(0).permutation(len(places))[:MOST_PLACES]
        places, darkness = places[some], darkness[some]
    return places, darkness, float(len(i)) * pitch**2
