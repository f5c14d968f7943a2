"""The ledger: the ink that the head has followed is struck off; what is left is still to be followed.

Signals: ways of the head in, (n, 2) sheet mm; out the sheet as the cells see it with the ink along those ways
struck off, and the patches of ink that are left.

Along a way the ink is struck off as wide as the line is there, and a little beyond its edges, where a scan is
soft. A line that crosses loses a piece as long as the way is wide; the ledger knows the sheet as it was, and
tells such a piece from a gap in the ink.

Source: our own; the patent has one contour to a tape.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates
from scipy.spatial import cKDTree

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.polyline import at_lengths, length_mm
from morfax.tracer.drawing.drawing import Darkness, Drawing
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.following.plain_places import aperture_for
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.photocell import LEVEL, Cells
from morfax.tracer.sensing.view import View

EVERY_MM = 0.1  # the width of the line is felt, and its ink struck off, so often along a way
# beyond the edges of a line, pixels: the softness of a scan, and the cells' aperture
FRINGE_PX = 2.5
FADING_PX = 1.0  # over which what is struck off goes over into what is left
WIDEST = 1.6  # of the usual half width: a place that is wider is a junction, and is struck off as the line
INKED = 0.12  # darkness: paler paper need not be struck off
BESIDE_WIDTHS = 0.7  # ink nearer to a way than this is that way's
SPECK_MM = 2.0  # a shorter patch of ink on which no stroke runs is a speck
FAINT = 0.25  # darkness: paler places were paper before
TINY = 1e-9  # so that a sheet of nothing but filled shapes has a width


Patch = tuple[float, float, float]  # about where its middle is, and its length, mm


class Balance(NamedTuple):
    """The ink of a sheet, mm of line by its area: followed, left, specks, and the rims of filled shapes.

    `lost`: patches on which the head could not be put down, (place X, place Y, length) mm, the longest first.
    """

    followed_mm: float
    left_mm: float
    specks_mm: float
    solid_mm: float
    lost: tuple[Patch, ...] = ()

    @property
    def followed_share(self) -> float:
        """Share of the lines' ink along which strokes run; specks and filled shapes apart."""
        return self.followed_mm / max(self.followed_mm + self.left_mm, TINY)


class Ledger:
    """The ink of a drawing that is left to be followed; what has been followed is struck off."""

    def __init__(self, whole: Sheet, line_width_mm: float | None = None) -> None:
        """Open the ledger of a sheet: all its ink is left. The width is that of its lines, if it is known."""
        lengths_mm = np.where(whole.are_solid, 0.0, whole.lengths_mm)
        measured_mm = float(np.average(whole.widths_mm, weights=np.maximum(lengths_mm, TINY)))
        self.whole, self.drawing = whole, whole.drawing
        self.usual_mm = line_width_mm or measured_mm
        self.ink_mm = float(lengths_mm.sum())
        self.left = replace(self.drawing, darkness=self.drawing.darkness.copy())
        self._seen: dict[float, Cells] = {}
        self._ways: list[Array] = []
        self._tree: cKDTree | None = None

    def sheet(self) -> Sheet | None:
        """The patches of ink that are left; None if nothing is left."""
        try:
            return Sheet.of(self.left)
        except DrawingFault:
            return None

    def view(self, width_mm: float, aperture_mm: float | None) -> View:
        """What is left, through cells for a line of a width."""
        spot_mm = round(aperture_mm or aperture_for(self.left, width_mm), 2)
        if spot_mm not in self._seen:
            self._seen[spot_mm] = photocell.behind_aperture(self.left, spot_mm)
        return View(self._seen[spot_mm], width_mm)

    def strike_off(self, way_mm: Array, view: View) -> None:
        """Strike off the ink along a way (n, 2) mm of a line that the view has seen."""
        places = _evenly(way_mm)
        halves_mm = _half_widths(view, places)
        behind = [self.left.darkness, *(cells.darkness for cells in self._seen.values())]
        _strike(behind, self.drawing.pitch_mm, places, halves_mm)
        self._ways.append(places)
        self._tree = None

    @property
    def has_ways(self) -> bool:
        """Whether anything has been struck off."""
        return bool(self._ways)

    def is_left(self, places_mm: Array) -> NDArray[np.bool_]:
        """Which places (n, 2) mm have ink that is left."""
        return np.asarray(_darkness(self.left, places_mm) > LEVEL)

    def was_ink(self, places_mm: Array) -> NDArray[np.bool_]:
        """Which places (n, 2) mm had ink before anything was struck off."""
        return np.asarray(_darkness(self.drawing, places_mm) > FAINT)

    def nearest_way(self, places_mm: Array) -> tuple[Array, Array]:
        """How far places (n, 2) mm are from the nearest way that was followed, mm, and the places there."""
        if not self._ways:
            return np.full(len(places_mm), np.inf), np.zeros((len(places_mm), 2))
        if self._tree is None:
            self._tree = cKDTree(np.vstack(self._ways))
        away, which = self._tree.query(places_mm)
        return np.asarray(away), np.asarray(self._tree.data)[which]

    def balance(self) -> Balance:
        """What has been followed, and what was left."""
        followed_mm = solid_mm = specks_mm = left_mm = 0.0
        for patch, ink_mm in enumerate(self.whole.lengths_mm.tolist()):
            share = 0.0 if self.whole.are_solid[patch] else self._share(patch)
            followed_mm += share * ink_mm
            if self.whole.are_solid[patch]:
                solid_mm += ink_mm
            elif share == 0.0 and ink_mm < SPECK_MM:
                specks_mm += ink_mm
            else:
                left_mm += (1 - share) * ink_mm
        return Balance(followed_mm, left_mm, specks_mm, solid_mm)

    def _share(self, patch: int) -> float:
        """The share of a patch along which a stroke runs."""
        middles = self.whole.stroke(patch).middles_mm
        if not len(middles):
            return 0.0
        away_mm, _ = self.nearest_way(middles)
        width_mm = max(self.usual_mm, float(self.whole.widths_mm[patch]))
        return float(np.mean(away_mm < BESIDE_WIDTHS * width_mm))


