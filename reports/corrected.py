"""The operator's corrections in a picture: in a colour of their own, each with its number.

Signals in: corrections as they lie on a sheet, and axes in sheet mm. Out: nothing; they are drawn.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.tracer.corrections.on_sheet import OnSheet, PlaceMm, Stroke

COLOUR = "#d100b8"
TURNS = {"straight": "↑", "left": "↰", "right": "↱"}
STOPS = {"stop": "D", "drill": "o", "not-stop": "X"}
POINTS = {"start": "P", "reference": "*"}
MARKER_PT = 7
RUBBED_ALPHA = 0.18  # what was rubbed out lets the paper shine through


def draw_corrections(axes: Axes, laid: OnSheet) -> None:
    """Draw all corrections of a sheet."""
    for stroke in laid.strokes:
        _stroke(axes, stroke)
        _number(
            axes, stroke.number, (float(stroke.places_mm[0, 0]), float(stroke.places_mm[0, 1]))
        )
    for turn in laid.turns:
        axes.annotate(
            TURNS[turn.do],
            turn.place_mm,
            color=COLOUR,
            ha="center",
            va="center",
            fontsize=12,
            fontweight="bold",
            zorder=6,
        )
        _number(axes, turn.number, turn.place_mm)
    for stop in laid.stops:
        _marker(axes, STOPS[stop.do], stop.place_mm)
        _number(axes, stop.number, stop.place_mm)
    for number, one in laid.corrections.of("start", "reference"):
        place_mm = laid.start_mm if one.do == "start" else laid.reference_mm
        if place_mm is not None:
            _marker(axes, POINTS[one.do], place_mm)
            _number(axes, number, place_mm)


def _stroke(axes: Axes, stroke: Stroke) -> None:
    """Draw a stroke of the rubber as an area, one of the pen as a line."""
    from matplotlib.patches import Circle, Polygon

    rubbed: dict[str, Any] = {"edgecolor": COLOUR, "facecolor": COLOUR, "alpha": RUBBED_ALPHA}
    places_mm = stroke.places_mm
    if stroke.do == "bridge" and len(places_mm) > 1:
        axes.plot(*places_mm.T, color=COLOUR, linewidth=1.2, linestyle=(0, (2, 1)), zorder=4)
        return
    if stroke.do == "rub-area":
        axes.add_patch(Polygon(places_mm, zorder=1, **rubbed))
        return
    half_mm = 0.5 * (stroke.width_mm or 1.0)
    for place_mm in places_mm[:: max(1, len(places_mm) // 200)]:
        axes.add_patch(Circle((place_mm[0], place_mm[1]), half_mm, zorder=1, **rubbed))
    for begin, end in pairwise(places_mm):
        along = (end - begin) / max(float(np.hypot(*(end - begin))), 1e-9)
        left = half_mm * np.array([-along[1], along[0]])
        corners = np.array([begin + left, end + left, end - left, begin - left])
        axes.add_patch(Polygon(corners, zorder=1, **rubbed))


def _marker(axes: Axes, marker: str, place_mm: PlaceMm) -> None:
    """Draw a place."""
    axes.plot(
        *place_mm,
        marker=marker,
        markersize=MARKER_PT,
        markerfacecolor="none",
        color=COLOUR,
        linestyle="none",
        zorder=6,
    )


def _number(axes: Axes, number: int, place_mm: PlaceMm) -> None:
    """Write the number of a correction beside its place."""
    axes.annotate(
        f"c{number}",
        place_mm,
        (7, -11),
        textcoords="offset points",
        fontsize=7,
        color=COLOUR,
        zorder=6,
    )
