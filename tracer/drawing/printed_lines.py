"""Printed lines: families of parallel lines on paper, found by period and straightness.

Signals: darkness of a sheet (0 paper, 1 ink) in; families of printed lines out.

    │   │   │ ╱ │       a family: angle, period, first and last line, and from where to where they run.
    │   │  ╭┼╯  │       All of them are there, straight, a period apart, over and over as dark.
    │   │ ╱ │   │       Finer lines between them, as on millimetre paper, are a family of their own.

Source: our own. Questions: a photograph of paper that is not flat has no such lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.drawing.even_lines import (
    INKED,
    LEVELS,
    PRESENT,
    SPANNED,
    SPREAD,
    EvenLines,
    are_evenly_apart,
    even_lines,
)
from morfax.tracer.effort import FEW_PX

Darkness = NDArray[np.float32]

# Chosen by trial on drawings on printed paper.
TILT_DEG, TILT_STEP_DEG = 4.0, 0.1  # of the paper on the scanner's glass
EDGE = 0.03  # of the sheet's length: most of it is inked at both ends of a line that goes over the edge
EDGE_LOST = 0.25  # of them may leave the sheet at a side, or lie under a shadow
# of the sheet's length: where lines are looked for first; no whole parts, at which a line across may lie
ROWS = 0.317, 0.373, 0.471, 0.593, 0.713
SAMPLES = 50_000  # pixels of ink that tell the tilt


class Family(NamedTuple):
    """Parallel printed lines: across · place = first + k · period, where the unit vector points across them
    (X to the right, Y down); from where to where they run, along what is left of that; px.
    """

    across: tuple[float, float]
    first_px: float
    period_px: float
    lines: int
    half_px: float  # of a printed line's width, with its soft edges
    run_px: tuple[float, float]
    is_whole: bool  # from edge to edge of the sheet, all over it

    def off_px(self, rows: Array, columns: Array) -> Array:
        """How far places are from the middle of the nearest printed line, px."""
        at = self.across[0] * columns + self.across[1] * rows - self.first_px
        number = np.round(at / self.period_px)
        if not self.is_whole:
            number = np.clip(number, 0, self.lines - 1)
        return np.asarray(at - number * self.period_px)

    def along_px(self, rows: Array, columns: Array) -> Array:
        """How far along the lines places are, px."""
        return np.asarray(self.across[0] * rows - self.across[1] * columns)

    def enlarged(self, by: int) -> Family:
        """The same lines on pixels that are so many times smaller."""
        right, down = self.across
        begin, end = (by * px + 0.5 * (by - 1) * (right - down) for px in self.run_px)
        return self._replace(
            first_px=self.first_px * by + 0.5 * (by - 1) * (right + down),
            period_px=self.period_px * by,
            half_px=self.half_px * by,
            run_px=(begin, end),
        )


def may_have_lines(darkness: Darkness, by: int) -> bool:
    """Whether most of some rows or columns of a sheet are inked at places that are evenly apart, on pixels
    that are so many times larger: only these rows and columns are made so large.
    """
    return any(
        _have_lines(_larger_rows(each, by), len(each) // by) for each in (darkness, darkness.T)
    )


def _larger_rows(darkness: Darkness, by: int) -> Callable[[int, int], Darkness]:
    """What gives some rows of a sheet on pixels that are so many times larger."""
    wide = darkness.shape[1] // by

    def rows(top: int, bottom: int) -> Darkness:
        part = np.ascontiguousarray(darkness[by * top : by * bottom, : by * wide])
        larger = cv2.resize(part, (wide, len(part) // by), interpolation=cv2.INTER_AREA)
        return np.asarray(larger, np.float32)

    return rows


def _have_lines(rows: Callable[[int, int], Darkness], high: int) -> bool:
    """Whether most of some rows of so many are inked at places that are evenly apart: to ask that takes no
    time, and most drawings have none.
    """
    if not high:
        return False
    missed = 0
    for part in ROWS:
        row = int(part * high)
        beside = rows(max(row - 3, 0), min(row + 4, high))
        seen = np.sort(beside, axis=0)[len(beside) // 2]
        missed += not any(are_evenly_apart(seen, level) for level in LEVELS)
        if missed > len(ROWS) // 2:
            return False
    return True


def families(darkness: Darkness, pitch_mm: float) -> list[list[Family]]:
    """The families of printed lines on a sheet: upright ones, lying ones, both or none; of each way the
    heavier ones among its lines first, and all of them last.
    """
    found = [_Frame.of(darkness, is_upright).found(pitch_mm) for is_upright in (True, False)]
    return [one for one in found if one]


class _Frame(NamedTuple):
    """A sheet turned so that the lines looked for are upright: rows along them, columns across."""

    darkness: Darkness
    is_upright: bool

    @classmethod
    def of(cls, darkness: Darkness, is_upright: bool) -> _Frame:
        """A sheet on which lines are upright, or lie across it."""
        return cls(darkness if is_upright else darkness.T, is_upright)

    def found(self, pitch_mm: float) -> list[Family]:
        """The families of this direction."""
        if not self._may_have_lines():
            return []
        tilt = self._tilt()
        upright = self._straightened(tilt)
        tried = (even_lines(upright, level, pitch_mm) for level in LEVELS)
        lines = next((found for found in tried if found is not None), None)
        runs = lines and _runs_of(upright, lines, tilt)
        if lines is None or runs is None:
            return []
        every = max(1, upright.size // FEW_PX)
        seen = np.median(upright[runs.rows][::every], axis=0).astype(float)
        finest = lines.finest(seen).with_outermost(seen)
        return [self._family(one, tilt, runs) for one in (*finest.heavier(seen), finest)]

    def _may_have_lines(self) -> bool:
        """Whether most of some rows are inked at places that are evenly apart."""
        return _have_lines(lambda top, bottom: self.darkness[top:bottom], len(self.darkness))

    def _tilt(self) -> float:
        """The tilt at which ink gathers on lines, rad."""
        rows, columns = np.nonzero(self.darkness > INKED)
        some = slice(None, None, max(1, len(rows) // SAMPLES))
        along, over = rows[some] - 0.5 * len(self.darkness), columns[some]
        wide = self.darkness.shape[1]
        tilt = 0.0
        for step_deg in (TILT_STEP_DEG, 0.1 * TILT_STEP_DEG):
            span_deg = TILT_DEG if step_deg == TILT_STEP_DEG else TILT_STEP_DEG
            tilts = tilt + np.radians(np.arange(-span_deg, span_deg + 0.5 * step_deg, step_deg))
            gathered = [_gathered(over - np.tan(t) * along, wide) for t in tilts]
            tilt = float(tilts[int(np.argmax(gathered))])
        return tilt

    def _straightened(self, tilt: float) -> Darkness:
        """Each row shifted, so that lines of a tilt are columns."""
        high, wide = self.darkness.shape
        shear = np.array([[1, math.tan(tilt), -0.5 * high * math.tan(tilt)], [0, 1, 0]])
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        lying = np.ascontiguousarray(self.darkness)
        return np.asarray(cv2.warpAffine(lying, shear, (wide, high), flags=flags))

    def _family(self, lines: EvenLines, tilt: float, runs: _Runs) -> Family:
        """Lines of a straightened sheet, on the sheet as it lies."""
        c, s = math.cos(tilt), math.sin(tilt)
        first_px = lines.first_px * c - 0.5 * len(self.darkness) * s
        across = (c, -s) if self.is_upright else (-s, c)
        begin, end = (-math.inf, math.inf) if runs.are_whole else (runs.begin_px, runs.end_px)
        run_px = (begin, end) if self.is_upright else (-end, -begin)
        period_px = lines.period_px * c
        return Family(
            across, first_px, period_px, lines.lines, lines.half_px, run_px, runs.are_whole
        )


def _gathered(at: Array, wide: int) -> float:
    """How unevenly places are spread over a width; each is shared by the two pixels about it."""
    at = at[(at >= 0) & (at < wide - 1)]
    first = at.astype(int)
    second = at - first
    counts = np.bincount(first, 1 - second, wide) + np.bincount(first + 1, second, wide)
    return float(np.sum(np.diff(counts) ** 2))


class _Runs(NamedTuple):
    """From where to where lines run along themselves, px; and whether they go from edge to edge."""

    rows: slice
    begin_px: float
    end_px: float
    are_whole: bool


def _runs_of(upright: Darkness, lines: EvenLines, tilt: float) -> _Runs | None:
    """How far the lines of a straightened sheet run; None if they are not there all the way."""
    high, wide = upright.shape
    beside = np.clip(np.round(lines.middles_px).astype(int)[:, None] + [-1, 0, 1], 0, wide - 1)
    inked = (upright[:, beside].max(axis=2) > INKED).astype(np.float32)
    is_line = cv2.blur(inked, (1, max(1, round(lines.period_px)))) > 0.5
    begins, ends = np.argmax(is_line, axis=0), high - np.argmax(is_line[::-1], axis=0)
    rows = slice(int(np.median(begins)), int(np.median(ends)))
    if rows.stop - rows.start < SPREAD * high:
        return None
    if np.mean(inked[rows].mean(axis=0) > SPANNED) < PRESENT:
        return None
    edge = (1 - SPANNED) * EDGE * high
    at_edges = [np.mean(begins <= edge), np.mean(ends >= high - edge)]
    is_wide = lines.lines >= PRESENT * (wide / lines.period_px - 2)
    c, s = math.cos(tilt), math.sin(tilt)
    at_row_0 = s * lines.middles_px - 0.5 * high * s * s / c
    begin_px, end_px = (float(np.median(at_row_0 + row / c)) for row in (begins, ends))
    are_whole = is_wide and min(at_edges) > PRESENT - EDGE_LOST
    return _Runs(rows, begin_px, end_px, bool(are_whole))
