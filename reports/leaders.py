"""Who led the head, in the colours of a traced path, with a legend that gives the shares.

Signals in: who led, with the runs of each leader in sheet mm. Out: lines for a plate.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from morfax.reports.looks import BOLD_PT, ON_PATHS
from morfax.reports.plate import Polyline, with_gaps

if TYPE_CHECKING:
    from morfax.jobs.remarks.who_led import WhoLed

COLOURS = ("#c1121f", "#f2a000", "#1f5fa8", "#7a3fa0")  # in the order of `LEADERS`


def lines(led: WhoLed) -> list[Polyline]:
    """The runs of each leader in its colour; labels name those that led anywhere."""
    from morfax.tracer.head.leaders import LEADERS

    all_mm, drawn = sum(led.lengths_mm), list[Polyline]()
    for leader, (name, mm) in enumerate(zip(LEADERS, led.lengths_mm, strict=True)):
        runs = [places for one, places in led.runs_mm if one == leader]
        if runs:
            label = f"{name} {100 * mm / all_mm:.1f} %"
            drawn.append(
                Polyline(with_gaps(runs), COLOURS[leader], BOLD_PT, label=label, order=ON_PATHS)
            )
    return drawn
