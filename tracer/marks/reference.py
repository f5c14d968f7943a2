"""The reference point: a small cross or ring that the draughtsman drew, to which the operator brings the
head before the run.

Signals: the patches of ink of a drawing and a view in; places (sheet mm) out, each with the lead line that
leaves it, if one does.

    ─┼─   ○       alone on the paper           ─┼────  ○────       with the lead line drawn from it

A cross: see `crosses`. A ring: spokes from its middle meet paper, then ink as wide as a line, then paper
again; its place is the middle of the circle through them.

A cross is nothing but a reference point. A ring is a hole of the part as well, or a box of a form: of itself
it is a reference point only where a single line leaves it and leads to a contour, or the operator says that a
program is drawn.
A symbol, a cross in a circle, marks a position or a hole's middle: it is one only if the operator says so.

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
from morfax.motion.plane import direction
from morfax.tracer.drawing.components import Patches
from morfax.tracer.drawing.holes import holes_in
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.limits import ABOUT_WIDTHS, WIDER
from morfax.tracer.marks.crosses import crosses
from morfax.tracer.marks.entered import entered
from morfax.tracer.marks.sizes import BOX, CROSS_MM, RING_LIKE, RING_ROUND, RING_SEEN
from morfax.tracer.sensing.leg import FEWEST_STATIONS, Leg, leg_of
from morfax.tracer.sensing.probe import SPECK_WIDTHS
from morfax.tracer.sensing.spokes import SPOKES, WAYS, spokes
from morfax.tracer.sensing.view import View, leg_mm

LEAST_MM, LARGEST_MM = CROSS_MM
MOST_PX = 50_000_000  # of a patch that is searched for holes: a tenth of a second
BESIDE = np.arange(SPOKES) - 1  # of each spoke, the one before it
TWO = (
    1.5  # widths: what is as broad, square to the lead line, is nearer to two lines than to one
)
BEYOND = np.array([1.5, 1.9, 2.3])  # widths beyond the arms, at which the lead line is sought

Kind = Literal["cross", "ring", "symbol"]


@dataclass(frozen=True, slots=True)
class Reference:
    """A reference point: its place, mm, the clean beginning of the lead line that touches it, and whether
    more lines leave it.
    """

    place_mm: tuple[float, float]
    kind: Kind
    lead: Leg | None = None
    is_forked: bool = False

    def is_sure(self, sheet: Sheet, patch: int) -> bool:
        """Whether it is one for a line of a patch that begins at it: a cross, or a ring that one line leaves
        if the patch goes round a contour besides.
        """
        if self.kind == "cross" or sheet.bare_rings:
            return True
        if self.kind == "symbol" or self.is_forked:
            return False
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


def reach_mm(width_mm: float, pitch_mm: float) -> float:
    """How far from a line of a width without ends what leads onto it may be: three and a half widths off
    (`BEYOND`), and a third of what is felt of it.
    """
    return 0.5 * leg_mm(width_mm, pitch_mm) + 4 * width_mm


def may_lead(sheet: Sheet, stroke: Stroke) -> bool:
    """Whether a line may begin at a reference point: it has ends, other ink is near it, or it goes round a
    hole that would do, and further than that.
    """
    pitch_mm = sheet.drawing.pitch_mm
    about_px = math.ceil(reach_mm(stroke.width_mm, pitch_mm) / pitch_mm)
    if len(stroke.ends_mm) or not _is_alone(sheet.patches, stroke.patch, about_px):
        return True
    return any(_leads_away(stroke, *each) for each in _inside(sheet, stroke.patch))


def _is_alone(patches: Patches, patch: int, about_px: int) -> bool:
    """Whether no other patch has ink within the box about a patch, so many pixels wider to each side."""
    top, bottom, left, right = patches.boxes[patch].tolist()
    rows = patches.runs_between(top - about_px, bottom + about_px)
    others = patches.patch[rows] != patch
    within = (patches.begin[rows] < right + about_px) & (patches.end[rows] > left - about_px)
    return not np.any(others & within)


def _leads_away(stroke: Stroke, middle_mm: Array, size_mm: float, is_square: bool) -> bool:
    """Whether a line is more than a ring about a hole of a reference point's size."""
    if not is_square or size_mm > LARGEST_MM:
        return False
    away_mm = np.hypot(*(stroke.middles_mm - middle_mm).T).max()
    return bool(away_mm > 0.5 * size_mm + stroke.width_mm)


