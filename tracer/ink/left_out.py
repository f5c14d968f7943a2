"""Left out: ink of a sheet along which no stroke is to run, by reason, and the ink that is left for strokes.

Signals: the patches of a sheet, and how high lettering must be to be followed (mm), in; out the ink of lines,
and beside it letters and solid areas.

    filled shapes    their rims: the paper within was taken for dark paper (see `drawing.paper`)
    solid areas      broader than a line (see `drawing.solids`)
    letters          patches in rows (see `drawing.lettering`), if they are not to be followed

Source: our own; the patent has one contour to a tape. Questions: letters that are joined to lines, or to each
other, are lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import INK, SOFTENED_PX, Mask, strips
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.large import HALO_PX
from morfax.tracer.drawing.lettering import lettering, lower_than
from morfax.tracer.drawing.packed import PackedMask
from morfax.tracer.drawing.solids import Solids
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.effort import FEW_PX

OUTLINE_PX = 0.5  # so near an outline is drawn, for the eye
RIM_PX = 1  # of a solid area beyond the place where it is half as dark


Box = tuple[float, float, float, float]  # left, bottom, right, top, mm


class Area(NamedTuple):
    """Ink that no stroke runs along: what it is, how large it is (mm²), the box about it, and of a solid area
    its outline: one line, to and fro along the same way where it comes to a hole.
    """

    what: Literal["solid area", "letter", "outlined area"]
    area_mm2: float
    box_mm: Box
    outline_mm: tuple[tuple[float, float], ...] = ()

    @property
    def place_mm(self) -> tuple[float, float]:
        """The middle of its box, mm."""
        left, bottom, right, top = self.box_mm
        return 0.5 * (left + right), 0.5 * (bottom + top)


class InkLeft(NamedTuple):
    """The ink of a sheet's lines, the drawing as it was read, and what was left out.

    Which patches are lettering, which of them are left out, the pixels of each patch that are solid areas,
    these, and where they are. Masks are packed: they last as long as the trace.
    """

    packed_ink: PackedMask
    read: Drawing
    lettering: NDArray[np.bool_]
    letters: NDArray[np.bool_]
    solid_px: NDArray[np.float64]
    areas: tuple[Area, ...]
    packed_solid: PackedMask

    @property
    def ink(self) -> Mask:
        """The ink of lines, a mask that is made when it is asked for."""
        return self.packed_ink.mask()

    @property
    def solid(self) -> Mask:
        """The solid areas, a mask that is made when it is asked for."""
        return self.packed_solid.mask()

    @property
    def drawing(self) -> Drawing:
        """The drawing without its solid areas, made when it is asked for: it is as large as the sheet."""
        are_solid = any(area.what == "solid area" for area in self.areas)
        return _without(self.read, self.solid) if are_solid else self.read


def ink_left(sheet: Sheet, letters_from_mm: float = 0.0) -> InkLeft:
    """The ink of lines; lettering as high as is given, or higher, is lines."""
    ink = _ink(sheet.drawing)
    rows, columns = ink.shape
    # 1. lettering, and the rims of filled shapes
    patches, pitch_mm = sheet.patches, sheet.drawing.pitch_mm
    is_lettering, letters = np.zeros(patches.count, bool), np.zeros(patches.count, bool)
    found = lettering(sheet)
    is_lettering[sorted(found)] = True
    letters[sorted(lower_than(sheet, found, letters_from_mm))] = True
    gone = letters | sheet.are_solid
    if gone.any():
        ink &= 1 - patches.painted(gone, 0, rows, 0, columns)
    # 2. solid areas
    solids = Solids.of(ink)
    solid_px = np.zeros(patches.count)
    if solids.each:
        solid_px = _pixels_of(sheet, solids.mask)
        ink &= 1 - solids.mask
    areas = [
        Area(
            "solid area",
            solid.pixels * pitch_mm**2,
            _box_mm(solid.box, rows, pitch_mm),
            _outline_mm(solids.mask, solid.box, pitch_mm),
        )
        for solid in solids.each
    ]
    for patch in np.flatnonzero(letters):
        box_mm = _box_mm(patches.boxes[patch].tolist(), rows, pitch_mm)
        areas.append(Area("letter", float(patches.areas[patch]) * pitch_mm**2, box_mm))
    masks = PackedMask.of(ink), PackedMask.of(solids.mask)
    read = sheet.drawing
    return InkLeft(masks[0], read, is_lettering, letters, solid_px, tuple(areas), masks[1])


def _ink(drawing: Drawing) -> Mask:
    """The ink of a sheet, softened, strip by strip: of a large sheet there is never more than that."""
    ink = np.zeros(drawing.darkness.shape, np.uint8)
    for top, bottom, rows in strips(ink.shape, halo=HALO_PX, pixels=FEW_PX):
        soft = cv2.GaussianBlur(drawing.darkness[rows], (0, 0), SOFTENED_PX)
        ink[top:bottom] = soft[top - rows.start : bottom - rows.start] > INK
    return ink


def _box_mm(box: Sequence[int], rows: int, pitch_mm: float) -> Box:
    """A box (first row, last row + 1, first column, last column + 1) on the sheet."""
    top, bottom, left, right = (pitch_mm * side for side in box)
    return left, rows * pitch_mm - bottom, right, rows * pitch_mm - top


def _outline_mm(
    mask: Mask, box: tuple[int, int, int, int], pitch_mm: float
) -> tuple[tuple[float, float], ...]:
    """The outline of the largest solid area in a box with its holes, on the sheet."""
    top, bottom, left, right = box
    found, kin = cv2.findContours(
        mask[top:bottom, left:right], cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE, offset=(left, top)
    )
    sides = [float(np.prod(np.ptp(line, axis=0))) for line in found]
    outer = int(np.argmax(sides))
    own = [outer, *np.flatnonzero(kin[0, :, 3] == outer).tolist()]
    lines = [cv2.approxPolyDP(found[k], OUTLINE_PX, True)[:, 0] for k in own]
    first = lines[0][:1]
    holes = [np.vstack([line, line[:1], first]) for line in lines[1:]]
    columns, down = np.vstack([lines[0], first, *holes]).T
    places = np.column_stack([columns + 0.5, len(mask) - down - 0.5]) * pitch_mm
    return tuple((float(x), float(y)) for x, y in places)


def _without(drawing: Drawing, solid: Mask) -> Drawing:
    """A drawing whose solid areas are paper, with their soft rims: the cells see where lines end at one."""
    rims = cv2.dilate(solid, np.ones((2 * RIM_PX + 1,) * 2, np.uint8)) > 0
    return replace(drawing, darkness=np.where(rims, np.float32(0), drawing.darkness))


def _pixels_of(sheet: Sheet, mask: Mask) -> NDArray[np.float64]:
    """How many pixels of each patch are in a mask, strip by strip."""
    runs, within = sheet.patches, np.zeros(len(sheet.patches.row), np.int32)
    for top, bottom, rows in strips(mask.shape, pixels=FEW_PX):
        own = runs.runs_between(top, bottom)
        sums = np.zeros((bottom - top, mask.shape[1] + 1), np.int32)
        np.cumsum(mask[rows], axis=1, out=sums[:, 1:])
        row = runs.row[own] - top
        within[own] = sums[row, runs.end[own]] - sums[row, runs.begin[own]]
    return np.bincount(runs.patch, within, runs.count).astype(float)
