"""Photographs made flat, against the truth: `python -m benchmarks flatten [N] [--traced M]`.

N photographs of a simulated phone (12 Mpx, A4 filling most of it, tilted by 0 to 25 degrees in any direction,
a bent lens, shadow, JPEG 85, blur of 1.2 px), half of them of a sheet with marks, half of plain paper, each
with a cam drawn on it. Of every photograph the map is measured: how far places all over the sheet come out
from where they are. Of the first M of either kind the head traces the cam too, and the traced line is
measured: its distance from the drawn one, and its size, X and Y.

With --results every photograph is kept as a line of JSON, and a further run goes on where the last one ended.
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.phone import FOCAL_35MM, Phone
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.flattening import FlattenSettings
from morfax.motion.contour import distances_mm
from morfax.motion.motion import thin
from morfax.reports import marked_sheet
from morfax.tracer.drawing import raster
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.flatten.flat import found
from morfax.tracer.flatten.layout import BAR_MM, Layout
from morfax.tracer.flatten.projection import Focal, Projection
from morfax.tracer.flatten.wanted import parsed
from morfax.tracer.program.trace import trace

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Row = dict[str, Any]

A4 = (210.0, 297.0)
PX_PER_MM = 20  # of the sheet before it is photographed: twice a phone's
LINE_MM = 0.6
LARGEST_TILT_DEG = 25.0
WAYS = {"marks": 0.05, "paper=a4": 0.02}  # and the largest k1
# asked for: RMS and largest distance of the line, mm; size
ASKED = {"marks": (0.06, 0.25, 0.0005), "paper=a4": (0.2, math.inf, 0.002)}
INSET_MM = 20.0  # of the places that are measured, from the sheet's edges


def main(words: list[str]) -> None:
    """Measure, and print the table with the worst case."""
    asked = argparse.ArgumentParser(prog="python -m benchmarks flatten")
    asked.add_argument("count", nargs="?", type=int, default=20, help="photographs")
    asked.add_argument(
        "--traced", type=int, default=2, help="of either kind that the head traces"
    )
    asked.add_argument(
        "--results", type=Path, help="file of lines of JSON, which a run goes on with"
    )
    how = asked.parse_args(words)
    rows: list[Row] = []
    if how.results is not None and how.results.exists():
        rows = [json.loads(line) for line in how.results.read_text().splitlines()]
    done = {(row["way"], row["number"]): "line_rms_mm" in row for row in rows}
    for number in range(how.count // 2):
        for way in WAYS:
            traced = number < how.traced
            if (way, number) in done and (done[way, number] or not traced):
                continue
            row = measured(way, number, traced=traced)
            rows = [*(r for r in rows if (r["way"], r["number"]) != (way, number)), row]
            if how.results is not None:
                how.results.write_text("".join(json.dumps(each) + "\n" for each in rows))
    table(rows)


def measured(way: str, number: int, *, traced: bool) -> Row:
    """Photograph one sheet, make it flat, and say how far it is from the truth."""
    phone = held(way, number)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "photo.jpg"
        phone.write(sheet(way), A4, file)
        if traced:
            drawing = DrawingFile(file, flatten=FlattenSettings(parsed(way))).open()
            made = drawing.flattening
        else:
            picture = np.asarray(raster.read(file, coloured=True).pixels, np.uint8)
            made = found(picture, parsed(way), BAR_MM, Focal.stated(FOCAL_35MM))
    assert made is not None and made.fit is not None
    row: Row = {
        "way": way,
        "number": number,
        "tilt_deg": math.degrees(phone.tilt_rad),
        "k1": phone.k1,
        "found_tilt_deg": math.degrees(made.tilt_rad),
        "residual_mm": made.fit.rms_mm,
    }
    row |= _map_row(made.projection, phone)
    return row | _line_row(drawing) if traced else row


def _map_row(projection: Projection, phone: Phone) -> Row:
    """How far places on the sheet are from where the projection has them, and by how much it stretches."""
    x, y = np.meshgrid(*(np.linspace(INSET_MM, side - INSET_MM, 25) for side in A4))
    places = np.column_stack([x.ravel(), y.ravel()])
    back = projection.to_sheet(phone.to_photo(places, A4))
    off = np.hypot(*(back - places).T)
    grown, *_ = np.linalg.lstsq(
        np.column_stack([places, np.ones(len(places))]), back, rcond=None
    )
    stretches = np.linalg.svd(grown[:2], compute_uv=False)
    return {
        "map_rms_mm": float(np.sqrt(np.mean(off**2))),
        "map_max_mm": float(off.max()),
        "map_size": float(np.abs(stretches - 1).max()),
    }


def _line_row(drawing: Drawing) -> Row:
    """How far the line that is traced is from the drawn one, and how much larger or smaller it is."""
    path, truth = thin(trace(drawing)).runs()[0], cam()
    away = distances_mm(path, truth)
    sizes = np.ptp(path[:, :2], axis=0) / np.ptp(truth, axis=0)
    return {
        "line_rms_mm": float(np.sqrt(np.mean(away**2))),
        "line_max_mm": float(np.abs(away).max()),
        "line_size": float(np.abs(sizes - 1).max()),
    }


def held(way: str, number: int) -> Phone:
    """How the phone is held for a photograph."""
    random = np.random.default_rng([number, len(way)])
    return Phone(
        tilt_rad=math.radians(random.uniform(0, LARGEST_TILT_DEG)),
        about_rad=random.uniform(0, 2 * math.pi),
        turn_rad=random.uniform(-0.15, 0.15),
        k1=WAYS[way] * random.uniform(-1, 1),
        fills=random.uniform(0.85, 0.96),
        shadow=random.uniform(0.1, 0.5),
        seed=number,
    )


@cache
def sheet(way: str) -> Picture:
    """A sheet of a kind with a cam drawn on it."""
    paper = marked_sheet.picture(Layout.of("a4"), 25.4 * PX_PER_MM)
    if way != "marks":
        paper[:] = 245
    x, y = cam().T * PX_PER_MM
    places = np.round(16 * np.column_stack([x - 0.5, len(paper) - y - 0.5])).astype(np.int32)
    width = round(LINE_MM * PX_PER_MM)
    cv2.polylines(paper, [places], True, (40, 40, 45), width, cv2.LINE_AA, shift=4)
    return paper


def cam() -> Array:
    """The cam's line, sheet mm: it reaches to 25 mm from the sides of the sheet."""
    turn = np.linspace(0, 2 * math.pi, 4001)
    radius_mm = 68 + 8 * np.cos(5 * turn) + 4 * np.cos(2 * turn)
    return np.column_stack(
        [105 + radius_mm * np.cos(turn), 152 + 1.25 * radius_mm * np.sin(turn)]
    )


