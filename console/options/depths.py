"""The options of cutting in Z: passes by a step, ramps, holding tabs and pecks."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import click

from morfax.console.options.groups import option
from morfax.console.options.types import COUNTED, LENGTH, RAMP
from morfax.jobs.settings.depths import DepthSettings

GROUP = "Cutting"
DEPTHS = (
    option(
        GROUP,
        "--step-down",
        "step_down_mm",
        type=COUNTED,
        help="Deepest cut of one pass, such as 1.5mm: each line is cut in equal passes down to its depth.  "
        "[default: the card's passes, or one]",
    ),
    option(
        GROUP,
        "--ramp",
        "ramp_rad",
        type=RAMP,
        help="The tool goes into the work along the line, at this angle, such as 3deg: round along a closed "
        "line, to and fro at the start of an open one.  [default: the card's, or straight down]",
    ),
    option(
        GROUP,
        "--tabs",
        type=click.IntRange(min=0, max=1000),
        help="Holding tabs on each closed line, evenly and clear of corners; 0 for none.  [default: the "
        "card's, or none]",
    ),
    option(
        GROUP,
        "--tab-width",
        "tab_width_mm",
        type=LENGTH,
        help="How wide a tab is at its top; the path over it is longer by the cutter's diameter.  "
        "[default: the card's, or 3mm]",
    ),
    option(
        GROUP,
        "--tab-height",
        "tab_height_mm",
        type=COUNTED,
        help="How high a tab stands above the depth.  [default: the card's, or 1mm]",
    ),
    option(
        GROUP,
        "--peck",
        "peck_mm",
        type=COUNTED,
        help="Depth of one peck in a drilled hole, such as 2mm: the drill comes up after each.  "
        "[default: the card's, or at once]",
    ),
)


def depth_settings(options: dict[str, Any]) -> DepthSettings:
    """The settings of cutting in Z, taken out of all options."""
    names = [field.name for field in fields(DepthSettings)]
    return DepthSettings(**{name: options.pop(name) for name in names})
