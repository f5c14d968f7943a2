"""The outline of a sheet in a photograph: its four sides, found against the table, and a projection by them.

Signals: a picture in; the four corners of the sheet (px), clockwise from the one at the upper left, and then
sightings of its edges out.

1. On a picture of some 700 pixels, paper and table are parted by lightness and by colour (Otsu's threshold).
   The hull of each large patch has four long straight sides, though a thumb hides a corner: the corners are
   where the sides meet. The outline whose sides show the clearest edge is taken.
2. On the picture itself each side is found over its whole length, every few pixels, and freed of what does
   not lie on the smooth curve of the others: a thumb, a tear, a pencil.

Source: our own. Questions: a table as light as the paper shows no edge; then there is no outline.
"""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import ROBUST, median
from morfax.motion.plane import left_of, unit
from morfax.tracer.effort import ROUNDS
from morfax.tracer.flatten.edges import LEAST_SHARE, Picture, crossings, light_at
from morfax.tracer.flatten.fit import Sightings

SMALL_PX = 700  # longer side of the picture on which the outline is looked for
LEAST_AREA, LARGEST_AREA = 0.08, 0.995  # of the photograph: of a sheet worth a trace
SMOOTHED_PX = 2.0  # of the small picture: away with texture and lines, as standard deviation
HULL_OFF = 0.012  # of the hull's length: bends smaller than this are straight
SQUARE_COS = 0.6  # of a corner's angle: sheets are not seen so aslant
BESIDE = 0.006  # of the diagonal: where paper and table are compared, from the edge
SEEN_SHARE = 0.6  # of the outline: that must show an edge
CLEAR_LIGHT = 0.04  # of white: between paper and table, where an edge is seen
WHITE = 255  # levels
EVERY_PX, AVERAGED = 4.0, 5  # between the places on a side; so many are averaged
END = 0.02  # of a side, at both ends
# how far from the outline an edge is looked for: of the diagonal; then px
WIDE, NARROW_PX = 0.008, 6.0
SMOOTH_DEGREE = 4  # of the curve of a side: lenses draw no more bends
STRAY = 4.0  # robust standard deviations: what is further off is no edge of the sheet
LEAST_STRAY_PX = 0.5
LEAST_SIDE = 0.3  # of a side: that must be seen
STRETCHES = 8  # into which a side's residual is parted

Mask = NDArray[np.uint8]


def outline(picture: Picture) -> Array | None:
    """The corners (4, 2) of the sheet, roughly, clockwise from the upper left, px; None without a sheet."""
    scale = min(1.0, SMALL_PX / max(picture.shape[:2]))
    small = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    best, clearest = None, 0.0
    for mask in _masks(np.asarray(small, np.uint8)):
        for corners in _quadrangles(mask):
            clear = _clearness(np.asarray(small, np.uint8), corners)
            if clear > clearest:
                best, clearest = corners, clear
    return None if best is None else best / scale


def on_a_table(picture: Picture) -> Array | None:
    """The corners (4, 2) of a light sheet on something darker that shows all round it, px; None without one.

    A frame drawn on paper is no sheet: there is paper about it.
    """
    corners = outline(picture)
    size_px = np.array(picture.shape[1::-1], float)
    if corners is None:
        return None
    if (np.minimum(corners, size_px - corners) < BESIDE * np.hypot(*size_px)).any():
        return None
    within = np.zeros(picture.shape[:2], np.uint8)
    cv2.fillConvexPoly(within, np.round(corners).astype(np.int32), 1)
    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    paper, table = (median(grey[within == part]) for part in (1, 0))
    return corners if paper - table > CLEAR_LIGHT * WHITE else None


