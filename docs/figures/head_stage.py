"""The stage of the head's figures: small drawings, a head put down on them, and who listens to it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.axes import Axes

from morfax.motion.arrays import Array
from morfax.motion.motion import MOTION_RATE_HZ
from morfax.tracer.drawing.drawing import Drawing
from morfax.tracer.drawing.levelling import levelled
from morfax.tracer.following import follower
from morfax.tracer.following.start import put_down
from morfax.tracer.head.settings import Settings
from morfax.tracer.head.stance import Stance
from samples import draw

PITCH_MM = 1 / draw.PIXELS_PER_MM
BLUE, RED, GREEN, ORANGE, VIOLET = "#1f5fa8", "#c1121f", "#2a7f3f", "#e07b00", "#7a3fa0"
SETTINGS = Settings()


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
