"""A choice that holds: is the same line taken, with the same numbers, however a sheet is scanned?

    python -m benchmarks choice [COUNT [FIRST]] [-v]

COUNT drawings (10), their numbers from FIRST (0); -v names those that differ. Each has two to twelve shapes
(rounds, lobes, polygons, stars, open curves), apart, one within another, or two that cross; their lengths
differ by 4 % at least. It is scanned as it is, at four other sizes (with the pen), six other angles and two
other resolutions: 13 scans, each with noise of its own. A plain trace says which line is taken, a trace of
all contours how lines are numbered: each line counts as the shape nearest to it.
"""

from __future__ import annotations

import math
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from morfax.motion.faults import Fault
from morfax.motion.polyline import evenly, length_mm, nearest_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.trace import trace
from morfax.tracer.program.trace_lines import trace_lines

Points = NDArray[np.float64]

# of the sheet as it is; pixels; levels of 255
SIDE_MM, PEN_MM, FINER, NOISE = 90.0, 0.5, 3, 5.0
CLEAR_MM, DIFFER = 3.0, 1.04
SIZES, ANGLES_DEG, RESOLUTIONS = (0.5, 0.75, 1.4, 2.0), (15, 33, 45, 90, 137, 200), (150, 600)


class Way(NamedTuple):
    """How a sheet is scanned: its size, its angle, and dots per inch."""

    times: float = 1.0
    angle_deg: float = 0.0
    dpi: float = 300.0


WAYS = [
    Way(),
    *(Way(times=times) for times in SIZES),
    *(Way(angle_deg=angle) for angle in ANGLES_DEG),
    *(Way(dpi=dpi) for dpi in RESOLUTIONS),
]


def shape(rng: np.random.Generator, size_mm: float) -> Points:
    """A shape of a size about zero, closed or open, (n, 2) mm."""
    kind, turns = rng.integers(5), np.linspace(0, math.tau, 1201) + rng.uniform(0, math.tau)
    radius = np.ones(len(turns))
    if kind == 1:
        radius += rng.uniform(0.1, 0.25) * np.cos(rng.integers(2, 6) * turns)
    if kind in (2, 3):
        corners = int(rng.integers(3, 7)) * (1 if kind == 2 else 2)
        turns = turns[0] + np.arange(corners + 1) * math.tau / corners
        radius = np.ones(corners + 1)
        radius[1::2] *= 1.0 if kind == 2 else rng.uniform(0.5, 0.7)
        radius[-1] = radius[0]
    if kind == 4:
        turns, radius = turns[:800], np.linspace(0.5, 1.0, 800)
    return size_mm * np.column_stack([radius * np.cos(turns), radius * np.sin(turns)])


def drawing(rng: np.random.Generator) -> list[Points]:
    """The shapes of a sheet, (n, 2) mm from its middle; two of them may cross."""
    shapes, crosses = list[Points](), rng.random() < 0.3
    wanted = int(rng.integers(2, 13))
    for _ in range(400):
        size_mm = float(rng.uniform(3, 16))
        reach_mm = SIDE_MM / 2 - size_mm - 4
        new = evenly(shape(rng, size_mm) + rng.uniform(-reach_mm, reach_mm, 2), 0.2)
        apart_mm = min((nearest_mm(new, old).min() for old in shapes), default=math.inf)
        lengths = [length_mm(old) / length_mm(new) for old in shapes]
        differs = all(not 1 / DIFFER < ratio < DIFFER for ratio in lengths)
        may_cross = crosses and len(shapes) == 1
        if differs and (apart_mm > CLEAR_MM or may_cross):
            shapes.append(new)
        if len(shapes) == wanted:
            break
    return shapes


def scanned(shapes: list[Points], way: Way, file: Path, seed: int) -> list[Points]:
    """Write the scan; the shapes as they lie on it, (n, 2) mm."""
    side_mm = math.sqrt(2) * way.times * SIDE_MM
    turn = math.radians(way.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    turned = np.array([[c, s], [-s, c]])
    on_it = [way.times * (places @ turned) + side_mm / 2 for places in shapes]
    pixels, scale = round(side_mm * way.dpi / 25.4), FINER * way.dpi / 25.4
    fine = np.zeros((FINER * pixels,) * 2, np.uint8)
    for places in on_it:
        x = places[:, 0] * scale - 0.5
        y = len(fine) - places[:, 1] * scale - 0.5
        sixteenths = np.round(16 * np.column_stack([x, y])).astype(np.int32)
        width = round(PEN_MM * way.times * scale)
        cv2.polylines(fine, [sixteenths], False, 255, width, cv2.LINE_AA, 4)
    ink = cv2.resize(fine, (pixels, pixels), interpolation=cv2.INTER_AREA) / 255.0
    ink = cv2.GaussianBlur(ink, (0, 0), 0.7)
    grey = 235 - 195 * ink + np.random.default_rng(seed).normal(0, NOISE, ink.shape)
    Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(file, dpi=(way.dpi, way.dpi))
    return on_it


def taken(line: Line, shapes: list[Points]) -> int:
    """The number of the shape that a line runs along most."""
    places = line.places_mm[::20]
    return int(np.argmin([np.median(nearest_mm(places, places_mm)) for places_mm in shapes]))


def found(file: Path, shapes: list[Points]) -> tuple[int | str, tuple[int, ...] | str]:
    """The shape that a plain trace takes, and the shapes by the numbers of their lines; or the fault."""
    sheet = Drawing.open(file)
    try:
        choice: int | str = taken(trace(sheet).lines[0], shapes)
    except Fault as fault:
        choice = str(fault)[:60]
    try:
        lines = sorted(trace_lines(sheet, "contours").lines, key=lambda line: line.number)
        return choice, tuple(taken(line, shapes) for line in lines)
    except Fault as fault:
        return choice, str(fault)[:60]


def differing(number: int, folder: Path) -> Iterator[tuple[Way, str]]:
    """The scans of a drawing in which another line is taken than on the first, or numbers are others."""
    shapes = drawing(np.random.default_rng([number, 90]))
    first: tuple[int | str, tuple[int, ...] | str] | None = None
    for k, way in enumerate(WAYS):
        on_it = scanned(shapes, way, folder / "sheet.png", 100 * number + k)
        seen = found(folder / "sheet.png", on_it)
        first = first or seen
        if seen[0] != first[0]:
            yield way, f"choice {seen[0]}, not {first[0]}"
        if seen[1] != first[1]:
            yield way, f"numbers {seen[1]}, not {first[1]}"


def main(arguments: list[str] | None = None) -> None:
    """Print how many drawings and scans hold."""
    words = arguments or []
    given = [int(word) for word in words if word != "-v"]
    count, first = (*given, *(10, 0)[len(words) :])[:2]
    drawings, scans = Counter[str](), Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + count):
            told = list(differing(number, Path(folder)))
            for what in ("choice", "numbers"):
                of_it = [text for _, text in told if text.startswith(what)]
                drawings[what] += not of_it
                scans[what] += len(WAYS) - 1 - len(of_it)
            if "-v" in words:
                for way, text in told:
                    print(number, way, text, flush=True)
    others = (len(WAYS) - 1) * count
    for what in ("choice", "numbers"):
        print(
            f"{what:8s} the same on {drawings[what]} of {count} drawings, "
            f"{scans[what]} of {others} scans"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