def sides(picture: Picture, corners_px: Array) -> list[tuple[Array, Array]] | None:
    """Places (n, 2) on each of the four sides, px, and the softness there; None if a side is not seen.

    The sides begin with the upper one and run clockwise.
    """
    diagonal = float(np.hypot(*picture.shape[:2]))
    found = []
    for a, b, outward in _sides(corners_px):
        way = unit(b - a)
        long = float(np.hypot(*(b - a)))
        along = np.arange(END * long, (1 - END) * long, min(EVERY_PX, long / 60))
        away = np.zeros(len(along))
        for reach in (WIDE * diagonal, NARROW_PX):
            on = a + along[:, None] * way + away[:, None] * outward
            seen = crossings(picture, on, np.tile(outward, (len(on), 1)), reach, AVERAGED)
            if len(seen.of) < LEAST_SIDE * len(along):
                return None
            off = (seen.places_px - a) @ outward
            kept, curve = _smooth((along / long)[seen.of], off)
            if np.count_nonzero(kept) < LEAST_SIDE * len(along):
                return None
            away = np.asarray(np.polynomial.polynomial.polyval(along / long, curve), float)
        found.append((seen.places_px[kept], seen.softness_px[kept]))
    return found


def _sides(corners_px: Array) -> Iterator[tuple[Array, Array, Array]]:
    """Each side from corner to corner, px, and its normal, away from the middle."""
    middle = corners_px.mean(axis=0)
    for a, b in zip(corners_px, np.roll(corners_px, -1, axis=0), strict=True):
        way = unit(b - a)
        outward = np.array([way[1], -way[0]])
        yield a, b, outward if outward @ (a - middle) > 0 else -outward


def corners_of(found: list[tuple[Array, Array]]) -> Array:
    """Where straight lines through the four sides meet, clockwise from the upper left, px."""
    lines = [_straight(places) for places, _ in found]
    return np.array([_meet(lines[k - 1], lines[k]) for k in range(4)])


def sightings(found: list[tuple[Array, Array]], width_mm: float, height_mm: float) -> Sightings:
    """What the four sides tell of a sheet of a size: each stretch is a place of its own."""
    # upper, right, lower, left
    lines = [((0, 1), height_mm), ((1, 0), width_mm), ((0, -1), 0.0), ((-1, 0), 0.0)]
    parts = []
    for (normal, offset_mm), (places, softness) in zip(lines, found, strict=True):
        count = len(places)
        parts.append(
            Sightings(
                places,
                np.tile(np.array(normal, float), (count, 1)),
                np.full(count, offset_mm),
                np.arange(count) * STRETCHES // count,
                softness,
            )
        )
    return Sightings.joined(parts)


def _masks(small: Picture) -> Iterator[Mask]:
    """Masks of what may be the sheet: lighter, darker, or of another colour than the rest."""
    soft = cv2.GaussianBlur(small, (0, 0), SMOOTHED_PX)
    lab = cv2.cvtColor(soft, cv2.COLOR_RGB2LAB)
    saturation = cv2.cvtColor(soft, cv2.COLOR_RGB2HSV)[..., 1]
    for channel in (
        lab[..., 0],
        soft[..., 0],
        soft[..., 2],
        saturation,
        lab[..., 2],
        lab[..., 1],
    ):
        for kind in (cv2.THRESH_BINARY, cv2.THRESH_BINARY_INV):
            _, mask = cv2.threshold(
                np.ascontiguousarray(channel), 0, 255, kind | cv2.THRESH_OTSU
            )
            yield np.asarray(mask, np.uint8)


def _quadrangles(mask: Mask) -> Iterator[Array]:
    """Corners (4, 2) of the four long sides of each large patch of a mask."""
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    for contour in contours:
        hull = cv2.convexHull(contour)
        if not LEAST_AREA <= cv2.contourArea(hull) / mask.size <= LARGEST_AREA:
            continue
        plain = cv2.approxPolyDP(hull, HULL_OFF * cv2.arcLength(hull, True), True)
        corners = _four_sides(plain.reshape(-1, 2).astype(float) + 0.5)
        if corners is not None:
            yield corners


