"""The verb `lines`: what is on a drawing, before anything is traced."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.files import FILE, PICTURES, Result
from morfax.console.options.groups import Verb, option
from morfax.console.options.tracing import GAP, LINE_WIDTH
from morfax.jobs.lines import LinesJob
from morfax.jobs.settings.line_settings import LineSettings

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.settings.drawing_file import DrawingFile

EXAMPLES = """\b
Examples:
  morfax lines samples/bracket.png
  morfax lines scan.png --width 210mm --picture numbers.png
  morfax lines plan.png --follow --json
  morfax lines plan.png --lines all --edge
"""


@click.command("lines", cls=Verb, epilog=EXAMPLES)
@click.argument("drawing", type=FILE)
@option(
    "Line",
    "--follow",
    is_flag=True,
    help="Follow all lines first (slower): lines that cross or touch then have a number each.",
)
@option(
    "Line",
    "--lines",
    type=click.Choice(["all"]),
    help="With --edge, what trace --lines all --edge takes: the lines without the solid areas among them, and"
    " these areas.",
)
@LINE_WIDTH
@GAP
@option(
    "Output",
    "--picture",
    type=Result(*PICTURES),
    help="Draw the sheet with the numbers, each line in a colour (.png, .svg, .pdf).",
)
@drawing_options("drawing")
@desk_options
def command(
    drawing: DrawingFile,
    follow: bool,
    lines: Literal["all"] | None,
    line_width_mm: float | None,
    gap_mm: float | None,
    picture: FilePath | None,
    desk: Desk,
) -> None:
    """List what is on a drawing: a numbered table of its lines, dots and likely lettering.

    Nothing is traced. `morfax trace --lines 1,3` takes these numbers, if it has the same options for the
    drawing and the line. First come lines that stand apart, the longest first, then dots, then, with
    --follow, the other lines of those that cross or touch. With --edge --lines all the numbers are valid in
    this table only.

    Notes say what --lines contours leaves out, and what is wrong with the scale, if anything is.
    """
    if lines is not None and not drawing.edge:
        raise click.UsageError(
            "--lines all is for --edge here; without --edge the table has all lines in any case"
        )
    line = LineSettings(lines=lines, line_width_mm=line_width_mm, gap_mm=gap_mm)
    result = LinesJob(drawing, line, follow, picture).run(desk)
    if result.picture is not None:
        from morfax.reports.numbered import draw_numbered

        draw_numbered(result)
    desk.figures(result.figures)
