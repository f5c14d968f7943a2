"""Make the pictures of `photograph.md` with the commands that the page shows, on a simulated photograph."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from benchmarks.phone import Phone
from morfax.console.cli import main as morfax
from morfax.reports.marked_sheet import picture
from morfax.tracer.flatten.layout import Layout

SIZE_MM = (210.0, 297.0)
PX_PER_MM = 20
PEN_MM = 0.6


def main(folder: Path) -> None:
    """Make all pictures in a folder."""
    with tempfile.TemporaryDirectory() as aside:
        photo, program = Path(aside) / "photo.jpg", Path(aside) / "part.ngc"
        sheet = picture(Layout.of("a4"), 25.4 * PX_PER_MM)
        draw_cam(sheet)
        Phone(tilt_rad=math.radians(14), about_rad=0.6, turn_rad=0.06, k1=0.03).write(
            sheet, SIZE_MM, photo
        )
        run("sheet", "-o", folder / "sheet.svg", "--paper", "a4")
        run("trace", photo, "-o", program, "--picture", Path(aside) / "photograph.png")
        (folder / "photograph.flat.png").write_bytes(
            (Path(aside) / "photograph.flat.png").read_bytes()
        )


def run(*words: object) -> None:
    """Run a command; raises SystemExit if it fails."""
    code = morfax([*(str(word) for word in words), "--quiet"])
    if code:
        raise SystemExit(code)


def draw_cam(sheet: NDArray[np.uint8]) -> None:
    """Draw a cam with three lobes on the sheet."""
    turn = np.linspace(0, 2 * math.pi, 2000)
    radius_mm = 52 + 9 * np.cos(3 * turn) + 3 * np.cos(turn)
    x_mm, y_mm = 105 + radius_mm * np.cos(turn), 155 + radius_mm * np.sin(turn)
    places = np.column_stack([x_mm, SIZE_MM[1] - y_mm]) * PX_PER_MM - 0.5
    cv2.polylines(
        sheet,
        [np.round(places * 16).astype(np.int32)],
        True,
        (45, 40, 60),
        round(PEN_MM * PX_PER_MM),
        cv2.LINE_AA,
        shift=4,
    )
