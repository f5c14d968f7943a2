"""Off ink: how much a pen along a way leaves unexplained about each place of it, and the pen that drew it.

    wrong = sum of ((drawn - seen)² - noise²) over the pixels about a place · area of a pixel / width²

Each pixel counts for that place of the way which is nearest to it, and so for those about that. What one
pixel alone has too much or too little is a speck, and left out.

Signals: the drawing and ways in; the ink about a stretch, and what is wrong about each of its places, out.

Source: our own (see `own_ink`, which tells lines that were followed wrongly; here corners are a tenth of
that off).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.against_ink.window import SheetWindow
from morfax.tracer.sensing.view import STEP_WIDTHS
from morfax.tracer.tangles.distances import NOWHERE_MM, away_from
from morfax.tracer.tangles.felt_pen import FAR, PAPER_FROM, FeltPen
from morfax.tracer.tangles.moved_way import nearest
from morfax.tracer.tangles.seen_ink import SeenInk, middles_mm
from morfax.tracer.tangles.spline import wrong_and_where
from morfax.tracer.tangles.within_reach import are_within

REACH = 1.6  # widths from the way, the ink is looked at; chosen
MOST_PLACES = 1500  # of ink, enough to place a corner within 10 um
ABOUT = 0.75  # widths on either side of a place, what is wrong counts as there; by trial
# darkness: so much by itself, with less than half of it within so many pixels, is a speck
SPECK, BESIDE_PX = 0.35, 1.6
# at the edge of what is looked at, half as much ink as a line has there, so far from all lines, goes on;
# less is specks
EDGE, OWN = 0.2, 0.8
# misfit: of what is wrong about a place noise is a quarter of that; 15 um of a line of 0.35 mm are as much
OFF = 0.006
OF_USUAL = 4.0  # times what most of the clean places of the line leave
MOST = 1.0  # that a pixel is wrong, squared
CLEAN_PLACES = 15  # of some lines, about which their pen is felt
ALONG = 0.8  # widths of way on either side of such a place
FEWEST = 200  # pixels that show a pen


class Clean(NamedTuple):
    """A way (n, 2) mm a step from place to place, and those places (k,) at which it is surely on its ink."""

    way: Array
    places: NDArray[np.int64]


def ink_about(
    drawing: Drawing,
    about: Array,
    width_mm: float,
    reach_widths: float,
    others: Sequence[tuple[Array, float]] = (),
) -> SeenInk:
    """The ink about some places (n, 2) mm of a line; other ways (m, 2) mm are drawn there anyway, each by how
    much wider to either side, mm.
    """
    reach_mm = reach_widths * width_mm
    i, j = SheetWindow.about(drawing, about, reach_mm).grid()
    within = np.flatnonzero(are_within(middles_mm(drawing, i, j), about, reach_mm))
    every = 1 + len(within) // MOST_PLACES
    i, j = i[within[::every]], j[within[::every]]
    places, known_mm = middles_mm(drawing, i, j), np.full(len(i), NOWHERE_MM)
    for other, wider_mm in others:
        if len(other) > 1:
            known_mm = np.minimum(known_mm, away_from(places, other) - wider_mm)
    return SeenInk.of(drawing, (i, j), known_mm, width_mm, every)


class UsualPen(NamedTuple):
    """The pen of some lines, and what most of their clean places leave unexplained."""

    pen: FeltPen
    usual: float

    @property
    def limit(self) -> float:
        """What is left about a place that is off its ink, at the least."""
        return max(OFF, OF_USUAL * self.usual)


def felt_at(drawing: Drawing, ways: Sequence[Clean], width_mm: float) -> UsualPen | None:
    """The pen that drew clean places of some ways; None if too little of its ink is seen."""
    around = round(ALONG / STEP_WIDTHS)
    every = 1 + sum(len(clean.places) for clean in ways) // CLEAN_PLACES
    owns, inks, away = list[Array](), list[SeenInk](), list[Array]()
    for clean in ways:
        for at in clean.places[every // 2 :: every].tolist():
            own = clean.way[np.arange(at - around, at + around + 1) % len(clean.way)]
            ink = ink_about(drawing, own, width_mm, REACH)
            away_mm, place = _nearest(ink.places_mm, own).T
            beside = (place > 0) & (place < len(own) - 1) & (away_mm < FAR * width_mm)
            owns.append(own)
            inks.append(ink.only(np.flatnonzero(beside)))
            away.append(away_mm[beside])
    every_mm = np.concatenate([np.empty(0), *away])
    dark = np.concatenate([np.empty(0), *(ink.darkness for ink in inks)])
    paper = dark[every_mm > PAPER_FROM * width_mm]
    # of a line along coarse pixels none may lie where paper begins; in a broad area there is none
    if len(every_mm) < FEWEST or not len(paper) or median(paper) > INK:
        return None
    pen = FeltPen.of(every_mm, inks[0]._replace(darkness=dark))
    left = [
        wrong_about(pen.sees(ink), own, np.zeros(len(own), bool), STEP_WIDTHS)[around]
        for ink, own in zip(inks, owns, strict=True)
    ]
    return UsualPen(pen, median(left))


def wrong_about(
    ink: SeenInk, way: Array, sharp: NDArray[np.bool_], apart_widths: float
) -> Array:
    """How much is wrong about each place of a way (n, 2) mm with some corners, some widths apart, (n,)."""
    wrong, at = wrong_and_where(ink, way, sharp)
    noise = ink.noise / max(len(wrong), 1)
    over = np.minimum(wrong**2, MOST) - noise
    each = np.bincount(at, over, len(way)) * ink.area_mm2 / ink.width_mm**2
    around = round(ABOUT / apart_widths)
    sums = np.r_[0.0, np.cumsum(each)]
    place = np.arange(len(way))
    last, first = np.minimum(place + around + 1, len(way)), np.maximum(place - around, 0)
    return np.asarray(sums[last] - sums[first])


def goes_on(ink: SeenInk, about: Array, reach_widths: float) -> bool:
    """Whether ink beside all lines goes on beyond what is looked at about some places (n, 2) mm.

    It is another line's then, or a longer bar's.
    """
    beside = (ink.darkness > INK) & (ink.known_mm > OWN * ink.width_mm)
    away_mm = away_from(ink.places_mm[beside], about)
    far = np.count_nonzero(away_mm > (reach_widths - EDGE) * ink.width_mm)
    # one place alone is a speck
    return bool(far > 1 and far * ink.area_mm2 > 0.5 * EDGE * ink.width_mm**2)


def without_lone_pixels(ink: SeenInk, way: Array, pitch_mm: float) -> SeenInk:
    """The ink without pixels that are wrong by themselves, where a pen goes along a way (n, 2) mm."""
    wrong = ink.drawn_along(way, ink.half_mm) - ink.darkness
    suspect = np.flatnonzero(np.abs(wrong) > SPECK)
    if not len(suspect):
        return ink
    beside = np.flatnonzero(np.abs(wrong) > 0.5 * SPECK)
    apart = ink.places_mm[suspect, None] - ink.places_mm[None, beside]
    is_near = np.hypot(apart[..., 0], apart[..., 1]) < BESIDE_PX * pitch_mm
    is_alike = wrong[suspect, None] * wrong[None, beside] > 0
    specks = suspect[np.count_nonzero(is_near & is_alike, axis=1) < 2]  # itself is one
    return ink.only(np.setdiff1d(np.arange(len(wrong)), specks))


def _nearest(places: Array, way: Array) -> Array:
    """How far places (n, 2) mm are from a way, and at which of its places, fractions included, (n, 2)."""
    near = np.empty((len(places), 3))
    nearest(np.ascontiguousarray(places), np.ascontiguousarray(way), near)
    return np.column_stack([near[:, 0], near[:, 1] + near[:, 2]])
