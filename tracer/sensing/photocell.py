"""The photocells: what a cell sees at a place, swept across a line, and round a ring.

Signals: places in sheet mm in, darkness out (0 paper, 1 ink), averaged over the cell's aperture.

A cell swept across a line, u = centre + amplitude·sin(phase), sees a current whose fundamental tells the side
and whose mean tells that the line is there:

    first = 2/N · sum D(u)·sin(phase)       0 when the sweep is centred; its sign is the side
    mean  = 1/N · sum D(u)                  falls when the line goes

                      D     ___________
                           /           \\        amplitude 0.6 of the line's width: the ends of the sweep
                      ____/             \\____   stand just outside the edges, where the current changes
                         |<-- sweep --->|         most

Source: patent ES 361967, figure 1: cell 101 on mount 42, eccentric pin 48, synchronous motor 45, amplifier
FSA; cell 102. Questions: the patent gives no aperture. Chosen: a spot of Gaussian weight as wide as a disc of
the aperture (standard deviation a quarter of it).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from morfax.motion.arrays import Array, bounds
from morfax.motion.compiled import keeps_kinds, njit
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.strokes import Window
from morfax.tracer.drawing.tiles import Tiles
from morfax.tracer.sensing import aperture
from morfax.tracer.sensing.behind_spot import Beyond, near_ink, part_behind

TWO_PI = 2.0 * math.pi
LEVEL = 0.5  # an edge is at this share of the line's darkness
STEP_PX = 0.35  # how finely cells look along a ray and round a ring: three steps to a pixel
LEAST_SPREAD_PX = 0.2  # a smaller aperture changes no pixel by more than a scanner's noise


class _Seen(NamedTuple):
    """The fields of `Cells`."""

    darkness: Darkness
    pitch_mm: float
    level: float
    tiles: aperture.MadeTiles = aperture.NONE
    beyond: Beyond = (0, 0, 0, 0)


@keeps_kinds
class Cells(_Seen):
    """What the cells see of a sheet: the darkness behind their aperture, (rows, columns) float32, on pixels
    of `pitch_mm`; and the darkness at which they see an edge. That of a large sheet is empty: it is made
    where the cells look, in `tiles`. Of a part of a sheet the darkness is that part's, and `beyond` it is
    paper.
    """

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the sheet."""
        above, left, below, right = self.beyond
        rows, columns = self.darkness.shape
        return (
            above + rows + below + self.tiles.rows,
            left + columns + right + self.tiles.columns,
        )

    def window(self, top: int, bottom: int, left: int, right: int) -> Darkness:
        """What the cells see in some rows and columns, those of them that are on the sheet."""
        if self.tiles.rows:
            return aperture.window(self.tiles, top, bottom, left, right)
        if not any(self.beyond):
            return self.darkness[top:bottom, left:right]
        (all_rows, all_columns), (above, beside) = self.shape, self.beyond[:2]
        shape = max(min(bottom, all_rows) - top, 0), max(min(right, all_columns) - left, 0)
        seen, (rows, columns) = np.zeros(shape, np.float32), self.darkness.shape
        first, last = max(top, above), min(top + shape[0], above + rows)
        begin, end = max(left, beside), min(left + shape[1], beside + columns)
        if first < last and begin < end:
            own = self.darkness[first - above : last - above, begin - beside : end - beside]
            seen[first - top : last - top, begin - left : end - left] = own
        return seen

    def wider(self, spread_px: float, places: Array, beyond_mm: float) -> Cells:
        """The same behind a further spot of a standard deviation, about some places (n, 2) sheet mm; a small
        sheet is paper further from them.
        """
        if self.tiles.rows:
            return self._replace(darkness=nothing(), tiles=self.tiles.wider(spread_px))
        rows, columns = self.shape
        (left, low), (right, high) = np.stack(bounds(places)) / self.pitch_mm
        about = beyond_mm / self.pitch_mm + 1.0
        top, bottom = max(0, math.floor(rows - high - about)), math.ceil(rows - low + about)
        first, last = max(0, math.floor(left - about)), math.ceil(right + about)
        window = top, first, min(rows, bottom), min(columns, last)
        darkness, beyond = part_behind(self.window, self.shape, spread_px, window)
        return self._replace(darkness=darkness, beyond=beyond)


def behind_aperture(
    drawing: Drawing, aperture_mm: float, level: float = LEVEL, window: Window | None = None
) -> Cells:
    """The drawing's darkness averaged over an aperture centred on each pixel; paper beyond a window."""
    darkness, sigma_px = drawing.darkness, aperture_mm / 4 / drawing.pitch_mm
    if isinstance(darkness, Tiles):
        spread_px = sigma_px if sigma_px >= LEAST_SPREAD_PX else 0.0
        made = aperture.MadeTiles.of(darkness, spread_px)
        return Cells(nothing(), drawing.pitch_mm, level, made)
    if sigma_px >= LEAST_SPREAD_PX and window is None:
        darkness = near_ink(drawing, sigma_px)
    whole = Cells(darkness, drawing.pitch_mm, level)
    if sigma_px < LEAST_SPREAD_PX or window is None:
        return whole
    darkness, beyond = part_behind(whole.window, whole.shape, sigma_px, window)
    return whole._replace(darkness=darkness, beyond=beyond)


def without_aperture(drawing: Drawing, level: float) -> Cells:
    """The drawing through cells as small as a point."""
    return behind_aperture(drawing, 0.0, level)


def nothing() -> Darkness:
    """What stands for the darkness of a large sheet."""
    return np.empty((0, 0), np.float32)


