"""The verb `trace`: a drawing becomes a tape."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.files import FILE, PATHS, PICTURES, ProgramOrFolder, Result
from morfax.console.options.groups import Verb, option
from morfax.console.options.placement import unit_options
from morfax.console.options.tracing import trace_options
from morfax.console.terminal.sheet import sheet_shown
from morfax.jobs.trace import NAME, TraceJob, TraceOutputs

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.operator.operator import Panel

EXAMPLES = """\b
Examples:
  morfax trace samples/cam.png
  morfax trace scan.png --width 120mm --start 40,62 -o cam.wav --path cam.csv
  morfax trace samples/bracket.png --lines contours --picture bracket-lines.png
  morfax trace scans/*.png --width 210mm --lines contours -o parts/{}.ngc
"""


@click.command("trace", cls=Verb, epilog=EXAMPLES)
@click.argument("drawings", metavar="DRAWING...", type=FILE, nargs=-1, required=True)
@option(
    "Output",
    "-o",
    "output",
    type=ProgramOrFolder(*PATHS),
    help="The tape (.wav), another program (.steps, .cubic, .ngc), or a path file only (.csv). Of several "
    "drawings: a folder for the tapes, or a name with {} for the drawing's, such as parts/{}.ngc.  [default: "
    "the drawing's name with .wav, in this folder]",
)
@option(
    "Output",
    "--path",
    "path_file",
    type=Result(*PATHS),
    help="Write the head's path as well (.csv).",
)
@option(
    "Output",
    "--picture",
    type=Result(*PICTURES),
    help="Draw the path over the drawing (.png, .svg, .pdf); of a photograph made flat, part.png, also what "
    "was found in it, part.flat.png.",
)
@option(
    "Output",
    "--force",
    is_flag=True,
    help="Without -o: write over a tape that is there already.",
)
@drawing_options("drawings")
@trace_options
@unit_options
@desk_options
def command(
    drawings: tuple[DrawingFile, ...],
    output: FilePath | None,
    path_file: FilePath | None,
    picture: FilePath | None,
    force: bool,
    settings: TraceSettings,
    panel: Panel | None,
    unit: RecordingUnit,
    desk: Desk,
) -> None:
    """Follow the lines of a drawing and write a program: a tape, G-code, DXF and others.

    DRAWING is a scan or photo (PNG, JPEG, TIFF, HEIC, …) or a PDF. The head follows a closed line until it
    closes, an open one from end to end. If it loses the line, what it traced before is kept, with
    `.incomplete` in the names; of several lines (--lines) the others are cut all the same.

    --picture shows the drawing with the path and the numbers of the lines; if the head finds no line to start
    on, it shows the sheet, so that you can read a place for --start. Program and path are mirrored, scaled
    and turned as the options say; the picture is not.

    Several drawings are traced with the same options, each to results of its own name. A drawing that fails
    does not stop the others.
    """
    outputs = TraceOutputs(output, path_file, picture, force)
    names = [str(name) for name in (output, path_file, picture) if name is not None]
    if len(drawings) > 1 or any(NAME in name for name in names) or (output and output.is_dir()):
        from morfax.console.terminal.each import trace_each
        from morfax.jobs.trace_each import TraceEachJob

        trace_each(TraceEachJob(drawings, outputs, settings, unit), desk, panel)
        return
    job = TraceJob(drawings[0], outputs, settings, unit)
    with sheet_shown(job, picture, desk):
        result = job.run(desk, panel)
    if result.picture is not None:
        from morfax.reports.pictures import draw_traced

        draw_traced(result)
    desk.figures(result.figures)
    if result.fault is not None:
        raise result.fault
