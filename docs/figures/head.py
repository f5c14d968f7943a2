"""Draw the figures of `how-the-head-works.md`: the head at work on small drawings.

Nothing is sketched. The drawings are made and scanned as the samples are, and the head is the one that
`morfax trace` runs. The figures show what its functions are asked and what they answer while it runs.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.levelling import levelled
from morfax.tracer.following import follower, ways_out
from morfax.tracer.following.start import put_down
from morfax.tracer.head import kernel
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from morfax.tracer.head.state import DRUM, Home
from morfax.tracer.junctions import planner
from morfax.tracer.sensing import photocell
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import solution
from samples import draw

PITCH_MM = 1 / draw.PIXELS_PER_MM
BLUE, RED, GREEN, ORANGE, VIOLET = "#1f5fa8", "#c1121f", "#2a7f3f", "#e07b00", "#7a3fa0"
SETTINGS = Settings()
DPI = 95
DRUM_STYLES: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "marker": ".", "linestyle": "none", "markersize": 4},
    {"color": ORANGE},
    {"color": RED, "marker": "o", "linestyle": "none", "markersize": 8},
    {"color": GREEN, "marker": "x", "linestyle": "none", "markersize": 9, "markeredgewidth": 2},
    {"color": VIOLET},
    {"color": VIOLET, "marker": "s", "linestyle": "none", "markerfacecolor": "none"},
    {"color": VIOLET, "marker": "D", "linestyle": "none"},
)


def inked(*lines: Array) -> tuple[Drawing, Array]:
    """The lines drawn and scanned as a sample is; the drawing, and by how much the lines were moved onto the
    sheet, mm.
    """
    moved, sheet_px = draw.placed(list(lines))
    grey = draw.scanned(draw.coverage(moved, sheet_px), seed=5)
    return Drawing(levelled(grey, PITCH_MM)[0], PITCH_MM), moved[0][0] - lines[0][0]


def put_down_at(drawing: Drawing, start_mm: Array) -> Stance:
    """A stance on the line at a place, heading to the right."""
    stance, _ = next(put_down(drawing, (float(start_mm[0]), float(start_mm[1])), SETTINGS))
    if np.cos(stance.heading_rad) < 0:
        stance = type(stance)(stance.place_mm, stance.heading_rad - np.pi, stance.view)
    return stance


def put_head(drawing: Drawing, start_mm: Array) -> follower.Follower:
    """A head put down on the line at a place, heading to the right."""
    return follower.Follower(put_down_at(drawing, start_mm), SETTINGS, MOTION_RATE_HZ)


@contextmanager
def listening(place: Any, name: str) -> Iterator[list[tuple[tuple[Any, ...], Any]]]:
    """Note the arguments and the answer of each call of a function while the head runs."""
    heard: list[tuple[tuple[Any, ...], Any]] = []
    asked = getattr(place, name)

    def noting(*words: Any, **named: Any) -> Any:
        answer = asked(*words, **named)
        heard.append((words, answer))
        return answer

    setattr(place, name, noting)
    try:
        yield heard
    finally:
        setattr(place, name, asked)


def ground(axes: Axes, drawing: Drawing, view: tuple[float, float, float, float]) -> None:
    """The drawing in grey, and the part of it to show, mm."""
    extent = (0.0, drawing.width_mm, 0.0, drawing.height_mm)
    axes.imshow(
        drawing.darkness, extent=extent, cmap="Greys", vmin=0, vmax=2.6, interpolation="nearest"
    )
    axes.set(xlim=view[:2], ylim=view[2:], aspect="equal", xlabel="X, mm", ylabel="Y, mm")


def about(place: Array, half_x: float, half_y: float) -> tuple[float, float, float, float]:
    """A view about a place, mm."""
    return place[0] - half_x, place[0] + half_x, place[1] - half_y, place[1] + half_y


def sweep_figure() -> plt.Figure:
    """What the swinging cell sees at three offsets, and its fundamental over all of them."""
    drawing, by = inked(np.array([[0.0, 0.0], [20.0, 0.0]]))
    stance = put_down_at(drawing, by + np.array([10, 0]))
    run = follower.Follower(stance, SETTINGS, MOTION_RATE_HZ)
    cells, amplitude = run.view.cells, run.carriage.tuning.amplitude_mm
    place, offsets = stance.place_mm, (0.0, 0.1, 0.25)
    figure, (across, *signals, slope) = plt.subplots(
        1, 5, figsize=(15, 3.4), width_ratios=(1.1, 1, 1, 1, 1.3)
    )
    ground(across, drawing, about(place, 0.8, 0.8))
    phase = np.linspace(0, 2 * np.pi, 300)
    for offset, axes, colour in zip(offsets, signals, (GREEN, BLUE, RED), strict=True):
        u = amplitude * np.sin(phase) - offset
        along = 0.1 * amplitude * np.cos(phase)
        shift = 0.45 * (offsets.index(offset) - 1)
        across.plot(place[0] + along + shift, place[1] + u, color=colour)
        seen = [photocell.darkness_at(cells, place[0], place[1] + y) for y in u]
        first, mean = photocell.sweep(cells, place, 0.0, (-offset, amplitude), 24)
        axes.plot(phase / 2 / np.pi, seen, color=colour, label="darkness seen")
        axes.plot(
            phase / 2 / np.pi,
            mean + first * np.sin(phase),
            "--",
            color="#555555",
            label="mean + fundamental",
        )
        axes.set(
            ylim=(-0.3, 1.35),
            xlabel="sweep, cycles",
            title=f"{offset:g} mm to the right\nfundamental {first:+.2f}",
        )
        axes.legend(fontsize=7, loc="lower center")
    show_characteristic(slope, run, place)
    across.set_title("three sweeps across the line")
    figure.tight_layout()
    return figure


def show_characteristic(axes: plt.Axes, run: follower.Follower, place: Array) -> None:
    """The fundamental and the mean that the sweep hears, over the line's distance, mm."""
    cells, tuning = run.view.cells, run.carriage.tuning
    every = np.linspace(-1.0, 1.0, 201)
    heard = [photocell.sweep(cells, place, 0.0, (-e, tuning.amplitude_mm), 24) for e in every]
    first, mean = np.array(heard).T
    axes.plot(every, first, color=BLUE, label="fundamental")
    axes.plot(every, mean, color=ORANGE, label="mean")
    calibrated = tuning.slope_per_mm * every
    axes.plot(every, calibrated, ":", color="#555555", label="slope as calibrated")
    axes.set(
        ylim=(-1.1, 1.1),
        xlabel="line's distance to the left, mm",
        title="the detector's characteristic",
    )
    axes.legend(fontsize=7)
    axes.grid(alpha=0.3)


