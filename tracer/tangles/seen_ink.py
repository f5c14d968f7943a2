"""The ink that is seen about a way, and how much of it a pen leaves unexplained there.

    misfit = (sum((drawn - seen)²) - what the paper's noise leaves) · area of a pixel / width²

Signals: places about a way and their darkness in; how much ink the pen's leaves unexplained, in squares of
the line's width, out.

Source: our own; the pen is that of the tangles (see `pen`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.compiled import njit
from morfax.motion.polyline import evenly, nearest_mm
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.limits import CLEAR_WIDTHS
from morfax.tracer.tangles import distances, pen
from morfax.tracer.tangles.tangle import DARKEST

OF_WIDTH = (0.9, 0.95, 1.0, 1.05, 1.1)  # of the width that was felt: a way is tried with these

# widths: a place of a way from which ink is farther is beside its ink; that of a right way is within half of
# one, and of the places that show ink some are left out
EVERY_WIDTHS = 0.5
DIFFER = 0.1  # darkness; chosen
# spacings of places: a place of ink has so many so near; one of a speck has not; chosen
CLOSE, NEIGHBOURS = 2.5, 5
# Of a way that is fitted to the ink:
PRICE = 0.01  # of a figure more, as misfit: noise alone pays less than a third of that
STEPS = 40  # times that the ink is drawn for each figure, at the most
SURE = 0.003  # for each width of its length: one that leaves less is taken at once
# the same: what a way leaves of lines that it explains, at most. Scans leave 0.013 of a circle of 0.5 mm at
# 150 dpi, and 0.027 of a slot of 0.35 mm at 200
LIKE = 0.035
# the same: it goes before the head's own way if it leaves so much less. Noise of a scan is a fifth of that; a
# corner that is cut short by 40 um leaves as much
GAIN = 0.001

Pixels = NDArray[np.int64]


class Fitted(Protocol):
    """A way that is fitted to the ink."""

    @property
    def misfit(self) -> float:
        """How much ink it leaves unexplained, in squares of the line's width."""

    @property
    def cost(self) -> float:
        """The misfit, and the price of the figures that it takes."""

    @property
    def length_mm(self) -> float:
        """The length of the way."""


Way = TypeVar("Way", bound=Fitted)


