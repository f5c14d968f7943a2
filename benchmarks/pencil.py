"""Pencil: is a faint line with grain one closed path, and how far is it from what was drawn?

    python -m benchmarks pencil [COUNT [FIRST]] [-v]

COUNT drawings a row (20), their numbers from FIRST (0); -v names those that are not right.

Closed outlines (rounds, lobes, cams, polygons, rounded polygons, slots) are drawn with a line of 0.35 to 0.6
mm at 300 dpi, a third as dark as ink, behind a scanner's lens, with a scanner's noise (8 levels of 255). The
grain multiplies the line's darkness: normal noise behind a spot of 1.2 pixels, of the standard deviation that
a row states. Each row is traced as `morfax trace` does without options.

A path is right if it is closed, and no part of the outline is farther from it than a line's width. It is
silently wrong if it is closed, not right, and nothing was said about it. The RMS is that of the right paths
from the outline's true line: the median drawing, and the worst.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.jobs.settings.settings import LineSettings
from morfax.jobs.tracing.skips import gap_across_skips
from morfax.motion.contour import distance
from morfax.motion.faults import Fault
from morfax.motion.units import MM_PER_INCH
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.scale import Scale
from morfax.tracer.drawing.scan import Scan, Stated
from morfax.tracer.head.settings import Settings
from morfax.tracer.program.trace import trace

Points = NDArray[np.float64]
Levels = NDArray[np.float32]
Paints = Callable[[Levels, np.random.Generator], Levels]

DPI, MARGIN_MM, SOFTNESS_MM, FINE = 300.0, 6.0, 0.05, 8
PAPER, BLACK, NOISE = 235.0, 40.0, 8.0  # levels of 255
FAINT = 1 / 3  # of ink's darkness
GRAIN_PX = 1.2  # standard deviation of the spot that the grain is seen through
UM = 1000.0
GRAINS = (0.25, 0.35, 0.45)


def outline(rng: np.random.Generator) -> Points:
    """A closed outline of one of six kinds, 25 to 50 mm across, (n, 2) mm from its margin."""
    kind, size_mm = rng.integers(6), rng.uniform(25, 50)
    turns = np.linspace(0, math.tau, 2001)
    lobes, phase = rng.integers(2, 6), rng.uniform(0, math.tau)
    radius = np.ones_like(turns)
    if kind == 1:
        radius = 1 + rng.uniform(0.1, 0.3) * np.cos(lobes * turns + phase)
    if kind == 2:
        for k in range(1, 6):
            radius = radius + 0.25 / k**1.5 * np.cos(k * turns + rng.uniform(0, math.tau))
    line = np.column_stack([radius * np.cos(turns), radius * np.sin(turns)])
    if kind in (3, 4):
        corners = rng.integers(3, 8)
        at = phase + (np.arange(corners) + rng.uniform(-0.2, 0.2, corners)) * math.tau / corners
        line = np.column_stack([np.cos(at), np.sin(at)]) * rng.uniform(0.8, 1.0, (corners, 1))
        line = np.vstack([line, line[:1]])
    if kind in (4, 5):
        import shapely

        core = shapely.Polygon(line) if kind == 4 else shapely.LineString([[0, 0], [1.5, 0.4]])
        line = np.asarray(core.buffer(0.25, quad_segs=200).exterior.coords)
    line = line * size_mm / np.ptp(line, axis=0).max()
    return np.asarray(line - line.min(axis=0) + MARGIN_MM)


def coverage(line: Points, width_mm: float, dpi: float = DPI) -> Levels:
    """The share of each pixel that the ink of a line covers, 0..1, rows from the top."""
    columns, rows = np.ceil((line.max(axis=0) + MARGIN_MM) * dpi / MM_PER_INCH).astype(int)
    scale = dpi / MM_PER_INCH * FINE
    fine = np.zeros((rows * FINE, columns * FINE), np.uint8)
    at = np.column_stack([line[:, 0] * scale, len(fine) - line[:, 1] * scale]) - 0.5
    fixed = np.round(at * 256).astype(np.int32)
    cv2.polylines(fine, [fixed], False, 255, round(width_mm * scale), cv2.LINE_AA, 8)
    small = cv2.resize(fine, (int(columns), int(rows)), interpolation=cv2.INTER_AREA)
    return np.asarray(small / np.float32(255), np.float32)


def pencil(grain: float, faint: float = FAINT) -> Paints:
    """How a pencil of a grain paints a coverage; levels 0..255."""

    def painted(covered: Levels, rng: np.random.Generator) -> Levels:
        soft = cv2.GaussianBlur(covered, (0, 0), SOFTNESS_MM * DPI / MM_PER_INCH)
        wave = cv2.GaussianBlur(rng.normal(size=soft.shape), (0, 0), GRAIN_PX)
        ink = soft * np.clip(1 + grain * wave / wave.std(), 0, 2) * faint
        return np.asarray(PAPER - (PAPER - BLACK) * ink + rng.normal(0, NOISE, soft.shape))

    return painted


class Found(NamedTuple):
    """What became of one drawing: "right", "told", "wrong", or "refused"; RMS, um; processor time, s."""

    verdict: str
    rms_um: float
    took_s: float
    said: str


def scanned(levels: Levels, dpi: float) -> Drawing:
    """The drawing of a picture of grey levels, as it is opened."""
    grey = np.clip(np.round(levels), 0, 255).astype(np.uint8)
    return Drawing.of(Scan(Path("made.png"), grey, Stated((dpi, dpi))), Scale())


def measured(line: Points, width_mm: float, levels: Levels, dpi: float = DPI) -> Found:
    """Trace a picture of a closed line, and hold the path against the line."""
    begun = time.process_time()
    try:
        drawing = scanned(levels, dpi)
        gap_mm = gap_across_skips(drawing, LineSettings(), Settings())
        settings = Settings() if gap_mm is None else Settings(gap_mm=gap_mm)
        found = trace(drawing, settings=settings)
    except Fault as fault:
        return Found("refused", math.nan, time.process_time() - begun, str(fault))
    took_s, run = time.process_time() - begun, found.lines[0]
    apart = distance(run.xy_mm[::4], line)
    there, back = apart.path_to_reference, apart.reference_to_path
    right = run.ending == "closed" and max(there.max_mm, back.max_mm) < width_mm
    is_said = run.ending != "closed" or bool(found.unexplained)
    verdict = "right" if right else "told" if is_said else "wrong"
    off_mm = max(there.max_mm, back.max_mm)
    said = f"{run.ending}, {run.length_mm:.0f} mm, at most {off_mm:.2f} mm off"
    return Found(verdict, there.rms_mm * UM, took_s, said)


def told(name: str, found: list[Found]) -> None:
    """Print a row."""
    verdicts = [one.verdict for one in found]
    counts = [f"{verdicts.count(v):9d}" for v in ("right", "told", "refused", "wrong")]
    rms = [one.rms_um for one in found if one.verdict == "right"] or [math.nan]
    print(
        f"{name:28s}{len(found):5d}{''.join(counts)}"
        f"{np.median(rms):9.1f}{np.max(rms):8.1f}{np.mean([one.took_s for one in found]):8.2f}",
        flush=True,
    )


HEAD = (
    f"{'drawing':28s}{'of':>5s}{'right':>9s}{'told':>9s}{'refused':>9s}{'WRONG':>9s}"
    f"{'RMS um':>9s}{'worst':>8s}{'s':>8s}"
)


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    numbers = [int(word) for word in arguments or [] if word != "-v"]
    count, first = (*numbers, *(20, 0)[len(numbers) :])
    print(HEAD)
    for grain in GRAINS:
        found = []
        for number in range(first, first + count):
            rng = np.random.default_rng([number, round(100 * grain)])
            line, width_mm = outline(rng), rng.uniform(0.35, 0.6)
            one = measured(line, width_mm, pencil(grain)(coverage(line, width_mm), rng))
            found.append(one)
            if one.verdict != "right" and "-v" in sys.argv:
                print(number, grain, f"{width_mm:.2f}", one.verdict, one.said)
        told(f"pencil, grain {grain:.0%}", found)
