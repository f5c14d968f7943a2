"""The options of line, head, tool and program, which become the TraceSettings of a job."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import fields
from typing import Any, NoReturn

import click

from morfax.console.options.cutting import CUTTING, KERF, contour_settings, kerf_is_cutter
from morfax.console.options.depths import DEPTHS, depth_settings
from morfax.console.options.files import FILE
from morfax.console.options.groups import given_all, option, renamed
from morfax.console.options.types import (
    CLEARANCE,
    CUTTER,
    DEPTH,
    LENGTH,
    LETTERS,
    LINES,
    ORDER,
    PLACE,
    REACH,
    SPEED,
    STOPS,
    ZERO,
)
from morfax.console.terminal import attended
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import (
    HeadSettings,
    ProgramSettings,
    ToolSettings,
    TraceSettings,
)

# the head's and the tool's own, stated here for --help, which does not wait for the tracer
DEFAULTS = {
    "speed_mm_s": "10mm/s",
    "gap_mm": "0.5mm",
    "depth_mm": "5mm",
    "clearance_mm": "2mm",
}

START = option(
    "Line",
    "--start",
    "starts_mm",
    type=PLACE,
    multiple=True,
    help="Where the head looks for the line, X,Y in mm from the sheet's lower-left corner; several times for "
    "several lines as one program.  [default: a smooth place of the longest line]",
)
SEVERAL = option(
    "Line",
    "--lines",
    type=LINES,
    help="Several lines as one program: all (every stretch of line, each once), contours (lines to be cut, "
    "inner before outer, without the bars between them), outer (contours inside no other), or numbers "
    "such as 1,3; 1 is the longest.  [default: one line, the longest or that at --start; contours with "
    "--cutter or --kerf, unless there is a --card; what --machine is for: all with grbl-pen and grbl-laser]",
)
LETTERING = option(
    "Line",
    "--lettering",
    "lettering_mm",
    type=LETTERS,
    help="With --lines all, contours or outer, which letters to follow: all, none, or a least height such as "
    "2mm. The figures list the others.  [default: all; of contours with --cutter, three cutters high]",
)
LINE_WIDTH = option(
    "Line",
    "--line-width",
    "line_width_mm",
    type=LENGTH,
    help="Width of the line, such as 0.5mm.  [default: measured on the drawing]",
)
GAP = option(
    "Line",
    "--gap",
    "gap_mm",
    type=REACH,
    help="Widest gap in the line that the head crosses; with 0 only gaps of a scan, some 3 pixels.  "
    f"[default: {DEFAULTS['gap_mm']}, or the widest skip of a pen that skips, up to 1mm]",
)
TRACING_SPEED = option(
    "Head",
    "--speed",
    "speed_mm_s",
    type=SPEED,
    help=f"Tracing speed.  [default: the card's, or {DEFAULTS['speed_mm_s']}]",
)

_LINE = (
    START,
    SEVERAL,
    LETTERING,
    LINE_WIDTH,
    GAP,
    option(
        "Line",
        "--recatch",
        "recatch_mm",
        type=REACH,
        help="Where the line is lost or ends, go on if ink begins within this distance ahead, such as 5mm.  "
        "[default: the head stops]",
    ),
    option(
        "Line",
        "--direction",
        type=click.Choice(["cw", "ccw", "left", "right"]),
        help="Which way round; or to which side the head turns where its lead line, or its way from --start, "
        "meets the line.  [default: as it comes; left from a lead line]",
    ),
    option(
        "Line",
        "--arrow",
        "arrows_mm",
        nargs=2,
        type=(PLACE, PLACE),
        multiple=True,
        metavar="X,Y X,Y",
        help="Where a line begins, and a place to which the head goes from there, such as 40,26 50,26; "
        "several times for several lines. With --lines these lines begin so, without it they are the lines. "
        "It takes precedence over --climb and the machine's direction.  [default: as it comes]",
    ),
    option(
        "Line",
        "--order",
        type=ORDER,
        default=(),
        help="Several lines: these are cut first, in this order, such as 3,1.  [default: inner before outer, "
        "with short ways between them]",
    ),
    option(
        "Line",
        "--reference-point",
        "reference_mm",
        type=PLACE,
        help="The reference point, X,Y in mm.  [default: a small cross or ring from which a line leads]",
    ),
    renamed("--reference", "--reference-point"),
)
_HEAD = (
    TRACING_SPEED,
    option(
        "Head",
        "--head",
        "kind",
        type=click.Choice(["precise", "historic"]),
        default="precise",
        show_default=True,
        help="The head: precise, or that of 1969, which steers straight by its cell and cuts corners.",
    ),
    option(
        "Head",
        "--set",
        "changes",
        multiple=True,
        metavar="NAME=VALUE",
        help="Change a setting of the head by name, such as sweep_hz=50; the unit is in the name.",
    ),
    option(
        "Head",
        "--settings",
        "settings_file",
        type=FILE,
        help="Settings of the head from a file (.toml) as --print-settings writes it. --set and other "
        "options "
        "take precedence.",
    ),
    option(
        "Head",
        "--print-settings",
        is_flag=True,
        help="Print the settings that the head would follow with, and do nothing else.",
    ),
)
_TOOL = (
    option(
        "Tool",
        "--depth",
        "depth_mm",
        type=DEPTH,
        help="How deep the tool goes into the work along the line.  [default: the card's, or "
        f"{DEFAULTS['depth_mm']}]",
    ),
    option(
        "Tool",
        "--clearance",
        "clearance_mm",
        type=CLEARANCE,
        help="How far above the work the tool stands before and after.  [default: the card's, or "
        f"{DEFAULTS['clearance_mm']}]",
    ),
    option(
        "Tool",
        "--cutter",
        "cutter_mm",
        type=CUTTER,
        help="Diameter of the cutter, such as 6mm: the tool runs beside the line, half the diameter away.  "
        "[default: the tool runs on the line]",
    ),
    KERF,
    option(
        "Tool",
        "--side",
        type=click.Choice(["outside", "inside", "left", "right"]),
        help="Side of the line for --cutter: outside or inside of the part (of a hole the other way "
        "round), or "
        "left or right of the head's travel.  [default: outside]",
    ),
)
_PROGRAM = (
    option(
        "Program",
        "--card",
        "card_file",
        type=FILE,
        help="The operator's card (.toml): depths, speeds, what to do at the stops, turns. Options take "
        "precedence.",
    ),
    option(
        "Program",
        "--stop-override",
        type=STOPS,
        help="Stop marks that do not stop the head: none, all, or numbers such as 1,3.  [default: the "
        "card's, or none]",
    ),
    renamed("--override", "--stop-override"),
    option(
        "Program",
        "--marks",
        type=click.Choice(["auto", "on", "off"]),
        default="auto",
        show_default=True,
        help="Whether ticks across a line and dots are stop marks and holes (on) or ink (off); with off no "
        "cross or ring is a reference point either. auto: marks with a card, with a reference point, and "
        "on a sheet of nothing but dots.",
    ),
    option(
        "Program",
        "--ask",
        is_flag=True,
        help="Stop at every mark and ask for the Z moves, at a terminal.",
    ),
    option(
        "Program",
        "--zero",
        type=ZERO,
        default="sheet",
        show_default=True,
        help="The zero of the program: sheet (its lower-left corner), lower-left or centre (of the part that "
        "is cut: the lines themselves, not the cutter's path), reference (the reference point), or a place "
        "X,Y on the sheet in mm.",
    ),
    renamed("--origin", "--zero"),
)


def trace_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of line, head, tool and program; hand it the `settings` and the `panel`."""

    @functools.wraps(verb)
    def with_settings(*args: Any, **options: Any) -> Any:
        ask, print_settings = options.pop("ask"), options.pop("print_settings")
        if ask and options["marks"] == "auto":
            options["marks"] = "on"
        settings = _settings(options)
        if print_settings:
            _print_settings(settings)
        return verb(*args, settings=settings, panel=attended.panel(asking=ask), **options)

    return given_all((*_LINE, *_HEAD, *_TOOL, *CUTTING, *DEPTHS, *_PROGRAM), with_settings)


def _settings(options: dict[str, Any]) -> TraceSettings:
    """The settings of the command line, taken out of all options; wrong use where two do not go together."""
    kerf_is_cutter(options)
    if options["cutter_mm"] is None and options["side"] is not None:
        raise click.UsageError(
            "--side is the side of the cutter; give its diameter with --cutter, such as 6mm"
        )
    options["side"] = options["side"] or "outside"

    starts_mm = options.pop("starts_mm")
    options["start_mm"] = starts_mm[0] if starts_mm else None
    options["more_starts_mm"] = tuple(starts_mm[1:])

    def of(kind: type[Any]) -> Any:
        return kind(**{field.name: options.pop(field.name) for field in fields(kind)})

    line, head, tool = of(LineSettings), of(HeadSettings), of(ToolSettings)
    made = depth_settings(options), contour_settings(options)
    return TraceSettings(line, head, tool, of(ProgramSettings), *made)


def _print_settings(settings: TraceSettings) -> NoReturn:
    """Print the settings of the head as a file that can be given again, and end."""
    from morfax.tracer.operator.settings_file import as_toml

    click.echo(as_toml(settings.of_head()), nl=False)
    raise click.exceptions.Exit