class SeenInk(NamedTuple):
    """Places (n, 2) mm and their darkness (n,), 1 on the line; how far each is from the lines that are drawn
    there anyway, mm; half the pen's width and its softness, mm; the area that a place stands for, mm2; and
    what noise of the paper leaves in all squares.
    """

    places_mm: Array
    darkness: Array
    known_mm: Array
    half_mm: float
    softness_mm: float
    area_mm2: float
    noise: float

    @classmethod
    def of(
        cls,
        drawing: Drawing,
        pixels: tuple[Pixels, Pixels],
        known_mm: Array,
        width_mm: float,
        every: int,
    ) -> SeenInk:
        """The ink at some pixels of a drawing, one in so many, about a line of a width; their rows (n,) and
        columns (n,).
        """
        rows, columns = pixels
        dark = np.minimum(np.asarray(drawing.darkness[rows, columns], float), DARKEST)
        noise = drawing.noise
        area_mm2, left_by_noise = every * drawing.pitch_mm**2, len(rows) * noise.paper**2
        places = middles_mm(drawing, rows, columns)
        half_mm, softness_mm = 0.5 * width_mm, noise.softness_mm
        return cls(places, dark, known_mm, half_mm, softness_mm, area_mm2, left_by_noise)

    @property
    def width_mm(self) -> float:
        """The pen's width."""
        return 2 * self.half_mm

    def only(self, kept: NDArray[np.int64]) -> SeenInk:
        """The same of some places, by their numbers."""
        noise = self.noise * len(kept) / max(len(self.darkness), 1)
        places, darkness, known_mm = (part[kept] for part in self[:3])
        return self._replace(
            places_mm=places, darkness=darkness, known_mm=known_mm, noise=noise
        )

    def without_specks(self, chosen: NDArray[np.bool_]) -> Array:
        """Those of some places (n,) that have others about them, or are beside one that has, (m, 2) mm."""
        places, near_mm2 = self.places_mm[chosen], CLOSE**2 * self.area_mm2
        near, kept = np.zeros(len(places), np.int64), np.zeros(len(places), np.int64)
        _count_near(places, near_mm2, np.ones(len(places), np.int64), near)
        _count_near(places, near_mm2, (near > NEIGHBOURS).astype(np.int64), kept)
        return places[kept > 0]

    def for_kernel(self) -> pen.Ink:
        """The same for kernels."""
        places, darkness, known_mm = map(np.ascontiguousarray, self[:3])
        return pen.Ink(places, darkness, known_mm, self.half_mm, self.softness_mm)

    def drawn_along(self, way: Array, half_mm: float) -> Array:
        """Darkness (n,) that a pen of half a width leaves along a way (m, 2) mm and the known lines."""
        return self._drawn(distances.away_from(self.places_mm, way), half_mm)

    def _drawn(self, away_mm: Array, half_mm: float) -> Array:
        """The same of ways that are so far (n,) from the places."""
        drawn = np.empty(len(away_mm))
        pen.ink(np.minimum(away_mm, self.known_mm), half_mm, self.softness_mm, drawn)
        return drawn

    def misfit(self, drawn: Array) -> float:
        """How much darkness (n,) that is drawn leaves unexplained, in squares of the line's width."""
        return self.left(drawn - self.darkness)

    def left(self, wrong: Array) -> float:
        """The same of what is drawn too dark or too light at each place, (n,)."""
        left = float(np.sum(wrong**2)) - self.noise
        return left * self.area_mm2 / self.width_mm**2

    def left_at(self, wrong: Array) -> Array:
        """The same at each place (n,), with what noise leaves."""
        return np.asarray(wrong**2 * self.area_mm2 / self.width_mm**2)

    def holds(self, way: Array) -> bool:
        """Whether a way (m, 2) mm lies on ink all along: beyond the places seen nothing costs it."""
        dark, off_mm = self.places_mm[self.darkness > INK], CLEAR_WIDTHS * self.width_mm
        # a fit may throw a corner kilometres away: such a way is too long to be looked at
        if not len(dark) or np.any(way < dark.min(axis=0) - off_mm):
            return False
        if np.any(way > dark.max(axis=0) + off_mm):
            return False
        away_mm = nearest_mm(evenly(way, EVERY_WIDTHS * self.width_mm), dark)
        return bool(away_mm.max() < off_mm)

    def misfit_along(self, way: Array) -> float:
        """How much a pen along a way (m, 2) mm leaves unexplained, of the width that explains most."""
        return self.misfit(self.best_drawn(distances.away_from(self.places_mm, way)))

    def best_drawn(self, away_mm: Array) -> Array:
        """Darkness (n,) that a pen leaves along ways that are so far (n,) from the places, of the width that
        explains most.
        """
        tried = [self._drawn(away_mm, share * self.half_mm) for share in OF_WIDTH]
        return min(tried, key=self.misfit)

    def left_where(self, drawn: Array, other: Array) -> float:
        """How much darkness (n,) that is drawn leaves unexplained where another is drawn otherwise, in
        squares of the line's width.
        """
        differ = _where_they_differ(drawn, other)
        return self.only(differ).misfit(drawn[differ])

    def share_left(self, drawn: Array, other: Array) -> float:
        """How much is left by what is drawn (n,) in shares of what another leaves, where these differ."""
        differ = _where_they_differ(drawn, other)
        left = np.sum((drawn - self.darkness)[differ] ** 2)
        return float(left / max(np.sum((other - self.darkness)[differ] ** 2), NOT_ZERO))


def _where_they_differ(drawn: Array, other: Array) -> Pixels:
    """The numbers of the places where what is drawn (n,) differs from another."""
    return np.flatnonzero(np.abs(drawn - other) > DIFFER)


@njit(cache=True, _nrt=False)
def _count_near(places, near_mm2, counts, near):  # type: ignore[no-untyped-def]
    """Add up for each of some places (n, 2) how much those count (n,) that are near it: to a square, mm2."""
    for k in range(len(places)):
        for other in range(len(places)):
            dx, dy = places[k, 0] - places[other, 0], places[k, 1] - places[other, 1]
            if dx * dx + dy * dy < near_mm2:
                near[k] += counts[other]


def middles_mm(drawing: Drawing, rows: Pixels, columns: Pixels) -> Array:
    """The middles (n, 2) of some pixels of a drawing, mm on the sheet."""
    up = len(drawing.darkness) - rows - 0.5
    return np.column_stack([columns + 0.5, up]) * drawing.pitch_mm


def best_of(
    ink: SeenInk, starts: Iterable[Way], settled: Callable[[SeenInk, Way], Way | None]
) -> Way | None:
    """The way that costs least of those to which some settle, or the first that leaves hardly any ink."""
    best: Way | None = None
    for start in starts:
        way = settled(ink, start)
        if way is not None and (best is None or way.cost < best.cost):
            best = way
        if best is not None and best.misfit < SURE * best.length_mm / ink.width_mm:
            break
    return best