def _four_sides(polygon: Array) -> Array | None:
    """Corners of the four longest sides of a convex polygon, clockwise; None if they are aslant."""
    if len(polygon) < 4:
        return None
    lengths = np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T)
    four = np.sort(np.argsort(lengths)[-4:])
    lines = [_straight(polygon[[k, (k + 1) % len(polygon)]]) for k in four]
    corners = [_meet(lines[k - 1], lines[k]) for k in range(4)]
    if not np.isfinite(corners).all():
        return None
    corners_px = np.array(corners)
    ways = unit(np.roll(corners_px, -1, axis=0) - corners_px)
    if (np.abs((ways * np.roll(ways, 1, axis=0)).sum(axis=1)) > SQUARE_COS).any():
        return None
    return clockwise(corners_px)


def clockwise(corners_px: Array) -> Array:
    """Four corners clockwise, as one sees them, from the one nearest to the upper left."""
    x, y = corners_px.T
    if float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) < 0:  # Y runs down
        corners_px = corners_px[::-1]
    return np.roll(corners_px, -int(np.argmin(corners_px.sum(axis=1))), axis=0)


def _clearness(small: Picture, corners_px: Array) -> float:
    """Light between paper and table beside the outline, where it is a clear edge; 0 where too little is.

    What lies outside the photograph does not count as seen.
    """
    rows, columns = small.shape[:2]
    step = max(2.0, BESIDE * float(np.hypot(rows, columns)))
    steps = []
    for a, b, outward in _sides(corners_px):
        on = a + np.linspace(0.04, 0.96, 40)[:, None] * (b - a)
        outer = on + step * outward
        inner = on - step * outward
        inside = np.asarray(((outer > 0) & (outer < (columns, rows))).all(axis=1))
        change = light_at(small, inner) - light_at(small, outer)
        steps.append(np.where(inside[:, None], change, 0.0))
    change = np.concatenate(steps)
    usual = np.array([median(channel) for channel in change.T])
    size = float(np.linalg.norm(usual))
    if size < CLEAR_LIGHT:
        return 0.0
    alike = change @ (usual / size) > max(CLEAR_LIGHT, LEAST_SHARE * size)
    if (
        min(part.mean() for part in np.split(alike, 4)) < LEAST_SIDE
        or alike.mean() < SEEN_SHARE
    ):
        return 0.0
    return (
        float(alike.mean())
        * size
        * float(cv2.contourArea(corners_px.astype(np.float32))) ** 0.5
    )


def _smooth(along: Array, off: Array) -> tuple[NDArray[np.bool_], Array]:
    """Which places lie on a smooth curve, and the curve; what is far off it is left out, worst first."""
    polynomial = np.polynomial.polynomial
    kept: NDArray[np.bool_] = np.ones(len(along), bool)
    curve: Array = np.array([np.median(off)])
    for degree in (1, 2, *[SMOOTH_DEGREE] * ROUNDS):
        curve = np.asarray(polynomial.polyfit(along[kept], off[kept], degree), float)
        away = np.abs(off - polynomial.polyval(along, curve))
        usual = ROBUST * float(np.median(away[kept]))
        kept = away < max(LEAST_STRAY_PX, STRAY * usual)
        if np.count_nonzero(kept) < 2 * SMOOTH_DEGREE:
            return kept, curve
    return kept, curve


def _straight(places: Array) -> Array:
    """The straight line through places: normal and offset, so that normal · place = offset."""
    middle = places.mean(axis=0)
    _, _, ways = np.linalg.svd(places - middle, full_matrices=False)
    normal = left_of(ways[0])
    return np.array([*normal, normal @ middle])


def _meet(a: Array, b: Array) -> Array:
    """Where two lines meet; not finite where they are parallel."""
    with np.errstate(divide="ignore", invalid="ignore"):
        cross = a[0] * b[1] - a[1] * b[0]
        x = a[2] * b[1] - a[1] * b[2]
        y = a[0] * b[2] - a[2] * b[0]
        return np.array([x, y]) / cross
