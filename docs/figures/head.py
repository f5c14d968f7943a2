"""Draw the figures of `how-the-head-works.md`: the head at work on small drawings.

Nothing is sketched. The drawings are made and scanned as the samples are, and the head is the one that
`morfax trace` runs. The figures show what its functions are asked and what they answer while it runs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from docs.figures.head_junctions import corner_figure, ride_figure, tangle_figure
from docs.figures.head_stage import (
    BLUE,
    GREEN,
    ORANGE,
    RED,
    SETTINGS,
    VIOLET,
    about,
    ground,
    inked,
    put_down_at,
)
from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.following import follower
from morfax.tracer.head import kernel
from morfax.tracer.head.state import DRUM, Home
from morfax.tracer.sensing import photocell
from samples import draw

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
