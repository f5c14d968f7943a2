"""Pictures of a checked program: rapids, plunges, cuts and their direction; stock and travel; findings.

Signals in: the result of a check. Signals out: a picture. From above, in mm of the program's zero; below it,
where there is a Z, the height of the tool along its way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from morfax.jobs.figures import MOST_PLACES
from morfax.motion.arrays import Array
from morfax.player.gcode.check.planes import CHORD_RAD
from morfax.reports.canvas import NUMBERS_IN, PANEL_IN, WIDTH_IN, new_figure, save
from morfax.reports.looks import (
    BESIDE_PT,
    LINE_PT,
    NAMES,
    ON_PATHS,
    ON_SPOTS,
    SPOT_PT,
    SPOTS,
    THIN_PT,
    WORDS_PT,
)
from morfax.reports.overlay import MARGIN_SHARE
from morfax.reports.plate import View

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.jobs.check import CheckResult
    from morfax.player.gcode.check.findings import Finding
    from morfax.player.gcode.check.motion_rules import Stock
    from morfax.player.gcode.check.steps import Step

CUT, RAPID, PLUNGE = "#222222", "#1f5fbf", "#2a7f3f"
STOPS, REMARK = "#c1121f", "#b08000"
WOOD, TRAVEL = "#f3e3c3", "#8a8a8a"
ARROWS = 60  # along the whole cut
ARROW_IN = 0.12  # its length
DASHES = 0, (5, 3)


def draw_checked(result: CheckResult, name: str, file: FilePath) -> None:
    """Write the picture, of the kind that the suffix says (.png, .svg, .pdf)."""
    steps = [step for step in result.checked.steps if step.moves]
    figure = new_figure(layout="constrained")
    view = _view(steps, result.stock)
    shape = (view[3] - view[2]) / (view[1] - view[0])
    above_in = min(max(WIDTH_IN * shape, 3.0), 10.0)
    if result.machine.z and steps:
        figure.set_size_inches(WIDTH_IN, above_in + NUMBERS_IN + PANEL_IN)
        above, side = figure.subplots(2, 1, height_ratios=(above_in, PANEL_IN))
        _side_view(side, steps, result)
    else:
        figure.set_size_inches(WIDTH_IN, above_in + NUMBERS_IN)
        above = figure.add_subplot()
    _ground(above, steps, result)
    _ways(above, steps)
    _arrows(above, steps)
    _marked(above, result.checked.findings)
    verdict = "may be started" if result.may_start else "must not be started"
    above.set(
        xlabel="X, mm",
        ylabel="Y, mm",
        aspect="equal",
        title=f"{name}, {result.machine.name}: {verdict}",
    )
    above.title.set_color(CUT if result.may_start else STOPS)
    above.set(xlim=view[:2], ylim=view[2:])
    if above.get_legend_handles_labels()[0]:
        figure.legend(
            *above.get_legend_handles_labels(),
            loc="outside lower center",
            ncols=6,
            fontsize=WORDS_PT,
        )
    save(figure, file)


def way_mm(step: Step) -> Array:
    """Places (n, 3) along a step: its ends, and between those of an arc as many as it takes to look round."""
    begin = np.array(step.begin_mm)
    end = np.array(step.move.end_mm)
    turned = step.move.turned_rad
    if not turned:
        return np.vstack([begin, end])
    share = np.linspace(0, 1, max(2, math.ceil(abs(turned) / CHORD_RAD)) + 1)
    x, y = np.array(step.begin_mm[:2]) - step.move.centre_mm
    cos = np.cos(turned * share)
    sin = np.sin(turned * share)
    places: Array = np.column_stack(
        [
            step.move.centre_mm[0] + cos * x - sin * y,
            step.move.centre_mm[1] + sin * x + cos * y,
            begin[2] + share * (end[2] - begin[2]),
        ]
    )
    return places


def _view(steps: Sequence[Step], stock: Stock | None) -> View:
    """The part that is shown, mm: the program, the stock, and the zero if it is not far away."""
    places = [way_mm(step)[:, :2] for step in steps] or [np.zeros((1, 2))]
    if stock is not None and stock.width_mm is not None and stock.height_mm is not None:
        size = np.array([stock.width_mm, stock.height_mm])
        corner = np.array(stock.corner_mm)
        places.append(np.vstack([corner, corner + size]))
    every = np.vstack(places)
    low, high = every.min(axis=0), every.max(axis=0)
    span = max(float((high - low).max()), 1.0)
    if (low - span < 0).all() and (high + span > 0).all():
        low = np.minimum(low, 0.0)
        high = np.maximum(high, 0.0)
    low = low - MARGIN_SHARE * span
    high = high + MARGIN_SHARE * span
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _ground(axes: Axes, steps: Sequence[Step], result: CheckResult) -> None:
    """Draw the stock, the zero, and the travel from the lowest place on: where it lies is not known."""
    from matplotlib.patches import Rectangle

    stock = result.stock
    if stock is not None and stock.width_mm is not None and stock.height_mm is not None:
        size = stock.width_mm, stock.height_mm
        axes.add_patch(
            Rectangle(stock.corner_mm, *size, facecolor=WOOD, edgecolor="none", label="stock")
        )
    if result.machine.travel_mm is not None and steps:
        low = np.vstack([way_mm(step) for step in steps])[:, :2].min(axis=0)
        size = result.machine.travel_mm[0], result.machine.travel_mm[1]
        style: dict[str, Any] = {"fill": False, "edgecolor": TRAVEL, "linestyle": ":"}
        axes.add_patch(Rectangle((low[0], low[1]), *size, label="travel", **style))
    axes.plot(
        0, 0, marker="+", markersize=2 * SPOT_PT, color=TRAVEL, linestyle="none", label="zero"
    )


def _ways(axes: Axes, steps: Sequence[Step]) -> None:
    """Draw rapids, cuts and plunges."""
    rapids = [way_mm(step)[:, :2] for step in steps if step.is_rapid and step.across]
    lines = [way_mm(step)[:, :2] for step in steps if not step.is_rapid and step.across]
    in_work = [step.in_work for step in steps if not step.is_rapid and step.across]
    cuts = [line for line, cut in zip(lines, in_work, strict=True) if cut]
    travels = [line for line, cut in zip(lines, in_work, strict=True) if not cut]
    _collection(axes, rapids, "rapid", RAPID, THIN_PT, DASHES)
    _collection(axes, travels, "line above the work", RAPID, THIN_PT, "-")
    _collection(axes, cuts, "cut", CUT, LINE_PT, "-")
    down = [step.move.end_mm[:2] for step in steps if _plunges(step)]
    if down:
        style: dict[str, Any] = {"marker": "o", "markersize": SPOT_PT, "linestyle": "none"}
        axes.plot(*np.array(down).T, color=PLUNGE, label="plunge", zorder=SPOTS, **style)


def _plunges(step: Step) -> bool:
    """Whether a step goes straight down into the work."""
    down = step.move.end_mm[2] < step.begin_mm[2]
    return step.in_work and not step.is_rapid and not step.across and down


def _collection(
    axes: Axes, lines: Sequence[Array], label: str, colour: str, width_pt: float, style: Any
) -> None:
    """Draw many lines of one kind."""
    from matplotlib.collections import LineCollection

    if lines:
        look: dict[str, Any] = {"colors": colour, "linewidths": width_pt, "linestyles": style}
        axes.add_collection(LineCollection(list(lines), label=label, **look))


def _arrows(axes: Axes, steps: Sequence[Step]) -> None:
    """Draw the direction of travel, evenly along what is cut, at least once in each cut."""
    cuts = [step for step in steps if step.in_work and not step.is_rapid and step.across]
    spacing_mm, waiting_mm = sum(step.length_mm for step in cuts) / ARROWS, math.inf
    places, ways = [], []
    before: Step | None = None
    for step in cuts:
        if before is None or before.move.end_mm[:2] != step.begin_mm[:2]:
            waiting_mm = math.inf
        waiting_mm += step.length_mm
        if waiting_mm >= spacing_mm:
            way = way_mm(step)[:, :2]
            middle = (len(way) - 1) // 2
            places.append((way[middle] + way[middle + 1]) / 2)
            ways.append(
                (way[middle + 1] - way[middle]) / math.dist(way[middle + 1], way[middle])
            )
            waiting_mm = 0.0
        before = step
    if places:
        look: dict[str, Any] = {
            "pivot": "mid",
            "color": CUT,
            "zorder": ON_PATHS,
            "units": "inches",
        }
        head: dict[str, Any] = {"headwidth": 9, "headlength": 9, "headaxislength": 8}
        arrows = *np.array(places).T, *(ARROW_IN * np.array(ways)).T
        axes.quiver(*arrows, scale_units="inches", scale=1, width=ARROW_IN / 11, **look, **head)


def _marked(axes: Axes, findings: Sequence[Finding]) -> None:
    """Mark the findings that have a place, with their line."""
    shown = [finding for finding in findings if finding.place_mm is not None]
    for stops, colour, label in ((True, STOPS, "found"), (False, REMARK, "remark")):
        places = [each.place_mm[:2] for each in shown if each.stops == stops and each.place_mm]
        if places:
            style: dict[str, Any] = {"marker": "x", "markersize": SPOT_PT, "linestyle": "none"}
            axes.plot(*np.array(places).T, color=colour, label=label, zorder=ON_SPOTS, **style)
    texts: dict[tuple[float, ...], list[Finding]] = {}
    for finding in shown[:MOST_PLACES]:
        assert finding.place_mm is not None
        texts.setdefault(finding.place_mm[:2], []).append(finding)
    for place_mm, here in texts.items():
        axes.annotate(
            "\n".join(f"line {each.line}: {each.rule}" for each in here),
            (place_mm[0], place_mm[1]),
            BESIDE_PT,
            textcoords="offset points",
            fontsize=WORDS_PT,
            color=STOPS if any(each.stops for each in here) else REMARK,
            zorder=NAMES,
        )


def _side_view(axes: Axes, steps: Sequence[Step], result: CheckResult) -> None:
    """Draw the height of the tool along its way, with the work's faces."""
    stock = result.stock
    surface_mm = stock.surface_mm if stock is not None else 0.0
    along_mm = 0.0
    rapids = list[Array]()
    lines = list[Array]()
    for step in steps:
        ends = [along_mm, along_mm + step.length_mm]
        way = np.column_stack([ends, [step.begin_mm[2], step.move.end_mm[2]]])
        (rapids if step.is_rapid else lines).append(way)
        along_mm = ends[1]
    _collection(axes, rapids, "rapid", RAPID, THIN_PT, "-")
    _collection(axes, lines, "line", CUT, LINE_PT, "-")
    axes.axhline(surface_mm, color="#a07840", linewidth=THIN_PT)
    if stock is not None and stock.thickness_mm is not None:
        axes.axhspan(surface_mm - stock.thickness_mm, surface_mm, color=WOOD, zorder=0)
    axes.autoscale_view()
    axes.set(xlabel="along the way, mm", ylabel="Z, mm", xlim=(0, max(along_mm, 1.0)))