def _evenly(way_mm: Array) -> Array:
    """Places along a way, its ends among them, (n, 2) mm."""
    whole = length_mm(way_mm)
    steps = max(1, round(whole / EVERY_MM))
    return at_lengths(way_mm, np.linspace(0.0, whole, steps + 1))


def _half_widths(view: View, places: Array) -> Array:
    """Half the width of the line at each place of a way, (n,) mm; at junctions its usual one."""
    ways = np.gradient(places, axis=0)
    headings = np.arctan2(ways[:, 1], ways[:, 0])
    reach_mm = WIDEST * view.width_mm
    edges = np.array(
        [view.edges(p, h, reach_mm) for p, h in zip(places, headings, strict=True)]
    )
    halves = np.maximum(edges[:, 1], -edges[:, 0])
    known = np.isfinite(halves)
    usual = float(np.median(halves[known])) if known.any() else 0.5 * view.width_mm
    return np.where(known & (halves < WIDEST * usual), halves, usual)


def _strike(behind: list[Darkness], pitch_mm: float, places: Array, halves_mm: Array) -> None:
    """Fade out the ink along places (n, 2) mm in pictures of one size."""
    rows, columns = behind[0].shape
    x, y = places[:, 0] / pitch_mm - 0.5, rows - places[:, 1] / pitch_mm - 0.5
    halves = halves_mm / pitch_mm
    margin = int(np.ceil(halves.max() + FRINGE_PX + FADING_PX)) + 1
    left, top = max(0, int(x.min()) - margin), max(0, int(y.min()) - margin)
    right, bottom = (
        min(columns, int(x.max()) + margin + 2),
        min(rows, int(y.max()) + margin + 2),
    )
    # 1. the pixels beside the way
    beside = np.zeros((bottom - top, right - left), np.uint8)
    line = np.round(np.column_stack([x - left, y - top])).astype(np.int32)
    cv2.polylines(beside, [line], False, 1, 2 * margin)
    beside &= behind[0][top:bottom, left:right] > INKED
    i, j = np.nonzero(beside)
    # 2. faded by how far they are from its edges
    away, which = cKDTree(np.column_stack([x, y])).query(np.column_stack([j + left, i + top]))
    outside = (away - halves[which] - FRINGE_PX) / FADING_PX
    kept = np.clip(outside, 0.0, 1.0).astype(np.float32)
    for picture in behind:
        picture[i + top, j + left] *= kept


def _darkness(drawing: Drawing, places_mm: Array) -> Array:
    """Darkness at places (n, 2) mm, between pixels."""
    x, y = places_mm.T / drawing.pitch_mm
    at = np.array([drawing.darkness.shape[0] - y, x]) - 0.5
    return np.asarray(map_coordinates(drawing.darkness, at, order=1))