@njit(cache=True, inline="always")
def darkness_at(cells, x_mm, y_mm):  # type: ignore[no-untyped-def]
    """Darkness under a cell at a place in sheet mm; paper outside the sheet."""
    return darkness_on(cells, x_mm / cells.pitch_mm, y_mm / cells.pitch_mm)


@njit(cache=True, inline="always")
def darkness_on(cells, x_px, y_px):  # type: ignore[no-untyped-def]
    """The same at a place in pixels, from the sheet's lower-left corner to the right and up.

    A small sheet does not name `tiles`: numba would count references to all its arrays.
    """
    seen = cells.darkness
    rows, columns = seen.shape
    if rows == 0:
        return aperture.darkness_at(cells.tiles, x_px, y_px)
    above_px, left_px, below_px, _ = cells.beyond
    x = x_px - 0.5
    y = (above_px + rows + below_px) - y_px - 0.5
    i, j = math.floor(y), math.floor(x)
    fx, fy = x - j, y - i
    i, j = i - above_px, j - left_px
    if i < 0 or j < 0 or i >= rows - 1 or j >= columns - 1:
        return 0.0
    i, j = int(i), int(j)
    above = seen[i, j] * (1 - fx) + seen[i, j + 1] * fx
    below = seen[i + 1, j] * (1 - fx) + seen[i + 1, j + 1] * fx
    return above * (1 - fy) + below * fy


@njit(cache=True)
def darkness_along(cells, places_mm):  # type: ignore[no-untyped-def]
    """Darkness under a cell at each of many places (n, 2) in sheet mm."""
    seen = np.empty(len(places_mm))
    _look_along(cells, places_mm, seen)
    return seen


@njit(cache=True, _nrt=False)
def _look_along(cells, places_mm, out):  # type: ignore[no-untyped-def]
    """Fill `out` with the darkness at each of many places."""
    for k in range(len(out)):
        out[k] = darkness_at(cells, places_mm[k, 0], places_mm[k, 1])


@njit(cache=True, _nrt=False)
def sweep(cells, place, heading, swing_mm, samples):  # type: ignore[no-untyped-def]
    """Fundamental and mean of one whole sweep (centre, amplitude) across a heading at a standing place."""
    (centre_mm, amplitude_mm), first, mean = swing_mm, 0.0, 0.0
    c, s = math.cos(heading), math.sin(heading)
    for k in range(samples):
        swing = math.sin(TWO_PI * (k + 0.5) / samples)
        u = centre_mm + amplitude_mm * swing
        d = darkness_at(cells, place[0] - u * s, place[1] + u * c)
        first += d * swing
        mean += d
    return 2.0 * first / samples, mean / samples


@njit(cache=True, inline="always")
def look_round(cells, centre, radius_mm, look, looks):  # type: ignore[no-untyped-def]
    """What a cell sees that goes round a centre, at one of so many looks."""
    a = TWO_PI * look / looks
    x = centre[0] + radius_mm * math.cos(a)
    y = centre[1] + radius_mm * math.sin(a)
    return darkness_at(cells, x, y)


@njit(cache=True)
def looks_round(cells, radius_mm):  # type: ignore[no-untyped-def]
    """How often a cell looks that goes once round."""
    return max(24, math.ceil(TWO_PI * radius_mm / (STEP_PX * cells.pitch_mm)))


@njit(cache=True)
def ring(cells, centre, radius_mm):  # type: ignore[no-untyped-def]
    """Dark arcs that a cell sees going once round a centre: (n, 2) rad, begin and end (end > begin).

    A ring that is dark all round is one arc of a whole turn.
    """
    return ring_along(cells, centre, radius_mm, ways_round(looks_round(cells, radius_mm)))


@njit(cache=True)
def ways_round(looks):  # type: ignore[no-untyped-def]
    """The directions of so many looks once round, cosine and sine (n, 2): rings of one size have the same."""
    ways = np.empty((looks, 2))
    for k in range(looks):
        a = TWO_PI * k / looks
        ways[k, 0], ways[k, 1] = math.cos(a), math.sin(a)
    return ways


@njit(cache=True)
def ring_along(cells, centre, radius_mm, ways):  # type: ignore[no-untyped-def]
    """The arcs of `ring` by its directions."""
    seen = np.empty(len(ways))
    for k in range(len(ways)):
        x = centre[0] + radius_mm * ways[k, 0]
        y = centre[1] + radius_mm * ways[k, 1]
        seen[k] = darkness_at(cells, x, y)
    return dark_arcs(seen, cells.level)


@njit(cache=True)
def dark_arcs(seen, level):  # type: ignore[no-untyped-def]
    """Dark arcs (n, 2) rad of what a cell has seen going once round."""
    samples = len(seen)
    arcs = np.empty((samples // 2 + 1, 2))
    first_light = -1
    for k in range(samples):
        if seen[k] < level:
            first_light = k
            break
    if first_light < 0:
        arcs[0, 0], arcs[0, 1] = -math.pi, math.pi
        return arcs[:1].copy()
    count, begin = 0, math.nan
    for n in range(1, samples + 1):
        now = seen[(first_light + n) % samples]
        before = seen[(first_light + n - 1) % samples]
        if (now < level) != (before < level):
            a = (first_light + n - 1 + (level - before) / (now - before)) * TWO_PI / samples
            if now >= level:
                begin = a
            else:
                arcs[count, 0], arcs[count, 1] = begin, a
                count += 1
    return arcs[:count].copy()
