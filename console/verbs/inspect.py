"""The verb `inspect`: what is on a tape, or in another program."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import FILE, Result
from morfax.console.options.groups import Verb, option, renamed
from morfax.console.options.tape import FOR_MACHINE, tape_options
from morfax.jobs.inspect import InspectJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.playing import ByHand

EXAMPLES = """\b
Examples:
  morfax inspect cam.wav
  morfax inspect found.wav --reference-frequency 6kHz --cycles-per-mm 20
  morfax inspect cam.wav --json
  morfax inspect cam.steps --picture cam-tape.svg
"""


@click.command("inspect", cls=Verb, epilog=EXAMPLES)
@click.argument("tape", type=FILE)
@option(
    "Output",
    "--picture",
    type=Result(".png", ".svg"),
    help="Draw the punched tape of a .steps program (.png, .svg).",
)
@renamed("-o", "--picture")
@FOR_MACHINE
@tape_options
@desk_options
def command(tape: FilePath, picture: FilePath | None, by_hand: ByHand, desk: Desk) -> None:
    """Say what is in a program: of a tape its tracks, carriers, levels, travel, format.

    If a tape cannot be played, the figures hold what can be known, and the fault says why. Of a program in
    another medium (.steps, .cubic, .ngc) the figures hold its format and what it does.

    `duration` is what the simulated machine takes; of G-code `machine duration` is what the machine takes
    that it is for, as `morfax check` says it.
    """
    result = InspectJob(tape, by_hand, picture).run(desk)
    figures = dict(result.figures)
    if picture is not None:
        from morfax.reports.pictures import draw_punched

        figures |= {"picture": str(picture), "rows_shown": draw_punched(tape, picture)}
    desk.figures(figures)
    if result.fault is not None:
        raise result.fault
