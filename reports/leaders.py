"""Who led the head, in the colours of a traced path, with a legend that gives the shares.

Signals in: who led, with the runs of each leader in sheet mm. Out: lines on the axes of a picture.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from morfax.jobs.who_led import WhoLed

COLOURS = ("#c1121f", "#f2a000", "#1f5fa8", "#7a3fa0")  # in the order of `LEADERS`
LINE_PT = 1.8


def draw(axes: Axes, led: WhoLed) -> None:
    """Draw the runs of each leader in its colour; the legend names those that led anywhere."""
    from matplotlib.collections import LineCollection

    from morfax.tracer.head.leaders import LEADERS

    all_mm = sum(led.lengths_mm)
    for leader, (name, mm) in enumerate(zip(LEADERS, led.lengths_mm, strict=True)):
        runs = [places for one, places in led.runs_mm if one == leader]
        if not runs:
            continue
        label = f"{name} {100 * mm / all_mm:.1f} %"
        lines = LineCollection(
            runs, colors=COLOURS[leader], linewidths=LINE_PT, label=label, zorder=3
        )
        axes.add_collection(lines)
