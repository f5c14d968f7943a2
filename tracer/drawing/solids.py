"""Solid areas among lines: ink that is broader than a line, such as a filled wall, an arrowhead, a blot.

Signals: a mask of ink in; out the part of it that is solid areas, and where each is (pixels).

    ───────●        a disc of more than two lines' width goes into the ink: a dot or an arrowhead at the end
    ══╦══╳══        of a line is solid; a place where lines meet is not, for lines leave it all round; nor is
                    a swelling through which a line goes on; nor a line drawn with a broad pen, unless it is
                    as broad as a wall

A solid area ends where no disc goes in; its corners, which are left then, belong to it. Specks of paper in it
do not stop the disc. Of lines of a broad pen only those places are solid which are broader than a crossing of
them.

Source: opening by a disc is Matheron's; what is solid is our own. Questions: how broad is a wall, and how
narrow a broad pen's line? Five times the usual width of the sheet's lines is a wall.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import Mask, strips
from morfax.tracer.drawing.depth import depth_px
from morfax.tracer.drawing.middles import SHALLOWER
from morfax.tracer.effort import FEW_PX
from morfax.tracer.limits import LONGER_WIDTHS, ROUND

# All limits below were chosen by trial on own and fetched drawings, in usual widths of a line.
BROAD, BROAD_PX = 2.2, 1.5  # a disc as broad goes into a solid area
WALL = 5.0  # a long area as broad is a wall, and no line
CROSSING = 1.6  # of a broader pen's own width: where two of its lines cross, 1.41
SHAPE = 0.33  # of some ink is broader than that: it is no line
LONG = 3.0  # times its breadth: a longer area is a wall or a line of a broad pen
SWELLING = 4.0  # a narrower one through which a line goes on is that line
# paper in ink that is no larger than a round of a width crowds with so many within so far of it, across and
# along
ABOUT, MANY = 4.0, 4
OPEN = 0.5  # of its rim is paper at least: round a place where lines meet it is lines
LEAST_PX = 7.0  # a narrower one is a line: few pixels tell no breadth
FINEST_PX = 2.0  # a line that is finer counts as so broad, for the same reason


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
        usual_px = usual_width_px(depth_px(ink))
        whole = _without_specks(ink, usual_px)
        solid = _solid(whole, depth_px(whole), usual_px)
        if not solid.any():
            return cls(solid)
        solid |= _corners(solid, whole, LONGER_WIDTHS * usual_px + 2)
        return cls(solid, _each(solid))


def usual_width_px(depth: NDArray[np.float32]) -> float:
    """The usual width of the lines of some ink by its depth, pixels."""
    ridge = ridge_of(depth, float(SHALLOWER))
    return max(FINEST_PX, 2 * float(np.median(ridge)) - 1) if len(ridge) else FINEST_PX


def ridge_of(depth: NDArray[np.float32], shallower_px: float = 0.0) -> NDArray[np.float32]:
    """The depths of ink that is nowhere about a pixel deeper by more, by rows, pixels."""
    ridges = list[NDArray[np.float32]]()
    # strip by strip: of a sheet as floats there is one at a time
    for top, bottom, rows in strips(depth.shape, halo=1, pixels=FEW_PX):
        inner = slice(top - rows.start, bottom - rows.start)
        deepest = cv2.dilate(depth[rows], np.ones((3, 3), np.uint8))[inner]
        own = depth[top:bottom]
        ridges.append(own[(own > 0) & (own >= deepest - shallower_px)])
    return np.concatenate(ridges)


def _without_specks(ink: Mask, usual_px: float) -> Mask:
    """Ink with the specks of paper within it filled where they crowd, strip by strip: as many labels are
    never there. The counters of letters do not crowd.
    """
    whole, about_px = ink.copy(), math.ceil(ABOUT * usual_px)
    halo_px = about_px + math.ceil(2 * usual_px)
    for top, bottom, rows in strips(ink.shape, halo=halo_px, pixels=FEW_PX):
        _, labels, boxes, middles = cv2.connectedComponentsWithStats(
            1 - ink[rows], connectivity=4
        )
        left, above, wide, high, pixels = boxes.T
        are_specks = (left > 0) & (left + wide < ink.shape[1])
        are_specks &= (above > 0) & (above + high < len(labels))
        are_specks &= pixels <= ROUND * usual_px**2
        at = tuple(np.round(middles[are_specks]).astype(int).T[::-1])
        dots = np.zeros(labels.shape, np.float32)
        dots[at] = 1
        across = (2 * about_px + 1,) * 2
        counts = cv2.boxFilter(
            dots, -1, across, normalize=False, borderType=cv2.BORDER_CONSTANT
        )
        are_specks[are_specks] = counts[at] > MANY - 0.5
        whole[top:bottom] |= are_specks[labels[top - rows.start : bottom - rows.start]]
    return whole


def _solid(ink: Mask, depth: NDArray[np.float32], usual_px: float) -> Mask:
    """The solid areas of some ink without their corners."""
    solid = np.zeros_like(ink)
    broad_px = max(BROAD * usual_px + BROAD_PX, LEAST_PX)
    for part, own in _parts(_opened(ink, depth, broad_px)):
        kind = _kind_of(own, ink[part], depth[part], usual_px)
        if kind == "broad lines":
            own = _walls(own, depth[part], usual_px)
        if kind != "lines":
            solid[part] |= own
    return solid


def _walls(own: Mask, depth: NDArray[np.float32], usual_px: float) -> Mask:
    """What is solid of some long ink that somewhere is as broad as a wall: all of it where it is so as a
    rule, or is no line by its breadth; else what is broader than a crossing of its own lines.
    """
    depth = np.where(own > 0, depth, np.float32(0))
    wall_px, own_px = WALL * usual_px, usual_width_px(depth)
    broad = _opened(own, depth, max(wall_px, CROSSING * own_px))
    if own_px > wall_px or float(broad.sum()) > SHAPE * float(own.sum()):
        return own
    # its lines are a pixel wider than they are deep, and soft in the corners between them
    return _opened(broad, depth, max(wall_px, CROSSING * (own_px + 1) + BROAD_PX))


def _opened(ink: Mask, depth: NDArray[np.float32], across_px: float) -> Mask:
    """As much of some ink as a disc covers that goes into it, by its depth."""
    cores = (depth > 0.5 * across_px).view(np.uint8)
    if not cores.any():
        return cores
    away = cv2.distanceTransform(1 - cores, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return (away <= 0.5 * across_px).view(np.uint8) & ink


def _parts(opened: Mask) -> Iterator[tuple[tuple[slice, slice], Mask]]:
    """The parts of a mask that hang together: the box about each, with a pixel all round, and its mask."""
    if not opened.any():
        return
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(opened, connectivity=8)
    for k in range(1, count):
        left, top, wide, high = boxes[k, :4].tolist()
        part = (
            slice(max(0, top - 1), min(len(opened), top + high + 1)),
            slice(max(0, left - 1), min(opened.shape[1], left + wide + 1)),
        )
        yield part, (labels[part] == k).view(np.uint8)


def _kind_of(
    own: Mask, ink: Mask, depth: NDArray[np.float32], usual_px: float
) -> Literal["solid area", "broad lines", "lines"]:
    """What a part of the ink into which a disc goes is; junctions are lines."""
    grown = np.asarray(cv2.dilate(own, np.ones((3, 3), np.uint8)), np.uint8)
    rim = grown & (1 - own)
    inked = (rim & ink).astype(np.uint8)
    if float(inked.sum()) > (1 - OPEN) * float(rim.sum()):
        return "lines"
    broad_px = 2 * float(depth[own > 0].max()) - 1
    if broad_px < SWELLING * usual_px and cv2.connectedComponents(inked, connectivity=8)[0] > 2:
        return "lines"
    if float(own.sum()) <= LONG * broad_px**2:
        return "solid area"
    return "broad lines" if broad_px > WALL * usual_px else "lines"


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
