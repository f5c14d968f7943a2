"""The reference point: a small cross or ring that the draughtsman drew, to which the operator brings the
head before the run.

Signals: the patches of ink of a drawing and a view in; places (sheet mm) out, each with the lead line that
leaves it, if one does.

    ─┼─   ○       alone on the paper           ─┼────  ○────       with the lead line drawn from it

A cross: a ring of cells sees arms square to each other that end alike, four of them, or three and the lead
line. Its place is where the middle lines of the arms meet. A ring: spokes from its middle meet paper, then
ink as wide as a line, then paper again; its place is the middle of the circle through them.

A cross is nothing but a reference point. A ring is a hole of the part as well: of itself it is a reference
point only where the line that begins at it leads to a contour, or the operator says that a program is drawn.

Source: patent ES 361967, section on use: a reference point, normally outside the contour, and a lead line
from it to the contour. Questions: the patent says neither how it is drawn nor how large it is. Chosen: 1.5 to
10 mm across.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.circle import circle_through
from morfax.motion.median import median
from morfax.motion.plane import direction, heading_of, meeting
from morfax.tracer.drawing.holes import holes
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.marks.sizes import (
    ALIKE,
    BOX,
    CROSS_MM,
    INKED,
    RING_LIKE,
    RING_ROUND,
    RING_SEEN,
    SQUARE,
)
from morfax.tracer.sensing.leg import Leg, leg_of
from morfax.tracer.sensing.probe import SPECK_WIDTHS, is_tip, lines_on
from morfax.tracer.sensing.spokes import SPOKES, WAYS, spokes
from morfax.tracer.sensing.view import View

LEAST_MM, LARGEST_MM = CROSS_MM
MOST_PX = 50_000_000  # of a patch that is searched for holes: a tenth of a second
BESIDE = np.arange(SPOKES) - 1  # of each spoke, the one before it
BEYOND = np.array([1.5, 1.9, 2.3])  # widths beyond the arms, at which the lead line is sought


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference point: its place, mm, and the clean beginning of the lead line that touches it."""

    place_mm: tuple[float, float]
    kind: Literal["cross", "ring"]
    lead: Leg | None = None

    def is_sure(self, sheet: Sheet, patch: int) -> bool:
        """Whether it is one for a line of a patch that begins at it: a cross, or a ring if the patch goes
        round a contour besides.
        """
        if self.kind == "cross" or sheet.bare_rings:
            return True
        return any(
            size_mm > LARGEST_MM or math.dist(middle_mm, self.place_mm) > LEAST_MM
            for middle_mm, size_mm, _ in _inside(sheet, patch)
        )


def references(
    sheet: Sheet, view: View, stroke: Stroke | None = None, about_mm: float = math.inf
) -> Iterator[Reference]:
    """The reference points that stand alone on the sheet, and those that touch a line.

    Of those that stand alone only such as the line comes within `about_mm` of, to all sides of their ink.
    """
    if not sheet.has_references:
        return
    found: list[Reference] = []
    for reference in _every(sheet, view, stroke, about_mm):
        if all(_apart(reference, other) > LEAST_MM for other in found):
            found.append(reference)
            yield reference


def _every(
    sheet: Sheet, view: View, stroke: Stroke | None, about_mm: float
) -> Iterator[Reference]:
    """The reference points, some of them more than once."""
    if stroke is not None:
        yield from _crosses(view, stroke.ends_mm())
        yield from _rings(view, _holes(sheet, stroke.patch))
    for patch, middle in _small_patches(sheet, stroke, about_mm):
        yield from _crosses(view, sheet.stroke(patch).ends_mm())
        yield from _rings(view, [middle])


def _rings(view: View, places: Iterable[Array]) -> Iterator[Reference]:
    """The rings about some places."""
    for place in places:
        if (found := _ring(view, place)) is not None:
            yield found


def _apart(a: Reference, b: Reference) -> float:
    return math.dist(a.place_mm, b.place_mm)


