"""Marks for ink that was left out: solid areas and letters, each in a colour of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.tracer.ink.left_out import Area

COLOURS = {"solid area": "#c77700", "letter": "#8a5cc7"}


def draw(axes: Axes, areas: Sequence[Area]) -> None:
    """Mark solid areas and letters that were left out, in colours of their own."""
    from matplotlib.patches import Rectangle

    named = set[str]()
    for area in (area for area in areas if area.what in COLOURS):
        left, bottom, right, top = area.box_mm
        box = Rectangle(
            (left, bottom),
            right - left,
            top - bottom,
            facecolor=COLOURS[area.what],
            alpha=0.4,
            linewidth=0,
            label=None if area.what in named else f"{area.what}, left out",
            zorder=2,
        )
        named.add(area.what)
        axes.add_patch(box)
    if named:
        axes.legend(loc="upper right", fontsize=8, framealpha=0.8)
