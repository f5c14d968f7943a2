"""The start: the operator puts the head down on a line.

Signals: a drawing, the place that the operator points at and the reference point in (mm); stances out, the
best first, each with the line's length (mm).

The head is put down where the line comes from a reference point (see `open_ends`), else at its open ends,
else where it is smooth, at the plainest place first (see `plain_places`).

Source: patent ES 361967, section on use: the operator brings the head over the drawing.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from morfax.motion.faults import Fault, LineFault
from morfax.tracer.drawing.coarse import at_dpi, finer_dpi
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.inked import is_filled
from morfax.tracer.drawing.narrow import PARTED, narrow_strip_of
from morfax.tracer.drawing.strokes import Sheet, Stroke
from morfax.tracer.following.open_ends import at_ends, stances_at
from morfax.tracer.following.plain_places import (
    ROUND_WIDTHS,
    edge_view_of,
    places_of,
    plainest_first,
    view_of,
)
from morfax.tracer.following.unchanged import changed_of, is_far, on_ink
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.limits import ABOUT_WIDTHS, USUAL_WIDTH_MM
from morfax.tracer.marks.reference import references
from morfax.tracer.sensing.view import View

# All limits below were chosen by trial on the test drawings.
CATCH_MM, CATCH_PX = 3.0, 12.0  # how far from a given place the line may be: the larger
ENDS = 6  # open ends that are tried: a lead line may begin at any
LISTED = 8  # reference points that a message lists


def put_down(
    drawing: Drawing | Sheet,
    start_mm: tuple[float, float] | None = None,
    settings: Settings | None = None,
    reference_mm: tuple[float, float] | None = None,
) -> Iterator[tuple[Stance, float]]:
    """Stances near a place, or on the longest line, the best first, each with the line's length, mm.

    A reference point that is not given is looked for. Raises LineFault if no line is near the place, or the
    line has no clean stretch.
    """
    sheet = drawing if isinstance(drawing, Sheet) else Sheet.of(drawing)
    settings = settings or Settings()
    stroke = _stroke_at(sheet, start_mm)
    sought = _Sought(start_mm, settings, reference_mm)
    for stance in _stances(sheet, stroke, sought):
        yield stance, stroke.length_mm


def _catch_mm(sheet: Sheet) -> float:
    """How far from a given place the line may be."""
    return max(CATCH_MM, CATCH_PX * sheet.drawing.pitch_mm)


def _stroke_at(sheet: Sheet, start_mm: tuple[float, float] | None) -> Stroke:
    """The line nearest to a place, or the longest; raises LineFault if there is none, or none is near."""
    if start_mm is None:
        stroke = sheet.longest()
        if sheet.are_solid[stroke.patch]:
            raise a_dark_area(sheet, stroke)
        return stroke
    return sheet.nearest(start_mm, _catch_mm(sheet))


class _Sought(NamedTuple):
    """What was given of the place where the head is put down: near it, the settings, the reference point."""

    start_mm: tuple[float, float] | None
    settings: Settings
    reference_mm: tuple[float, float] | None

    def view(self, sheet: Sheet, stroke: Stroke) -> View:
        """How the head sees a line of a sheet."""
        width_mm = self.settings.line_width_mm or stroke.width_mm
        return view_of(sheet, self.settings.aperture_mm, width_mm)


def _stances(sheet: Sheet, stroke: Stroke, sought: _Sought) -> Iterator[Stance]:
    """Stances on a line, the best first: at its open ends, of which an edge has none, and at plain places."""
    settings = sought.settings
    if sheet.drawing.shade is not None:
        view, ends = edge_view_of(sheet.drawing, settings.aperture_mm), list[Stance]()
    else:
        yield from _as_before(sheet, stroke, sought)
        view = sought.view(sheet, stroke)
        ends = _ends(view, sheet, stroke, sought)
    yield from ends
    is_clean = bool(ends)
    for stance in _plain(view, stroke, sought.start_mm, _catch_mm(sheet)):
        is_clean = True
        yield stance
    if not is_clean:
        raise _nowhere_clean(sheet, stroke, view.width_mm, settings.line_width_mm)


def _ends(view: View, sheet: Sheet, stroke: Stroke, sought: _Sought) -> list[Stance]:
    """Stances at the open ends of a line, or at those near a place."""
    gap_mm = sought.settings.gap_mm
    if sought.start_mm is not None:
        return _ends_near(view, stroke, sought.start_mm, gap_mm)[:ENDS]
    return at_ends(view, sheet, stroke, gap_mm, sought.reference_mm)[:ENDS]


def _as_before(sheet: Sheet, stroke: Stroke, sought: _Sought) -> Iterator[Stance]:
    """Of a line whose ink was changed elsewhere: the stances that the head had before, so that it runs the
    same way up to there.
    """
    changed_mm = changed_of(sheet.drawing)
    if changed_mm is None or sheet.drawing.bare is None:
        return
    # 1. where the head was put down on the bare drawing
    try:
        before = sheet.drawing.bare.sheet
        old = _stroke_at(before, sought.start_mm)
    except Fault:
        return
    view = sought.view(before, old)
    found = _ends(view, before, old, sought)
    found += _plain(view, old, sought.start_mm, _catch_mm(before))
    # 2. the same on the ink as it is now, where that is still this line
    now = sought.view(sheet, old).cells
    for stance in found:
        if stroke.is_at(stance.place_mm) and is_far(stance, changed_mm):
            yield on_ink(stance, now)


def _plain(
    view: View, stroke: Stroke, start_mm: tuple[float, float] | None, catch_mm: float
) -> Iterator[Stance]:
    """Stances at plain places of a line, the plainest first; the plainest alone of those near a place."""
    if start_mm is None:
        yield from plainest_first(view, places_of(stroke, None))
        return
    for about_mm in (ROUND_WIDTHS * stroke.width_mm, catch_mm):
        near = plainest_first(view, places_of(stroke, start_mm, about_mm))
        if (plainest := next(near, None)) is not None:
            yield plainest
            return


def ends_of(
    sheet: Sheet, stroke: Stroke, settings: Settings, reference_mm: tuple[float, float] | None
) -> list[tuple[Stance, float]]:
    """Stances at the open ends of one of the lines, each with its length, mm."""
    sought = _Sought(None, settings, reference_mm)
    ends = _ends(sought.view(sheet, stroke), sheet, stroke, sought)
    return [(stance, stroke.length_mm) for stance in ends]


def reference_on(drawing: Drawing) -> tuple[float, float]:
    """The place of the only reference point of a drawing, mm; raises LineFault unless there is just one."""
    sheet = Sheet.of(drawing)
    line = sheet.longest()
    found = list(references(sheet, view_of(sheet, None, line.width_mm), line))
    if len(found) == 1:
        return found[0].place_mm
    listed = (reference.place_mm for reference in found[:LISTED])
    places = "; ".join(f"{x:.1f},{y:.1f}" for x, y in listed)
    what = f"{len(found)} crosses and rings, at {places}" if found else "no small cross or ring"
    raise LineFault(
        f"no reference point is certain: the drawing has {what}; give its place in mm instead, --zero X,Y"
    )


def _ends_near(
    view: View, stroke: Stroke, start_mm: tuple[float, float], gap_mm: float
) -> list[Stance]:
    """Stances at the open ends near a place."""
    ends = stroke.ends_mm
    # a start as near to an open end is that end
    near_mm = ABOUT_WIDTHS * max(view.width_mm, USUAL_WIDTH_MM)
    near = ends[np.hypot(*(ends - np.asarray(start_mm)).T) < near_mm]
    return list(stances_at(view, near, gap_mm))


def _nowhere_clean(
    sheet: Sheet, stroke: Stroke, width_mm: float, told_width_mm: float | None
) -> LineFault:
    """The fault of a line on which the head can nowhere be put down."""
    drawing, why, edge = sheet.drawing, "", ""
    is_speckled = sheet.are_speckled()[stroke.patch]
    if is_speckled or is_filled(drawing, sheet.patches, stroke.patch):
        return a_dark_area(sheet, stroke)
    gap = narrow_strip_of(drawing, stroke.middles_mm, width_mm)
    if gap is not None:
        (x, y), dpi = gap.place_mm, finer_dpi(drawing.pitch_mm * drawing.finer, PARTED)
        why = (
            f": at most two pixels of paper part two lines along {gap.length_mm:.0f} mm, as at "
            f"{x:.1f},{y:.1f} mm"
        )
        edge = f"{at_dpi(dpi, is_rendered=drawing.is_rendered)} or more, "
    give = "give" if told_width_mm is None else "give another"
    return LineFault(
        f"no clean stretch of line {width_mm:.2f} mm wide to start on{why}; {edge}follow all the ink with "
        f"--lines all, {give} --line-width, or --start X,Y at a plain stretch"
    )


def a_dark_area(sheet: Sheet, stroke: Stroke) -> LineFault:
    """The fault of a filled shape where a line is asked for; an edge needs paper all round."""
    x, y = stroke.middles_mm[0]
    top, bottom, left, right = sheet.patches.boxes[stroke.patch].tolist()
    rows, columns = sheet.drawing.darkness.shape
    is_whole = top > 0 and left > 0 and bottom < rows and right < columns
    shape = (
        "it is full of specks of paper: soften the picture by 2 pixels, and --edge follows the outline of a "
        "filled shape; or give "
        if sheet.are_speckled()[stroke.patch]
        else "--lines all --edge follows the outlines of filled shapes and the lines beside them; or give "
    )
    use = (
        f"{shape}--start X,Y at a line"
        if is_whole
        else "it reaches the border of the picture: scan the sheet with paper all round, or cut a dark "
        "border off; or give --start X,Y at a line"
    )
    return LineFault(f"the ink at {x:.1f},{y:.1f} mm is a dark area, and no line: {use}")
