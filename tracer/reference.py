"""The reference point: a small cross or ring that the draughtsman drew, where the operator brings the head before the run.

Signals: the patches of ink of a drawing and the cells' picture in; places (sheet mm) out, each with the lead line that leaves it if it touches one.

    ─┼─   ○       alone on the paper           ─┼────  ○────       with the lead line drawn from it

A cross: a ring of cells sees arms square to each other that end alike, four of them, or three and the lead line. Its place is where the
middle lines of the arms meet. A ring: spokes from its middle meet paper, then ink as wide as a line, then paper again; its place is the middle of the
circle through them.

Source: patent ES 361967, section on use: a reference point, normally outside the contour. Questions: the patent says neither how it is drawn nor how large
it is. Chosen: 1.5 to 10 mm across.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from tracer import photocell
from tracer.leg import Leg, leg_of, reach_of_ink, stroke_end
from tracer.lines import Sheet, Stroke
from tracer.rounds import WAYS, circle_through, spokes
from tracer.view import Array, View

LEAST_MM, LARGEST_MM = 1.5, 10.0  # across
SQUARE = math.sin(math.radians(30))  # of twice the angle between arms: 15 degrees
ALIKE = 0.4  # arms differ by less than this share
MOST_PX = 50_000_000  # of a patch that is looked through for rings


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference point: its place, mm, and the clean beginning of the lead line that touches it."""

    place_mm: tuple[float, float]
    kind: Literal["cross", "ring"]
    lead: Leg | None = None


def references(sheet: Sheet, view: View, stroke: Stroke | None = None) -> Iterator[Reference]:
    """The reference points that stand alone on the sheet, and those that touch a line."""
    found: list[Reference] = []
    own = [] if stroke is None else [*_crossings(view, stroke.ends_mm()), *_holes(sheet, stroke.patch)]
    for place in [*own, *_small_patches(sheet)]:
        reference = _cross(view, place) or _ring(view, place)
        if reference is not None and all(_apart(reference, other) > LEAST_MM for other in found):
            found.append(reference)
            yield reference


def _apart(a: Reference, b: Reference) -> float:
    return math.dist(a.place_mm, b.place_mm)


def _small_patches(sheet: Sheet) -> Iterator[Array]:
    """Middles of the patches of a reference point's size, about as high as wide."""
    pitch, patches = sheet.drawing.pitch_mm, sheet.patches
    small = (patches.longer_sides * pitch >= LEAST_MM) & (patches.longer_sides * pitch <= LARGEST_MM)
    for patch in np.flatnonzero(small):
        top, bottom, left, right = patches.box(np.arange(patches.count) == patch)
        if min(bottom - top, right - left) > 0.7 * max(bottom - top, right - left):
            yield np.array([0.5 * (left + right), sheet.drawing.darkness.shape[0] - 0.5 * (top + bottom)]) * pitch


def _crossings(view: View, ends_mm: Array) -> Iterator[Array]:
    """Where the arms that end at some places cross the line."""
    radius = max(1.5 * view.width_mm, 6 * view.pitch_mm)
    for end in ends_mm:
        arcs = photocell.ring(view.cells, view.pitch_mm, end, radius, view.level)
        if len(arcs) == 1:
            heading = float(arcs.mean())
            seen = view.feel(end + 0.5 * radius * _unit(heading), heading, LARGEST_MM)
            if len(seen):
                yield seen[-1, :2] + (0.5 * view.width_mm + view.step_mm) * _unit(heading)


def _holes(sheet: Sheet, patch: int) -> Iterator[Array]:
    """Middles of the small round holes in a patch of ink."""
    chosen = np.arange(sheet.patches.count) == patch
    top, bottom, left, right = sheet.patches.box(chosen)
    if (bottom - top) * (right - left) > MOST_PX:
        return
    pitch = sheet.drawing.pitch_mm
    contours, _ = cv2.findContours(
        sheet.patches.painted(chosen, top, bottom, left, right), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE
    )
    for contour in contours:
        x, y, wide, high = cv2.boundingRect(contour)
        if LEAST_MM <= max(wide, high) * pitch <= LARGEST_MM and min(wide, high) > 0.7 * max(wide, high):
            yield np.array([left + x + 0.5 * wide, sheet.drawing.darkness.shape[0] - top - y - 0.5 * high]) * pitch


