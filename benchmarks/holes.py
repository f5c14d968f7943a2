"""A plate of many holes: `python -m benchmarks holes [N …]`, 100 and 1000 holes.

Signals out: processor time (user and system) of whole `morfax trace` processes, from the file to the path,
kernels warm: of the contours, and of all the ink. The exponent is that of the time by the number of holes,
from each plate to the next; 1.0 is linear. The holes are circles of 6 mm, 10 mm apart, inked with 0.5 mm at
300 dpi, on paper with a scanner's noise.
"""

from __future__ import annotations

import math
import tempfile
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from benchmarks.large import used
from benchmarks.rows import Row, tell
from morfax.motion.units import MM_PER_INCH

DPI, LINE_MM = 300, 0.5
HOLE_MM, APART_MM = 6.0, 10.0
SIXTEENTH = 4  # bits: places are drawn to a sixteenth of a pixel
ASKED = {100: 2.0, 1000: 16.0}  # s


def main(words: list[str]) -> None:
    """Print the table."""
    counts = [int(word) for word in words] or list(ASKED)
    with tempfile.TemporaryDirectory() as here:
        file = Path(here, "plate.png")
        drawn(file, 4)
        for lines in ("contours", "all"):
            used(file, "--lines", lines)  # kernels
        took_s = {lines: list[float]() for lines in ("contours", "all")}
        for count in counts:
            drawn(file, count)
            told = f", {ASKED[count]:g} s asked" if count in ASKED else ""
            for lines, times in took_s.items():
                times.append(used(file, "--lines", lines)[0])
            tell(
                f"{count} holes{told}",
                [Row(f"--lines {lines}", times[-1], "s") for lines, times in took_s.items()],
            )
    for lines, times in took_s.items():
        for (few, less_s), (many, more_s) in pairwise(zip(counts, times, strict=True)):
            exponent = math.log(more_s / less_s) / math.log(many / few)
            print(
                f"  --lines {lines}, {few} to {many} holes: exponent {exponent:.2f} (1.0 asked)"
            )


def drawn(file: Path, count: int) -> None:
    """A plate of so many holes in rows, about as high as it is wide."""
    across = math.ceil(math.sqrt(count))
    side_px = round((across + 1) * APART_MM * DPI / MM_PER_INCH)
    grey = np.random.default_rng(1).normal(240, 3, (side_px, side_px))
    ink = np.zeros((side_px, side_px), np.uint8)
    to_px = DPI / MM_PER_INCH * (1 << SIXTEENTH)
    for k in range(count):
        middle = [round((n + 1) * APART_MM * to_px) for n in (k % across, k // across)]
        wide_px = round(LINE_MM * DPI / MM_PER_INCH)
        radius = round(0.5 * HOLE_MM * to_px)
        cv2.circle(ink, middle, radius, 255, wide_px, cv2.LINE_AA, SIXTEENTH)
    grey -= ink * (200 / 255)
    Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
