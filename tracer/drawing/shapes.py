"""Silhouettes: where the edges of filled shapes are, and how dark the sheet is between paper and shape.

Signals: grey levels in; out the shade that the head's cells see, 0 paper and 1 shape; and where edges are: a
line of `EDGE_MM` whose middle is where the picture is half way, and that middle as outlines.

The head follows the edge by its own cells, and sees the shade only. The line tells which edges there are, how
long they are and where the head may be put down; the outlines serve to check afterwards that it kept to them
(see `edge_check`), and `compare` measures a path by the line. What the scanner's lens has taken off their
corners is put back (see `sharpening`). Where edges are near one another the line is finer, on finer pixels
(see `spacing`). Slits and bridges that are too thin for the lens are closed across (see `closing`). Paper and
shape may both be uneven: their levels are averaged over `ROUND_ABOUT_MM`.

Source: our own; the patent's follower has lines only. Questions: an edge is the same from both sides, so
light shapes on dark paper need no option. Which of the two is paper matters only for ink that is too thin to
be a shape: paper is what covers most of the sheet's border.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.neighbours import Neighbours
from morfax.motion.polyline import lengths_mm as lengths_px
from morfax.motion.polyline import with_places
from morfax.tracer.drawing import tips
from morfax.tracer.drawing.closing import Closed, covers, note, places_of, streaks_of
from morfax.tracer.drawing.components import FRINGE_PX, SOFTENED_PX
from morfax.tracer.drawing.sharpening import Edge, sharpened
from morfax.tracer.drawing.spacing import EDGE_MM, finer, too_near
from morfax.tracer.effort import FINE_PX, ROUNDS

ROUNDED_PX = 1.0  # an edge and its pen, drawn to whole pixels, lie no further aside
EDGE_PX = 2.0  # of a pen that leaves one line at any angle
LEAST_MM = 2.0  # a shorter outline is a speck's
LEAST_CONTRAST = 20.0  # levels
LEAST_SHAPE_MM = 1.0  # across at its widest; what is thinner everywhere is lines
ROUND_ABOUT_MM = 6.0  # standard deviation: over which paper and shape are averaged
SLOPE_PX = 0.3  # to both sides, to measure a slope
LEAST_SLOPE = 0.1  # per pixel
REDUCED = 4  # levels are estimated on a picture reduced by this


Grey = NDArray[np.float32]


class NoShape(DrawingFault):
    """Nothing on the drawing is broad enough, or has an edge sharp enough, to be gone round."""


class ShapeCut(DrawingFault):
    """The border of the sheet cuts every shape."""


@dataclass(frozen=True, slots=True)
class Outlined:
    """Where the edges of filled shapes are: a line along them, on pixels so many times `finer`.

    Its darkness, and the edges (n, 2) in sheet mm. The `shade` of the picture itself, paper 0 and shape 1,
    and notes for the operator.
    """

    darkness: Grey
    shade: Grey
    finer: int
    edges_mm: tuple[Array, ...]
    notes: tuple[str, ...]


def outlined(grey: NDArray[Any], pitch_mm: float) -> Outlined:
    """Where the edges of filled shapes are, and the picture between paper and shape.

    Raises NoShape without any shape, and ShapeCut if the border of the sheet cuts all of them.
    """
    share, shade = _shares(grey, pitch_mm)
    # 1. the edges, without slits and bridges that are too thin for the lens
    closed = list[Closed]()
    for _ in range(ROUNDS):
        sharp, softness_px, notes = _edges(share, pitch_mm)
        pairs = too_near(sharp, softness_px)
        if not len(pairs.back):
            break
        closed += places_of(share, pairs, pitch_mm)
        for cover in covers(share, pairs, softness_px):
            share, shade = cover.over(share), cover.over(shade)
    else:  # as they are after the last closing
        sharp, softness_px, notes = _edges(share, pitch_mm)
    closed += streaks_of(share, softness_px, pitch_mm)
    if closed:
        notes = (*notes, note(closed, softness_px * pitch_mm, max(share.shape) * pitch_mm))
    notes = (*notes, *_of_tips(sharp, softness_px, share.shape, pitch_mm))
    # 2. where they are, as a line
    times = finer(sharp, share.shape, pitch_mm)
    fine = [(edge.outline + 0.5) * times - 0.5 for edge in sharp]
    rows, columns = share.shape
    darkness = pen_along(
        fine, (rows * times, columns * times), max(EDGE_MM / pitch_mm, EDGE_PX)
    )
    edges_mm = tuple(_mm(edge.outline, share.shape, pitch_mm) for edge in sharp)
    return Outlined(darkness, shade, times, edges_mm, notes)


def _of_tips(
    edges: Sequence[Edge], softness_px: float, shape: tuple[int, ...], pitch_mm: float
) -> Iterator[str]:
    """What the operator should know of tips that end short."""
    found = sorted(
        (tip for edge in edges for tip in tips.tips_of(edge, softness_px)),
        key=lambda tip: -tip.short_px,
    )
    if found:
        at_mm = [_mm(tip.place[None], shape, pitch_mm)[0] for tip in found]
        yield tips.note(
            [(tip, (x, y)) for tip, (x, y) in zip(found, at_mm, strict=True)], pitch_mm
        )


def shade_of(grey: NDArray[Any], pitch_mm: float) -> Grey:
    """How much of each pixel is the darker of paper and shape; raises NoShape without any contrast."""
    return _shares(grey, pitch_mm)[1]


def _edges(share: Grey, pitch_mm: float) -> tuple[list[Edge], float, tuple[str, ...]]:
    """The edges of whole shapes with their corners, the lens's softness (pixels), and notes on others."""
    from skimage.measure import find_contours

    edges = [
        edge for edge in find_contours(share, 0.5) if _length_mm(edge, pitch_mm) > LEAST_MM
    ]
    if not edges:
        raise _none()
    _refuse_lines(share, pitch_mm)
    whole = [edge for edge in edges if np.all(edge[0] == edge[-1])]
    cut = [edge for edge in edges if np.any(edge[0] != edge[-1])]
    if not whole:
        raise ShapeCut(_cut(cut, share.shape, pitch_mm))
    softness_px = _softness_px(share, whole)
    sharp = [sharpened(edge, softness_px) for edge in _refined(whole, share)]
    notes = (f"left out: {_cut(cut, share.shape, pitch_mm)}",) if cut else ()
    return sharp, softness_px, notes


