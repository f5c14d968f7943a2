"""The border of a picture: a frame or a dark strip along its edges is no line, and is made paper.

Signals: darkness 0..1 in, changed in place; out the edges along which ink was taken away.

    ╔═══════════════╗
    ║   ╭───────╮   ║      a frame drawn round a picture, the shadow under a scanner's lid, or the desk beside
    ║   ╰───────╯   ║      the paper: ink at the very edge, along most of it, and nowhere else
    ╚═══════════════╝

Source: our own; in patent ES 361967 the operator sees what lies round the sheet. Questions: the outline of a
part whose picture is cut off just there looks the same. A sheet with no other ink keeps it.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.tracer.drawing.components import FRINGE_PX, INK, Patches, runs_of, strips
from morfax.tracer.drawing.contrast import LEAST_STROKE_PX
from morfax.tracer.drawing.tiles import Tiles, paper_like

# All limits below were chosen by trial on framed and badly cropped pictures.
AT_EDGE = 0.005  # of the shorter side: ink as near to an edge, or as its own fringe is broad, is at it
ALONG = 0.6  # of an edge along which there is ink: it is a border's
MARGIN = 0.05  # of the shorter side: a border reaches no further into the picture

Picture = NDArray[np.float32] | Tiles


class _Band(NamedTuple):
    """The pixels at one edge: the edge's name, first and last row and column, and the axis across them."""

    edge: str
    top: int
    bottom: int
    left: int
    right: int
    across: int

    def covered(self, mask: NDArray[np.generic]) -> float:
        """Share of the edge along which a mask of the band has ink."""
        return float(np.mean(mask.any(axis=self.across)))


def without_border(darkness: Picture, ink: float = INK) -> tuple[str, ...]:
    """Make the border of a picture paper, in place; returns the names of the edges where there was one.

    What is darker than `ink` counts: where pale lines are followed, so is what resizing leaves of a row.
    """
    bands = [band for band in _bands(darkness.shape) if _is_inked(darkness, band, ink)]
    if not bands:
        return ()
    patches = Patches.of(
        runs_of(darkness[top:bottom] > ink, top) for top, bottom, _ in strips(darkness.shape)
    )
    # 1. patches in the margin that lie along an edge
    borders, edges = np.zeros(patches.count, bool), set[str]()
    longer_px = patches.longer_sides
    long_enough = longer_px >= ALONG * min(darkness.shape)
    for patch in np.flatnonzero(long_enough & _are_in_margin(patches, darkness.shape)):
        along = _edges_along(patches, int(patch), bands)
        borders[patch] = bool(along)
        edges |= along
    # 2. made paper, unless they are all that is drawn
    if not edges or not (longer_px[~borders] > LEAST_STROKE_PX).any():
        return ()
    _make_paper(darkness, patches, borders)
    return tuple(band.edge for band in bands if band.edge in edges)


def border_note(edges: tuple[str, ...]) -> str:
    """What the operator should know of a border that was left out."""
    which = f"{', '.join(edges)} edge" + ("s" if len(edges) > 1 else "")
    return (
        f"the ink along the {which} of the picture is its border, and is left out; if it is a line of the "
        "drawing, give the picture a margin of paper"
    )


def _bands(shape: tuple[int, ...]) -> list[_Band]:
    """The pixels at the four edges of a picture."""
    height, width = shape
    at = max(FRINGE_PX, round(AT_EDGE * min(height, width)))
    return [
        _Band("upper", 0, at, 0, width, 0),
        _Band("lower", height - at, height, 0, width, 0),
        _Band("left", 0, height, 0, at, 1),
        _Band("right", 0, height, width - at, width, 1),
    ]


def _is_inked(darkness: Picture, band: _Band, ink: float) -> bool:
    """Whether there is ink along an edge, whatever it belongs to."""
    pixels = darkness[band.top : band.bottom, band.left : band.right]
    return band.covered(pixels > ink) >= ALONG


def _edges_along(patches: Patches, patch: int, bands: list[_Band]) -> set[str]:
    """The edges along which a patch lies."""
    alone = patches.alone(patch)
    return {
        band.edge for band in bands if band.covered(patches.painted(alone, *band[1:5])) >= ALONG
    }


def _are_in_margin(patches: Patches, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Which patches lie wholly in the margin of a picture."""
    height, width = shape
    margin = MARGIN * min(height, width)
    inner_row = (patches.row >= margin) & (patches.row < height - margin)
    low = np.maximum(patches.begin, margin)
    high = np.minimum(patches.end, width - margin)
    beyond = inner_row & (high > low)
    return np.asarray(np.bincount(patches.patch[beyond], minlength=patches.count) == 0)


def _make_paper(darkness: Picture, patches: Patches, which: NDArray[np.bool_]) -> None:
    """Make some patches and their soft edges paper."""
    spot = np.ones((2 * FRINGE_PX + 1, 2 * FRINGE_PX + 1), np.uint8)
    for top, bottom, rows in strips(darkness.shape, halo=FRINGE_PX):
        mask = patches.painted(which, rows.start, rows.stop, 0, darkness.shape[1])
        wide = cv2.dilate(mask, spot)[top - rows.start : bottom - rows.start].view(bool)
        if isinstance(darkness, Tiles):
            paper_like(darkness, (slice(top, bottom), wide))
        else:
            darkness[top:bottom][wide] = 0.0
