"""Large sheets: `python -m benchmarks large [MPX METRES [TYPE]]`.

Without words A0 at 600 dpi with 0.3, 30 and 100 m of line, and one line on sheets of 16 to 256 Mpx.

Signals out: processor time (user and system) and largest memory of whole `morfax trace` processes, from the
file to the path, kernels warm. The line is one closed serpentine of 0.5 mm on paper with a scanner's noise.
The files are a TIFF of strips, which is not packed, and a PNG.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from multiprocessing import get_context
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.rows import Row, tell
from benchmarks.start import ENVIRONMENT
from morfax.motion.units import MM_PER_INCH

DPI, LINE_MM = 600, 0.5
A0_MM = 841.0, 1189.0
A0_MPX = 558.0
MARGIN_MM = 20.0
# the noise of the paper comes again: a whole sheet of it takes a minute to make
NOISE_TILE_PX = 512
ASKED = {0.3: (3, 0.6), 30.0: (30, 0.6), 100.0: (90, 0.6)}  # s, GB


def main(words: list[str]) -> None:
    """Print the table."""
    sheets = [(A0_MPX, metres, "tif") for metres in ASKED]
    sheets += [(A0_MPX, 0.3, "png"), *((mpx, 0.3, "tif") for mpx in (16.0, 64.0, 256.0))]
    if words:
        sheets = [(float(words[0]), float(words[1]), words[2] if len(words) > 2 else "tif")]
    with tempfile.TemporaryDirectory() as here:
        for mpx, metres, kind in sheets:
            file = Path(here, f"sheet.{kind}")
            # drawn by another process: memory of this one would count as that of the trace it starts
            drawing = get_context("spawn").Process(target=drawn, args=(file, mpx, metres))
            drawing.start()
            drawing.join()
            took_s, held_gb = used(file)
            asked = ASKED.get(metres) if mpx == A0_MPX else None
            told = "" if asked is None else f", {asked[0]} s and {asked[1]} GB asked"
            tell(
                f"{mpx:g} Mpx, {metres:g} m of line, {kind}{told}",
                [
                    Row("processor time", took_s, "s"),
                    Row("largest memory", held_gb * 1e3, "MB"),
                ],
            )


def drawn(file: Path, mpx: float, metres: float) -> None:
    """A sheet of A0's shape with a serpentine of so many metres."""
    across_mm, up_mm = (side * (mpx / A0_MPX) ** 0.5 for side in A0_MM)
    columns, rows = (round(side * DPI / MM_PER_INCH) for side in (across_mm, up_mm))
    rng = np.random.default_rng(1)
    tile = np.clip(rng.normal(240, 3, (NOISE_TILE_PX,) * 2), 0, 255).astype(np.uint8)
    times = -(-rows // NOISE_TILE_PX), -(-columns // NOISE_TILE_PX)
    grey = np.tile(tile, times)[:rows, :columns].copy()
    places = serpentine(across_mm - 2 * MARGIN_MM, up_mm - 2 * MARGIN_MM, 1e3 * metres)
    pixels = (places + MARGIN_MM) * DPI / MM_PER_INCH
    for first in range(0, len(pixels) - 1, 1000):  # of the whole OpenCV would fill the inside
        some = np.rint(pixels[first : first + 1001] * 16).astype(np.int32)
        cv2.polylines(
            grey, [some], False, 40, round(LINE_MM * DPI / MM_PER_INCH), cv2.LINE_AA, 4
        )
    Image.fromarray(grey).save(
        file, dpi=(DPI, DPI), **({"compress_level": 1} if file.suffix == ".png" else {})
    )


def serpentine(across_mm: float, up_mm: float, length_mm: float) -> NDArray[np.float64]:
    """A closed line of about a length: a band folded into rows that are joined by half circles, (n, 2) mm."""
    # the middle of the band, and half the band's width: two lines to a row
    rows = max(1, round(length_mm / (2 * across_mm)))
    wide_mm = min(across_mm, length_mm / (2 * rows))
    pitch_mm = min(up_mm / rows, 60.0)
    half_mm, turn_mm = 0.25 * pitch_mm, 0.5 * pitch_mm
    middle = []
    for row in range(rows):
        y, way = (row + 0.5) * pitch_mm, 1 if row % 2 == 0 else -1
        ends = (turn_mm, wide_mm - turn_mm)[::way]
        middle.append(np.array([[ends[0], y], [ends[1], y]]))
        if row + 1 < rows:
            angle = np.linspace(-np.pi / 2, np.pi / 2, 90)[1:-1]
            x = ends[1] + way * turn_mm * np.cos(angle)
            middle.append(np.column_stack([x, y + turn_mm + turn_mm * np.sin(angle)]))
    line = np.vstack(middle)
    way = np.gradient(line, axis=0)
    way /= np.hypot(*way.T)[:, None]
    aside = half_mm * np.column_stack([-way[:, 1], way[:, 0]])
    angle = np.linspace(0, np.pi, 45)[1:-1]
    there, back = line + aside, (line - aside)[::-1]
    round_end = half_mm * np.column_stack([np.cos(angle), np.sin(angle)])
    far = line[-1] + round_end @ np.stack([aside[-1] / half_mm, way[-1]])
    near = line[0] + round_end @ np.stack([-aside[0] / half_mm, -way[0]])
    return np.vstack([there, far, back, near, there[:1]])


def used(file: Path, *options: str) -> tuple[float, float]:
    """Processor time, s, and largest memory, GB, of tracing a sheet."""
    path = file.with_suffix(".csv")
    words = [
        sys.executable,
        "-m",
        "morfax",
        "trace",
        str(file),
        "-o",
        str(path),
        "-q",
        *options,
    ]
    process = subprocess.Popen(words, env=ENVIRONMENT)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"tracing {file} ended with {status}")
    path.unlink()
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e6
