"""Even lines: columns of a sheet that are evenly apart and darker than what is between them.

Signals: darkness of a sheet whose lines are upright (rows along them, columns across), or the usual darkness
of its columns, in; first line, period and number of the lines out, px.

    │    │    │    │        each tenth or fifth line may be heavier than the others, as on millimetre paper
    │ ╷ ╷│ ╷ ╷│ ╷ ╷│

Source: our own. Questions: none.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from morfax.motion.arrays import Array
from morfax.motion.median import median
from morfax.tracer.drawing.components import INK

Darkness = NDArray[np.float32]

# Chosen by trial on drawings on printed paper.
INKED = 0.15  # darker is ink, drawn or printed
LEVELS = INKED, INK  # noise and finer lines are paler than the second one
# of printed lines: squares of 1, 4, 5 mm; 6 to 11 mm ruled
LEAST_PERIOD_MM, LARGEST_PERIOD_MM = 0.9, 15.0
# lines for each one that is found, or that is heavier: of paper in millimetres and in inches
FINER = 10, 8, 5, 4, 2
HEAVIER = 1.25  # times as dark as usual
FEWEST_LINES = 6
BROADEST_MM = 0.6  # of a printed line
OFF_PERIOD = 0.06  # of the period: a printed line is as near to its place
PRESENT = 0.85  # of the lines that the period asks for
SOFT_PX = 1.5  # beside a printed line: its soft edges
SPANNED = 0.6  # of a line's length is inked
SPREAD = 0.5  # of the sheet's length and width: so far printed lines run
SHADE = 0.02  # of ink's darkness: a printed line is so much darker than the paper beside it


class EvenLines(NamedTuple):
    """First line, period, number and half width of lines that are evenly apart, px."""

    first_px: float
    period_px: float
    lines: int
    half_px: float

    @property
    def middles_px(self) -> Array:
        """Where the lines are."""
        return np.asarray(self.first_px + self.period_px * np.arange(self.lines), float)

    def with_outermost(self, seen: Array) -> EvenLines:
        """These lines, and those beyond the first and the last one that stand out."""
        lines = self
        for before in (True, False):
            while True:
                at = lines.first_px + lines.period_px * (-1 if before else lines.lines)
                on_sheet = 0 <= at < len(seen)
                if not on_sheet or not _stand_out(seen, np.array([at]), lines.period_px)[0]:
                    break
                first_px = at if before else lines.first_px
                lines = lines._replace(first_px=first_px, lines=lines.lines + 1)
        return lines

    def finest(self, seen: Array) -> EvenLines:
        """The finest lines evenly between these, or these themselves."""
        for times in FINER:
            period, lines = self.period_px / times, times * (self.lines - 1) + 1
            finer = self._replace(period_px=period, lines=lines)
            at = finer.middles_px[np.arange(lines) % times != 0]
            is_clear = period > 2 * self.half_px + 1
            if is_clear and np.mean(_stand_out(seen, at, period)) > PRESENT:
                return finer
        return self

    def heavier(self, seen: Array) -> list[EvenLines]:
        """Each tenth, fifth or second of these lines, where it is darker than the others."""
        beside = np.round(self.middles_px).astype(int)[:, None] + [-1, 0, 1]
        dark = seen[np.clip(beside, 0, len(seen) - 1)].max(axis=1)
        found = []
        for times in (of for of in FINER if 3 * of <= self.lines):
            first = int(np.argmax([median(dark[k::times]) for k in range(times)]))
            of_these = dark[first::times]
            if np.mean(of_these > HEAVIER * median(dark)) > PRESENT:
                found.append(
                    self._replace(
                        first_px=self.first_px + first * self.period_px,
                        period_px=self.period_px * times,
                        lines=len(of_these),
                    )
                )
        return found


def even_lines(upright: Darkness, level: float, pitch_mm: float) -> EvenLines | None:
    """The evenly spaced lines of a straightened sheet that are darker than a level."""
    # 1. narrow lines
    is_line = np.mean(upright > level, axis=0) > SPREAD * SPANNED
    lines, widths = _middles(np.mean(upright, axis=0), is_line, BROADEST_MM / pitch_mm)
    if len(lines) < FEWEST_LINES:
        return None
    # 2. the period that they keep; those midway between two are of a finer family
    period = median(np.diff(lines))
    if not LEAST_PERIOD_MM <= period * pitch_mm <= LARGEST_PERIOD_MM:
        return None
    halves = np.r_[0, np.cumsum(np.round(2 * np.diff(lines) / period))]
    halves += np.mean(halves % 2) > 0.5
    number, whole = halves / 2, halves % 2 == 0
    period, first = (float(v) for v in np.polyfit(number[whole], lines[whole], 1))
    kept = np.abs(lines - first - number * period) < OFF_PERIOD * period
    ours = number[kept & whole]
    if len(ours) < FEWEST_LINES or kept.mean() < PRESENT:
        return None
    begin, asked = ours.min(), int(np.ptp(ours)) + 1
    if len(ours) < SPANNED * asked:  # all of them are asked for along their runs
        return None
    half_px = 0.5 * median(widths) + SOFT_PX
    if asked * period < SPREAD * len(is_line) or period < 2 * half_px + 1:
        return None
    return EvenLines(first + begin * period, period, asked, half_px)


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


def are_evenly_apart(seen: Array, level: float) -> bool:
    """Whether the lines that cross a row are evenly apart, or are some of such lines."""
    middles, widths = _middles(seen, seen > level, math.inf)
    middles = (
        middles[widths < 2 * median(widths)] if len(middles) else middles
    )  # none along a line across
    if len(middles) < FEWEST_LINES:
        return False
    gaps = np.diff(middles)
    times = gaps / median(gaps)
    return bool(np.mean(np.abs(times - np.round(times)) < 2 * OFF_PERIOD) > SPANNED)


def _stand_out(seen: Array, at_px: Array, apart_px: float) -> NDArray[np.bool_]:
    """Whether the darkness of columns is more at some places than midway to the next ones."""
    places = np.round(at_px + apart_px * np.array([[-0.5], [0.0], [0.5]])).astype(int)
    on_sheet = (places >= 0) & (places < len(seen))
    low, line, high = np.where(on_sheet, seen[np.clip(places, 0, len(seen) - 1)], 0.0)
    return np.asarray(line - np.maximum(low, high) > SHADE)
