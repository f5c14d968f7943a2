"""The verb `check`: whether a machine may be started with a program."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import FILE, PICTURES, Result, machine_names
from morfax.console.options.groups import Verb, given, option
from morfax.console.options.types import PLACE, REACH, STOCK
from morfax.jobs.check import CheckJob, CheckResult

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.player.gcode.check.motion_rules import Stock

MAY_NOT_START = 1
SHOWN = 40  # findings in the text; --json has all of them
EXAMPLES = """\b
Examples:
  morfax check part.nc --machine grbl-router
  morfax check part.ngc --stock 200x100x18mm --through 0.3mm --picture part.png
  morfax check part.nc --machine my.toml --json
"""


@click.command("check", cls=Verb, epilog=EXAMPLES)
@click.argument("program", type=FILE)
@option(
    "Machine",
    "--machine",
    metavar="MACHINE",
    shell_complete=machine_names,
    help="The machine that will run the program: a name that `morfax machines` lists, or a .toml file of "
    "your own.  [default: the one that the program names, or linuxcnc]",
)
@option(
    "Machine",
    "--stock",
    type=STOCK,
    help="The material, width x height x thickness (or without thickness): work beside or below it is "
    "a finding.",
)
@option(
    "Machine",
    "--stock-at",
    type=PLACE,
    default="0,0",
    show_default=True,
    help="Where the stock's lower left corner lies, from the program's zero.",
)
@option(
    "Machine",
    "--surface",
    type=REACH,
    default="0mm",
    show_default=True,
    help="Z of the upper face of the work: 18mm if Z0 is on the table below a board of 18 mm.",
)
@option(
    "Machine",
    "--through",
    type=REACH,
    default="0mm",
    show_default=True,
    help="How far below the stock the tool may go.",
)
@option(
    "Output",
    "--picture",
    type=Result(*PICTURES),
    help="Draw rapids, plunges, cuts and their direction, with the findings marked (.png, .svg, .pdf).",
)
@desk_options
@click.pass_context
def command(
    ctx: click.Context,
    program: FilePath,
    machine: str | None,
    picture: FilePath | None,
    desk: Desk,
    **work: Any,
) -> None:
    """Say whether a machine may be started with a program, and what the program does.

    G-code of any origin is read as the machine's control reads it: words that it does not take, arcs that
    do not close, a missing feed, rapids through the work, cuts with the tool off, work beyond the stock
    or the machine's travel. Every finding has its line. Exit code 1: do not start the machine.
    """
    result = CheckJob(program, machine, _stock(work), picture).run(desk)
    if picture is not None:
        from morfax.reports.checked import draw_checked

        draw_checked(result, program.name, picture)
    _show(result, picture, desk)
    ctx.exit(0 if result.may_start else MAY_NOT_START)


def _stock(work: dict[str, Any]) -> Stock:
    """The stock that the options describe; without a size it has no sides."""
    from morfax.player.gcode.check.motion_rules import Stock

    surface_mm, through_mm = work["surface"], work["through"]
    if work["stock"] is None:
        if given("stock_at") or given("through"):
            raise click.UsageError(
                "--stock-at and --through are of a stock; give --stock as well"
            )
        return Stock(surface_mm=surface_mm)
    width_mm, height_mm, thickness_mm = work["stock"]
    size = width_mm, height_mm, thickness_mm
    return Stock(*size, work["stock_at"], surface_mm, through_mm)


def _show(result: CheckResult, picture: FilePath | None, desk: Desk) -> None:
    """Print figures, then findings, a line for each."""
    figures = dict(result.figures)
    if picture is not None:
        figures["picture"] = str(picture)
    if desk.json:
        desk.figures(figures)
        return
    figures.pop("findings")
    desk.figures(figures)
    findings = sorted(result.checked.findings, key=lambda each: not each.stops)
    if desk.quiet:
        findings = [finding for finding in findings if finding.stops]
    for finding in findings[:SHOWN]:
        click.echo(("" if finding.stops else "remark: ") + finding.text)
    if len(findings) > SHOWN:
        click.echo(f"{len(findings) - SHOWN} more findings; --json lists all of them")