def _small_patches(
    sheet: Sheet, stroke: Stroke | None, about_mm: float
) -> Iterator[tuple[int, Array]]:
    """The patches of a reference point's size, about as high as wide, near a line, and their middles."""
    pitch_mm, boxes = sheet.drawing.pitch_mm, sheet.patches.boxes
    top, bottom, left, right = boxes.T
    high, wide = bottom - top, right - left
    sides_mm = sheet.patches.longer_sides * pitch_mm
    small = (sides_mm >= LEAST_MM) & (sides_mm <= LARGEST_MM) & _is_square(high, wide)
    patches = np.flatnonzero(small)
    middles_mm = sheet.middles_mm(patches)
    if stroke is not None:
        near = _passed(stroke.middles_mm, middles_mm, 0.5 * sides_mm[patches] + about_mm)
        patches, middles_mm = patches[near], middles_mm[near]
    yield from zip(patches.tolist(), middles_mm, strict=True)


def _passed(line_mm: Array, middles_mm: Array, reach_mm: NDArray[Any]) -> NDArray[np.int64]:
    """The numbers of the squares, by middle and reach to each side, that a line enters."""
    low_mm, high_mm = line_mm.min(axis=0), line_mm.max(axis=0)
    away_mm = np.abs(middles_mm - np.clip(middles_mm, low_mm, high_mm)).max(axis=1)
    near = np.flatnonzero(away_mm <= reach_mm).tolist()
    enters = [
        k for k in near if (np.abs(line_mm - middles_mm[k]).max(axis=1) <= reach_mm[k]).any()
    ]
    return np.array(enters, np.int64)


def _is_square(high: Any, wide: Any) -> Any:
    """Whether a box, or each of some, is about as high as wide."""
    return np.minimum(high, wide) > BOX * np.maximum(high, wide)


def _holes(sheet: Sheet, patch: int) -> Iterator[Array]:
    """Middles of the small round holes in a patch of ink."""
    for middle_mm, size_mm, is_square in _inside(sheet, patch):
        if size_mm <= LARGEST_MM and is_square:
            yield middle_mm


def _inside(sheet: Sheet, patch: int) -> Iterator[tuple[Array, float, bool]]:
    """The areas that a patch of ink goes round: middle and longer side, mm, and whether they are about as
    high as wide; smaller ones than a reference point are flaws of the ink.
    """
    chosen = np.arange(sheet.patches.count) == patch
    top, bottom, left, right = sheet.patches.box(chosen)
    if (bottom - top) * (right - left) > MOST_PX:
        return
    pitch = sheet.drawing.pitch_mm
    rows = sheet.drawing.darkness.shape[0]
    ink = sheet.patches.painted(chosen, top, bottom, left, right)
    for x, y, wide, high, _ in holes(ink):
        size_mm = max(wide, high) * pitch
        if size_mm >= LEAST_MM:
            middle_px = left + x + 0.5 * wide, rows - top - y - 0.5 * high
            yield np.array(middle_px) * pitch, size_mm, bool(_is_square(high, wide))


def _crosses(view: View, tips_mm: Array) -> Iterator[Reference]:
    """The crosses whose arms end at some places."""
    tips = [tip for tip in tips_mm if is_tip(view, tip)]
    for i, a in enumerate(tips):
        for b in tips[i + 1 :]:
            if not LEAST_MM < math.dist(a, b) + view.width_mm < LARGEST_MM:
                continue
            others = [c for c in tips if c is not a and c is not b]
            crosses = (_cross(view, a, b, c) for c in others)
            yield from (cross for cross in crosses if cross is not None)


def _cross(view: View, a: Array, b: Array, c: Array) -> Reference | None:
    """The cross whose arms end at three tips, a and b of one stroke.

    The fourth arm may run on as the lead line, or another line may begin anywhere on it.
    """
    # 1. three arms square to each other, and a fourth, all of them inked
    half = 0.5 * (b - a)
    middle = a + 0.5 * (b - a)
    arm = c - middle
    reach = float(np.hypot(*half))
    length = float(np.hypot(*arm))
    if abs(length - reach) >= ALIKE * reach or abs(arm @ half) > SQUARE * length * reach:
        return None
    fourth = -arm * min(1.0, reach / length)
    if not all(_inked(view, middle, middle + way) for way in (-half, half, arm, fourth)):
        return None
    # 2. their middle lines cross in one place, as far from all the tips
    arms = [_felt_inward(view, tip, middle) for tip in (a, b, c)]
    if min(len(arm) for arm in arms) < 4:
        return None
    centre = _crossing(np.vstack(arms[:2]), arms[2])
    reaches = np.hypot(*(np.array([a, b, c]) - centre).T)
    if np.ptp(reaches) > ALIKE * median(reaches):
        return None
    # 3. no lines pass or cross here
    reach_mm = float(reaches.max())
    if lines_on(view, centre, reach_mm + 1.2 * view.width_mm) > 1:
        return None
    return _reference(view, centre, reach_mm, "cross")