def table(rows: list[Row]) -> None:
    """Print, for each way, what is usual, what is worst, and what was asked for."""
    head = ("", "pictures", "RMS mm", "worst RMS", "largest mm", "size %", "worst at")
    print("{:26s}{:>9s}{:>9s}{:>11s}{:>12s}{:>9s}  {}".format(*head))
    for way, (rms_mm, max_mm, size) in ASKED.items():
        for what, name in (("map", "whole sheet"), ("line", "traced line")):
            of = [row for row in rows if row["way"] == way and f"{what}_rms_mm" in row]
            if not of:
                continue
            rms, largest, sizes = (
                np.array([row[f"{what}_{key}"] for row in of])
                for key in ("rms_mm", "max_mm", "size")
            )
            worst = of[int(np.argmax(rms))]
            at = (
                f"no. {worst['number']}: {worst['tilt_deg']:.1f} degrees, k1 {worst['k1']:+.3f}"
            )
            usual = float(np.sqrt(np.mean(rms**2)))
            print(
                f"{way + ', ' + name:26s}{len(of):9d}{usual:9.4f}{rms.max():11.4f}{largest.max():12.4f}"
                f"{100 * sizes.max():9.4f}  {at}"
            )
        print(f"{'  asked':26s}{'':9s}{'':9s}{rms_mm:11.4f}{max_mm:12.4f}{100 * size:9.4f}")
