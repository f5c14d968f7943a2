"""Rubber and pen: ink is rubbed out and drawn on the sheet, as an operator would on paper.

Signals: darkness (rows from the top, columns), strokes in sheet mm, and the usual pen of the drawing in;
darkness with the strokes on it, and the numbers of the strokes that changed ink, out.

Where the rubber has been there is paper without noise: darkness 0. A pen's stroke has the profile that a line
of its width w and darkness a has through the scanner's lens, of softness s, at a distance u from its middle:

    D(u) = a/2 · (erf((w/2 + u) / √2 s) + erf((w/2 - u) / √2 s))

and never makes lighter what is there. A pen without a width takes width and darkness of the lines on which
the stroke begins and ends. There it begins at their middle, though the place was clicked beside it; and a
stroke from line to line leaves them in their own direction, as a cubic.

Source: our own; the profile is that of `drawing.noise`. Questions: grain is not imitated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion import curves
from morfax.motion.arrays import NOT_ZERO, Array
from morfax.motion.plane import heading_of, left_of, unit
from morfax.motion.polyline import evenly
from morfax.tracer.corrections.on_sheet import CorrectionStroke
from morfax.tracer.effort import ROUNDS
from morfax.tracer.limits import FADES, PAPER

Darkness = NDArray[np.float32]

PIECE_PX = 48.0  # of a stroke that is drawn at a time
LEAST_SOFT_PX = 0.3  # a sharper edge than a pixel's own has no profile
# the line at the end of a stroke is felt this far back, in widths of the usual line; by trial
BACK_WIDTHS = np.linspace(0.5, 5.0, 19)
ASIDE_WIDTHS = 2.0  # and so far to both sides
FEWEST = 8  # of those profiles: fewer show no line
STEP_PX = 0.5
WITHIN = 1.0  # widths: a stroke may begin so far beside the middle of its line
ALONG = math.radians(50)  # a stroke that leaves its line at more than this has a corner there
CURVE_PX = 0.5  # between places on a stroke's cubic


class DrawingPen(NamedTuple):
    """The usual pen of a drawing: its width and the softness of its edges, mm."""

    width_mm: float
    soft_mm: float


class _Line(NamedTuple):
    """The line on which a stroke begins: its middle there, mm; the heading out of it; width and darkness."""

    place_mm: Array
    heading_rad: float
    width_mm: float
    dark: float


@dataclass(frozen=True, slots=True)
class Easel:
    """A sheet's darkness, that is drawn on in place, with its pitch and the drawing's usual pen."""

    darkness: Darkness
    pitch_mm: float
    pen: DrawingPen

    def drawn(self, strokes: tuple[CorrectionStroke, ...]) -> frozenset[int]:
        """Draw all strokes in their order; the numbers of those that changed ink."""
        return frozenset(stroke.number for stroke in strokes if self._draw(stroke))

    def _draw(self, stroke: CorrectionStroke) -> bool:
        """Draw one stroke; whether it changed ink."""
        if stroke.do == "rub-area":
            return self._rub_area(stroke.places_mm)
        if stroke.do == "rub":
            return self._rub(stroke.places_mm, stroke.width_mm or self.pen.width_mm)
        return self._bridge(stroke)

    # the rubber

    def _rub(self, places_mm: Array, width_mm: float) -> bool:
        """Rub along a stroke."""
        half_px, changed = 0.5 * width_mm / self.pitch_mm, False
        for piece in self._pieces(places_mm):
            window, away_px = self._window(piece, half_px + 1)
            share = np.clip(half_px - away_px + 0.5, 0.0, 1.0)
            changed = self._rubbed(window, share) or changed
        return changed

    def _rub_area(self, places_mm: Array) -> bool:
        """Rub out all that is inside a polygon."""
        corners = self._pixels(places_mm)
        window = self._box(corners, 1.0)
        share = np.zeros(self.darkness[window].shape, np.uint8)
        at = corners - [window[1].start, window[0].start]
        fixed = np.round(at * 256).astype(np.int32).reshape(-1, 1, 2)
        cv2.fillPoly(share, [fixed], 255, cv2.LINE_AA, 8)
        return self._rubbed(window, share.astype(float) / 255)

    def _rubbed(self, window: tuple[slice, slice], share: Array) -> bool:
        """Rub out a share of the ink in a window; whether there was any."""
        before = self.darkness[window]
        inked = bool(np.any((before > PAPER) & (share > 0.5)))
        self.darkness[window] = (before * (1.0 - share)).astype(np.float32)
        return inked

    # the pen

    def _bridge(self, stroke: CorrectionStroke) -> bool:
        """Draw a stroke of ink, as wide and dark as the lines at its ends if no width is given."""
        places_mm = stroke.places_mm
        begins, ends = self._lines_at(places_mm)
        lines = [line for line in (begins, ends) if line is not None]
        if begins is not None:
            places_mm = np.vstack([begins.place_mm, places_mm[1:]])
        if ends is not None:
            places_mm = np.vstack([places_mm[:-1], ends.place_mm])
        if begins is not None and ends is not None and len(places_mm) == 2:
            places_mm = self._curve(begins, ends)
        usual = [(line.width_mm, line.dark) for line in lines] or [(self.pen.width_mm, 1.0)]
        width_mm, dark = np.mean(usual, axis=0)
        return self._ink(places_mm, stroke.width_mm or float(width_mm), float(dark))

    def _ink(self, places_mm: Array, width_mm: float, dark: float) -> bool:
        """Draw a line of a width and darkness."""
        from scipy.special import erf

        half_px = 0.5 * width_mm / self.pitch_mm
        soft_px = math.sqrt(2) * max(self.pen.soft_mm / self.pitch_mm, LEAST_SOFT_PX)
        changed = False
        for piece in self._pieces(places_mm):
            window, away_px = self._window(piece, half_px + FADES * soft_px)
            profile = erf((half_px + away_px) / soft_px) + erf((half_px - away_px) / soft_px)
            before = self.darkness[window]
            after = np.maximum(before, (0.5 * dark * profile).astype(np.float32))
            changed = changed or bool(np.any(after - before > PAPER * dark))
            self.darkness[window] = after
        return changed

    def _curve(self, begins: _Line, ends: _Line) -> Array:
        """The way from a line to a line, in their own directions, (n, 2) mm."""
        onto_rad = ends.heading_rad + math.pi
        way = curves.hermite(begins.place_mm, begins.heading_rad, ends.place_mm, onto_rad)
        return np.vstack([evenly(way, CURVE_PX * self.pitch_mm), way[-1]])

    def _lines_at(self, places_mm: Array) -> tuple[_Line | None, _Line | None]:
        """The lines on which a stroke begins and ends, if it goes on along them."""
        if len(places_mm) < 2:
            return None, None
        return self._line_at(places_mm[0], places_mm[1]), self._line_at(
            places_mm[-1], places_mm[-2]
        )

    def _line_at(self, end_mm: Array, next_mm: Array) -> _Line | None:
        """The line behind the end of a stroke, by profiles square to the stroke; None if there is none."""
        way = next_mm - end_mm
        if not np.hypot(*way) > 0:
            return None
        ahead = unit(way)
        left = left_of(ahead)
        reach_mm = ASIDE_WIDTHS * self.pen.width_mm
        aside_mm = np.arange(-reach_mm, reach_mm, STEP_PX * self.pitch_mm)
        back_mm = BACK_WIDTHS * self.pen.width_mm
        places = end_mm - back_mm[:, None, None] * ahead + aside_mm[:, None] * left
        felt = [_profile(seen, aside_mm) for seen in self._seen(places)]
        good = np.array([one is not None for one in felt])
        if good.sum() < FEWEST:
            return None
        middles, areas, peaks = np.array([one for one in felt if one is not None]).T
        slope, aside = np.polyfit(-back_mm[good], middles, 2)[1:]
        if abs(aside) > WITHIN * self.pen.width_mm or abs(math.atan(slope)) > ALONG:
            return None
        heading_rad = heading_of(ahead) + math.atan(float(slope))
        across = math.cos(math.atan(float(slope)))  # profiles are square to the stroke
        width_mm, dark = self._pen_of(across * float(np.median(areas)), float(np.median(peaks)))
        return _Line(end_mm + aside * left, heading_rad, width_mm, dark)

    def _pen_of(self, area_mm: float, peak: float) -> tuple[float, float]:
        """Width (mm) and darkness of a line by the area and the height of its profile."""
        from scipy.special import erf

        dark = peak
        for _ in range(ROUNDS):
            width_mm = area_mm / dark
            dark = peak / float(erf(width_mm / (math.sqrt(8) * max(self.pen.soft_mm, 1e-6))))
        return area_mm / dark, dark

    # pixels

    def _pixels(self, places_mm: Array) -> Array:
        """Columns and rows (n, 2) of places, 0 at the middle of the first pixel."""
        x, y = (places_mm / self.pitch_mm).T
        return np.column_stack([x - 0.5, len(self.darkness) - y - 0.5])

    def _seen(self, places_mm: Array) -> Array:
        """Darkness at places (n, k, 2) mm, (n, k)."""
        from scipy.ndimage import map_coordinates

        columns = places_mm[..., 0] / self.pitch_mm - 0.5
        rows = len(self.darkness) - places_mm[..., 1] / self.pitch_mm - 0.5
        seen = map_coordinates(self.darkness, [rows, columns], output=float, order=1, cval=0.0)
        return np.asarray(seen)

    def _pieces(self, places_mm: Array) -> list[Array]:
        """Straight pieces (2, 2) of a stroke, columns and rows, none longer than `PIECE_PX`."""
        places = self._pixels(places_mm)
        if len(places) == 1:
            return [np.vstack([places, places])]
        made = []
        for a, b in pairwise(places):
            count = max(1, math.ceil(float(np.hypot(*(b - a))) / PIECE_PX))
            shares = np.linspace(0.0, 1.0, count + 1)[:, None]
            stops = a + shares * (b - a)
            made += [stops[k : k + 2] for k in range(count)]
        return made

    def _box(self, places: Array, margin_px: float) -> tuple[slice, slice]:
        """The rows and columns about some places that are on the sheet."""
        rows, columns = self.darkness.shape
        low = np.floor(places.min(axis=0) - margin_px).astype(int)
        high = np.ceil(places.max(axis=0) + margin_px).astype(int) + 1
        left, right = np.clip([low[0], high[0]], 0, columns)
        top, bottom = np.clip([low[1], high[1]], 0, rows)
        return slice(int(top), int(bottom)), slice(int(left), int(right))

    def _window(self, piece: Array, margin_px: float) -> tuple[tuple[slice, slice], Array]:
        """The pixels about a piece, and how far each is from it, pixels."""
        window = self._box(piece, margin_px)
        rows, columns = np.mgrid[window]
        begin = piece[0]
        way = piece[1] - piece[0]
        x = columns - begin[0]
        y = rows - begin[1]
        square = max(float(way @ way), NOT_ZERO)
        along = np.clip((x * way[0] + y * way[1]) / square, 0.0, 1.0)
        return window, np.hypot(x - along * way[0], y - along * way[1])


def _profile(seen: Array, aside_mm: Array) -> tuple[float, float, float] | None:
    """Middle, area and height of the line in a profile; None without a line with paper to both sides.

    Of several lines it is the one nearest to the middle of the profile.
    """
    inked = seen > 0.5 * seen.max()
    if seen.max() < PAPER:
        return None
    places = np.flatnonzero(inked)
    # 1. the run of ink nearest to the middle
    middle = int(places[np.argmin(np.abs(aside_mm[places]))])
    paper = np.flatnonzero(~inked)
    if inked[0] or inked[-1]:
        return None
    begin = int(paper[paper < middle][-1]) + 1
    end = int(paper[paper > middle][0]) - 1
    if end - begin < 2:
        return None
    # 2. its soft edges
    while begin > 0 and 0 < seen[begin - 1] < seen[begin]:
        begin -= 1
    while end < len(seen) - 1 and 0 < seen[end + 1] < seen[end]:
        end += 1
    own = slice(begin, end + 1)
    step_mm = aside_mm[1] - aside_mm[0]
    area_mm = float(seen[own].sum()) * step_mm
    middle_mm = float((seen[own] * aside_mm[own]).sum()) * step_mm / area_mm
    return middle_mm, area_mm, float(np.interp(middle_mm, aside_mm, seen))