def _reference(
    view: View, centre: Array, reach_mm: float, kind: Literal["cross", "ring"]
) -> Reference:
    """A reference point that reaches so far from its centre, with its lead line."""
    place_mm = float(centre[0]), float(centre[1])
    return Reference(place_mm, kind, _lead(view, centre, reach_mm))


def _inked(view: View, a: Array, b: Array) -> bool:
    """Whether there is ink all along a straight stretch, but for a speck of paper."""
    count = 2 + int(math.dist(a, b) / view.pitch_mm)
    return bool(np.mean([view.dark(place) for place in np.linspace(a, b, count)]) > INKED)


def _felt_inward(view: View, tip: Array, middle: Array) -> Array:
    """The clean stations (n, 2) of an arm, felt from its tip towards the middle."""
    way = middle - tip
    length = float(np.hypot(*way))
    start = tip + 0.3 * view.width_mm * way / length
    return view.feel(start, heading_of(way), length - view.width_mm)[:, :2]


def _lead(view: View, centre: Array, reach_mm: float) -> Leg | None:
    """The clean beginning of the line that leaves a cross or a ring, felt back to it as far as it is clean.

    The cross or the ring reaches so far from its centre.
    """
    for arc in view.ring(centre, reach_mm + BEYOND[0] * view.width_mm):
        heading = float(arc.mean())
        way = direction(heading)
        for start in centre + (reach_mm + BEYOND[:, None] * view.width_mm) * way:
            seen = view.feel(start, heading, view.leg_mm)
            if len(seen) < 4:
                continue
            leg = leg_of(seen, False, view.leg_mm)
            back = view.feel(leg.end_mm, leg.heading_rad + math.pi, reach_mm + view.width_mm)
            last = max(1, len(back) - round(view.width_mm / view.step_mm))
            clear = back[1:last]  # of the other arms
            return leg_of(np.vstack([clear[::-1], seen]), False, view.leg_mm)
    return None


def _crossing(one: Array, other: Array) -> Array:
    """Where the straight lines through two strokes' places (n, 2) cross."""
    return meeting(*_straight(one), *_straight(other))


def _straight(places: Array) -> tuple[Array, Array]:
    """Middle and direction of the straight line through places (n, 2), least squares."""
    middle = places.mean(axis=0)
    return middle, np.linalg.svd(places - middle)[2][0]


def _ring(view: View, place: Array) -> Reference | None:
    """The ring about a place."""
    if view.dark(place):
        return None
    changes = spokes(view, place, LARGEST_MM / 2)
    widths = changes[:, 1] - changes[:, 0]
    good = np.abs(widths / view.width_mm - 1) < RING_LIKE
    specks = widths < SPECK_WIDTHS * view.width_mm
    several_lines = _runs(~good & ~specks) > 1  # then it is a part of the drawing
    if good.mean() < RING_SEEN or several_lines:
        return None
    middles = place + changes[good].mean(axis=1)[:, None] * WAYS[good]
    centre, radius_mm, misfit_mm = circle_through(middles)
    if misfit_mm > RING_ROUND * radius_mm or not LEAST_MM < 2 * radius_mm < LARGEST_MM:
        return None
    return _reference(view, centre, radius_mm + 0.5 * view.width_mm, "ring")


def _runs(flags: NDArray[np.bool_]) -> int:
    """How many runs of two or more there are round a circle of flags."""
    twice = flags & flags[BESIDE]
    return int(np.count_nonzero(twice & ~twice[BESIDE]))
