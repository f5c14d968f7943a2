"""Pictures: the path over its drawing, with the error along the contour in colour.

Signals in: a path, and what it was compared with: the drawing it came from, or another path, with the error
at each of some points along the contour, all in mm. Out: a picture; its axes are sheet coordinates in mm. The
worst places are shown once more, enlarged so much that the error can be seen.

matplotlib takes most of a second to import: nothing here does it before a picture is asked for.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.files import written_beside
from morfax.motion.motion import Path

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from morfax.tracer.drawing.drawing import Drawing

from morfax.motion.arrays import Array

UM_PER_MM = 1000.0
COLOURS = ("#1f5fa8", "#5fa8d3", "#f2a65a", "#c1121f")  # no error … largest error
PLAIN = "#c1121f"
RAISED = "#1f5fbf"  # stops, and ways with the tool up
UNMEASURED = "#8a8a8a"  # the path where it has no error that means anything
REFERENCE = "#555555"
MARGIN_SHARE = 0.06  # of the larger side, round the path
LARGEST_IMAGE_PX = 2000  # a larger drawing is reduced for the picture
# more points are gathered, and the largest error of each gathering is shown
LARGEST_POINTS = 20_000
INSETS = 3
NARROWEST = 0.35  # shorter to longer side of what is shown
WIDE = 0.6  # height to width
DPI = 130
PLACE_MARKS = (("x", "#c1121f"), ("+", "#1f5fa8"))


@dataclass(frozen=True, slots=True)
class Picture:
    """What there is to be seen: a path, its reference, and the error at points along it."""

    title: str
    path: Path
    drawing: Drawing | None = None
    reference: Path | None = None
    points_mm: Array | None = None  # (n, 2)
    error_mm: Array | None = None  # (n,); not a number where there is none that means anything
    numbers_mm: Sequence[
        tuple[str, tuple[float, float]]
    ] = ()  # numbers of lines, and where each begins
    stops_mm: Mapping[str, tuple[float, float]] = field(
        default_factory=dict
    )  # where the head stops, by name


def draw(picture: Picture, file: FilePath) -> None:
    """Write the picture; the suffix says as what (.png, .svg, .pdf)."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    insets = _worst_places(picture)
    view = view_of(picture)
    figure = Figure(layout="compressed")
    FigureCanvasAgg(figure)
    main, beside = _axes(figure, len(insets), (view[3] - view[2]) / (view[1] - view[0]))
    _fill(figure, main, picture, view)
    for number, (axes, place_mm) in enumerate(zip(beside, insets, strict=True), 1):
        _enlarge(axes, main, picture, place_mm, number)
    save(figure, file)


