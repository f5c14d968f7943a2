"""Solid areas among lines: ink that is broader than a line, such as a filled wall, an arrowhead, a blot.

Signals: a mask of ink in; out the part of it that is solid areas, and where each is (pixels).

    ───────●        a disc of more than two lines' width goes into the ink: a dot or an arrowhead at the end
    ══╦══╳══        of a line is solid; a place where lines meet is not, for lines leave it all round; nor is
                    a swelling through which a line goes on; nor a line drawn with a broad pen, unless it is
                    as broad as a wall

A solid area ends where no disc goes in; its corners, which are left then, belong to it.

Source: opening by a disc is Matheron's; what is solid is our own. Questions: how broad is a wall, and how
narrow a broad pen's line? Five times the usual width of the sheet's lines is a wall.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import Mask, strips
from morfax.tracer.effort import FEW_PX

# All limits below were chosen by trial on own and fetched drawings, in usual widths of a line.
BROAD, BROAD_PX = 2.2, 1.5  # a disc as broad goes into a solid area
WALL = 5.0  # a long area as broad is a wall, and no line
LONG = 3.0  # times its breadth: a longer area is a wall or a line of a broad pen
SWELLING = 4.0  # a narrower one through which a line goes on is that line
CORNER = 4.0  # ink no larger that hangs on a solid area is its corner
OPEN = 0.5  # of its rim is paper at least: round a place where lines meet it is lines
LEAST_PX = 7.0  # a narrower one is a line: few pixels tell no breadth
FINEST_PX = 2.0  # a line that is finer counts as so broad, for the same reason
RIDGE_PX = 0.3  # pixels no less deep than those about them are in the middle of ink


class Solid(NamedTuple):
    """A solid area: first row, last row + 1, first column, last column + 1, and its pixels."""

    box: tuple[int, int, int, int]
    pixels: int


class Solids(NamedTuple):
    """The solid areas of some ink: their mask, and each of them, the largest first."""

    mask: Mask
    each: tuple[Solid, ...] = ()

    @classmethod
    def of(cls, ink: Mask) -> Solids:
        """The solid areas of some ink."""
        depth = np.asarray(
            cv2.distanceTransform(ink, cv2.DIST_L2, cv2.DIST_MASK_PRECISE), np.float32
        )
        none = cls(np.zeros_like(ink))
        usual_px = usual_width_px(depth)
        reach_px = 0.5 * max(BROAD * usual_px + BROAD_PX, LEAST_PX)
        cores = (depth > reach_px).view(np.uint8)
        if not cores.any():
            return none
        # 1. as far as a disc goes in
        away = cv2.distanceTransform(1 - cores, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        opened = ((away <= reach_px) & (ink > 0)).view(np.uint8)
        del away  # as large as the labels that follow
        solid = np.zeros_like(ink)
        count, labels, boxes, _ = cv2.connectedComponentsWithStats(opened, connectivity=8)
        for k in range(1, count):
            part = _about(boxes[k], ink.shape)
            own = (labels[part] == k).view(np.uint8)
            if _is_solid(own, ink[part], depth[part], usual_px):
                solid[part] |= own
        if not solid.any():
            return none
        # 2. with their corners
        solid |= _corners(solid, ink, CORNER * usual_px + 2)
        return cls(solid, _each(solid))


def usual_width_px(depth: NDArray[np.float32]) -> float:
    """The usual width of the lines of some ink by its depth, pixels."""
    ridges = list[NDArray[np.float32]]()
    # strip by strip: of a sheet as floats there is one at a time
    for top, bottom, rows in strips(depth.shape, halo=1, pixels=FEW_PX):
        inner = slice(top - rows.start, bottom - rows.start)
        deepest = cv2.dilate(depth[rows], np.ones((3, 3), np.uint8))[inner]
        own = depth[top:bottom]
        ridges.append(own[(own > 0) & (own >= deepest - RIDGE_PX)])
    ridge = np.concatenate(ridges)
    return max(FINEST_PX, 2 * float(np.median(ridge)) - 1) if len(ridge) else FINEST_PX


def _about(box: NDArray[np.int32], shape: tuple[int, ...]) -> tuple[slice, slice]:
    """A box (left, top, width, height) with a pixel all round, as far as the sheet goes."""
    left, top, wide, high = (int(side) for side in box[:4])
    rows = slice(max(0, top - 1), min(shape[0], top + high + 1))
    return rows, slice(max(0, left - 1), min(shape[1], left + wide + 1))


def _is_solid(own: Mask, ink: Mask, depth: NDArray[np.float32], usual_px: float) -> bool:
    """Whether a part of the ink into which a disc goes is a solid area, and no line or junction."""
    grown = np.asarray(cv2.dilate(own, np.ones((3, 3), np.uint8)), np.uint8)
    rim = grown & (1 - own)
    inked = (rim & ink).astype(np.uint8)
    if float(inked.sum()) > (1 - OPEN) * float(rim.sum()):
        return False
    broad_px = 2 * float(depth[own > 0].max()) - 1
    if broad_px < SWELLING * usual_px and cv2.connectedComponents(inked, connectivity=8)[0] > 2:
        return False
    is_long = float(own.sum()) > LONG * broad_px**2
    return not is_long or broad_px > WALL * usual_px


def _corners(solid: Mask, ink: Mask, most_px: float) -> Mask:
    """Small pieces of ink that hang on solid areas, and on nothing else."""
    rest = ink & (1 - solid)
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(rest, connectivity=8)
    beside = np.unique(labels[cv2.dilate(solid, np.ones((3, 3), np.uint8)) > 0])
    small = np.zeros(count, bool)
    small[beside] = boxes[beside, 2:4].max(axis=1) <= most_px
    small[0] = False
    return small[labels].view(np.uint8)


def _each(solid: Mask) -> tuple[Solid, ...]:
    """The solid areas of a mask, the largest first."""
    _, _, boxes, _ = cv2.connectedComponentsWithStats(solid, connectivity=8)
    found = [
        Solid((top, top + high, left, left + wide), pixels)
        for left, top, wide, high, pixels in boxes[1:].tolist()
    ]
    return tuple(sorted(found, key=lambda area: -area.pixels))