def seen_from_axis(run: follower.Follower) -> dict[str, Array]:
    """What the head remembers, concludes and looks at just now, each (n, 2) mm along its heading and to the
    left of it.
    """
    s, t = run.carriage.state, run.carriage.tuning
    heading, axis = s.heading_rad, np.array([s.x_mm, s.y_mm])
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    places = (s.drum_mm[: min(s.places, DRUM)] - axis) @ turn
    x, y = places[np.abs(places[:, 0] - t.point_mm) < t.half_window_mm].T
    fitted = np.polyfit(x, y, 2, w=np.sqrt(1 - ((x - t.point_mm) / t.half_window_mm) ** 2))
    window = t.point_mm + np.linspace(-1, 1, 60) * t.half_window_mm
    phase, curve = np.linspace(0, 2 * np.pi, 100), s.middle_mm / t.lead_mm**2
    ellipse = [
        t.lead_mm + t.along_mm * np.cos(phase),
        s.middle_mm + t.amplitude_mm * np.sin(phase),
    ]
    beside = t.guard_mm * np.hypot(1, 2 * curve * t.guard_lead_mm) * np.array([1, 0, -1])
    return {
        "drum: the line's places, one a sweep": places,
        "parabola about the point": np.column_stack([window, np.polyval(fitted, window)]),
        "steering axis": np.zeros((1, 2)),
        "point steered for": (np.array([[s.point_x_mm, s.point_y_mm]]) - axis) @ turn,
        "sweep of cell 101": np.column_stack(ellipse),
        "guard cells": np.column_stack(
            [np.full(3, t.guard_lead_mm), curve * t.guard_lead_mm**2 + beside]
        ),
        "look-ahead cell 102": np.array([[t.look_ahead_mm, curve * t.look_ahead_mm**2]]),
    }


