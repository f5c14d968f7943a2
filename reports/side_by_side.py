"""Pictures of the systems side by side: all contours with enlargements where they differ, and their errors.

Signals in: the results of `jobs.systems`, the traced path and the drawing, mm. Out: figures of matplotlib.
Errors are some micrometres, so the contours lie on each other on the sheet; the enlargements have axes in µm
from their place.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.polyline import lengths_mm
from morfax.reports import page
from morfax.reports.canvas import (
    NUMBERS_IN,
    PANEL_IN,
    REFERENCE,
    UM_PER_MM,
    WIDE_IN,
    new_figure,
    show_drawing,
)
from morfax.reports.looks import (
    BESIDE_PT,
    GRID,
    ON_PATHS,
    ON_SPOTS,
    SPOT_PT,
    THIN_PT,
    TITLE_PT,
    WORDS_PT,
)
from morfax.reports.overlay import LIGHT, Picture, view_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from morfax.jobs.results import SystemResult
    from morfax.motion.motion import Path
    from morfax.tracer.drawing.drawing import Drawing

COLOURS = {"wav": "#c1121f", "steps": "#1f5fa8", "cubic": "#2a7f3f", "ngc": "#e07b00"}
APART_MM = 2.0
LEAST_REACH_UM = 5.0


def contours(
    title: str,
    results: Sequence[SystemResult],
    traced: Path,
    drawing: Drawing,
    corners_mm: Array,
) -> Figure:
    """All contours over the drawing; enlarged where each is furthest from the traced path, and at corners."""
    ran = [result for result in results if result.path is not None]
    figure = new_figure(WIDE_IN, WIDE_IN)
    grid = figure.add_gridspec(3, 3, height_ratios=(2.1, 1, 1))
    main = figure.add_subplot(grid[0, :])
    view = view_of(Picture(title, traced, reference=traced))
    show_drawing(main, drawing, view, LIGHT)
    _lines(main, ran, traced, np.zeros(2), 1.0)
    main.set(xlim=view[:2], ylim=view[2:], xlabel="X, mm", ylabel="Y, mm", aspect="equal")
    main.set_title(title, fontsize=TITLE_PT)
    main.legend(fontsize=WORDS_PT, loc="center left", bbox_to_anchor=(1, 0.5))
    for number, (place_mm, what) in enumerate(_places(ran, corners_mm), 1):
        axes = figure.add_subplot(grid[1 + (number - 1) // 3, (number - 1) % 3])
        _enlarge(
            axes,
            ran,
            traced,
            place_mm,
            f"{number}: {what} at {place_mm[0]:.1f}, {place_mm[1]:.1f}",
        )
        main.annotate(
            str(number),
            tuple(place_mm),
            BESIDE_PT,
            textcoords="offset points",
            fontsize=WORDS_PT,
        )
        main.plot(*place_mm, "+", color="black", markersize=SPOT_PT)
    return figure


def errors(results: Sequence[SystemResult]) -> Figure:
    """The signed distance of each contour from the ink's centre along the way; all on one scale."""
    ran = [result for result in results if result.from_ink is not None]
    figure = new_figure(WIDE_IN, NUMBERS_IN + PANEL_IN * max(1, len(ran)))
    panels = figure.subplots(max(1, len(ran)), 1, squeeze=False, sharex=True, sharey=True)[:, 0]
    for axes, result in zip(panels, ran, strict=False):
        assert result.from_ink is not None
        points = result.from_ink.points_mm
        error_um = result.from_ink.error_mm * UM_PER_MM
        way_mm = lengths_mm(points)
        axes.axhline(0, color=REFERENCE, linewidth=THIN_PT)
        axes.plot(way_mm, error_um, color=COLOURS[result.suffix], linewidth=THIN_PT)
        axes.set_ylabel("µm")
        axes.set_title(result.name, fontsize=WORDS_PT, loc="left")
        axes.grid(**GRID)
    panels[-1].set_xlabel("way along the contour, mm")
    return figure


def _lines(
    axes: Axes, ran: Sequence[SystemResult], traced: Path, origin_mm: Array, scale: float
) -> None:
    """The traced path and those of the machines, from an origin, in mm or in um."""
    style: dict[str, Any] = {
        "color": "black",
        "linewidth": 1.0,
        "linestyle": (0, (4, 3)),
        "zorder": ON_SPOTS,
    }
    for number, run in enumerate(traced.runs()):
        axes.plot(*((run - origin_mm) * scale).T, label=None if number else "traced", **style)
    for result in ran:
        assert result.path is not None
        for number, run in enumerate(result.path.runs()):
            label = None if number else result.name
            axes.plot(
                *((run - origin_mm) * scale).T,
                color=COLOURS[result.suffix],
                linewidth=1.0,
                label=label,
                zorder=ON_PATHS,
            )


def _places(ran: Sequence[SystemResult], corners_mm: Array) -> list[tuple[Array, str]]:
    """Places to enlarge, apart from each other, and what each is: the worst of each system, then corners."""
    wanted: list[tuple[Array, str]] = []
    for result in ran:
        assert result.from_traced is not None
        worst = int(result.from_traced.error_mm.argmax())
        off_um = result.from_traced.error_mm[worst] * UM_PER_MM
        wanted.append(
            (result.from_traced.points_mm[worst], f".{result.suffix} {off_um:.3g} µm off")
        )
    wanted += [(corner_mm, "corner") for corner_mm in corners_mm]
    chosen: list[tuple[Array, str]] = []
    for place_mm, what in wanted:
        if all(np.hypot(*(place_mm - other)) > APART_MM for other, _ in chosen):
            chosen.append((place_mm, what))
    return chosen[: 2 * page.INSETS]


def _enlarge(
    axes: Axes, ran: Sequence[SystemResult], traced: Path, place_mm: Array, title: str
) -> None:
    """One place, enlarged until the contours separate."""
    reach_um = LEAST_REACH_UM
    for result in ran:
        assert result.from_traced is not None
        near = np.hypot(*(result.from_traced.points_mm - place_mm).T) < 0.2
        reach_um = max(
            reach_um, 3 * UM_PER_MM * float(result.from_traced.error_mm[near].max(initial=0.0))
        )
    _lines(axes, ran, traced, place_mm, UM_PER_MM)
    axes.set(xlim=(-reach_um, reach_um), ylim=(-reach_um, reach_um), aspect="equal")
    axes.set_title(title, fontsize=WORDS_PT)
    axes.tick_params(labelsize=WORDS_PT)
    axes.set_xlabel("µm", fontsize=WORDS_PT)
    axes.grid(**GRID)
