"""Strokes beside the line, felt outward by cells: some of them are stop marks.

Signals: the path of the head at a station, a side of it and a distance in; the stroke there out: its middles
in mm along and away from the path and on the sheet, how far it reaches, and what is about it.

    away  │   ▮   │ <- paper to both sides: else it is lettering, a blot, a line beside the line
          │   ▮   │
     ─────────┴──────── path ─▶    beyond its end nothing in line with it: else it is a crossing line's dash

Source: our own (see `marks`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.median import ROBUST, median
from morfax.motion.plane import left_of
from morfax.motion.usual import INCREMENT_MM
from morfax.tracer.limits import ABOUT_WIDTHS, CLEAR_WIDTHS, LONGER_WIDTHS, USUAL_WIDTH_MM
from morfax.tracer.marks import sizes
from morfax.tracer.marks.stroke_cells import (
    Base,
    darkness_of,
    goes_on,
    soiled_beside,
    stroke_at,
)
from morfax.tracer.sensing.gauge import NARROWEST, WIDEST
from morfax.tracer.sensing.parabola import OUTLIERS
from morfax.tracer.sensing.photocell import LEVEL
from morfax.tracer.sensing.probe import is_tip
from morfax.tracer.sensing.view import View

TURNS = 3  # the cells are turned this often: by then they stand square to a stroke


@dataclass(frozen=True)
class SideStroke:
    """Ink beside the line, felt outward from a base that is `at_mm` along the path: middles (along, away) and
    widths, (n, 3) mm. What else the cells see of it is looked for when it is asked for: of most strokes,
    which are the line itself or seen already from another row of cells, nothing is.
    """

    view: View
    base: Base
    at_mm: float
    seen: Array
    longest_mm: float

    @property
    def side(self) -> int:
        """On which side of the path it is."""
        return self.base.side

    @cached_property
    def clear(self) -> Array:
        """The middles and widths (n, 3) mm that are clear of the line."""
        return self.seen[self.seen[:, 1] > sizes.CLEAR_OF_LINE * self.view.width_mm]

    @cached_property
    def middles(self) -> Array:
        """The same middles (n, 2), mm along and away from the path."""
        return np.asarray(self.clear[:, :2] + [self.at_mm, 0.0])

    @cached_property
    def places(self) -> Array:
        """Their places (n, 2) on the sheet, mm."""
        across = self.side * left_of(self.base.along)
        along_mm, away_mm = self.clear[:, :1], self.clear[:, 1:2]
        return self.base.place + along_mm * self.base.along + away_mm * across

    @cached_property
    def wide(self) -> float:
        """Its width in widths of the line; 0 if too little is clear of that."""
        return median(self.clear[:, 2]) / self.view.width_mm if len(self.clear) > 2 else 0.0

    @cached_property
    def from_line_mm(self) -> float:
        """How far from the line's edge it begins."""
        return float(self.seen[:, 1].min()) - 0.5 * self.view.width_mm

    @cached_property
    def reach_mm(self) -> float:
        """How far it reaches beyond the line's edge."""
        return float(self.seen[:, 1].max()) - 0.5 * self.view.width_mm

    @property
    def touches(self) -> bool:
        """Whether it touches the line."""
        return self.from_line_mm < 2 * self.view.pitch_mm

    @property
    def foot_mm(self) -> float:
        """Where its middle line meets the path, mm along it."""
        return self._line[1]

    @property
    def length_mm(self) -> float:
        """How far it reaches beyond the line's edge along itself."""
        return self.reach_mm * math.hypot(1.0, self.slant)

    @property
    def slant(self) -> float:
        """How far it goes along the path for each mm away from it."""
        return self._line[0]

    @property
    def straight(self) -> bool:
        """Whether it is straight, and near enough to square."""
        slant, foot = self._line
        rest = self.middles[:, 0] - foot - slant * self.middles[:, 1]
        return bool(abs(slant) < sizes.SLANT and np.sqrt(np.mean(rest**2)) < sizes.BENT_MM)

    @cached_property
    def is_like(self) -> bool:
        """Whether the line's pen drew it: as wide and as dark as the line."""
        darkness = darkness_of(self.view.cells, self.base, self.clear) * LEVEL / self.view.level
        is_wide = NARROWEST < self.wide < WIDEST
        return bool(is_wide and sizes.INK[0] < darkness < sizes.INK[1])

    @cached_property
    def ends(self) -> bool:
        """Whether it ends at its far end, and at the near one if it does not touch the line."""
        is_short = self.reach_mm < self.longest_mm
        return is_short and _ends(self.view, self.base, self.seen, self.touches)

    @cached_property
    def is_clear(self) -> bool:
        """Whether there is paper about it."""
        return _is_clear(self.view, self.base, self.clear, self.touches)

    @property
    def is_tick(self) -> bool:
        """Whether it is drawn as a tick is."""
        return self.straight and self.is_like and self.ends and self.is_clear

    @cached_property
    def _line(self) -> tuple[float, float]:
        """Slope and offset of its middle line: each stroke is held against many others."""
        along, away = self.middles.T
        off = away - away.mean()
        slope = float(off @ along) / float(off @ off)
        return slope, float(along.mean() - slope * away.mean())


