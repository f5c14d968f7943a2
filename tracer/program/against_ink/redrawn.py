"""Redrawn: on a coarse scan, the ink that the head's pen would leave on a way is held against the scan's.

Signals: the sheet's darkness and a closed way (n, 2) mm in; out the place at which the two differ most, and
by how much darkness.

A line of about one pixel has no edges to be felt: a way that cuts off a corner or doubles a spike stays on
grey pixels. But then its ink lies on other pixels than the sheet's:

    darkness left = a · (length of the way in each pixel, behind a spot)

Height a and spot are those that explain the sheet best; both differences are averaged over about a pixel.

Source: our own, as tangles are redrawn (see `tangles`). Questions: the spot is round, and no pen's; a line of
three pixels and more has a flat top, and is not judged.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.polyline import evenly, length_mm
from morfax.tracer.drawing.components import FRINGE_PX
from morfax.tracer.drawing.discs import disc
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.tangles.tangle import DARKEST

Darkness = NDArray[np.float64]

# All limits below were chosen by trial on scans of lines of 1 to 2 pixels.
SAMPLES = 10  # places of the way to a pixel
SPOTS_PX = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1)  # standard deviations that are tried
AVERAGED_PX = 0.8  # standard deviation of the average of what differs
BESIDE_PX = 1.5  # further from the way other lines may lie
DARK = 98.0  # percent of the places are less dark than the darkest ink


class Astray(NamedTuple):
    """Where a way and the ink differ most, mm, and by how much darkness."""

    place_mm: tuple[float, float]
    darkness: float


def most_astray(drawing: Drawing, way_mm: Array) -> Astray:
    """Where the ink that a pen would leave on a way differs most from what is on a coarse scan."""
    finer, pitch_mm = drawing.finer, drawing.pitch_mm
    # 1. the sheet about the way, and how much of the way is in each pixel
    around = FRINGE_PX * finer
    rows, columns = _pixels(drawing, way_mm)
    top, left = (max(0, int(at.min()) - around) for at in (rows, columns))
    bottom, right = (int(at.max()) + around + 2 for at in (rows, columns))
    sheet = np.asarray(drawing.darkness[top:bottom, left:right], np.float64)
    places = evenly(way_mm, pitch_mm * finer / SAMPLES)
    row, column = _pixels(drawing, places)
    spread = _spread(np.column_stack([row - top, column - left]), sheet.shape)
    there = spread * (length_mm(way_mm) / len(places) / pitch_mm)
    # 2. the spot and the height that explain the sheet best
    about = cv2.dilate((there > 0).astype(np.uint8), disc(around)) > 0
    redrawn = min(
        (_redrawn(there, sheet, about, spot * finer) for spot in SPOTS_PX),
        key=lambda drawn: float(np.mean((drawn - sheet)[about] ** 2)),
    )
    # 3. what differs, beside the way
    wide = 2 * math.ceil(BESIDE_PX * finer) + 1
    beside = cv2.dilate((there > 0).astype(np.uint8), np.ones((wide, wide), np.uint8)) > 0
    differs = np.abs(cv2.GaussianBlur(sheet - redrawn, (0, 0), AVERAGED_PX * finer)) * beside
    below, beyond = np.unravel_index(int(np.argmax(differs)), differs.shape)
    x_mm = (left + beyond + 0.5) * pitch_mm
    y_mm = (drawing.darkness.shape[0] - top - below - 0.5) * pitch_mm
    return Astray((float(x_mm), float(y_mm)), float(differs[below, beyond]))


def _pixels(drawing: Drawing, places: Array) -> tuple[Array, Array]:
    """The rows and the columns of some places (n, 2) mm; whole ones are the middles of pixels."""
    rows = drawing.darkness.shape[0]
    x_px, y_px = places.T / drawing.pitch_mm
    return rows - y_px - 0.5, x_px - 0.5


def _spread(at: Array, shape: tuple[int, ...]) -> Darkness:
    """Places (n, 2) of rows and columns, each shared out among the four pixels about it."""
    first = np.floor(at).astype(int)
    share = at - first
    sums = np.zeros(shape[0] * shape[1])
    for down in (0, 1):
        for right in (0, 1):
            row = np.clip(first[:, 0] + down, 0, shape[0] - 1)
            column = np.clip(first[:, 1] + right, 0, shape[1] - 1)
            of_row = np.abs(1 - down - share[:, 0])
            of_column = np.abs(1 - right - share[:, 1])
            pixel = row * shape[1] + column
            sums += np.bincount(pixel, of_row * of_column, len(sums))
    return sums.reshape(shape)


def _redrawn(
    there: Darkness, sheet: Darkness, about: NDArray[np.bool_], spot: float
) -> Darkness:
    """The ink of a way behind a spot, as high as explains the sheet best."""
    soft = cv2.GaussianBlur(there, (0, 0), spot)
    height = float(np.sum((soft * sheet)[about]) / np.sum((soft * soft)[about]))
    darkest = DARKEST * float(np.percentile(sheet[about], DARK))
    return np.minimum(height * soft, darkest)
