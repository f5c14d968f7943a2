"""The verb `run`: the whole way from the drawing to the machine, and how well all three agree."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.files import FILE
from morfax.console.options.groups import Verb, option
from morfax.console.options.placement import unit_options
from morfax.console.options.tracing import trace_options
from morfax.console.terminal.sheet import sheet_shown
from morfax.jobs.run import RunJob, RunResult

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.operator.operator import Panel

EXAMPLES = """\b
Examples:
  morfax run samples/cam.png -o demo
  morfax run scan.png --width 120mm --start 40,62 -o cam
"""


@click.command("run", cls=Verb, epilog=EXAMPLES)
@click.argument("drawing", type=FILE)
@option(
    "Output",
    "-o",
    "folder",
    type=FILE,
    help="Folder for the results; it is made.  [default: the drawing's name, here]",
)
@drawing_options("drawing")
@trace_options
@unit_options
@desk_options
def command(
    drawing: DrawingFile,
    folder: FilePath | None,
    settings: TraceSettings,
    panel: Panel | None,
    unit: RecordingUnit,
    desk: Desk,
) -> None:
    """Go the whole way: trace a drawing, play the program, compare all three.

    The folder then holds the tape (.wav), or with --machine the program for that machine, the traced and the
    played path (.csv), the picture of the played path with its error in colour (.png) and the figures
    (.json). Files of these names are written over. If --mirror, --scale or --turn changes the program, the
    comparison with the drawing undoes the change.
    """
    run_and_show(RunJob(drawing, folder, settings, unit), desk, panel)


def run_and_show(job: RunJob, desk: Desk, panel: Panel | None = None) -> RunResult:
    """Run the job, draw and print; raises the faults that the result has."""
    with sheet_shown(job, job.file(".png"), desk):
        result = job.run(desk, panel)
    from morfax.reports.pictures import draw_run, write_figures

    draw_run(result)
    write_figures(result)
    desk.figures(result.figures)
    for fault in result.faults:
        raise fault
    return result
