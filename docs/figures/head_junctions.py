"""Figures of `how-the-head-works.md`: the head at corners, past a line that touches, and in a tangle."""

from __future__ import annotations

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from docs.figures.head_stage import (
    BLUE,
    GREEN,
    ORANGE,
    RED,
    VIOLET,
    about,
    ground,
    inked,
    listening,
    put_head,
)
from morfax.motion.arrays import Array
from morfax.tracer.following import ways_out
from morfax.tracer.junctions import choice, planner, rings
from morfax.tracer.sensing.leg import Leg
from morfax.tracer.sensing.view import View
from morfax.tracer.tangles import solution


def draw_ring(axes: Axes, centre: Array, radius: float, arcs: Array) -> None:
    """A ring that was looked round, and the ink that was seen on it."""
    for begin, end, width in ((0, 2 * np.pi, 0.25), *((*arc, 0.9) for arc in arcs)):
        a = np.linspace(begin, end, 100)
        axes.plot(
            *(centre[:, None] + radius * np.array([np.cos(a), np.sin(a)])),
            color=VIOLET,
            lw=width,
        )


def draw_rings(axes: Axes, view: View, centre: Array, found: list[Leg]) -> None:
    """The rings about a place: on by half a leg after the first of the legs that they found."""
    first_mm = min(np.hypot(*(leg.seen[:, :2] - centre).T).min() for leg in found)
    last_mm = first_mm + rings.MORE_LEGS * view.leg_mm
    for radius in np.arange(rings.BEGIN * view.width_mm, last_mm, view.step_mm):
        draw_ring(axes, centre, radius, view.ring(centre, radius))


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
            listening(choice, "legs_around") as looks,
            listening(ways_out, "survey") as surveys,
            listening(run.carriage, "run") as drives,
        ):
            done = run.follow(30.0)
        vertex = corner[1] + by
        ground(axes, drawing, about(vertex + np.array([-1.3, 0.9]), 2.1, 2.1))
        for (view, centre, _), found in looks:
            if np.hypot(*(centre - vertex)) < 1.5 and found:
                draw_rings(axes, view, centre, found)
        (way_in, *_), chosen = surveys[0]
        legs = (way_in.incoming, BLUE, "incoming"), (chosen.leg, GREEN, "outgoing")
        for leg, colour, name in legs:
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