def draw_sheet(
    drawing: Drawing, places_mm: dict[str, tuple[float, float]], file: FilePath
) -> None:
    """Write a picture of the whole sheet, with a grid and with places that have a name (those beyond its
    edges left out).
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(layout="compressed")
    FigureCanvasAgg(figure)
    axes, _ = _axes(figure, 0, drawing.height_mm / drawing.width_mm)
    darkness, extent = _cut_out(drawing, (0.0, drawing.width_mm, 0.0, drawing.height_mm))
    axes.imshow(
        darkness,
        extent=extent,
        cmap="Greys",
        vmin=0,
        vmax=1.5,
        interpolation="nearest",
        zorder=0,
    )
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    axes.grid(color=REFERENCE, linewidth=0.4, alpha=0.4)
    for (name, (x, y)), (marker, colour) in zip(places_mm.items(), PLACE_MARKS, strict=False):
        if extent[0] <= x <= extent[1] and extent[2] <= y <= extent[3]:
            axes.plot(
                x,
                y,
                marker,
                color=colour,
                markersize=12,
                label=f"{name} {x:.1f},{y:.1f}",
                linestyle="none",
            )
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper right", fontsize=8, framealpha=0.8)
    save(figure, file)


def save(figure: Figure, file: FilePath) -> None:
    """Write a figure whole or not at all; made in memory first, since not every kind of picture tells of a
    full disk.
    """
    made = io.BytesIO()
    figure.savefig(
        made, format=file.suffix[1:].lower(), dpi=DPI, bbox_inches="tight", pad_inches=0.15
    )
    with written_beside(file) as unfinished:
        unfinished.write_bytes(made.getvalue())


def _axes(figure: Figure, insets: int, height_to_width: float) -> tuple[Axes, list[Axes]]:
    """The main axes, and one for each enlargement: in a column beside them, or below them if they are wide."""
    shape = float(np.clip(height_to_width, 0.2, 1.4))
    if not insets:
        figure.set_size_inches(8.5, 1.4 + 8 * shape)
        return figure.add_subplot(), []
    if shape < WIDE:
        figure.set_size_inches(11, 4.5 + 10 * shape)
        grid = figure.add_gridspec(2, INSETS, height_ratios=(10 * shape + 1, 3))
        return figure.add_subplot(grid[0, :]), [
            figure.add_subplot(grid[1, i]) for i in range(insets)
        ]
    figure.set_size_inches(11, 1.4 + 8 * shape)
    grid = figure.add_gridspec(INSETS, 2, width_ratios=(3.2, 1))
    return figure.add_subplot(grid[:, 0]), [
        figure.add_subplot(grid[i, 1]) for i in range(insets)
    ]


def _fill(
    figure: Figure, axes: Axes, picture: Picture, view: tuple[float, float, float, float]
) -> None:
    """Draw the whole contour, with its marks and the scale of the colours."""
    ground(axes, picture, view)
    coloured = _contour(axes, picture, line_pt=1.8)
    _ends(axes, picture.path)
    _numbers(axes, picture)
    _stops(axes, picture)
    axes.set(xlim=view[:2], ylim=view[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    axes.set_title(picture.title, fontsize=10)
    if coloured is not None:
        figure.colorbar(
            coloured,
            ax=axes,
            orientation="horizontal",
            shrink=0.7,
            aspect=40,
            label="error, µm",
        )


def ground(axes: Axes, picture: Picture, view: tuple[float, float, float, float]) -> None:
    """Draw what the path was compared with: the drawing in light grey, or the other path."""
    if picture.drawing is not None:
        darkness, extent = _cut_out(picture.drawing, view)
        axes.imshow(
            darkness,
            extent=extent,
            cmap="Greys",
            vmin=0,
            vmax=3.2,
            interpolation="nearest",
            zorder=0,
        )
    if picture.reference is not None:
        for run in picture.reference.runs():
            axes.plot(*run.T, color=REFERENCE, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)


def _cut_out(
    drawing: Drawing, view: tuple[float, float, float, float]
) -> tuple[Any, tuple[float, float, float, float]]:
    """The part of the drawing within the view, not larger than needed, and its extent in sheet mm."""
    pitch_mm, (rows, columns) = drawing.pitch_mm, drawing.darkness.shape
    left, right = (
        int(np.clip(x / pitch_mm + r, 0, columns)) for x, r in ((view[0], 0), (view[1], 1))
    )
    top, bottom = (
        int(np.clip(rows - y / pitch_mm + r, 0, rows)) for y, r in ((view[3], 0), (view[2], 1))
    )
    part: Any = drawing.darkness[top:bottom, left:right]
    extent = (
        left * pitch_mm,
        right * pitch_mm,
        (rows - bottom) * pitch_mm,
        (rows - top) * pitch_mm,
    )
    if max(part.shape) > LARGEST_IMAGE_PX:
        import cv2

        scale = LARGEST_IMAGE_PX / max(part.shape)
        part = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return part, extent


def _contour(axes: Axes, picture: Picture, line_pt: float) -> Any:
    """Draw the path: in the colours of its error where there is one (gives what a colour bar needs), else in
    one.
    """
    measured = (
        picture.points_mm is not None
        and picture.error_mm is not None
        and np.isfinite(picture.error_mm).any()
    )
    for run in picture.path.runs():
        axes.plot(
            *run.T, color=UNMEASURED if measured else PLAIN, linewidth=line_pt * 0.6, zorder=2
        )
    return _coloured(axes, picture, line_pt) if measured else None


def _coloured(axes: Axes, picture: Picture, line_pt: float) -> Any:
    """Draw the error along the path in colours, where there is one; gives what a colour bar needs."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    assert picture.points_mm is not None and picture.error_mm is not None
    points, error_um = _gathered(picture.points_mm, np.abs(picture.error_mm) * UM_PER_MM)
    steps = np.hypot(*np.diff(points, axis=0).T)
    shown = steps <= 10 * np.median(steps) + 0.05  # a wider step is a way with the tool up
    larger = np.fmax(error_um[:-1], error_um[1:])
    shown &= np.isfinite(larger)
    colours = LinearSegmentedColormap.from_list("error", COLOURS)
    pieces = np.stack([points[:-1], points[1:]], axis=1)[shown]
    lines = LineCollection(
        list(pieces), cmap=colours, linewidths=line_pt, zorder=3, capstyle="round"
    )
    lines.set_array(larger[shown])
    lines.set_clim(0, max(float(np.nanmax(error_um)), 1e-3))
    axes.add_collection(lines)
    return lines