def _mm(outline: Array, shape: tuple[int, ...], pitch_mm: float) -> Array:
    """Rows and columns as X and Y, sheet mm."""
    return np.column_stack([outline[:, 1] + 0.5, shape[0] - outline[:, 0] - 0.5]) * pitch_mm


def _none() -> NoShape:
    return NoShape(
        "no filled shape on the drawing: nothing on it has an edge; leave --edge out for lines"
    )


# A scan may have 36 million pixels and more: each picture of float32 is then 144 MB. So they are changed in
# place, and three are held at most beside what is handed out.
def _shares(grey: NDArray[Any], pitch_mm: float) -> tuple[Grey, Grey]:
    """How much of each pixel is the darker of paper and shape, 0..1: of the soft scan, and of the scan."""
    blurred = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), SOFTENED_PX)
    soft = np.asarray(blurred, np.float32)
    low, high = _levels(soft, pitch_mm)
    span = np.maximum(np.subtract(high, low, out=low), LEAST_CONTRAST, out=low)
    for level in (soft, grey):
        share = np.subtract(high, level, out=soft if level is soft else high)
        share /= span
    return soft, high


def _levels(soft: Grey, pitch_mm: float) -> tuple[Grey, Grey]:
    """The levels of the darker and of the lighter of paper and shape round about each pixel."""
    eight_bits = np.clip(soft, 0, 255).astype(np.uint8)
    dark = (soft <= cv2.threshold(eight_bits, 0, 255, cv2.THRESH_OTSU)[0]).view(np.uint8)
    del eight_bits
    low, high = _both_levels(soft, dark, pitch_mm)
    # the second time by levels that are those of the place
    level = np.add(low, high, out=low)
    level *= 0.5
    dark = (soft <= level).view(np.uint8)
    del low, high, level
    low, high = _both_levels(soft, dark, pitch_mm)
    if float(np.median(high - low, overwrite_input=True)) < LEAST_CONTRAST:
        raise _none()
    return low, high


def _both_levels(soft: Grey, dark: NDArray[np.uint8], pitch_mm: float) -> tuple[Grey, Grey]:
    """The levels where it is dark and where it is light; raises DrawingFault where it is only one of them."""
    if not 0 < int(dark.sum()) < dark.size:
        raise _none()
    return _level(soft, dark, pitch_mm), _level(soft, 1 - dark, pitch_mm)


