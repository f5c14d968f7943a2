"""Pictures: the path over its drawing, with the error along the contour in colour.

Signals in: a path, and what it was compared with: the drawing it came from, or another path, with the error
at each of some points along the contour, all in mm. Out: a picture; its axes are sheet coordinates in mm. The
worst places are shown once more, enlarged until the error can be seen.

matplotlib takes most of a second to import: nothing here does it before a picture is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import Path
from morfax.reports import leaders, left_out
from morfax.reports.canvas import REFERENCE, UM_PER_MM, View, new_figure, save, show_drawing
from morfax.reports.coloured import draw_error
from morfax.reports.corrected import draw_corrections
from morfax.reports.page import INSETS, Page, lay_out

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.jobs.who_led import WhoLed
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.ink.left_out import Area

PLAIN = "#c1121f"
RAISED = "#1f5fbf"  # stops, and ways with the tool up
UNMEASURED = "#8a8a8a"  # the path where its error cannot be measured
MARGIN_SHARE = 0.06  # of the larger side, round the path
NARROWEST = 0.35  # shorter to longer side of what is shown
# along an enlargement: each number of all takes a hundredth of a picture's time
FEW_NUMBERS = 4
LETTERS_PER_IN = 11.0  # of a title of 10 points: capitals and underscores too
LIGHT = 3.2  # ink as light grey, for a path to lie on


@dataclass(frozen=True, slots=True)
class Picture:
    """What a picture shows: a path, its reference, and the error at points along it."""

    title: str
    path: Path
    drawing: Drawing | None = None
    reference: Path | None = None
    points_mm: Array | None = None  # (n, 2)
    error_mm: Array | None = None  # (n,); not a number where it cannot be measured
    # numbers of lines, and where each begins; where the head stops, by name
    numbers_mm: Sequence[tuple[str, tuple[float, float]]] = ()
    stops_mm: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    led: WhoLed | None = None  # who led the head, in colours
    left_out: Sequence[Area] = ()  # ink along which no stroke was to run


def draw(picture: Picture, file: FilePath) -> None:
    """Write the picture, of the kind that the suffix says (.png, .svg, .pdf)."""
    insets = _worst_places(picture)
    view = view_of(picture)
    figure = new_figure(layout="none")
    shape = (view[3] - view[2]) / (view[1] - view[0])
    page = lay_out(figure, shape, len(insets), has_bar=_is_measured(picture))
    _fill(page, picture, view)
    for number, (axes, place_mm) in enumerate(zip(page.insets, insets, strict=True), 1):
        _enlarge(axes, page.main, picture, place_mm, number)
    save(figure, file, trim=False)


def _fill(page: Page, picture: Picture, view: View) -> None:
    """Draw the whole contour, with its marks and the scale of the colours."""
    axes = page.main
    ground(axes, picture, view)
    coloured = _contour(axes, picture, view, line_pt=1.8)
    if picture.led is not None:
        leaders.draw(axes, picture.led)
    _ends(axes, picture.path)
    _numbers(axes, picture)
    _stops(axes, picture)
    left_out.draw(axes, picture.left_out)
    if picture.drawing is not None and picture.drawing.corrected is not None:
        draw_corrections(axes, picture.drawing.corrected)
    axes.set(xlim=view[:2], ylim=view[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    letters = round(page.wide_in * LETTERS_PER_IN)
    title = picture.title
    title = title if len(title) <= letters else f"{title[: letters - 1]}…"
    axes.set_title(title, fontsize=10)
    if page.bar is not None:
        figure = axes.figure
        figure.colorbar(coloured, cax=page.bar, orientation="horizontal", label="error, µm")


def ground(axes: Axes, picture: Picture, view: View) -> None:
    """Draw what the path was compared with: the drawing in light grey, or the other path."""
    if picture.drawing is not None:
        show_drawing(axes, picture.drawing, view, LIGHT)
    if picture.reference is not None:
        for run in picture.reference.runs():
            axes.plot(*run.T, color=REFERENCE, linewidth=0.8, linestyle=(0, (4, 2)), zorder=1)


def _is_measured(picture: Picture) -> bool:
    """Whether the error is known anywhere."""
    error_mm = picture.error_mm
    if picture.points_mm is None or error_mm is None:
        return False
    return bool(np.isfinite(error_mm).any())


def _contour(axes: Axes, picture: Picture, view: View, line_pt: float) -> Any:
    """Draw the path, its error in colour if that is known; gives what a colour bar needs."""
    measured = _is_measured(picture)
    for run in picture.path.runs():
        axes.plot(
            *run.T, color=UNMEASURED if measured else PLAIN, linewidth=line_pt * 0.6, zorder=2
        )
    if not measured:
        return None
    assert picture.points_mm is not None and picture.error_mm is not None
    return draw_error(axes, picture.points_mm, picture.error_mm, view, line_pt)


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
    """Mark the stops, and the ways with the tool up."""
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
    _contour(axes, picture, view, line_pt=2.2)
    axes.set(xlim=view[:2], ylim=view[2:], aspect="equal")
    axes.locator_params(nbins=FEW_NUMBERS)
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


def view_of(picture: Picture) -> View:
    """The part of the sheet to show, mm: what was compared, or the whole sheet without an error to see."""
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
