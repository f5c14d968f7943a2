"""Empty paper: what a million pixels of it cost, beside OpenCV's blur of the same picture.

The same ring of 0.5 mm is drawn at 600 dpi on a small and on a large sheet, with a scanner's noise. Signals
out: processor time for each further million pixels, in turn in one run, least of ROUNDS: reading the file,
making the darkness, finding the strokes, and all of `trace`; and each in times of one `cv2.GaussianBlur` of
the picture in floats.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from morfax.tracer.drawing import raster
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.levelling import levelled
from morfax.tracer.drawing.strokes import Sheet
from morfax.tracer.program.trace import trace

DPI, NOISE = 600, 1.5  # levels
SIDES_PX = (2000, 5000)
RING_PX = (700, 12)  # radius and width: 186 mm of line
ROUNDS = 3
ASKED_MS = 4.0  # for each Mpx of paper


def sheet(side_px: int, folder: Path) -> Path:
    """A scan of the ring in the middle of a sheet of some pixels, not packed."""
    picture = np.random.default_rng(1).normal(240, NOISE, (side_px, side_px)).astype(np.float32)
    middle = (side_px // 2, side_px // 2)
    cv2.circle(picture, middle, RING_PX[0], 30.0, RING_PX[1], cv2.LINE_AA)
    file = folder / f"{side_px}.tif"
    Image.fromarray(picture.clip(0, 255).astype(np.uint8)).save(file, dpi=(DPI, DPI))
    return file


def tasks(file: Path) -> dict[str, Callable[[], object]]:
    """What is timed on a sheet."""
    grey = raster.read(file, coloured=False).pixels
    drawing = Drawing.open(file)
    floats = np.asarray(grey, np.float32)
    return {
        "one blur of OpenCV": lambda: cv2.GaussianBlur(floats, (0, 0), 1.0),
        "reading": lambda: raster.read(file, coloured=False),
        "darkness": lambda: levelled(grey, 25.4 / DPI),
        "strokes": lambda: Sheet.of(Drawing(drawing.darkness, drawing.pitch_mm)).longest(),
        "trace, file to motion": lambda: trace(Drawing.open(file)),
    }


def used_s(task: Callable[[], object]) -> float:
    """Processor time of a task."""
    before = time.process_time()
    task()
    return time.process_time() - before


def main() -> None:
    """Print a line for each part of the work."""
    with tempfile.TemporaryDirectory() as folder:
        small, large = (tasks(sheet(side, Path(folder))) for side in SIDES_PX)
        least = {name: [float("inf")] * 2 for name in small}
        for _ in range(ROUNDS):
            for name in small:
                both = used_s(small[name]), used_s(large[name])
                least[name] = [min(pair) for pair in zip(least[name], both, strict=True)]
    more_mpx = (SIDES_PX[1] ** 2 - SIDES_PX[0] ** 2) / 1e6
    each_ms = {name: (b - a) / more_mpx * 1e3 for name, (a, b) in least.items()}
    blur_ms = each_ms["one blur of OpenCV"]
    for name, ms in each_ms.items():
        asked = f" ({ASKED_MS:g} asked)" if name.startswith("trace") else ""
        times = f"{ms / blur_ms:.2f} blurs"
        print(f"empty paper: {name}: {ms:.2f} ms for each Mpx, {times}{asked}")


if __name__ == "__main__":
    main()
