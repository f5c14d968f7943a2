"""The verb `sheet`: a sheet with marks, to be printed."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import Result
from morfax.console.options.groups import Verb, option
from morfax.jobs.sheet import SheetJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk

EXAMPLES = """\b
Examples:
  morfax sheet -o sheet.pdf
  morfax sheet -o sheet-letter.pdf --paper letter
  morfax sheet -o plain.pdf --paper a3 --no-grid
"""


@click.command("sheet", cls=Verb, epilog=EXAMPLES)
@option(
    "Output",
    "-o",
    "output",
    type=Result(".pdf", ".svg", ".png"),
    required=True,
    help="The sheet (.pdf, .svg, or .png of 600 dpi).",
)
@option(
    "Drawing",
    "--paper",
    default="a4",
    show_default=True,
    metavar="FORMAT",
    help="Format of the paper: a4, letter or a3.",
)
@option(
    "Drawing",
    "--grid/--no-grid",
    default=True,
    help="A faint cyan grid of 10 mm, which the head takes for paper; without one for printers without "
    "colour.  [default: with a grid]",
)
@desk_options
def command(output: FilePath, paper: str, grid: bool, desk: Desk) -> None:
    """Make a sheet with marks to print, draw on and photograph.

    Print it at 100 % and measure its bar. Draw inside the marks, photograph the whole sheet, and trace the
    photograph: --flatten marks makes it flat and to scale.
    """
    from morfax.reports.marked_sheet import write_sheet

    result = SheetJob(output, paper.strip().lower(), grid).run()
    write_sheet(result.layout, result.file, grid=result.grid)
    desk.figures(result.figures)
