"""A path as an SVG drawing in its true size: one unit is one mm, the page's corner is the sheet's."""

from __future__ import annotations

from pathlib import Path as FilePath

import numpy as np
from numpy.typing import NDArray

from morfax.motion.files import written_beside
from morfax.motion.motion import Path
from morfax.recorder.drawings.drawings import LINE_MM

MARGIN_MM = 5.0


def write_svg(path: Path, file: FilePath, sheet_mm: tuple[float, float] | None = None) -> None:
    """Draw what is run with the tool in the work, as polylines, on a sheet of a width and height."""
    low = np.minimum(path.xy_mm.min(axis=0) - MARGIN_MM, 0) * (path.xy_mm.min(axis=0) < 0)
    width, height = (
        path.xy_mm.max(axis=0) + MARGIN_MM if sheet_mm is None else np.array(sheet_mm)
    ) - low
    lines = "".join(
        f'  <polyline points="{_points(run - low, height)}"/>\n'
        for run in path.runs()
        if len(run) > 1
    )
    with written_beside(file) as beside:
        beside.write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.4f}mm" height="{height:.4f}mm"'
            f' viewBox="0 0 {width:.4f} {height:.4f}">\n'
            f' <g fill="none" stroke="black" stroke-width="{LINE_MM}" stroke-linejoin="round">\n'
            f"{lines} </g>\n</svg>\n",
            encoding="utf-8",
        )


def _points(run: NDArray[np.float64], height_mm: float) -> str:
    """Points of a polyline in mm to 0.1 um; an SVG's Y runs down."""
    down = np.column_stack([run[:, 0], height_mm - run[:, 1]])
    return " ".join(f"{x:.4f},{y:.4f}" for x, y in down)
