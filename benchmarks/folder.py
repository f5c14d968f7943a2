"""The table of a folder of drawings: `python -m benchmarks folder DIR`.

Every truth file (`*.csv` with columns loop, x, y in mm) is traced as a program of all its lines: from the image beside it (`name.png`, .jpg or .tif, in the
same sheet coordinates) or, where there is none, from a picture drawn of it here, at 300 dpi with a line of 0.5 mm and a scanner's softness and noise.
Printed are ending, lines traced and true, RMS and largest distance of the path from the truth, Hausdorff distance, the share of the truth that no path
comes within 0.2 mm of, and the time.
"""

from __future__ import annotations

import csv
import sys
import time
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from motion.contour import distance, pointwise
from motion.faults import Fault
from motion.motion import thin
from tracer.drawing import MM_PER_INCH, Drawing
from tracer.tour import trace_lines

Points = NDArray[np.float64]

DPI, LINE_MM, MARGIN_MM, SOFTNESS_MM, FINE = 300.0, 0.5, 8.0, 0.05, 8
NOISE = 0.04  # of the contrast
MISSED_MM = 0.2
HEAD = f"{'drawing':32s}{'ending':8s}{'lines':>9s}{'RMS um':>9s}{'max um':>9s}{'Hausd. um':>11s}{'missed %':>10s}{'time s':>8s}"


def loops_of(file: Path) -> list[Points]:
    """The lines of a truth file, (n, 2) mm each; none if it is another kind of file."""
    loops: dict[str, list[tuple[float, float]]] = {}
    with file.open(newline="", encoding="utf-8") as opened:
        rows = csv.DictReader(opened)
        if not {"loop", "x", "y"} <= set(rows.fieldnames or ()):
            return []
        for row in rows:
            loops.setdefault(row["loop"], []).append((float(row["x"]), float(row["y"])))
    return [np.array(loop) for loop in loops.values() if len(loop) > 1]


def drawn(loops: list[Points]) -> tuple[Drawing, list[Points]]:
    """A picture of the lines as a scanner sees it, and the lines in its sheet coordinates."""
    every = np.vstack(loops)
    loops = [loop - every.min(axis=0) + MARGIN_MM for loop in loops]
    columns, rows = np.ceil((np.ptp(every, axis=0) + 2 * MARGIN_MM) * DPI / MM_PER_INCH).astype(int)
    scale = DPI / MM_PER_INCH * FINE
    fine = np.zeros((rows * FINE, columns * FINE), np.uint8)
    for loop in loops:
        at = np.column_stack([loop[:, 0] * scale, len(fine) - loop[:, 1] * scale]) - 0.5
        cv2.polylines(fine, [np.round(at * 256).astype(np.int32)], False, 255, round(LINE_MM * scale), cv2.LINE_AA, 8)
    ink = cv2.resize(fine, (int(columns), int(rows)), interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    soft = cv2.GaussianBlur(ink, (0, 0), SOFTNESS_MM * DPI / MM_PER_INCH)
    seen = soft + np.random.default_rng(1).normal(0, NOISE, soft.shape)
    return Drawing(np.asarray(seen, np.float32), MM_PER_INCH / DPI), loops


def row(file: Path, loops: list[Points]) -> str:
    """One drawing traced and measured, as a line of the table."""
    image = next((file.with_suffix(s) for s in (".png", ".jpg", ".tif") if file.with_suffix(s).exists()), None)
    begun = time.perf_counter()
    try:
        drawing, truth = (Drawing.open(image), loops) if image is not None else drawn(loops)
        run = trace_lines(drawing)
        path = thin(run)
        found = distance(path, truth)
    except Fault as fault:
        return f"{file.stem[:31]:32s}{fault}"
    took_s = time.perf_counter() - begun
    away_mm = np.concatenate([pointwise(loop, path, 0.05)[1] for loop in truth])
    there = found.path_to_reference
    return (
        f"{file.stem[:31]:32s}{run.ending:8s}{f'{len(run.lines)} of {len(truth)}':>9s}{there.rms_mm * 1e3:9.1f}{there.max_mm * 1e3:9.0f}"
        f"{found.hausdorff_mm * 1e3:11.0f}{100 * np.mean(away_mm > MISSED_MM):10.2f}{took_s:8.1f}"
    )


def main(words: list[str] | None = None) -> None:
    """Print the table of a folder."""
    if not words:
        print("folder: give a folder of drawings, python -m benchmarks folder DIR")
        return
    folder = Path(words[0])
    print(HEAD)
    truths = [(file, loops) for file in sorted(folder.glob("*.csv")) if (loops := loops_of(file))]
    if not truths:
        sys.exit(f"{folder} holds no truth file (.csv with columns loop,x,y)")
    for file, loops in truths:
        print(row(file, loops), flush=True)
