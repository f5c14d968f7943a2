"""Closing across: where the edges of filled shapes are too near for the lens, the shape goes on without them.

Signals: how dark each pixel is between paper and shape, and pairs of places of edges that are too near one
another (pixels), in; the same picture with slits filled and thin bridges left out, and where that is, out.

    ███████ ██████        ██████████████        A slit that narrows to less than two standard deviations of
    ███████ ██████   →    ██████████████        the lens is filled from there on; a bridge of the shape that
    ██████   █████        ██████   █████        is as thin is taken away.

A slit so thin that the lens shows no edge of it is a streak in the shape: it is told of.

Source: our own; an operator closes with the pen what the paper does not show.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.clusters import clusters
from morfax.motion.plane import unit
from morfax.tracer.drawing.components import draw_way
from morfax.tracer.drawing.spacing import CLEAR, Pairs
from morfax.tracer.limits import DETAIL_PX

Grey = NDArray[np.float32]

BEYOND = 2.0  # standard deviations of the lens: so far beyond the edges their softness goes
STROKE_PX = 3  # of the strokes from edge to edge, which are a pixel apart
TOLD = 3  # places that are told one by one
ROOM = 1.15  # times the least distance: what is printed so large is followed
LONGEST_MM = 1189.0  # of paper: A0 (ISO 216)
TIP_PERCENT = 10.0
NARROWS = 0.5  # of the usual distance: a slit that is nearer somewhere narrows to a tip
# darkness of a streak, its depth in the shape (standard deviations of the lens), its least length; by trial
STREAK, STREAK_DEEP, STREAK_MM = 0.8, 4.0, 1.5
STREAK_GAP_MM = 0.3  # half of what noise breaks of it


@dataclass(frozen=True, slots=True)
class Closed:
    """A place that was closed across: its middle, how far apart its edges are as a rule, and its length, mm.

    Of a slit in a shape, or of a thin bridge. `narrows` to nothing, like the tip of a wedge. A streak has no
    edges that were apart.
    """

    place_mm: tuple[float, float]
    apart_mm: float
    length_mm: float
    is_slit: bool
    narrows: bool

    def __str__(self) -> str:
        what = f"{'slit' if self.is_slit else 'bridge'} of {self.apart_mm:.2f} mm"
        if not self.apart_mm:
            what = "slit that shows as a streak only,"
        return (
            f"a {what} over {self.length_mm:.1f} mm at"
            f" {self.place_mm[0]:.1f},{self.place_mm[1]:.1f} mm"
        )


class Cover(NamedTuple):
    """What is laid over a picture: where (0 to 1), and how dark it is."""

    where: Grey
    darkness: float

    def over(self, share: Grey) -> Grey:
        """A picture with this over it."""
        return np.asarray(share + self.where * (self.darkness - share), np.float32)


def covers(share: Grey, pairs: Pairs, softness_px: float) -> Iterator[Cover]:
    """What fills the slits and takes the bridges away where pairs of places are too near."""
    slits = _are_slits(share, pairs)
    for darkness, which in ((1.0, slits), (0.0, ~slits)):
        if which.any():
            where = _strokes(pairs.places[which], share.shape, BEYOND * softness_px)
            soft = cv2.GaussianBlur(where, (0, 0), softness_px)
            yield Cover(np.asarray(soft, np.float32), darkness)


def places_of(share: Grey, pairs: Pairs, pitch_mm: float) -> list[Closed]:
    """The slits and bridges that pairs of places are of, the longest first."""
    middles = pairs.places.mean(axis=1)
    group = clusters(middles, DETAIL_PX)
    order = np.argsort(group, kind="stable")
    slits, found = _are_slits(share, pairs), list[Closed]()
    for mine in (
        np.split(order, np.flatnonzero(np.diff(group[order])) + 1) if len(order) else ()
    ):
        row, column = np.median(middles[mine], axis=0)
        along = np.round(pairs.along[mine][:, 0]).astype(int)
        gaps = np.full(along.max() + 1, np.inf)
        np.minimum.at(gaps, along, pairs.across[mine])
        gaps = gaps[np.isfinite(gaps)]  # straight across from each place
        usual = float(np.median(gaps))
        found.append(
            Closed(
                ((column + 0.5) * pitch_mm, (share.shape[0] - row - 0.5) * pitch_mm),
                usual * pitch_mm,
                len(gaps) * pitch_mm,
                bool(np.mean(slits[mine]) > 0.5),
                bool(np.percentile(gaps, TIP_PERCENT) < NARROWS * usual),
            )
        )
    return sorted(found, key=lambda closed: -closed.length_mm)


def streaks_of(share: Grey, softness_px: float, pitch_mm: float) -> list[Closed]:
    """Slits in the shapes that are too thin for the lens to show an edge of them, the longest first."""
    border = np.concatenate([share[0], share[-1], share[:, 0], share[:, -1]])
    shape = share if float(np.median(border)) < 0.5 else 1 - share
    depth = cv2.distanceTransform((shape > 0.5).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    pale = ((shape < STREAK) & (depth > STREAK_DEEP * softness_px)).view(np.uint8)
    joins = np.ones((2 * round(STREAK_GAP_MM / pitch_mm) + 1,) * 2, np.uint8)
    pale = np.asarray(cv2.morphologyEx(pale, cv2.MORPH_CLOSE, joins), np.uint8)
    _, _, boxes, middles = cv2.connectedComponentsWithStats(pale)
    found = list[Closed]()
    for box, (column, row) in zip(boxes[1:], middles[1:], strict=True):
        length_mm = math.hypot(box[2], box[3]) * pitch_mm
        if length_mm > STREAK_MM:
            x, y = (column + 0.5) * pitch_mm, (share.shape[0] - row - 0.5) * pitch_mm
            found.append(Closed((float(x), float(y)), 0.0, length_mm, True, False))
    return sorted(found, key=lambda closed: -closed.length_mm)


def note(closed: list[Closed], softness_mm: float, sheet_mm: float) -> str:
    """What the operator should know of places that were closed across, and what to do, on a sheet so long."""
    told = "; ".join(map(str, closed[:TOLD]))
    more = f"; and {len(closed) - TOLD} more places" if len(closed) > TOLD else ""
    least_mm = CLEAR * softness_mm
    text = (
        f"this scan cannot show edges nearer than {least_mm:.2f} mm apart; they are closed across:"
        f" {told}{more}"
    )
    even = [each.apart_mm for each in closed if each.apart_mm and not each.narrows]
    if not even:
        return f"{text}; only a finer scan, or a larger print, can show their shape"
    times = math.ceil(10 * ROOM * least_mm / min(even)) / 10
    if times * sheet_mm > LONGEST_MM:
        blur_mm = float(np.median([each.length_mm for each in closed]))
        return (
            f"{text}; no paper is so large that a print of it would part them: they are texture of the shape"
            f" or the paper; fill the shape evenly, or blur the picture by {blur_mm:.1f} mm"
            f" (Gaussian, standard deviation) in a picture editor, and trace that"
        )
    return (
        f"{text}; to follow them, print the shape {times:g} times as large and give --scale"
        f" {1 / times:.4g}"
    )


def _are_slits(share: Grey, pairs: Pairs) -> NDArray[np.bool_]:
    """Whether there is paper between the places of each pair, and not shape."""
    rows, columns = np.round(pairs.places.mean(axis=1)).astype(int).T
    limits = np.array(share.shape) - 1
    return np.asarray(share[np.clip(rows, 0, limits[0]), np.clip(columns, 0, limits[1])] < 0.5)


def _strokes(places: Array, shape: tuple[int, ...], beyond_px: float) -> Grey:
    """Strokes from place to place of each pair (n, 2, 2), and so far beyond."""
    ways = unit(places[:, 1] - places[:, 0])
    begins = places[:, 0] - beyond_px * ways
    stops = places[:, 1] + beyond_px * ways
    ends = np.stack([begins, stops], axis=1)
    cover = np.zeros(shape, np.uint8)
    for stroke in ends[:, :, ::-1]:
        draw_way(cover, stroke, STROKE_PX)
    return cover.astype(np.float32)
