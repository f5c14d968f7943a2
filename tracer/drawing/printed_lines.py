"""Printed lines: families of parallel lines on paper, found by period and straightness.

Signals: darkness of a sheet (0 paper, 1 ink) in; families of printed lines out.

    │   │   │ ╱ │       a family: angle, period, first and last line, and from where to where they run.
    │   │  ╭┼╯  │       All of them are there, straight, a period apart, over and over as dark.
    │   │ ╱ │   │       Finer lines between them, as on millimetre paper, are a family of their own.

Source: our own. Questions: a photograph of paper that is not flat has no such lines.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.tracer.drawing.components import INK
from morfax.tracer.effort import FEW_PX

Darkness = NDArray[np.float32]

# Chosen by trial on drawings on printed paper.
TILT_DEG, TILT_STEP_DEG = 4.0, 0.1  # of the paper on the scanner's glass
INKED = 0.15  # darker is ink, drawn or printed
LEVELS = INKED, INK  # noise and finer lines are paler than the second one
# of printed lines: squares of 1, 4, 5 mm; 6 to 11 mm ruled
LEAST_PERIOD_MM, LARGEST_PERIOD_MM = 0.9, 15.0
FINER = (
    10,
    8,
    5,
    4,
    2,
)  # lines for each one that is found: of paper in millimetres and in inches
FEWEST_LINES = 6
BROADEST_MM = 0.6  # of a printed line
OFF_PERIOD = 0.06  # of the period: a printed line is as near to its place
PRESENT = 0.85  # of the lines that the period asks for
SOFT_PX = 1.5  # beside a printed line: its soft edges
SPANNED = 0.6  # of a line's length is inked
EDGE = 0.03  # of the sheet's length: most of it is inked at both ends of a line that goes over the edge
EDGE_LOST = 0.25  # of them may leave the sheet at a side, or lie under a shadow
SPREAD = 0.5  # of the sheet's length and width: so far printed lines run
# of the sheet's length: where lines are looked for first; no whole parts, at which a line across may lie
ROWS = 0.317, 0.373, 0.471, 0.593, 0.713
SHADE = 0.02  # of ink's darkness: a printed line is so much darker than the paper beside it
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
    is_whole: bool  # from edge to edge of the sheet

    def off_px(self, rows: Array, columns: Array) -> Array:
        """How far places are from the middle of the nearest printed line, px."""
        at = self.across[0] * columns + self.across[1] * rows - self.first_px
        last = self.lines - 1
        return np.asarray(at - np.clip(np.round(at / self.period_px), 0, last) * self.period_px)

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


def families(darkness: Darkness, pitch_mm: float) -> list[list[Family]]:
    """The families of printed lines on a sheet: upright ones, lying ones, both or none; each with the finer
    one between its lines, if there is one.
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
        """The family of this direction, and the finer one."""
        if not self._may_have_lines():
            return []
        tilt = self._tilt()
        upright = self._straightened(tilt)
        combs = (_comb(upright, level, pitch_mm) for level in LEVELS)
        comb = next((one for one in combs if one is not None), None)
        runs = comb and _runs_of(upright, comb, tilt)
        if comb is None or runs is None:
            return []
        family = self._family(comb, tilt, runs)
        finer = _finer(upright, comb, runs, pitch_mm)
        return [family] if finer is None else [family, self._family(finer, tilt, runs)]

    def _may_have_lines(self) -> bool:
        """Whether most of some rows are inked at places that are evenly apart: to ask that takes no time, and
        most drawings have none.
        """
        high = len(self.darkness)
        missed = 0
        for part in ROWS:
            row = int(part * high)
            seen = np.sort(self.darkness[row - 3 : row + 4], axis=0)[3]
            missed += not any(_are_evenly_apart(seen, level) for level in LEVELS)
            if missed > len(ROWS) // 2:
                return False
        return True

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

    def _family(self, comb: _Comb, tilt: float, runs: _Runs) -> Family:
        """Lines of a straightened sheet, on the sheet as it lies."""
        c, s = math.cos(tilt), math.sin(tilt)
        first_px = comb.first_px * c - 0.5 * len(self.darkness) * s
        across = (c, -s) if self.is_upright else (-s, c)
        begin, end = runs.begin_px, runs.end_px
        run_px = (begin, end) if self.is_upright else (-end, -begin)
        period_px = comb.period_px * c
        return Family(
            across, first_px, period_px, comb.lines, comb.half_px, run_px, runs.are_whole
        )


def _gathered(at: Array, wide: int) -> float:
    """How unevenly places are spread over a width; each is shared by the two pixels about it."""
    at = at[(at >= 0) & (at < wide - 1)]
    first = at.astype(int)
    second = at - first
    counts = np.bincount(first, 1 - second, wide) + np.bincount(first + 1, second, wide)
    return float(np.sum(np.diff(counts) ** 2))


