"""Marks in a photograph: which are seen, where their edges are, and the bar beside them.

Signals: a picture in; the layout that the marks belong to and sightings of their edges out.

OpenCV finds the marks; their edges are then placed over their whole length, corners left out, since a blurred
corner is round.

Source: Garrido-Jurado and others 2014 for the marks; OpenCV's detector. Questions: a drawing may look like a
mark; so marks that do not lie as the layout says are left out.
"""

from __future__ import annotations

import cv2
import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.plane import unit
from morfax.tracer.flatten.edges import Picture, crossings
from morfax.tracer.flatten.fit import Fit, Sightings, fitted, homography_of
from morfax.tracer.flatten.layout import (
    BAR_END_MM,
    BAR_THICK_MM,
    SQUARES,
    Layout,
    dictionary,
    layout_of,
)
from morfax.tracer.flatten.projection import Projection, Rectangle, projected

FEWEST = 4  # marks: fewer may be a drawing that looks like them
LEAST_SPREAD = 0.6  # of the area within all marks: beyond the marks found the map is a guess
STRAY = 0.03  # half diagonals of the photograph: lenses and bent paper move marks less
PER_EDGE = 24  # places on an edge of a mark
CORNER = 0.12  # of an edge, at both ends: round by blur
REACH_SQUARES, LARGEST_REACH_PX = 0.8, 6.0  # across an edge: within the border of the mark
BAR_PLACES = 15  # across the stroke at an end of the bar

Marks = dict[int, Array]  # corners (4, 2) by number, px


def marks_in(picture: Picture) -> Marks:
    """The marks in a picture; raises DrawingFault if one is there twice."""
    settings = cv2.aruco.DetectorParameters()
    settings.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    corners, numbers, _ = cv2.aruco.ArucoDetector(dictionary(), settings).detectMarkers(grey)
    if numbers is None:
        return {}
    found: Marks = {}
    for number, four in zip(numbers.ravel().astype(int), corners, strict=True):
        number = int(number)
        if number in found:
            raise DrawingFault(
                f"mark {number} is in the photograph twice; photograph one sheet at a time"
            )
        found[number] = np.asarray(four, float).reshape(4, 2) + 0.5
    return found


def sheet_of(marks: Marks, photo: Rectangle) -> tuple[Layout, Marks] | None:
    """The layout of some marks, and those of them that lie as it says; None if they are too few."""
    layout = layout_of(list(marks))
    if layout is None:
        return None
    numbers = [number for number in marks if number in layout.marks_mm]
    if len(numbers) < FEWEST:
        return None
    places_mm = np.vstack([layout.marks_mm[number] for number in numbers])
    places = photo.from_middle(np.vstack([marks[number] for number in numbers]))
    likely, _ = cv2.findHomography(places_mm, places, cv2.RANSAC, STRAY)
    if likely is None:
        return None
    homography = np.asarray(likely, float)
    off = np.hypot(*(projected(homography, places_mm) - places).T).reshape(-1, 4).max(axis=1)
    true = {
        number: marks[number] for number, far in zip(numbers, off, strict=True) if far < STRAY
    }
    return (layout, true) if len(true) >= FEWEST else None


def fit_marks(picture: Picture, layout: Layout, marks: Marks) -> Fit:
    """Fit a projection to the marks' edges; raises DrawingFault if the marks found are on one side only."""
    photo = Rectangle(picture.shape[1], picture.shape[0])
    sheet = Rectangle(layout.paper.width_mm, layout.paper.height_mm)
    places_mm = np.vstack([layout.marks_mm[number] for number in marks])
    spread = _area(places_mm) / _area(np.vstack(list(layout.marks_mm.values())))
    if spread < LEAST_SPREAD:
        raise DrawingFault(
            f"only {len(marks)} of {len(layout.marks_mm)} marks are seen, around {100 * spread:.0f} % of"
            f" the sheet, and {100 * LEAST_SPREAD:.0f} % are needed; photograph the whole sheet, sharp and"
            " evenly lit"
        )
    first = homography_of(places_mm, np.vstack(list(marks.values())), sheet, photo)
    seen = [_edges(picture, layout.marks_mm[number], marks[number]) for number in marks]
    sightings = [each for each in seen if each is not None]
    if len(sightings) < FEWEST:
        raise DrawingFault(
            f"{len(sightings)} of {len(marks)} marks are sharp enough to be placed, and {FEWEST} are needed; "
            "photograph the sheet sharp and evenly lit"
        )
    return fitted(Sightings.joined(sightings), sheet, photo, first, inked=True)


