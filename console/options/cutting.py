"""The options of cutting in the plane: direction of closed lines, leads, start; and the kerf."""

from __future__ import annotations

from typing import Any, Literal

import click

from morfax.console.options.groups import option
from morfax.console.options.types import CUTTER, LEAD
from morfax.jobs.settings.contour_settings import ContourSettings

GROUP = "Cutting"
KERF = option(
    "Tool",
    "--kerf",
    "kerf_mm",
    type=CUTTER,
    help="Width of the cut of a torch or laser, such as 1.2mm: the same as --cutter.",
)
CUTTING = (
    option(
        GROUP,
        "--climb",
        is_flag=True,
        help="Closed lines turn so that the tool climbs: outside of the part clockwise, inside its holes "
        "counter-clockwise (good side of a plasma cut too).  [default: as the head followed them, or the "
        "machine's]",
    ),
    option(
        GROUP,
        "--conventional",
        is_flag=True,
        help="Closed lines turn the other way round than with --climb.",
    ),
    option(
        GROUP,
        "--lead-in",
        type=LEAD,
        help="Come to a closed line through the scrap: 3mm is a quarter circle of that radius which touches "
        "the cut, 3mm,line a straight line of that length at 45 degrees. Shorter where there is no room.",
    ),
    option(
        GROUP,
        "--lead-out",
        type=LEAD,
        help="Leave a closed line through the scrap: the same for its end.",
    ),
    option(
        GROUP,
        "--start-at",
        type=click.Choice(["corner", "straight", "nearest"]),
        help="Where the cut of a closed line begins: at its sharpest corner, on its longest straight, or "
        "nearest to where the tool comes from.  [default: with leads on the longest straight, else where "
        "the head began]",
    ),
)


def kerf_is_cutter(options: dict[str, Any]) -> None:
    """Take the kerf out of all options, for the cutter; wrong use where both are given."""
    kerf_mm = options.pop("kerf_mm")
    if kerf_mm is None:
        return
    if options["cutter_mm"] is not None:
        raise click.UsageError("--kerf and --cutter are the same; give one of them")
    options["cutter_mm"] = kerf_mm


def contour_settings(options: dict[str, Any]) -> ContourSettings:
    """The settings of contouring, taken out of all options; wrong use where two do not go together."""
    climb, conventional = options.pop("climb"), options.pop("conventional")
    if climb and conventional:
        raise click.UsageError("--climb and --conventional were both given; give one of them")
    milling: Literal["climb", "conventional"] | None = "conventional" if conventional else None
    milling = "climb" if climb else milling
    leads = {name: options.pop(name) for name in ("lead_in", "lead_out")}
    return ContourSettings(milling, start_at=options.pop("start_at"), **leads)