def _middles(
    seen: Array, is_line: NDArray[np.bool_], broadest_px: float
) -> tuple[Array, Array]:
    """Middles and widths of the narrow lines of a profile, by its darkness and where that is of a line."""
    edges = np.flatnonzero(np.diff(np.r_[False, is_line, False].astype(int)))
    begins, ends = edges[::2], edges[1::2]
    narrow = ends - begins < broadest_px
    spans = [np.arange(b, e) for b, e in zip(begins[narrow], ends[narrow], strict=True)]
    middles = [np.average(span, weights=seen[span]) for span in spans]
    return np.array(middles, float), np.asarray(ends - begins, float)[narrow]


def _are_evenly_apart(seen: Array, level: float) -> bool:
    """Whether the lines that cross a row are evenly apart, or are some of such lines."""
    middles, widths = _middles(seen, seen > level, math.inf)
    if len(middles) < FEWEST_LINES:
        return False
    gaps = np.diff(
        middles[widths < 2 * np.median(widths)]
    )  # and not where a row runs in a line across
    times = gaps / np.median(gaps)
    return bool(np.mean(np.abs(times - np.round(times)) < 2 * OFF_PERIOD) > SPANNED)


class _Comb(NamedTuple):
    """First line, period, lines and half width of evenly spaced lines, px."""

    first_px: float
    period_px: float
    lines: int
    half_px: float

    @property
    def middles_px(self) -> Array:
        """Where the lines are."""
        return np.asarray(self.first_px + self.period_px * np.arange(self.lines), float)


def _comb(upright: Darkness, level: float, pitch_mm: float) -> _Comb | None:
    """The evenly spaced lines of a straightened sheet that are darker than a level."""
    # 1. narrow lines
    is_line = np.mean(upright > level, axis=0) > SPREAD * SPANNED
    lines, widths = _middles(np.mean(upright, axis=0), is_line, BROADEST_MM / pitch_mm)
    if len(lines) < FEWEST_LINES:
        return None
    # 2. the period that they keep
    period = float(np.median(np.diff(lines)))
    if not LEAST_PERIOD_MM <= period * pitch_mm <= LARGEST_PERIOD_MM:
        return None
    number = np.round((lines - lines[len(lines) // 2]) / period)
    period, first = (float(v) for v in np.polyfit(number, lines, 1))
    number = np.round((lines - first) / period)
    kept = np.abs(lines - first - number * period) < OFF_PERIOD * period
    if not kept.any():
        return None
    begin, end = number[kept].min(), number[kept].max()
    asked = int(end - begin) + 1
    if np.count_nonzero(kept) < max(FEWEST_LINES, PRESENT * asked) or kept.mean() < PRESENT:
        return None
    half_px = 0.5 * float(np.median(widths)) + SOFT_PX
    if asked * period < SPREAD * len(is_line) or period < 2 * half_px + 2:
        return None
    return _Comb(first + begin * period, period, asked, half_px)


class _Runs(NamedTuple):
    """From where to where lines run along themselves, px; and whether they go from edge to edge."""

    rows: slice
    begin_px: float
    end_px: float
    are_whole: bool


def _runs_of(upright: Darkness, comb: _Comb, tilt: float) -> _Runs | None:
    """How far the lines of a straightened sheet run; None if they are not there all the way."""
    high, wide = upright.shape
    beside = np.clip(np.round(comb.middles_px).astype(int)[:, None] + [-1, 0, 1], 0, wide - 1)
    inked = (upright[:, beside].max(axis=2) > INKED).astype(np.float32)
    is_line = cv2.blur(inked, (1, max(1, round(comb.period_px)))) > 0.5
    begins, ends = np.argmax(is_line, axis=0), high - np.argmax(is_line[::-1], axis=0)
    rows = slice(int(np.median(begins)), int(np.median(ends)))
    if rows.stop - rows.start < SPREAD * high:
        return None
    if np.mean(inked[rows].mean(axis=0) > SPANNED) < PRESENT:
        return None
    edge = (1 - SPANNED) * EDGE * high
    at_edges = [np.mean(begins <= edge), np.mean(ends >= high - edge)]
    is_wide = comb.lines >= PRESENT * (wide / comb.period_px - 2)
    c, s = math.cos(tilt), math.sin(tilt)
    at_row_0 = s * comb.middles_px - 0.5 * high * s * s / c
    begin_px, end_px = (float(np.median(at_row_0 + row / c)) for row in (begins, ends))
    are_whole = is_wide and min(at_edges) > PRESENT - EDGE_LOST
    return _Runs(rows, begin_px, end_px, bool(are_whole))


def _finer(upright: Darkness, comb: _Comb, runs: _Runs, pitch_mm: float) -> _Comb | None:
    """The finest lines evenly between those that were found."""
    every = max(1, upright.size // FEW_PX)
    seen = np.median(upright[runs.rows][::every], axis=0)
    for times in FINER:
        period = comb.period_px / times
        lines = times * (comb.lines - 1) + 1
        if period < 2 * comb.half_px + 2:
            continue
        finer = comb._replace(period_px=period, lines=lines)
        between = np.arange(lines) % times != 0
        at = finer.middles_px[between]
        places = np.round(at + period * np.array([[-0.5], [0.0], [0.5]])).astype(int)
        low, line, high = seen[np.clip(places, 0, len(seen) - 1)]
        if np.mean(line - np.maximum(low, high) > SHADE) > PRESENT:
            return finer
    return None