def bar_length_mm(picture: Picture, layout: Layout, projection: Projection) -> float | None:
    """Length of the bar as it is seen, mm of the layout; None if an end cannot be seen."""
    ends = [_bar_end(picture, layout, projection, sign) for sign in (-1.0, 1.0)]
    if ends[0] is None or ends[1] is None:
        return None
    return ends[1] - ends[0]


def _bar_end(
    picture: Picture, layout: Layout, projection: Projection, sign: float
) -> float | None:
    """Middle of the stroke at one end of the bar, X from the bar's middle outwards by its thickness, mm."""
    x, y = layout.bar_mm[0 if sign < 0 else 1]
    ups = np.linspace(-0.35, 0.35, BAR_PLACES) * BAR_END_MM
    ups = ups[np.abs(ups) > BAR_THICK_MM]  # beside the bar itself
    reach = 0.5 * BAR_THICK_MM
    found = []
    for edge, way in ((x, sign), (x - sign * BAR_THICK_MM, -sign)):
        places_mm = np.column_stack([np.full(len(ups), edge), y + ups])
        at, beyond = (
            projection.to_photo(places_mm),
            projection.to_photo(places_mm + np.array([way * reach, 0.0])),
        )
        across = beyond - at
        reach_px = float(np.median(np.hypot(*across.T)))
        outward = unit(across)
        seen = crossings(picture, at, outward, reach_px).places_px
        if len(seen) < len(ups) / 2:
            return None
        found.append(float(np.median(projection.to_sheet(seen)[:, 0])))
    return (found[0] + found[1] + sign * BAR_THICK_MM) / 2


def _edges(picture: Picture, corners_mm: Array, corners_px: Array) -> Sightings | None:
    """Sightings of the four edges of a mark; None if one of them is not seen."""
    sides_px = np.hypot(*(np.roll(corners_px, -1, axis=0) - corners_px).T)
    reach = min(LARGEST_REACH_PX, REACH_SQUARES * float(sides_px.min()) / SQUARES)
    shares = np.linspace(CORNER, 1 - CORNER, PER_EDGE)[:, None]
    middle_px, middle_mm = corners_px.mean(axis=0), corners_mm.mean(axis=0)
    parts = []
    for k in range(4):
        a = corners_px[k]
        b = corners_px[(k + 1) % 4]
        outward = _normal(a, b, middle_px)
        seen = crossings(picture, a + shares * (b - a), np.tile(outward, (PER_EDGE, 1)), reach)
        if len(seen.of) < PER_EDGE / 2:
            return None
        normal = _normal(corners_mm[k], corners_mm[(k + 1) % 4], middle_mm)
        count = len(seen.of)
        parts.append(
            Sightings(
                seen.places_px,
                np.tile(normal, (count, 1)),
                np.full(count, normal @ corners_mm[k]),
                np.zeros(count, np.intp),
                seen.softness_px,
            )
        )
    whole = Sightings.joined(parts)
    return Sightings(
        whole.places_px,
        whole.normals,
        whole.offsets_mm,
        np.zeros_like(whole.place),
        whole.softness_px,
    )


def _normal(a: Array, b: Array, inside: Array) -> Array:
    """Unit vector square to the way from a to b, away from a place inside."""
    x, y = unit(b - a)
    normal = np.array([y, -x])
    return normal if normal @ (a - inside) > 0 else -normal


def _area(places: Array) -> float:
    """Area of the hull of places."""
    return float(cv2.contourArea(cv2.convexHull(places.astype(np.float32))))
