"""Coarse and soft scans: lines of 3 pixels down to 1, blurred ones, JPEG, screenshots.

    python -m benchmarks coarse [COUNT [FIRST]] [-v]

COUNT drawings a row (10), their numbers from FIRST (0); -v names those that are not right.

The outlines and the columns are those of `pencil`; the line has 0.5 mm of ink. "soft 0.5 widths" is a blur
whose spot is as broad at half its height as half of the line's width.
"""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

import cv2
import numpy as np

from benchmarks.pencil import BLACK, HEAD, PAPER, Levels, coverage, measured, outline, told
from morfax.motion.units import MM_PER_INCH

LINE_MM = 0.5
SPOT = 2.355  # standard deviations to the breadth at half of the height
NOISE = 8.0  # levels of 255


class Case(NamedTuple):
    """A row: the line's width in pixels, the blur in widths, noise in levels, JPEG quality (0: none)."""

    name: str
    wide_px: float
    soft: float = 0.25
    noise: float = NOISE
    jpeg: int = 0


CASES = (
    *(Case(f"line of {px:g} px", px) for px in (4, 3, 2.5, 2, 1.75, 1.5, 1.25, 1)),
    *(Case(f"6 px, soft {s:g} widths", 6, s) for s in (0.5, 1.0)),
    *(Case(f"3 px, soft {s:g} widths", 3, s) for s in (0.5, 1.0)),
    *(Case(f"{px:g} px, JPEG quality 30", px, jpeg=30) for px in (6, 3, 2)),
    *(Case(f"screenshot at 96 dpi, {px:g} px", px, 0.0, 0.0) for px in (2, 1.5, 1)),
)


def painted(covered: Levels, case: Case, rng: np.random.Generator) -> Levels:
    """How a coverage looks in a case; levels 0..255."""
    spot_px = case.soft * case.wide_px / SPOT
    soft = cv2.GaussianBlur(covered, (0, 0), spot_px) if spot_px > 0 else covered
    grey = PAPER - (PAPER - BLACK) * soft + rng.normal(0, case.noise, soft.shape)
    if not case.jpeg:
        return np.asarray(grey, np.float32)
    whole = np.clip(np.round(grey), 0, 255).astype(np.uint8)
    _, packed = cv2.imencode(".jpg", whole, [cv2.IMWRITE_JPEG_QUALITY, case.jpeg])
    return np.asarray(cv2.imdecode(packed, cv2.IMREAD_GRAYSCALE), np.float32)


def main(arguments: list[str] | None = None) -> None:
    """Print the table."""
    numbers = [int(word) for word in arguments or [] if word != "-v"]
    count, first = (*numbers, *(10, 0)[len(numbers) :])
    print(HEAD)
    for case in CASES:
        dpi, found = case.wide_px / LINE_MM * MM_PER_INCH, []
        for number in range(first, first + count):
            rng = np.random.default_rng([number, math.ceil(100 * case.wide_px)])
            line = outline(rng)
            found.append(
                measured(line, LINE_MM, painted(coverage(line, LINE_MM, dpi), case, rng), dpi)
            )
            if found[-1].verdict != "right" and "-v" in sys.argv:
                print("   ", number, found[-1].verdict, found[-1].said)
        told(case.name, found)