def _every(
    sheet: Sheet, view: View, stroke: Stroke | None, about_mm: float
) -> Iterator[Reference]:
    """The reference points, some of them more than once."""
    if stroke is not None:
        yield from _crosses(view, stroke)
        yield from _rings(view, _holes(sheet, stroke.patch))
    for patch, middle in _small_patches(sheet, stroke, about_mm):
        yield from _crosses(view, sheet.stroke(patch))
        yield from _rings(view, [middle])


def _crosses(view: View, stroke: Stroke) -> Iterator[Reference]:
    """The crosses and symbols whose arms end where a stroke does."""
    for cross in crosses(view, stroke.ends_mm):
        yield _reference(view, cross.centre_mm, cross.reach_mm, cross.kind)


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
        near = entered(stroke.middles_mm, middles_mm, 0.5 * sides_mm[patches] + about_mm)
        patches, middles_mm = patches[near], middles_mm[near]
    yield from zip(patches.tolist(), middles_mm, strict=True)


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
    top, bottom, left, right = sheet.patches.boxes[patch].tolist()
    if (bottom - top) * (right - left) > MOST_PX:
        return
    pitch = sheet.drawing.pitch_mm
    rows = sheet.drawing.darkness.shape[0]
    for x, y, wide, high, _ in holes_in(sheet.patches, patch):
        size_mm = max(wide, high) * pitch
        if size_mm >= LEAST_MM:
            middle_px = left + x + 0.5 * wide, rows - top - y - 0.5 * high
            yield np.array(middle_px) * pitch, size_mm, bool(_is_square(high, wide))


def _reference(view: View, centre: Array, reach_mm: float, kind: Kind) -> Reference:
    """A reference point that reaches so far from its centre, with its lead line."""
    place_mm = float(centre[0]), float(centre[1])
    leads = _leads(view, centre, reach_mm)
    if kind == "ring":  # a line that touches it comes by
        leads = (each for each in leads if _leaves(view, centre, reach_mm, each))
    lead = next(leads, None)
    is_forked = kind == "ring" and next(leads, None) is not None
    return Reference(place_mm, kind, lead, is_forked)


def _leads(view: View, centre: Array, reach_mm: float) -> Iterator[Leg]:
    """The clean beginnings of the lines that leave a cross or a ring, felt back to it as far as they are
    clean.

    The cross or the ring reaches so far from its centre. Two lines that part there are a part of the drawing.
    """
    radius_mm = reach_mm + BEYOND[0] * view.width_mm
    arcs = view.ring(centre, radius_mm)
    middles_mm = radius_mm * arcs.mean(axis=1)
    for arc, middle_mm in zip(arcs, middles_mm, strict=True):
        apart_mm = np.abs(_round(middles_mm - middle_mm, math.tau * radius_mm))
        if np.count_nonzero(apart_mm < ABOUT_WIDTHS * view.width_mm) > 1:
            continue
        heading = float(arc.mean())
        way = direction(heading)
        for start in centre + (reach_mm + BEYOND[:, None] * view.width_mm) * way:
            seen = view.feel(start, heading, view.leg_mm)
            if len(seen) < FEWEST_STATIONS:
                continue
            if _widens(view, seen):
                break
            leg = leg_of(seen, False, view.leg_mm)
            across_mm = radius_mm * float(np.ptp(arc)) * math.cos(leg.heading_rad - heading)
            if across_mm > TWO * view.width_mm:  # two that part only further on
                break
            back = view.feel(leg.end_mm, leg.heading_rad + math.pi, reach_mm + view.width_mm)
            last = max(1, len(back) - round(view.width_mm / view.step_mm))
            clear = back[1:last]  # of the other arms
            yield leg_of(np.vstack([clear[::-1], seen]), False, view.leg_mm)
            break


def _leaves(view: View, centre: Array, reach_mm: float, lead: Leg) -> bool:
    """Whether the line of a lead leaves the ring that reaches so far: ink leads back from it to the ring."""
    back = lead.at(-np.arange(0.0, reach_mm, view.step_mm))
    on_ring = np.hypot(*(back - centre).T) < reach_mm
    if not on_ring.any():
        return False
    return bool((view.darkness_along(back[: np.argmax(on_ring)]) > view.level).all())


def _round(along_mm: Array, circle_mm: float) -> Array:
    """Distances along a circle, the shorter way round, with their sign."""
    half_mm = 0.5 * circle_mm
    return (along_mm + half_mm) % circle_mm - half_mm


def _widens(view: View, seen: Array) -> bool:
    """Whether a line that is clean for less than a leg has grown wider until then: two lines part there."""
    is_short = (len(seen) - 1) * view.step_mm < view.leg_mm - view.step_mm
    return is_short and median(seen[-FEWEST_STATIONS:, 2]) > WIDER * view.width_mm


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