def _level(soft: Grey, part: NDArray[np.uint8], pitch_mm: float) -> Grey:
    """The level of one part of the picture round about each pixel; far from the part its usual level."""
    inner = cv2.erode(part, np.ones((2 * FRINGE_PX + 1,) * 2, np.uint8))
    inner = inner if inner.any() else part
    rows, columns = soft.shape
    reduced = max(1, columns // REDUCED), max(1, rows // REDUCED)
    usual = float(np.median(soft[inner > 0], overwrite_input=True))
    about_px = ROUND_ABOUT_MM / pitch_mm / REDUCED

    def about(values: NDArray[Any]) -> Grey:
        small = cv2.resize(values, reduced, interpolation=cv2.INTER_AREA)
        mean = cv2.GaussianBlur(small, (0, 0), about_px, borderType=cv2.BORDER_REFLECT)
        return np.asarray(mean, np.float32)

    values = soft - np.float32(usual)
    values *= inner
    off = about(values)
    np.copyto(values, inner)
    off /= about(values) + 1e-3
    del values
    whole = np.asarray(
        cv2.resize(off, (columns, rows), interpolation=cv2.INTER_LINEAR), np.float32
    )
    whole += np.float32(usual)
    return whole


def _refuse_lines(share: Grey, pitch_mm: float) -> None:
    """Raise NoShape if nothing on the sheet is as broad as a shape."""
    border = np.concatenate([share[0], share[-1], share[:, 0], share[:, -1]])
    shapes = (share < 0.5) if float(np.median(border)) > 0.5 else (share > 0.5)
    depth_px = cv2.distanceTransform(shapes.view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    broadest_mm = 2 * pitch_mm * float(depth_px.max())
    if broadest_mm < LEAST_SHAPE_MM:
        raise NoShape(
            f"no filled shape on the drawing: what is on it is {broadest_mm:.2g} mm broad at most,"
            f" and a shape is {LEAST_SHAPE_MM:g} mm or more; leave --edge out to follow lines"
        )


def _cut(edges: list[Array], shape: tuple[int, ...], pitch_mm: float) -> str:
    """What is wrong with edges that run off the sheet."""
    x, y = _mm(edges[0][:1], shape, pitch_mm)[0]
    return (
        f"a filled shape is cut by the border of the sheet at {x:.1f},{y:.1f} mm;"
        " scan it whole, with paper all round it (or cut a dark border off the scan)"
    )


def _softness_px(share: Grey, edges: list[Array]) -> float:
    """Standard deviation of the lens, pixels, by how steep the edges are: 1/(√(2π) · steepness)."""
    rows, columns = np.round(np.vstack(edges)).astype(int).T
    ways = (1, 0), (0, 1)
    steep = np.hypot(*(cv2.Sobel(share, cv2.CV_32F, *way, scale=1 / 8) for way in ways))
    steepness = float(np.percentile(steep[rows, columns], 60))
    # the Sobel cells are themselves as soft as (1, 2, 1)/4 along and across, and the pixel as a twelfth
    return float(np.sqrt(max(1 / (2 * np.pi * steepness**2) - 0.4, SOFTENED_PX**2)))


def _refined(edges: list[Array], share: Grey) -> list[Array]:
    """The edges where a smooth surface through the pixels is half way.

    Straight pieces from pixel to pixel would cut corners by a tenth of a pixel.
    """
    from scipy.ndimage import map_coordinates, spline_filter

    surface = spline_filter(share, 3, output=np.float32)

    def height(places: Array) -> Array:
        seen = map_coordinates(surface, places.T, order=3, prefilter=False, mode="nearest")
        return np.asarray(seen, np.float64)

    refined, nearby = list[Array](), SLOPE_PX * np.eye(2)
    for edge in edges:
        places = with_places(edge, FINE_PX)
        for _ in range(2):  # steps of Newton's
            steps = [height(places + way) - height(places - way) for way in nearby]
            slope = np.column_stack(steps) / (2 * SLOPE_PX)
            step = (height(places) - 0.5) / np.maximum((slope**2).sum(axis=1), LEAST_SLOPE**2)
            places = places - np.clip(step, -0.5, 0.5)[:, None] * slope
        refined.append(np.vstack([places[:-1], places[:1]]))
    return refined


def pen_along(edges: Sequence[Array], shape: tuple[int, ...], width_px: float) -> Grey:
    """The darkness that a round pen of a width leaves along edges (n, 2), rows and columns."""
    near, reach_px = np.zeros(shape, np.uint8), 0.5 * width_px + 0.5
    for edge in edges:
        pixels = np.round(edge[:, ::-1]).astype(np.int32)
        cv2.polylines(near, [pixels], False, 1, 2 * math.ceil(reach_px + ROUNDED_PX) + 1)
    rows, columns = np.nonzero(near)
    places = Neighbours(np.vstack([with_places(edge, 0.1) for edge in edges]))
    away_px = places.nearest(np.column_stack([rows, columns]), reach_px)[0]
    darkness = np.zeros(shape, np.float32)
    darkness[rows, columns] = np.clip(reach_px - away_px, 0, 1)
    return darkness


def _length_mm(edge: Array, pitch_mm: float) -> float:
    return float(lengths_px(edge)[-1]) * pitch_mm