def drum_figure() -> plt.Figure:
    """The head on an arc: axis, drum of places, parabola, point, cells."""
    drawing, by = inked(draw.arc((0, 0), 6, 0, 340))
    stance = put_down_at(drawing, by + np.array([0, 6]))
    run = follower.Follower(stance, SETTINGS, MOTION_RATE_HZ)
    home = Home(*stance.place_mm, stance.heading_rad, 1e9)
    state, tuning = run.carriage.state, run.carriage.tuning
    kernel.follow(run.view.cells, state, tuning, home, np.empty((3000, 2)))
    axis, heading = np.array([state.x_mm, state.y_mm]), state.heading_rad
    to_sheet = np.array(
        [[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]]
    )
    figure, (sheet, close) = plt.subplots(1, 2, figsize=(13, 5.6))
    ground(sheet, drawing, about(axis + 0.6 * to_sheet[0], 1.6, 1.6))
    for (name, points), style in zip(seen_from_axis(run).items(), DRUM_STYLES, strict=True):
        sheet.plot(*(axis + points @ to_sheet).T, **style, label=name)
        if style["color"] != VIOLET:
            close.plot(*points.T, **style)
    sheet.legend(fontsize=7, loc="lower left")
    sheet.set_title("on the sheet")
    close.set(
        xlim=(-0.8, 1.2),
        ylim=(-0.07, 0.01),
        xlabel="along the heading, mm",
        ylabel="to the left of it, mm",
    )
    close.set_title("seen from the axis, sideways enlarged")
    close.grid(alpha=0.3)
    figure.tight_layout()
    return figure


def draw_ring(axes: Axes, centre: Array, radius: float, arcs: Array) -> None:
    """A ring that was looked round, and the ink that was seen on it."""
    for begin, end, width in ((0, 2 * np.pi, 0.25), *((*arc, 0.9) for arc in arcs)):
        a = np.linspace(begin, end, 100)
        axes.plot(
            *(centre[:, None] + radius * np.array([np.cos(a), np.sin(a)])),
            color=VIOLET,
            lw=width,
        )


def corner_figure() -> plt.Figure:
    """Two corners: the legs, the rings that found them, and the course through."""
    figure, panels = plt.subplots(1, 2, figsize=(13, 6))
    for axes, angle in zip(panels, (90, 36), strict=True):
        turned = np.radians(180 - angle)
        corner = np.array(
            [[-14.0, 0.0], [0.0, 0.0], [14 * np.cos(turned), 14 * np.sin(turned)]]
        )
        drawing, by = inked(corner)
        run = put_head(drawing, by + np.array([-7, 0]))
        with (
            listening(View, "ring") as rings,
            listening(ways_out, "survey") as surveys,
            listening(run.carriage, "run") as drives,
        ):
            done = run.follow(30.0)
        vertex = corner[1] + by
        ground(axes, drawing, about(vertex + np.array([-1.3, 0.9]), 2.1, 2.1))
        for (_, centre, radius), arcs in rings:
            if np.hypot(*(centre - vertex)) < 1.5:
                draw_ring(axes, centre, radius, arcs)
        (_, incoming, *_), (outgoing, *_) = surveys[0]
        for leg, colour, name in ((incoming, BLUE, "incoming"), (outgoing, GREEN, "outgoing")):
            axes.plot(
                *leg.seen[:, :2].T, ".", color=colour, markersize=4, label=f"{name} leg, felt"
            )
        for k, stretch in enumerate(drives[0][0][0]):
            axes.plot(
                *stretch.T,
                color=ORANGE,
                lw=2.5,
                label="course through the junction" if k == 0 else None,
            )
        axes.plot(*done.positions_mm.T, color=RED, lw=0.9, label="motion of the axis")
        axes.plot(*vertex, "+", color="black", markersize=12, label="the corner as drawn")
        near = float(np.min(np.hypot(*(done.positions_mm - vertex).T))) * 1000
        axes.set_title(f"{angle} degrees: the axis passes the corner within {near:.0f} µm")
        axes.legend(fontsize=7, loc="upper left")
    figure.tight_layout()
    return figure


