"""What the page gets of a run: figures, both paths, the error along the contour, and the machine's following
errors.

Signals in: the result of the job `run`. Signals out: plain lists that JSON holds, mm and s. The page shows
at most `MOST` rows of each curve: longer ones are thinned more roughly, to a tolerance that is stated.

Source: our own.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.panel.tape_levels import DECIMALS, levels

if TYPE_CHECKING:
    from morfax.jobs.run import RunResult
    from morfax.motion.arrays import Array
    from morfax.motion.motion import Path
    from morfax.player.monitor.chart import Chart

MOST = 40_000  # rows of a curve on the page: a browser draws these within a frame
# places of the largest error that are listed, and how far apart they are
WORST, APART_MM = 6, 3.0


def of_run(result: RunResult) -> dict[str, Any]:
    """A run for the page."""
    traced, error = result.traced, result.from_ink
    return {
        "figures": result.figures,
        "faults": [str(fault) for fault in result.faults],
        "fault_place_mm": _place_of(result),
        "played": path_rows(result.played),
        "traced": path_rows(traced.path),
        "error": _error_rows(error.points_mm, error.error_mm),
        "worst": worst_places(error.points_mm, error.error_mm),
        "largest_error_mm": error.largest_mm,
        "following": following_rows(result.chart),
        "override": 1.0,  # at which the machine ran
        "placed": _placed(result),
        "program": None if result.program is None else result.program.name,
        "tape": levels(FilePath(program)) if (program := result.figures.get("tape")) else None,
        "marks_mm": {
            name: [float(x) for x in place] for name, place in traced.marked_mm.items()
        },
        "line_numbers_mm": [[name, *map(float, place)] for name, place in traced.places_mm],
        "sheet_mm": [result.drawing.width_mm, result.drawing.height_mm],
        "files": sorted(
            file.name for file in result.picture.parent.glob(f"{result.picture.stem}.*")
        ),
    }


def of_play(path: Path, chart: Chart | None, placed: list[list[float]]) -> dict[str, Any]:
    """What is other in a run that the machine ran again: its path back on the drawing, and its errors."""
    moved = np.array(path.positions_mm, np.float64)
    placed_mm = np.array(placed)
    moved[:, :2] = moved[:, :2] @ placed_mm[:, :2].T + placed_mm[:, 2]
    return {
        "played": path_rows(replace(path, positions_mm=moved)),
        "following": following_rows(chart),
    }


def path_rows(path: Path) -> dict[str, list[Any]]:
    """A path as columns t, x, y, z and whether the tool is in the work."""
    rows = _some(len(path.t_s))
    x, y, z = path.positions_mm[rows, :3].T
    columns = {"t_s": path.t_s[rows], "x_mm": x, "y_mm": y, "z_mm": z}
    listed: dict[str, list[Any]] = {
        k: np.round(v, DECIMALS).tolist() for k, v in columns.items()
    }
    return {**listed, "tool": path.tool[rows].astype(int).tolist()}


def worst_places(points_mm: Array, error_mm: Array) -> list[dict[str, float]]:
    """The places of the largest distance from the ink, each `APART_MM` from those before it."""
    worst = list[dict[str, float]]()
    known = np.flatnonzero(np.isfinite(error_mm))
    for i in known[np.argsort(-np.abs(error_mm[known]))]:
        x, y = (float(v) for v in points_mm[i])
        if all(np.hypot(x - w["x_mm"], y - w["y_mm"]) > APART_MM for w in worst):
            worst.append({"x_mm": x, "y_mm": y, "error_mm": float(abs(error_mm[i]))})
        if len(worst) == WORST:
            break
    return worst


def _error_rows(points_mm: Array, error_mm: Array) -> dict[str, list[Any]]:
    """The error along the contour, mm; None where the ink has no single middle."""
    rows = _some(len(points_mm))
    x, y = np.round(points_mm[rows], DECIMALS).T.tolist()
    error = [None if not np.isfinite(e) else round(abs(float(e)), 5) for e in error_mm[rows]]
    return {"x_mm": x, "y_mm": y, "error_mm": error}


def following_rows(chart: Chart | None) -> dict[str, Any] | None:
    """What the machine's axes were told, where they were, and the limit of their following errors, over time;
    None if nothing was taken down.
    """
    if chart is None or not len(chart.t_s):
        return None
    rows = _some(len(chart.t_s))
    return {
        "axes": list(chart.axes),
        "t_s": np.round(chart.t_s[rows], DECIMALS).tolist(),
        "demand_mm": np.round(chart.demand_mm[rows].T, DECIMALS).tolist(),
        "error_mm": np.round(chart.error_mm[rows].T, 5).tolist(),
        "limit_mm": np.round(chart.limit_mm[rows].T, 5).tolist(),
    }


def _placed(result: RunResult) -> list[list[float]]:
    """How a place of the machine is moved back onto the drawing: x and y from (x, y, 1); (2, 3)."""
    about = result.placement
    if about is None:
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    corners = about.places_back(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    moved = np.column_stack([corners[1] - corners[0], corners[2] - corners[0], corners[0]])
    rows: list[list[float]] = moved.tolist()
    return rows


def _place_of(result: RunResult) -> list[float] | None:
    """Where the line was lost."""
    fault = result.traced.fault
    x, y = getattr(fault, "x_mm", None), getattr(fault, "y_mm", None)
    return None if x is None or y is None else [float(x), float(y)]


def _some(rows: int) -> Array:
    """Indices of at most `MOST` rows, evenly, with the first and the last."""
    return np.unique(np.linspace(0, rows - 1, min(rows, MOST)).astype(int))
