"""The photocells: what a cell sees at a place, swept across a line, and round a ring.

Signals: places in sheet mm in, darkness out (0 paper, 1 ink), averaged over the cell's aperture.

A cell swept across a line, u = centre + amplitude·sin(phase), sees a current whose fundamental tells the side
and whose mean tells that the line is there:

    first = 2/N · sum D(u)·sin(phase)       0 when the sweep is centred; its sign is the side
    mean  = 1/N · sum D(u)                  falls when the line goes

                      D     ___________
                           /           \\           amplitude 0.6 of the line's width: the ends of the sweep stand
                      ____/             \\____      just outside the edges, where the current changes most
                         |<-- sweep --->|

Source: patent ES 361967, figure 1: cell 101 on mount 42, eccentric pin 48, synchronous motor 45, amplifier
FSA; cell 102. Questions: the patent gives no aperture. Chosen: a spot of Gaussian weight as wide as a disc of
the aperture (standard deviation a quarter of it).
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numba import njit
from numpy.typing import NDArray

from morfax.tracer.drawing.drawing import Drawing

TWO_PI = 2.0 * math.pi
SPECK_PX, SPECK_MM = 2.2, 0.25  # no wider is a speck: one pixel seen through the aperture
REACH, REACH_PX = (
    0.8,
    3.0,
)  # widths and pixels from where a line is expected, within which its edges are
CLEAN = 0.2  # of the width, by which a clean line's may differ
# a line that is felt may swell: its width follows what was felt, by so much of the difference
FOLLOWS_PER_MM = 0.2
Cells = NDArray[np.float32]


def behind_aperture(drawing: Drawing, aperture_mm: float) -> Cells:
    """Darkness of the drawing averaged over an aperture centred on each pixel; (rows, columns) float32."""
    sigma_px = aperture_mm / 4 / drawing.pitch_mm
    if sigma_px < 0.2:
        return drawing.darkness
    return np.asarray(cv2.GaussianBlur(drawing.darkness, (0, 0), sigma_px), np.float32)


@njit(cache=True, inline="always")
def darkness_at(cells, pitch_mm, x_mm, y_mm):  # type: ignore[no-untyped-def]
    """Darkness under a cell at a place in sheet mm; paper outside the sheet."""
    rows, columns = cells.shape
    x, y = x_mm / pitch_mm - 0.5, rows - y_mm / pitch_mm - 0.5
    i, j = math.floor(y), math.floor(x)
    if i < 0 or j < 0 or i >= rows - 1 or j >= columns - 1:
        return 0.0
    fx, fy = x - j, y - i
    i, j = int(i), int(j)
    above = cells[i, j] * (1 - fx) + cells[i, j + 1] * fx
    below = cells[i + 1, j] * (1 - fx) + cells[i + 1, j + 1] * fx
    return above * (1 - fy) + below * fy


@njit(cache=True)
def sweep(cells, pitch_mm, place, heading, centre_mm, amplitude_mm, samples):  # type: ignore[no-untyped-def]
    """Fundamental and mean of one whole sweep across a heading at a standing place (x, y); (first, mean)."""
    c, s = math.cos(heading), math.sin(heading)
    first = mean = 0.0
    for k in range(samples):
        swing = math.sin(TWO_PI * (k + 0.5) / samples)
        u = centre_mm + amplitude_mm * swing
        d = darkness_at(cells, pitch_mm, place[0] - u * s, place[1] + u * c)
        first += d * swing
        mean += d
    return 2.0 * first / samples, mean / samples


@njit(cache=True)
def edges(cells, pitch_mm, x_mm, y_mm, heading, reach_mm, level):  # type: ignore[no-untyped-def]
    """Where the line under (x, y) ends to the right and to the left of a heading, mm; NaN for an edge out of
    reach or no ink.

    An edge is where the darkness crosses `level`; the search starts at the darkest place within half the
    reach.
    """
    nx, ny = -math.sin(heading), math.cos(heading)
    step = 0.35 * pitch_mm
    half = math.ceil(reach_mm / step)
    best, start = -1.0, 0
    for k in range(-half // 2, half // 2 + 1):
        d = darkness_at(
            cells, pitch_mm, x_mm + k * step * nx, y_mm + k * step * ny
        ) - 1e-3 * abs(k * step)
        if d > best:
            best, start = d, k
    right, left = math.nan, math.nan
    if best < level:
        return right, left
    for side in (-1, 1):
        before = darkness_at(
            cells, pitch_mm, x_mm + start * step * nx, y_mm + start * step * ny
        )
        k = start
        while -half <= k <= half:
            k += side
            now = darkness_at(cells, pitch_mm, x_mm + k * step * nx, y_mm + k * step * ny)
            if now < level:
                found = (k - side * (level - now) / (before - now)) * step
                if side < 0:
                    right = found
                else:
                    left = found
                break
            before = now
    return right, left


@njit(cache=True)
def edge_along(cells, pitch_mm, x_mm, y_mm, direction, reach_mm, level):  # type: ignore[no-untyped-def]
    """How far the ink under (x, y) goes on in a direction, mm; NaN if there is none, or if it reaches
    farther. A light speck in it is passed over.
    """
    c, s, step = math.cos(direction), math.sin(direction), 0.35 * pitch_mm
    found, before = math.nan, darkness_at(cells, pitch_mm, x_mm, y_mm)
    if before < level:
        return found
    for k in range(1, math.ceil(reach_mm / step) + 1):
        now = darkness_at(cells, pitch_mm, x_mm + k * step * c, y_mm + k * step * s)
        if now < level <= before:
            found = (k - (level - now) / (before - now)) * step
        elif now >= level > before:
            found = math.nan
        if k * step - found > min(SPECK_PX * pitch_mm, SPECK_MM):
            return found
        before = now
    return math.nan


@njit(cache=True)
def ring(cells, pitch_mm, centre, radius_mm, level):  # type: ignore[no-untyped-def]
    """Dark arcs that a cell sees going once round a centre: (n, 2) angles where each begins and ends (end >
    begin), rad.

    A ring that is dark all round is one arc of a whole turn.
    """
    samples = max(24, math.ceil(TWO_PI * radius_mm / (0.35 * pitch_mm)))
    seen = np.empty(samples)
    for k in range(samples):
        a = TWO_PI * k / samples
        seen[k] = darkness_at(
            cells,
            pitch_mm,
            centre[0] + radius_mm * math.cos(a),
            centre[1] + radius_mm * math.sin(a),
        )
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
        now, before = seen[(first_light + n) % samples], seen[(first_light + n - 1) % samples]
        if (now < level) != (before < level):
            a = (first_light + n - 1 + (level - before) / (now - before)) * TWO_PI / samples
            if now >= level:
                begin = a
            else:
                arcs[count, 0], arcs[count, 1] = begin, a
                count += 1
    return arcs[:count].copy()


@njit(cache=True)
def scout(cells, pitch_mm, start, heading, step_mm, stations, width_mm, level):  # type: ignore[no-untyped-def]
    """Feel along a line from a place on it: (n, 3) centre x, y and width, mm, where the line is seen clean
    between two edges.

    At each station the edges are found across the way that the last stations point. A station is not clean
    where an edge is missing, where the width leaves what the line has had by a fifth, or where the centre
    leaps aside by a sixth of the width. A speck may spoil a few stations: they are passed over if the line is
    clean for longer behind them; else the clean line ends before them.
    """
    seen = np.empty((stations, 3))
    reach = REACH * width_mm + REACH_PX * pitch_mm
    passed_over = int(max(0.16, 2.5 * pitch_mm) / step_mm)
    x, y = start[0], start[1]
    count = spoilt = 0
    before_speck, since_speck = 0, passed_over + 1
    for _ in range(stations):
        right, left = edges(cells, pitch_mm, x, y, heading, reach, level)
        width, aside = left - right, 0.5 * (left + right)
        slack = CLEAN * width_mm + 0.5 * pitch_mm
        if abs(width - width_mm) < slack and (
            count == 0 or abs(aside) < width_mm / 6 + 0.4 * pitch_mm
        ):
            seen[count, 0], seen[count, 1] = (
                x - aside * math.sin(heading),
                y + aside * math.cos(heading),
            )
            seen[count, 2] = width
            width_mm += FOLLOWS_PER_MM * step_mm * (width - width_mm)
            count += 1
            since_speck += 1
            spoilt = 0
            x, y = seen[count - 1, 0], seen[count - 1, 1]
            if count >= 3:
                heading = onward(seen, count)
        else:
            if since_speck > passed_over:
                before_speck = count
            since_speck = 0
            spoilt += 1
            if spoilt > passed_over or count == 0:
                break
        x, y = x + step_mm * math.cos(heading), y + step_mm * math.sin(heading)
    return seen[: count if since_speck > passed_over else before_speck].copy()


@njit(cache=True)
def onward(seen, count):  # type: ignore[no-untyped-def]
    """Heading from the newest of some stations to the next: that of the last stations' chord, and on by what
    the chords have turned.
    """
    last, back = count - 1, max(0, count - 5)
    chord = math.atan2(seen[last, 1] - seen[back, 1], seen[last, 0] - seen[back, 0])
    if count < 9:
        return chord
    before = math.atan2(seen[back, 1] - seen[back - 4, 1], seen[back, 0] - seen[back - 4, 0])
    turned = math.atan2(math.sin(chord - before), math.cos(chord - before))
    return chord + 0.625 * turned  # from the chord's middle to half a step beyond its end