def ride_figure() -> plt.Figure:
    """Edge following: another line comes close, runs along, and leaves again."""
    x = np.linspace(0, 24, 400)
    own = np.column_stack([x, np.zeros_like(x)])
    other = np.column_stack([x, 0.3 + 1.6 * np.clip(np.abs(x - 12) - 2.5, 0, None) ** 2 / 12])
    drawing, by = inked(own, other)
    run = put_head(drawing, by + np.array([1.5, 0]))
    with listening(planner, "follow_edge") as runs:
        done = run.follow(40.0)
    incoming, felt = next((words[1], felt) for words, felt in runs if felt is not None)
    figure, axes = plt.subplots(figsize=(13, 4.2))
    ground(axes, drawing, about(by + np.array([12, 0.5]), 9, 2.2))
    seen = felt.seen[:, :2]
    step = np.gradient(seen, axis=0)
    right = (
        np.column_stack([step[:, 1], -step[:, 0]]) / np.hypot(*step.T)[:, None]
    )  # the other line is on the left
    edge = seen + 0.5 * incoming.width_mm * right
    axes.plot(*edge.T, color=VIOLET, lw=1.2, label="outer edge, felt")
    axes.plot(
        *incoming.seen[:, :2].T,
        ".",
        color=BLUE,
        markersize=4,
        label="incoming leg, felt on both edges",
    )
    axes.plot(*seen.T, ".", color=GREEN, markersize=3, label="the line, half a width within")
    axes.plot(*done.positions_mm.T, color=RED, lw=0.9, label="motion of the axis")
    axes.plot(*(own + by).T, ":", color="black", lw=0.8, label="the line as drawn")
    off = np.abs(done.positions_mm[:, 1] - by[1]).max() * 1000
    axes.set_title(f"followed by one edge past a line that touches: {off:.0f} µm off at most")
    axes.legend(fontsize=7, loc="upper center", ncol=3)
    figure.tight_layout()
    return figure


def tangle_figure() -> plt.Figure:
    """A tangle: two spikes whose inks run together, and the vertices by which the pen leaves the same ink."""
    own = np.array(
        [(0, 0), (9, 0), (9.4, -2.4), (10.0, 0.1), (10.5, 2.3), (10.9, 0), (20, 0)], float
    )
    drawing, by = inked(own)
    run = put_head(drawing, by + np.array([1.5, 0]))
    with listening(solution, "unravelled") as unravelled:
        done = run.follow(40.0)
    sketch, way = next(
        (words[0], answer[1]) for words, answer in unravelled if answer[1] is not None
    )
    figure, axes = plt.subplots(figsize=(13, 7))
    ground(axes, drawing, about(by + np.array([10, 0]), 4.5, 3.2))
    ends_mm = np.array([leg.end_mm for leg in sketch.tangle.legs])
    marks = (
        (sketch.tangle.places_mm, ".", BLUE, 2, "places of the tangle's ink, and about it"),
        (ends_mm, "s", GREEN, 7, "clean ends of the legs"),
        (way.vertices[0], "o", VIOLET, 7, "vertices, moved until the pen leaves this ink"),
    )
    for places, mark, colour, size, said in marks:
        see_through = 0.5 if mark == "." else 1.0
        axes.plot(*places.T, mark, color=colour, markersize=size, alpha=see_through, label=said)
    axes.plot(*done.positions_mm.T, color=RED, lw=1.2, label="motion of the axis")
    axes.plot(*(own + by).T, ":", color="black", lw=0.9, label="the line as drawn")
    axes.set_title(
        f"a tangle redrawn: unexplained ink {way.misfit:.3f} of a stretch as long as the line is wide"
    )
    axes.legend(fontsize=7, loc="upper left")
    figure.tight_layout()
    return figure


FIGURES = {
    "sweep": sweep_figure,
    "drum": drum_figure,
    "corner": corner_figure,
    "ride": ride_figure,
    "tangle": tangle_figure,
}


def main(folder: Path) -> None:
    """Write all figures into a folder."""
    for name, make in FIGURES.items():
        figure = make()
        figure.savefig(folder / f"head-{name}.png", dpi=DPI)
        plt.close(figure)