def felt(
    view: View, base: Base, at_mm: float, away_mm: float, longest_mm: float
) -> SideStroke | None:
    """The stroke that a cell is on beside a place of the path, which is `at_mm` along it.

    None if the stroke is not nearly as wide as the line, or too short.
    """
    width = view.width_mm
    seen = stroke_at(view.cells, base, away_mm, longest_mm + width, width)
    stroke = SideStroke(view, base, at_mm, seen, longest_mm)
    if not sizes.SEEN[0] < stroke.wide < sizes.SEEN[1]:
        return None
    from_line_mm = stroke.from_line_mm
    least_mm = sizes.LEAST_PENS * max(width, USUAL_WIDTH_MM)
    is_short = stroke.reach_mm - max(0.0, from_line_mm) <= least_mm
    return None if is_short or from_line_mm > sizes.FARTHEST_MM else stroke


def _ends(view: View, base: Base, seen: Array, touches: bool) -> bool:
    """Whether a stroke ends at its far end, and at the near one if it does not touch the line."""
    width, across = view.width_mm, base.side * left_of(base.along)
    far = seen[np.argmax(seen[:, 1]), :2] - [0, 0.5 * width]
    near = seen[np.argmin(seen[:, 1]), :2] + [0, 0.5 * width]
    for u, v in [far] if touches else [far, near]:
        if not is_tip(view, base.place + u * base.along + v * across):
            return False
    middles = seen[seen[:, 1] > sizes.CLEAR_OF_LINE * width]
    others_mm = LONGER_WIDTHS * max(width, USUAL_WIDTH_MM)
    return not goes_on(view.cells, base, middles, others_mm, width)


def _is_clear(view: View, base: Base, middles: Array, touches: bool) -> bool:
    """Whether there is paper to both sides of a stroke."""
    width = view.width_mm
    clear_mm = CLEAR_WIDTHS * width
    if not touches:
        clear_mm = ABOUT_WIDTHS * max(width, USUAL_WIDTH_MM)
    beside_mm = sizes.CLEAR_OF_EDGE * width, clear_mm
    soiled = float(soiled_beside(view.cells, base, middles, beside_mm))
    return soiled < (sizes.SOILED if touches else sizes.APART_SOILED)


def crossing_mm(view: View, place: Array, along: Array, mark: Sequence[SideStroke]) -> float:
    """Where the middle line of a mark meets the path, mm along it from a place near by.

    The mark is one stroke, or one on either side. It is felt square to itself: felt along the path, its round
    tips and the corners at its foot would draw the middle of a slanted mark aside.
    """
    left = left_of(along)
    slant, foot_mm = mark[0].side * mark[0].slant, 0.0
    for _ in range(TURNS):
        square = (along - slant * left) / math.hypot(1.0, slant)
        found = (
            np.vstack([_square_to(view, place, square, slant, stroke) for stroke in mark])
            - place
        )
        slant, foot_mm = _robust_line(found @ left, found @ along)
    return foot_mm


def _square_to(
    view: View, place: Array, square: Array, slant: float, stroke: SideStroke
) -> Array:
    """Middles (n, 2) of a stroke on the sheet, felt square to it and clear of the line.

    Too few of them are left: the middles as they were.
    """
    width, lean, away = view.width_mm, math.hypot(1.0, slant), stroke.middles[:, 1]
    base = Base(place, square, stroke.side)
    away_mm = median(away) * lean
    farthest_mm = float(away.max()) * lean + width
    seen = stroke_at(view.cells, base, away_mm, farthest_mm, width)
    seen = seen[seen[:, 1] > sizes.CLEAR_OF_LINE * width * lean + 0.5 * width * abs(slant)]
    out = stroke.side * left_of(square)
    return place + seen[:, :1] * square + seen[:, 1:2] * out if len(seen) > 3 else stroke.places


def _robust_line(x: Array, y: Array) -> tuple[float, float]:
    """Slope and offset of the straight line y(x), without places that a speck has drawn aside."""
    for _ in range(2):
        rest = np.abs(y - np.polyval(np.polyfit(x, y, 1), x))
        good = rest <= OUTLIERS * max(ROBUST * median(rest), INCREMENT_MM)
        x, y = x[good], y[good]
    slope, offset = np.polyfit(x, y, 1)
    return float(slope), float(offset)
