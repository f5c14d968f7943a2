"""Ruling: the printed lines of squared and ruled paper are found by period and straightness, and left out.

Signals: darkness of a sheet (0 paper, 1 ink) in; out the families of printed lines, and the darkness without
them. Printed lines may be as dark as what is drawn.

    │   │   │ ╱ │       a family: angle, period, first line. All lines are there, straight, a period apart,
    │   │  ╭┼╯  │       from one side of the sheet to the other, over and over as dark
    │   │ ╱ │   │

What is much darker than printed lines are as a rule is drawn ink and stays. Drawn ink that is as dark as they
are cannot be told from them where it crosses them; so a stroke that comes up to a printed line on both sides,
in one direction, is drawn on across it:

    fill = largest, over directions, of the smaller of the darknesses on both sides of the printed line

Source: our own. Questions: a stroke along a printed line, nearer than a line's width, is taken off with it
over that length; the head goes over such gaps as it does over others.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.faults import DrawingFault
from morfax.motion.plane import left_of
from morfax.tracer.drawing.between import between
from morfax.tracer.drawing.contrast import DARKER
from morfax.tracer.drawing.tiles import Kept, Tiles
from morfax.tracer.effort import FEW_PX

Darkness = NDArray[np.float32]
PaperKind = Literal["auto", "plain", "squared", "ruled"]

# Chosen by trial on drawings on printed paper.
TILT_DEG, TILT_STEP_DEG = 4.0, 0.1  # of the paper on the scanner's glass
SEARCHED_PX = 2 * FEW_PX  # pixels of the picture on which families are looked for
INKED = 0.15  # darker is ink, drawn or printed
# of printed lines: 4, 5 mm squares; 6 to 11 mm ruled
LEAST_PERIOD_MM, LARGEST_PERIOD_MM = 2.0, 15.0
FEWEST_LINES = 6
BROADEST_MM = 0.6  # of a printed line
OFF_PERIOD = 0.06  # of the period: a printed line is as near to its place
PRESENT = 0.85  # of the lines that the period asks for
SOFT_PX = 1.5  # beside a printed line: its soft edges
SPANNED = 0.6  # of a line's length on the sheet is inked
EDGE = 0.03  # of the sheet's length: printed lines are there at both ends
EDGE_LOST = 0.25  # of them may leave the sheet at a side, or lie under a shadow
EXCESS = 0.35  # of ink's darkness: noise is no ink on a printed line
SAMPLES = 50_000  # pixels of ink that tell the tilt
# of strokes, from square to the printed line
FILL_DEG = -55.0, -35.0, -15.0, 0.0, 15.0, 35.0, 55.0


class Family(NamedTuple):
    """Parallel printed lines: across · place = first + k · period; the unit vector points across them (X to
    the right, Y down); px."""

    across: tuple[float, float]
    first_px: float
    period_px: float
    half_px: float  # of a printed line's width, with its soft edges

    def off_px(self, rows: Array, columns: Array) -> Array:
        """How far places are from the middle of the nearest printed line, px."""
        at = self.across[0] * columns + self.across[1] * rows - self.first_px
        return np.asarray(at - np.round(at / self.period_px) * self.period_px)

    def enlarged(self, by: int) -> Family:
        """The same lines on pixels that are so many times smaller."""
        first_px = self.first_px * by + 0.5 * (by - 1) * sum(self.across)
        return Family(self.across, first_px, self.period_px * by, self.half_px * by)


def families(darkness: Kept, pitch_mm: float) -> list[Family]:
    """The families of printed lines on a sheet: two of squared paper, one of ruled paper, or none."""
    by = max(1, math.isqrt(max(1, darkness.size // SEARCHED_PX)))
    small = darkness.shrunk(by) if isinstance(darkness, Tiles) else darkness
    if by > 1 and not isinstance(darkness, Tiles):
        size = darkness.shape[1] // by, darkness.shape[0] // by
        small = np.asarray(cv2.resize(darkness, size, interpolation=cv2.INTER_AREA), np.float32)
    ways = [is_upright for is_upright in (True, False) if _may_reach_edges(small, is_upright)]
    found = [_family(small, pitch_mm * by, is_upright) for is_upright in ways]
    return [one.enlarged(by) for one in found if one is not None]


def left_out(darkness: Kept, pitch_mm: float, paper: PaperKind) -> tuple[Kept, str | None]:
    """The sheet without its printed lines, and what the operator should know; raises DrawingFault if printed
    lines were asked for and none are found.
    """
    if paper == "plain":
        return darkness, None
    found = families(darkness, pitch_mm)
    if paper == "ruled":
        found = found[:1]
    if not found:
        if paper == "auto":
            return darkness, None
        raise DrawingFault(
            f"--paper {paper}, but no printed lines are found: {FEWEST_LINES} or more, straight,"
            f" {LEAST_PERIOD_MM:g} to {LARGEST_PERIOD_MM:g} mm apart, from side to side; leave --paper out,"
            " or name the line's colour with --ink"
        )
    for family in found:
        darkness = _without(np.asarray(darkness), family)
    kind = "squared" if len(found) == 2 else "ruled"
    apart = " and ".join(f"{one.period_px * pitch_mm:.2f}" for one in found)
    return darkness, (
        f"the paper is {kind}, with lines {apart} mm apart; they are left out: if they belong to the drawing,"
        " give --paper plain"
    )


# finding


def _may_reach_edges(darkness: Darkness, is_upright: bool) -> bool:
    """Whether there is ink enough for the fewest lines of a family at both ends of the sheet: most drawings
    have paper about them, and to ask that takes a hundredth of the time of `_family`.
    """
    upright = darkness if is_upright else darkness.T
    ends_px = math.floor(EDGE * len(upright))
    ends = upright[: ends_px + 1], upright[-ends_px - 1 :]
    # one of them may begin off the sheet; lines two columns apart may share a column
    fewest = math.ceil((PRESENT - EDGE_LOST) * (FEWEST_LINES - 1)) / 2
    return all(np.count_nonzero(end > INKED) > fewest * SPANNED * ends_px for end in ends)


def _family(darkness: Darkness, pitch_mm: float, is_upright: bool) -> Family | None:
    """The printed lines that stand upright, or lie across the sheet."""
    rows, columns = np.nonzero(darkness > INKED)
    long, wide = darkness.shape if is_upright else darkness.shape[::-1]
    along, over = (rows, columns) if is_upright else (columns, rows)
    along = along - 0.5 * long
    # 1. the tilt at which ink gathers on lines
    some = slice(None, None, max(1, len(rows) // SAMPLES))
    tilt = _tilt_rad(along[some], over[some], wide)
    # 2. how much of each line's length is inked
    beside_px = over - math.tan(tilt) * along
    inked = _counts(beside_px, wide) / long
    # 3. lines a period apart
    comb = _comb(inked, pitch_mm)
    if comb is None:
        return None
    # 4. from edge to edge of the sheet: a drawn grid has paper about it
    for is_edge in (along < (EDGE - 0.5) * long, along > (0.5 - EDGE) * long):
        there = _counts(beside_px[is_edge], wide) / (EDGE * long)
        at_lines = np.arange(comb.first_px, wide, comb.period_px).astype(int)
        beside = np.clip(at_lines[:, None] + [-1, 0, 1, 2], 0, wide - 1)
        if np.mean(there[beside].max(axis=1) > SPANNED) < PRESENT - EDGE_LOST:
            return None
    c, s = math.cos(tilt), math.sin(tilt)
    first_px = comb.first_px * c - 0.5 * long * s
    across = (c, -s) if is_upright else (-s, c)
    return Family(across, first_px, comb.period_px * c, comb.half_px)


def _tilt_rad(along: Array, over: Array, wide: int) -> float:
    """The tilt at which pixels of ink gather on upright lines, sought in steps and in tenths of them."""
    tilt = 0.0
    for span_deg, step_deg in (
        (TILT_DEG, TILT_STEP_DEG),
        (TILT_STEP_DEG, 0.1 * TILT_STEP_DEG),
    ):
        tilts = tilt + np.radians(np.arange(-span_deg, span_deg + 0.5 * step_deg, step_deg))
        gathered = [_gathered(over - np.tan(t) * along, wide) for t in tilts]
        tilt = float(tilts[int(np.argmax(gathered))])
    return tilt


def _counts(at: Array, wide: int) -> Array:
    """How many places fall on each pixel of a width."""
    nearest = np.round(at).astype(int)
    on_sheet = (nearest >= 0) & (nearest < wide)
    return np.bincount(nearest[on_sheet], minlength=wide).astype(float)


def _gathered(at: Array, wide: int) -> float:
    """How unevenly places are spread over a width."""
    return float(np.sum(np.diff(_counts(at, wide)) ** 2))


class _Comb(NamedTuple):
    """First line, period and half width of evenly spaced lines, px."""

    first_px: float
    period_px: float
    half_px: float


def _comb(inked: Array, pitch_mm: float) -> _Comb | None:
    """The evenly spaced lines of a profile: the share of each line's length that is inked."""
    # 1. narrow lines
    edges = np.flatnonzero(np.diff(np.r_[False, inked > SPANNED, False].astype(int)))
    begins, ends = edges[::2], edges[1::2]
    narrow = (ends - begins) * pitch_mm < BROADEST_MM
    begins, ends = begins[narrow], ends[narrow]
    if len(begins) < FEWEST_LINES:
        return None
    lines = np.array(
        [
            np.average(np.arange(b, e), weights=inked[b:e])
            for b, e in zip(begins, ends, strict=True)
        ]
    )
    # 2. the period that they keep
    period = float(np.median(np.diff(lines)))
    if not LEAST_PERIOD_MM <= period * pitch_mm <= LARGEST_PERIOD_MM:
        return None
    number = np.round((lines - lines[len(lines) // 2]) / period)
    period, first = (float(v) for v in np.polyfit(number, lines, 1))
    number = np.round((lines - first) / period)
    kept = np.abs(lines - first - number * period) < OFF_PERIOD * period
    asked = len(inked) / period - 2
    if np.count_nonzero(kept) < max(FEWEST_LINES, PRESENT * asked) or kept.mean() < PRESENT:
        return None
    half_px = 0.5 * float(np.median(ends - begins)) + SOFT_PX
    return _Comb(first % period, period, half_px)


# leaving out


def _without(darkness: Darkness, family: Family) -> Darkness:
    """The sheet without a family of printed lines."""
    rows = np.arange(darkness.shape[0], dtype=float)[:, None]
    columns = np.arange(darkness.shape[1], dtype=float)[None, :]
    off = family.off_px(rows, columns)
    i, j = np.nonzero(np.abs(off) <= family.half_px)
    off, seen = off[i, j], np.asarray(darkness[i, j], float)
    # 1. what is darker than printed lines are as a rule
    printed = _printed(seen, off)
    darker = np.where(seen - printed > EXCESS, seen - printed, 0.0)
    # 2. strokes that come up to the printed line from both sides
    across = np.array(family.across)
    along = left_of(across)
    fill = np.zeros(len(i))
    for degrees in FILL_DEG:
        way = across + math.tan(math.radians(degrees)) * along
        sides = [
            _seen(darkness, i + (edge - off) * way[1], j + (edge - off) * way[0])
            for edge in (-family.half_px - 0.5, family.half_px + 0.5)
        ]
        np.maximum(fill, np.minimum(*sides), out=fill)
    left = darkness.copy()
    left[i, j] = np.maximum(np.minimum(fill, seen), darker)
    return left


def _printed(seen: Array, off_px: Array) -> Array:
    """How dark printed lines are as a rule, at distances from their middles."""
    ring = np.abs(off_px).astype(int)
    usual = [np.percentile(seen[ring == k], DARKER) for k in range(int(ring.max()) + 1)]
    return np.asarray(usual)[ring]


def _seen(darkness: Darkness, rows: Array, columns: Array) -> Array:
    """Darkness between pixels."""
    return between(darkness, rows, columns, edge_goes_on=True)
