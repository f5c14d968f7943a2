"""The options of the recording unit: how the motion is placed, and how the medium is written."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import fields
from typing import Any

import click

from morfax.console.options.files import machine_names
from morfax.console.options.groups import option, renamed
from morfax.console.options.types import ANGLE, FEED, LENGTH, PLACE, SHARE
from morfax.jobs.machine.recording import PICK_UPS, RecordingUnit

GROUP = "Program"
_OF_THE_JOB = ("origin_mm", "made")  # no options
_NAMES = tuple(field.name for field in fields(RecordingUnit) if field.name not in _OF_THE_JOB)


def unit_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of the recording unit, and hand it the `unit`."""

    @option(
        GROUP,
        "--pickup",
        type=click.Choice(PICK_UPS),
        help="What makes the tracks of a tape: its wave and its travel per cycle, see "
        "docs/reference/tape-format.md.  "
        f"[default: {PICK_UPS[0]}]",
    )
    @option(
        GROUP,
        "--plain",
        is_flag=True,
        help="Record a tape of bare tracks, without the check signal by which it vouches for itself.",
    )
    @option(
        GROUP,
        "--machine",
        metavar="MACHINE",
        shell_complete=machine_names,
        help="The machine that G-code or a plotter file is for: a name that `morfax machines` lists, or a "
        ".toml file of your own.  [default: linuxcnc; hpgl for .plt]",
    )
    @option(
        GROUP,
        "--machine-value",
        "machine_values",
        multiple=True,
        metavar="NAME=NUMBER",
        help="Change a value of the machine by name, such as speed=18000 or power=300; `morfax machines "
        "NAME` shows them.",
    )
    @option(
        GROUP,
        "--feed",
        "feed_mm_s",
        type=FEED,
        help="Feed of the cut in G-code, such as 1200mm/min.  [default: the speeds of the motion; "
        "10 mm/s for a path without times]",
    )
    @option(
        GROUP,
        "--plunge",
        "plunge_mm_s",
        type=FEED,
        help="Feed of Z into the work in G-code.  [default: that of the motion]",
    )
    @option(
        GROUP,
        "--rapid",
        "rapid_mm_s",
        type=FEED,
        help="Speed above the work, for controls that want one in the program (Marlin), and for the time "
        "that is stated; LinuxCNC and Grbl have their own.  [default: the machine's]",
    )
    @option(
        GROUP,
        "--fit-tolerance",
        "fit_tolerance_mm",
        type=LENGTH,
        help="How far the program may be from the path; not for tapes.  [default: the medium's own]",
    )
    @renamed("--tolerance", "--fit-tolerance")
    @option(
        GROUP,
        "--lines-only",
        is_flag=True,
        help="No arcs in G-code and in drawings: short lines instead.",
    )
    @option(
        GROUP,
        "--mirror",
        type=click.Choice(["x", "y"]),
        help="Mirror the program: X, or Y, runs the other way.",
    )
    @option(
        GROUP,
        "--scale",
        type=SHARE,
        default=1.0,
        show_default=True,
        help="Make X and Y this many times as large, such as 0.5 or 50%; the cutter's radius, leads and tabs "
        "scale with them, Z does not.",
    )
    @option(
        GROUP,
        "--turn",
        "turn_rad",
        type=ANGLE,
        default="0deg",
        show_default=True,
        help="Turn X and Y, counter-clockwise, such as 90deg.",
    )
    @option(
        GROUP,
        "--about",
        "about_mm",
        type=PLACE,
        help="The place X,Y in mm that mirror, scale and turn leave where it is.  [default: the start of the "
        "program]",
    )
    @functools.wraps(verb)
    def with_unit(*args: Any, **options: Any) -> Any:
        set_ = {name: options.pop(name) for name in _NAMES}
        set_["mirror"] = set_["mirror"] or ""
        return verb(*args, unit=RecordingUnit(**set_), **options)

    return with_unit