def _gathered(points: Array, error: Array) -> tuple[Array, Array]:
    """Not more points than can be seen; each shows the largest error of those it stands for."""
    step = -(-len(points) // LARGEST_POINTS)
    starts = np.arange(0, len(points), step)
    return points[starts], np.fmax.reduceat(error, starts)


def _ends(axes: Axes, path: Path) -> None:
    """Mark where the path starts and where it ends in the work."""
    runs = path.runs()
    if not runs:
        return
    start, end = runs[0][0], runs[-1][-1]
    style: dict[str, Any] = {
        "linestyle": "none",
        "markersize": 7,
        "markerfacecolor": "none",
        "zorder": 4,
    }
    axes.plot(*start, marker="o", color="#2a7f3f", label="start", **style)
    axes.plot(*end, marker="s", color="#7a3fa0", label="end", **style)
    axes.legend(loc="upper right", fontsize=8, framealpha=0.8)


def _numbers(axes: Axes, picture: Picture) -> None:
    """Number several lines, each beside its start, in a ring: the enlargements have plain numbers."""
    ring = {
        "boxstyle": "circle,pad=0.2",
        "facecolor": "white",
        "edgecolor": REFERENCE,
        "alpha": 0.85,
    }
    for number, place_mm in picture.numbers_mm:
        axes.annotate(
            number,
            place_mm,
            (-11, -11),
            textcoords="offset points",
            fontsize=8,
            bbox=ring,
            zorder=6,
        )


def _stops(axes: Axes, picture: Picture) -> None:
    """Mark the stops, and the ways with the tool up, which they part from those in the work."""
    if not picture.stops_mm:
        return
    raised = np.where(picture.path.tool[:, None], np.nan, picture.path.xy_mm)
    axes.plot(
        *raised.T, color=RAISED, linewidth=1.2, linestyle=(0, (4, 2)), zorder=2, label="tool up"
    )
    for name, place_mm in picture.stops_mm.items():
        axes.plot(
            *place_mm, marker="D", markersize=6, markerfacecolor="none", color=RAISED, zorder=5
        )
        axes.annotate(
            name,
            place_mm,
            (7, 7),
            textcoords="offset points",
            fontsize=8,
            color=RAISED,
            zorder=6,
        )
    axes.legend(loc="upper right", fontsize=8, framealpha=0.8)


def _enlarge(axes: Axes, main: Axes, picture: Picture, place_mm: Array, number: int) -> None:
    """Draw one of the worst places so large that its error can be seen."""
    assert picture.points_mm is not None and picture.error_mm is not None
    error_mm = float(
        np.nanmax(np.abs(picture.error_mm[(picture.points_mm == place_mm).all(axis=1)]))
    )
    reach_mm = float(np.clip(20 * error_mm, 0.5, 4.0))
    x, y = place_mm
    view = (x - reach_mm, x + reach_mm, y - reach_mm, y + reach_mm)
    ground(axes, picture, view)
    _contour(axes, picture, line_pt=2.2)
    axes.set(xlim=view[:2], ylim=view[2:], aspect="equal")
    axes.tick_params(labelsize=7)
    axes.set_title(f"{number}: {error_mm * UM_PER_MM:.3g} µm at {x:.1f}, {y:.1f}", fontsize=8)
    main.annotate(
        str(number), (x, y), xytext=(9, 9), textcoords="offset points", fontsize=9, zorder=5
    )
    main.plot(x, y, marker="+", markersize=9, color="black", zorder=5)


def _worst_places(picture: Picture) -> list[Array]:
    """The places with the largest error, apart from each other."""
    if picture.points_mm is None or picture.error_mm is None:
        return []
    left = np.nan_to_num(np.abs(picture.error_mm))
    apart_mm = 0.12 * float(np.ptp(picture.points_mm, axis=0).max(initial=0.0))
    places: list[Array] = []
    while len(places) < INSETS and left.max(initial=0.0) > 0:
        worst = picture.points_mm[int(left.argmax())]
        places.append(worst)
        left[np.hypot(*(picture.points_mm - worst).T) < apart_mm] = 0
    return places


def view_of(picture: Picture) -> tuple[float, float, float, float]:
    """What part of the sheet to show, mm: all of it where there is no error to look at, else what was
    compared.
    """
    if picture.drawing is not None and picture.points_mm is None:
        return 0.0, picture.drawing.width_mm, 0.0, picture.drawing.height_mm
    parts = [
        run
        for path in (picture.path, picture.reference)
        if path is not None
        for run in path.runs()
    ]
    every = np.vstack(parts) if parts else picture.path.xy_mm
    low, high = every.min(axis=0), every.max(axis=0)
    longer_mm = max(float((high - low).max()), 1.0)
    margin = np.maximum(MARGIN_SHARE * longer_mm, (NARROWEST * longer_mm - (high - low)) / 2)
    low, high = low - margin, high + margin
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])
