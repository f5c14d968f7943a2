"""Holes: paper that a patch of ink goes round.

    ▒▒▒▒▒▒▒     ink hangs together where pixels meet at a corner, and paper does not:
    ▒░░▒▒▒▒     two holes here, of two pixels and of one
    ▒▒▒▒░▒▒
    ▒▒▒▒▒▒▒

Signals: a mask of one connected patch of ink, or a patch of a sheet, in; its holes out, in columns and rows
of the mask, or of the patch's box.

Source: Pick's theorem tells how many pixels lie within the ring of ink about a hole: the area of the polygon
through the middles of that ink, less half of its steps, and 1.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2

from morfax.tracer.drawing.components import Mask, Patches


class Hole(NamedTuple):
    """A hole: its first column and row, how wide and high it is with the ink about it, and its paper, px."""

    column: int
    row: int
    wide_px: int
    high_px: int
    paper_px: int


def holes(ink: Mask) -> list[Hole]:
    """The holes of a patch of ink."""
    outlines, levels = cv2.findContours(ink, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    found = list[Hole]()
    for outline, level in zip(outlines, levels[0] if outlines else (), strict=True):
        is_about_paper = level[3] >= 0
        if is_about_paper:
            paper_px = round(cv2.contourArea(outline) - 0.5 * len(outline) + 1)
            column, row, wide, high = cv2.boundingRect(outline)
            found.append(Hole(column, row, wide, high, paper_px))
    return found


def holes_in(patches: Patches, patch: int) -> list[Hole]:
    """The holes of one of some patches; looked for once, as several ask for them."""
    if patch not in patches.known_holes:
        top, bottom, left, right = patches.boxes[patch].tolist()
        ink = patches.painted(patch, top, bottom, left, right)
        patches.known_holes[patch] = holes(ink)
    return patches.known_holes[patch]
