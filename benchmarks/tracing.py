"""Tracing a drawing, side by side with what one would reach for first: the contours and the skeleton of
scikit-image.

All start from the same file, a scan at 300 dpi of a star inked with a line of 0.5 mm (the project's own
cam where the collection of real parts is missing), and end with places in mm on the sheet. The time is
that of the whole way from the file, kernels warm. The accuracy is the RMS distance of those places from
the true line. Contours run along both edges of the ink, half a line width away; a row of its own
subtracts that half, as if the width were known.

Times real time: the motion's own duration over the time that the processor spent (all its cores counted).
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from skimage.filters import threshold_otsu
from skimage.measure import find_contours, label
from skimage.morphology import skeletonize

from benchmarks.rows import Row, best_s, tell
from morfax.motion.contour import distances_mm
from morfax.motion.motion import thin
from morfax.motion.pathfile import read_path
from morfax.motion.polyline import lengths_mm
from morfax.motion.units import MM_PER_INCH
from morfax.player.tape.playback import play
from morfax.recorder.tape.tape import TapeFormat, record
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace import trace

Points = NDArray[np.float64]

HOUSE = Path(__file__).parents[1]
PARTS = HOUSE.parent / "shared" / "drawings"
STAR = PARTS / "truth" / "v04_star.ngc.csv"
DPI = 300.0
LINE_MM = 0.5
STEP_MM = 0.01  # between the places of the truth
UM = 1000.0  # um per mm


def drawing_and_truth(folder: Path) -> tuple[Path, Path]:
    """The drawing, and the true line beside it."""
    if not STAR.exists():
        return HOUSE / "samples" / "cam.png", HOUSE / "samples" / "cam.csv"
    drawn = folder / "star.png"
    command = [
        sys.executable,
        PARTS / "render.py",
        STAR,
        drawn,
        "--dpi",
        f"{DPI:g}",
        "--line",
        f"{LINE_MM}",
        "--scan",
    ]
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    return drawn, drawn.with_suffix(".csv")


def traced(file: Path) -> Trace:
    """The whole pipeline: file to motion."""
    return trace(Drawing.open(file))


def on_sheet(rows: Points, columns: Points, height_px: int) -> Points:
    """Places in mm of pixels, whose centres are whole numbers."""
    return np.column_stack([columns + 0.5, height_px - rows - 0.5]) * MM_PER_INCH / DPI


def contours(file: Path) -> Points:
    """Places on the edges of the longest patch of ink, by marching squares between the grey levels; as one
    would first write it.
    """
    grey = np.asarray(Image.open(file).convert("L"))
    found = sorted(find_contours(grey, threshold_otsu(grey)), key=len)[
        -2:
    ]  # both edges of a closed line
    return np.vstack([on_sheet(edge[:, 0], edge[:, 1], len(grey)) for edge in found])


def skeleton(file: Path) -> Points:
    """Places of the largest skeleton; as one would first write it."""
    grey = np.asarray(Image.open(file).convert("L"))
    thinned = label(skeletonize(grey < threshold_otsu(grey)), connectivity=2)
    rows, columns = np.nonzero(thinned == np.argmax(np.bincount(thinned.ravel())[1:]) + 1)
    return on_sheet(rows, columns, len(grey))


def rms_um(distances: Points) -> float:
    """Root mean square, um."""
    return float(np.sqrt(np.mean(distances**2))) * UM


def dense(line: Points) -> Points:
    """The line with a place every `STEP_MM`."""
    along = lengths_mm(line)
    every = np.arange(0.0, along[-1], STEP_MM)
    return np.column_stack([np.interp(every, along, line[:, i]) for i in (0, 1)])


def tracing_rows(file: Path, truth_file: Path) -> list[Row]:
    """Times from the file to places on the sheet, and how far those are from the truth."""
    truth = read_path(truth_file).xy_mm
    tasks: dict[str, Callable[[], object]] = {
        "trace": lambda: traced(file),
        "contours": lambda: contours(file),
        "skeleton": lambda: skeleton(file),
    }
    for task in tasks.values():
        task()  # kernels from their cache
    took = best_s(tasks)
    path = dense(thin(traced(file)).runs()[0])
    edges = distances_mm(contours(file), truth)
    head_um = rms_um(distances_mm(path, truth))
    accuracy = {
        "trace": head_um,
        "find_contours": rms_um(edges),
        "find_contours, less half a width": rms_um(edges - LINE_MM / 2),
        "skeletonize": rms_um(distances_mm(skeleton(file), truth)),
    }
    return [
        Row("trace, file to motion", took["trace"] * 1e3, "ms"),
        Row(
            "find_contours, file to edges",
            took["contours"] * 1e3,
            "ms",
            took["contours"] / took["trace"],
            "trace",
        ),
        Row(
            "skeletonize, file to pixels",
            took["skeleton"] * 1e3,
            "ms",
            took["skeleton"] / took["trace"],
            "trace",
        ),
        *(
            Row(f"off the truth: {name}", um, "um RMS", um / head_um, "trace")
            for name, um in accuracy.items()
        ),
    ]


def speed_rows(file: Path, folder: Path) -> list[Row]:
    """Simulated time over processor time of each machine."""
    drawing, tape = Drawing.open(file), folder / "tape.wav"
    motion = trace(drawing)
    blocks = list(motion)

    def recorded() -> None:
        tape.unlink(missing_ok=True)
        record(blocks, tape, TapeFormat())

    def played() -> None:
        for _ in play(tape):
            pass

    recorded(), played()
    took = best_s(
        {
            "follower, finding the line too": lambda: trace(drawing),
            "recorder": recorded,
            "player": played,
        },
        time.process_time,
    )
    simulated = {name: motion.duration_s / taken for name, taken in took.items()}
    both = motion.duration_s / (took["recorder"] + took["player"])
    return [
        *(Row(f"{name}", ratio, "x real time") for name, ratio in simulated.items()),
        Row("recorder and player", both, "x real time"),
    ]


def main() -> None:
    """Print the figures as a table."""
    with tempfile.TemporaryDirectory() as folder:
        file, truth = drawing_and_truth(Path(folder))
        with Image.open(file) as image:
            width, height = image.size
        title = f"tracing: {file.stem}, {width} x {height} pixels at {DPI:g} dpi, a line of {LINE_MM} mm"
        tell(title, tracing_rows(file, truth) + speed_rows(file, Path(folder)))


if __name__ == "__main__":
    main()
