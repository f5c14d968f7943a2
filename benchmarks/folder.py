"""The table of a folder of drawings: `python -m benchmarks folder DIR [--line 0.5mm]... [--size 300mm]`.

Every truth file (`*.csv` with columns loop, x, y in mm) is traced as a program of all its lines. The
drawing is the image beside it (`name.png`, .jpg or .tif, in the same sheet coordinates). Without an image
it is drawn here at 300 dpi with each of the line widths, scaled to the given size, with a scanner's
softness and noise. Every loop of the truth has a row; a traced line counts for the loop that it is
nearest to. A row has the ending, the pieces (lines traced for the loop), RMS, 95 % and largest distance
of the path from the truth, Hausdorff distance, and the share of the truth that no path comes within 0.2
mm of. The time is that of the whole drawing.
"""

from __future__ import annotations

import csv
import time
from pathlib import Path

import click
import cv2
import numpy as np
from numpy.typing import NDArray

from morfax.motion.contour import distance, distances_mm, pointwise
from morfax.motion.faults import Fault
from morfax.motion.units import MM_PER_INCH, parse_length_mm
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.following.line import Line
from morfax.tracer.program.program import ENDINGS
from morfax.tracer.program.trace_lines import trace_lines

Points = NDArray[np.float64]

DPI, MARGIN_MM, SOFTNESS_MM, FINE = 300.0, 8.0, 0.05, 8
NOISE = 0.04  # of the contrast
MISSED_MM = 0.2
HEAD = (
    f"{'drawing':28s}{'width mm':>9s}{'loop':>5s}  {'ending':8s}{'pieces':>7s}"
    f"{'RMS um':>9s}{'95 % um':>9s}{'max um':>9s}{'Hausd. um':>11s}{'missed %':>10s}{'time s':>8s}"
)


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


def drawn(
    loops: list[Points], line_mm: float, size_mm: float | None = None
) -> tuple[Drawing, list[Points]]:
    """Draw the lines as a scanner sees them; the picture, and the lines in its sheet coordinates."""
    every = np.vstack(loops)
    scale = 1.0 if size_mm is None else size_mm / float(np.ptp(every, axis=0).max())
    loops, every = [loop * scale for loop in loops], every * scale
    loops = [loop - every.min(axis=0) + MARGIN_MM for loop in loops]
    columns, rows = np.ceil((np.ptp(every, axis=0) + 2 * MARGIN_MM) * DPI / MM_PER_INCH).astype(
        int
    )
    scale = DPI / MM_PER_INCH * FINE
    fine = np.zeros((rows * FINE, columns * FINE), np.uint8)
    for loop in loops:
        at = np.column_stack([loop[:, 0] * scale, len(fine) - loop[:, 1] * scale]) - 0.5
        cv2.polylines(
            fine,
            [np.round(at * 256).astype(np.int32)],
            False,
            255,
            round(line_mm * scale),
            cv2.LINE_AA,
            8,
        )
    ink = (
        cv2.resize(fine, (int(columns), int(rows)), interpolation=cv2.INTER_AREA).astype(
            np.float32
        )
        / 255
    )
    soft = cv2.GaussianBlur(ink, (0, 0), SOFTNESS_MM * DPI / MM_PER_INCH)
    seen = soft + np.random.default_rng(1).normal(0, NOISE, soft.shape)
    return Drawing(np.asarray(seen, np.float32), MM_PER_INCH / DPI), loops


def rows(
    file: Path, loops: list[Points], line_mm: float, size_mm: float | None = None
) -> list[str]:
    """One drawing traced and measured, as lines of the table: one for each loop."""
    image = next(
        (file.with_suffix(s) for s in (".png", ".jpg", ".tif") if file.with_suffix(s).exists()),
        None,
    )
    begun = time.perf_counter()
    width = f"{line_mm:9g}" if image is None else f"{'scan':>9s}"
    try:
        drawing, truth = (
            (Drawing.open(image), loops)
            if image is not None
            else drawn(loops, line_mm, size_mm)
        )
        lines = [line for line in trace_lines(drawing).lines if len(line.xy_mm) > 1]
    except Fault as fault:
        return [f"{file.stem[:27]:28s}{width}  {fault}"]
    took_s = time.perf_counter() - begun
    own = [nearest(line, truth) for line in lines]
    parts = [
        [line for line, k in zip(lines, own, strict=True) if k == loop]
        for loop in range(len(truth))
    ]
    found = [
        f"{file.stem[:27]:28s}{width}{k:5d}  {figures(part, loop)}"
        for k, (part, loop) in enumerate(zip(parts, truth, strict=True))
    ]
    return [f"{found[0]}{took_s:8.1f}", *found[1:]]


def nearest(line: Line, truth: list[Points]) -> int:
    """Find the loop that a traced line is nearest to, by the median distance."""
    return int(np.argmin([np.median(distances_mm(line.xy_mm[::30], [loop])) for loop in truth]))


def figures(lines: list[Line], loop: Points) -> str:
    """Measure what was traced for one loop against its truth."""
    if not lines:
        return f"{'missed':8s}{0:7d}{'':38s}{100:10.2f}"
    path = [line.xy_mm for line in lines]
    found, ending = (
        distance(path, [loop]),
        min((line.ending for line in lines), key=ENDINGS.index),
    )
    there, missed = (
        found.path_to_reference,
        np.mean(pointwise([loop], path, 0.05)[1] > MISSED_MM),
    )
    return (
        f"{ending:8s}{len(lines):7d}{there.rms_mm * 1e3:9.1f}{there.p95_mm * 1e3:9.1f}"
        f"{there.max_mm * 1e3:9.0f}{found.hausdorff_mm * 1e3:11.0f}{100 * missed:10.2f}"
    )


def lengths_mm(
    _context: object, _option: object, value: str | tuple[str, ...] | None
) -> float | tuple[float, ...] | None:
    """Lengths of an option, mm."""
    try:
        if isinstance(value, tuple):
            return tuple(parse_length_mm(text) for text in value)
        return None if value is None else parse_length_mm(value)
    except ValueError as error:
        raise click.BadParameter(str(error)) from None


@click.command("folder")
@click.argument(
    "folder", metavar="DIR", type=click.Path(exists=True, file_okay=False, path_type=Path)
)
@click.option(
    "--line",
    "widths_mm",
    multiple=True,
    default=("0.5mm",),
    show_default=True,
    callback=lengths_mm,
    help="Line width of pictures drawn here; may be given again.",
)
@click.option(
    "--size",
    "size_mm",
    callback=lengths_mm,
    help="Longest side of drawings drawn here.  [default: as the truth is]",
)
def table(folder: Path, widths_mm: tuple[float, ...], size_mm: float | None) -> None:
    """Print the table of a folder of drawings."""
    truths = [
        (file, loops) for file in sorted(folder.glob("*.csv")) if (loops := loops_of(file))
    ]
    if not truths:
        raise click.ClickException(f"{folder} holds no truth file (.csv with columns loop,x,y)")
    click.echo(HEAD)
    for file, loops in truths:
        for line_mm in widths_mm:
            click.echo("\n".join(rows(file, loops, line_mm, size_mm)))


def main(words: list[str]) -> None:
    """Run the command."""
    table.main(words, prog_name="python -m benchmarks folder")