def _cross(view: View, place: Array) -> Reference | None:
    """The cross about a place: three or four arms that end, alike and square to each other."""
    if not view.dark(place):
        return None
    legs = _legs(view, place)
    arms = [leg for leg in legs if stroke_end(view, leg, LARGEST_MM / 2) is not None]
    if (
        len(legs) < 4
        or len(arms) not in (3, 4)
        or any(abs(math.sin(2 * (leg.heading_rad - arms[0].heading_rad))) > SQUARE for leg in arms)
    ):
        return None
    centre = _meeting(arms)
    lengths = np.array([_length(view, leg, centre) for leg in arms])
    usual = float(np.median(lengths))
    if np.ptp(lengths) > ALIKE * usual or not LEAST_MM < 2 * usual < LARGEST_MM:
        return None
    return Reference((float(centre[0]), float(centre[1])), "cross", _lead(view, centre, usual))


def _legs(view: View, place: Array) -> list[Leg]:
    """The four or five strokes that leave a place, where they have parted."""
    for widths in (1.0, 1.4, 2.0, 2.8):  # a lead line between two arms runs together with them at first
        radius = max(widths * view.width_mm, 5 * view.pitch_mm)
        arcs = photocell.ring(view.cells, view.pitch_mm, place, radius, view.level)
        if len(arcs) in (4, 5):
            legs = [_arm(view, place, float(direction), max(1.0, widths - 0.4)) for direction in arcs.mean(axis=1)]
            return [leg for leg in legs if leg is not None]
    return []


def _lead(view: View, centre: Array, reach_mm: float) -> Leg | None:
    """The clean beginning of the line that leaves a cross or ring which reaches so far from its centre."""
    for arc in photocell.ring(view.cells, view.pitch_mm, centre, reach_mm + 1.5 * view.width_mm, view.level):
        leg = _arm(view, centre, float(arc.mean()), reach_mm / view.width_mm + 1.0)
        if leg is not None:
            return leg
    return None


def _arm(view: View, place: Array, direction: float, widths: float = 1.0) -> Leg | None:
    """The clean stretch that leaves a place in a direction, so many widths away from it or a little more."""
    for start in (0.0, 0.3, 0.6):
        seen = view.feel(
            place + max((widths + start) * view.width_mm, 4 * view.pitch_mm) * _unit(direction), direction, view.leg_mm
        )
        if len(seen) >= 4:
            return leg_of(seen, False, view.leg_mm)
    return None


def _length(view: View, arm: Leg, centre: Array) -> float:
    """How far an arm that ends reaches from the centre, mm."""
    return (reach_of_ink(view, arm, LARGEST_MM / 2) or 0.0) + float(np.hypot(*(arm.end_mm - centre)))


def _meeting(legs: list[Leg]) -> Array:
    """The place nearest to the middle lines of all arms, least squares."""
    across = np.array([[-math.sin(leg.heading_rad), math.cos(leg.heading_rad)] for leg in legs])
    away = np.array([n @ leg.end_mm for n, leg in zip(across, legs, strict=True)])
    return np.asarray(np.linalg.lstsq(across, away, rcond=None)[0])


def _ring(view: View, place: Array) -> Reference | None:
    """The ring about a place."""
    if view.dark(place):
        return None
    changes = spokes(view, place, LARGEST_MM / 2)
    widths = changes[:, 1] - changes[:, 0]
    good = np.abs(widths / view.width_mm - 1) < 0.6
    if good.mean() < 0.75 or _runs(~good) > 1:
        return None  # with several lines from it, it is a part of the drawing
    middles = place + changes[good].mean(axis=1)[:, None] * WAYS[good]
    centre, radius_mm, misfit_mm = circle_through(middles)
    if misfit_mm > 0.1 * radius_mm or not LEAST_MM < 2 * radius_mm < LARGEST_MM:
        return None
    lead = _lead(view, centre, radius_mm + 0.5 * view.width_mm)
    return Reference((float(centre[0]), float(centre[1])), "ring", lead)


def _runs(flags: NDArray[np.bool_]) -> int:
    """How many runs of two or more there are round a circle of flags."""
    twice = flags & np.roll(flags, 1)
    return int(np.sum(twice & ~np.roll(twice, 1)))


def _unit(heading: float) -> Array:
    return np.array([math.cos(heading), math.sin(heading)])
