"""Following errors of a run: as a picture, error against limit for each axis, and as CSV.

Signals in: the chart of a playing, mm; of a program of lines and arcs the speeds that it holds, mm/s. Out: a
picture, or rows `t_s, x_demand_mm, x_actual_mm, x_error_mm, x_limit_mm, …`. A row stands for 10 ms, and shows
the sample in which the axis came nearest to its limit; with --raw every sample has a row.
"""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from morfax.motion.files import written_beside
from morfax.reports.canvas import NUMBERS_IN, PANEL_IN, SMALLEST_UM, UM_PER_MM, new_figure, save
from morfax.reports.looks import GRID, SPOT_PT, THIN_PT, TITLE_PT, WORDS_PT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from morfax.jobs.readings.following import Speeds
    from morfax.player.monitor.chart import Chart

SUFFIXES = (".png", ".svg", ".pdf", ".csv")
ERROR, LIMIT, TRUE, PROGRAMMED = "#1f5fa8", "#c1121f", "#2a7f3f", "#555555"
_HEADINGS = ("demand", "actual", "error", "limit")


def write(chart: Chart, file: FilePath, title: str, speeds: Speeds | None = None) -> None:
    """Write a chart as what the suffix says."""
    if file.suffix.lower() == ".csv":
        _write_csv(chart, file)
    else:
        save(picture(chart, title, speeds), file)


def picture(chart: Chart, title: str, speeds: Speeds | None = None) -> Figure:
    """One panel for each axis, and one for the speed held if there is one."""
    panels = len(chart.axes) + (speeds is not None)
    figure = new_figure(height_in=NUMBERS_IN + PANEL_IN * panels)
    axes = figure.subplots(panels, 1, squeeze=False)[:, 0]
    for number, name in enumerate(chart.axes):
        _panel(axes[number], chart, number, name)
        axes[number].sharex(axes[0])
    axes[0].set_title(title, fontsize=TITLE_PT, loc="left")
    axes[0].legend(
        fontsize=WORDS_PT, ncols=3, loc="lower right", bbox_to_anchor=(1, 1), frameon=False
    )
    axes[len(chart.axes) - 1].set_xlabel("time, s")
    if speeds is not None:
        _speeds(axes[-1], speeds)
    return figure


def _panel(axes: Axes, chart: Chart, number: int, name: str) -> None:
    """Error and limit of one axis over the run, on a scale of decades; where it left its limit there is a
    cross.
    """
    error_um = np.maximum(np.abs(chart.error_mm[:, number]) * UM_PER_MM, SMALLEST_UM)
    limit_um = chart.limit_mm[:, number] * UM_PER_MM
    axes.semilogy(chart.t_s, limit_um, color=LIMIT, linewidth=1.0, label="limit")
    axes.semilogy(chart.t_s, error_um, color=ERROR, linewidth=THIN_PT, label="following error")
    over = error_um > limit_um
    if over.any():
        axes.semilogy(
            chart.t_s[over], error_um[over], "x", color=LIMIT, markersize=SPOT_PT, label="fault"
        )
    axes.set_ylabel(f"{name.upper()}, µm")
    axes.set_ylim(bottom=SMALLEST_UM)
    axes.grid(**GRID)


def _speeds(axes: Axes, speeds: Speeds) -> None:
    """Programmed and held speed along the way."""
    programmed = next(iter(speeds.values()))
    axes.plot(
        programmed.way_mm,
        programmed.programmed_mm_s,
        color=PROGRAMMED,
        linewidth=1.0,
        label="programmed",
    )
    for (name, held), colour in zip(speeds.items(), (ERROR, TRUE), strict=False):
        axes.plot(
            held.way_mm, held.held_mm_s, color=colour, linewidth=THIN_PT, label=f"held, {name}"
        )
    axes.set(xlabel="way along the program, mm", ylabel="speed, mm/s", ylim=(0, None))
    axes.legend(
        fontsize=WORDS_PT, ncols=3, loc="lower right", bbox_to_anchor=(1, 1), frameon=False
    )
    axes.grid(**GRID)


def _write_csv(chart: Chart, file: FilePath) -> None:
    """Write the rows."""
    columns: list[NDArray[np.float64]] = [chart.t_s]
    for number in range(len(chart.axes)):
        of_axis: tuple[Any, ...] = (
            chart.demand_mm,
            chart.actual_mm,
            chart.error_mm,
            chart.limit_mm,
        )
        columns += [column[:, number] for column in of_axis]
    header = ",".join(
        ["t_s", *(f"{name}_{what}_mm" for name in chart.axes for what in _HEADINGS)]
    )
    with written_beside(file) as beside:
        np.savetxt(
            beside,
            np.column_stack(columns),
            fmt="%.7f",
            delimiter=",",
            header=header,
            comments="",
        )
