"""Ruling: the printed lines of squared and ruled paper are left out.

Signals: darkness of a sheet (0 paper, 1 ink) in; out the darkness without printed lines, which may be as dark
as what is drawn.

    without printed lines = (seen - printed) / (1 - printed), where much is left: ink lies on ink

Drawn ink that is as dark as printed lines cannot be told from them where it crosses them; so a stroke that
comes up to a printed line on both sides, in one direction, is drawn on across it:

    fill = largest, over directions, of the smaller of the darknesses on both sides of the printed line

Lines that run from edge to edge of the sheet are printed: what is drawn has paper about it. So are squares
with a margin that are paler than what is drawn, or more than anybody draws.

Source: our own. Questions: a stroke along a printed line that is as dark, nearer than a line's width, is
taken off with it over that length; the head goes over such gaps as it does over others.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.median import NEARLY_ALL
from morfax.motion.plane import left_of
from morfax.tracer.drawing.between import between
from morfax.tracer.drawing.components import INK
from morfax.tracer.drawing.contrast import DARKER
from morfax.tracer.drawing.even_lines import (
    FEWEST_LINES,
    INKED,
    LARGEST_PERIOD_MM,
    LEAST_PERIOD_MM,
)
from morfax.tracer.drawing.printed_lines import Family, families, may_have_lines
from morfax.tracer.drawing.tiles import Kept, Tiles
from morfax.tracer.effort import FEW_PX

Darkness = NDArray[np.float32]
PaperKind = Literal["auto", "plain", "squared", "ruled"]

# Chosen by trial on drawings on printed paper.
SEARCHED_PX = 2 * FEW_PX  # pixels of the picture on which printed lines are looked for
# of the darkness of what is drawn: printed lines that are paler are no part of that
PALER = 0.75
BOARD = 25  # lines of a drawn board or crossword, each way, at the most
EXCESS = 0.35  # of ink's darkness: noise is no ink on a printed line
# of strokes, from square to the printed line
FILL_DEG = -55.0, -35.0, -15.0, 0.0, 15.0, 35.0, 55.0


class Cleared(NamedTuple):
    """A sheet without printed lines, how dark what is drawn was on it before it was made 1, and what the
    operator should know.
    """

    darkness: Kept
    ink: float = 1.0
    note: str | None = None


def left_out(darkness: Kept, pitch_mm: float, paper: PaperKind) -> Cleared:
    """The sheet without its printed lines; raises DrawingFault if printed lines were asked for and none are
    found.
    """
    if paper == "plain":
        return Cleared(darkness)
    small, by = _small_enough(darkness)
    found = families(small, by * pitch_mm) if small.size else []
    if paper == "ruled":
        found = found[:1]
    if not found:
        if paper == "auto":
            return Cleared(darkness)
        raise _none_found(paper)
    printed, ink = _levels(small, [family for of in found for family in of])
    if paper == "auto":
        whole = [of for of in found if of[0].is_whole]
        is_drawn = printed > PALER * ink and min(of[-1].lines for of in found) <= BOARD
        if not whole and (len(found) == 1 or is_drawn):
            kind, apart = _in_words(found, by * pitch_mm)
            note = (
                f"straight lines run over most of the sheet, {apart} mm apart; if the paper is {kind},"
                f" give --paper {kind}, and they are left out"
            )
            return Cleared(darkness, note=note)
        found = whole or found
    kind, apart = _in_words(found, by * pitch_mm)
    left = np.asarray(np.asarray(darkness) / ink, np.float32)
    for family in (family for of in found for family in of):
        left = _without(left, family.enlarged(by))
    note = (
        f"the paper is {kind}, with lines {apart} mm apart; they are left out: if they belong to the"
        " drawing, give --paper plain"
    )
    return Cleared(left, ink, note)


def _none_found(paper: PaperKind) -> DrawingFault:
    """What an operator is told who asked for printed lines that are not there."""
    return DrawingFault(
        f"--paper {paper}, but no printed lines are found: {FEWEST_LINES} or more, straight,"
        f" {LEAST_PERIOD_MM:g} to {LARGEST_PERIOD_MM:g} mm apart, over half of the sheet or more; leave"
        " --paper out, or name the line's colour with --ink"
    )


def _in_words(found: list[list[Family]], pixel_mm: float) -> tuple[str, str]:
    """What paper with such printed lines is called, and how far apart they are, mm."""
    apart = " and ".join(f"{pixel_mm * of[-1].period_px:.2f}" for of in found)
    return "squared" if len(found) == 2 else "ruled", apart


def _small_enough(darkness: Kept) -> tuple[Darkness, int]:
    """The sheet on pixels that are so many times larger, few enough to look for printed lines on them; no row
    of it if some of its rows and columns show none.
    """
    by = max(1, math.isqrt(max(1, darkness.size // SEARCHED_PX)))
    if isinstance(darkness, Tiles):
        return darkness.shrunk(by), by
    if by == 1:
        return darkness, by
    if not may_have_lines(darkness, by):
        return darkness[:0], by
    size = darkness.shape[1] // by, darkness.shape[0] // by
    return np.asarray(cv2.resize(darkness, size, interpolation=cv2.INTER_AREA), np.float32), by


def _levels(darkness: Darkness, found: list[Family]) -> tuple[float, float]:
    """How dark printed lines are, and what else is on the sheet; 1 and 1 if nothing is."""
    rows = np.arange(darkness.shape[0], dtype=float)[:, None]
    columns = np.arange(darkness.shape[1], dtype=float)[None, :]
    drawn = darkness > INKED
    printed = []
    for family in found:
        begin, end = family.run_px
        off, along = np.abs(family.off_px(rows, columns)), family.along_px(rows, columns)
        is_there = (along >= begin) & (along <= end)
        printed.append(float(np.median(darkness[is_there & (off < 0.5)])))
        drawn &= ~(is_there & (off <= family.half_px))
    if not drawn.any():
        return 1.0, 1.0
    seen = darkness[drawn]
    ink = seen[
        seen > INK * np.percentile(seen, NEARLY_ALL)
    ]  # and not the soft edges of printed lines
    return max(printed), float(np.percentile(ink, DARKER))


def _without(darkness: Darkness, family: Family) -> Darkness:
    """The sheet without a family of printed lines."""
    rows = np.arange(darkness.shape[0], dtype=float)[:, None]
    columns = np.arange(darkness.shape[1], dtype=float)[None, :]
    off = family.off_px(rows, columns)
    i, j = np.nonzero(np.abs(off) <= family.half_px)
    along = family.along_px(i.astype(float), j.astype(float))
    is_there = (along >= family.run_px[0]) & (along <= family.run_px[1])
    i, j = i[is_there], j[is_there]
    off, seen = off[i, j], np.asarray(darkness[i, j], float)
    # 1. what is darker than printed lines are as a rule
    printed = _printed(seen, off)
    is_darker = seen - printed > np.minimum(EXCESS, printed)
    darker = np.where(is_darker, (seen - printed) / np.maximum(1 - printed, EXCESS), 0.0)
    # 2. strokes that come up to the printed line from both sides
    across = np.array(family.across)
    on = left_of(across)
    fill = np.zeros(len(i))
    for degrees in FILL_DEG:
        way = across + math.tan(math.radians(degrees)) * on
        sides = [
            _seen(darkness, i + (edge - off) * way[1], j + (edge - off) * way[0])
            for edge in (-family.half_px - 0.5, family.half_px + 0.5)
        ]
        np.maximum(fill, np.minimum(*sides), out=fill)
    left = darkness.copy()
    left[i, j] = np.maximum(np.minimum(fill, seen), np.minimum(darker, seen))
    return left


def _printed(seen: Array, off_px: Array) -> Array:
    """How dark printed lines are as a rule, at distances from their middles."""
    ring = np.abs(off_px).astype(int)
    usual = [np.percentile(seen[ring == k], DARKER) for k in range(int(ring.max()) + 1)]
    return np.asarray(usual)[ring]


def _seen(darkness: Darkness, rows: Array, columns: Array) -> Array:
    """Darkness between pixels."""
    return between(darkness, rows, columns, edge_goes_on=True)
