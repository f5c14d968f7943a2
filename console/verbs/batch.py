"""The verb `batch`: many drawings traced alike, each into a folder of its own."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.batch.job import BatchJob, cores
from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.files import FILE, ProgramPath
from morfax.console.options.groups import Verb, given, option
from morfax.console.options.placement import unit_options
from morfax.console.options.tracing import trace_options
from morfax.console.options.types import LIMIT, MEMORY
from morfax.console.terminal.counted import count_all

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.tracer.operator.operator import Panel

SOME_FAILED = 1
EXAMPLES = """\b
Examples:
  morfax batch scans/ -o traced
  morfax batch scans/ -o traced --glob '**/*.tif' --lines contours --limit 300s
  morfax batch --report traced
  morfax batch s3://archive/scans -o s3://archive/traced --scheduler tcp://host:8786
"""


@click.command("batch", cls=Verb, epilog=EXAMPLES)
@click.argument("drawings", required=False)
@option(
    "Output",
    "-o",
    "out",
    metavar="FOLDER",
    help="Folder for the results; it is made. With --scheduler also an address, such as s3://bucket/out.",
)
@option(
    "Output",
    "--program",
    type=ProgramPath(),
    default="program.ngc",
    show_default=True,
    help="Name of the program in each drawing's folder; its suffix says the medium, as of trace -o.",
)
@option(
    "Output",
    "--force",
    is_flag=True,
    help="Trace drawings again whose results are there already.",
)
@option(
    "Output",
    "--report",
    type=FILE,
    metavar="FOLDER",
    help="Write the page of a batch, FOLDER/report.html, and do nothing else: all drawings in small, those "
    "that need a person's eye first.",
)
@option(
    "Batch",
    "--glob",
    "pattern",
    help="Which files of the folder, such as '**/*.tif'.  [default: all drawings in it and below]",
)
@option(
    "Batch",
    "--jobs",
    type=click.IntRange(1, 1024),
    help="Drawings at the same time, each on one core.  [default: the number of cores]",
)
@option(
    "Batch",
    "--limit",
    "limit_s",
    type=LIMIT,
    default="120s",
    show_default=True,
    help="How long one drawing may take; one that takes longer is stopped and marked.",
)
@option(
    "Batch",
    "--memory",
    "memory_bytes",
    type=MEMORY,
    default="2GB",
    show_default=True,
    help="How much memory one drawing may take (Linux).",
)
@option(
    "Batch",
    "--scheduler",
    metavar="ADDRESS",
    help="Have a Dask cluster trace, such as tcp://host:8786; it has its own limits.  [default: this "
    "computer]",
)
@drawing_options("drawings")
@trace_options
@unit_options
@desk_options
@click.pass_context
def command(
    ctx: click.Context,
    drawings: DrawingFile,
    out: str | None,
    report: FilePath | None,
    settings: TraceSettings,
    unit: RecordingUnit,
    desk: Desk,
    panel: Panel | None,
    **how: Any,
) -> None:
    """Trace all drawings of a folder, each into a folder of its own.

    DRAWINGS is a folder. Each drawing's results are in a folder of its name and a hash of its content, the
    settings and the version: path.csv, the program, picture.png, figures.json. Results that are there already
    are not made again, so an interrupted batch goes on where it stopped. A drawing that fails, hangs or
    crashes does not stop the others. manifest.jsonl gets a line for each drawing as it ends. Exit code 1:
    some failed.
    """
    named: Any = drawings.file  # as it was given: an address is no path
    where = None if named is None else str(named)
    if report is not None:
        _write_report(report, where, out, desk)
        return
    job = _job(where, out, drawings, settings, unit, how)
    job.check()

    from morfax.batch.manifest import NAME as MANIFEST
    from morfax.batch.tally import Tally

    total = None if job.scheduler is not None else sum(1 for _ in job.names())
    tally = Tally(total, job.limits.workers)
    count_all(job.rows(desk), tally, desk)
    desk.figures({**tally.figures(), "manifest": str(job.folder / MANIFEST)})
    if job.scheduler is None:
        page = shlex.join(["morfax", "batch", "--report", out or ""])
        desk.note(f"{page} shows all drawings on a page, those that need a person's eye first")
    ctx.exit(SOME_FAILED if tally.failed else 0)


def _job(
    where: str | None,
    out: str | None,
    drawings: DrawingFile,
    settings: TraceSettings,
    unit: RecordingUnit,
    how: dict[str, Any],
) -> BatchJob:
    """The job of the options; wrong use where two do not go together."""
    from morfax.batch.crew import WorkerLimits
    from morfax.batch.order import Order

    if where is None or out is None:
        raise click.UsageError(
            "give a folder of drawings, and a folder for the results with -o"
        )
    if given("ask"):
        raise click.UsageError(
            "--ask asks at every stop, and a batch asks nobody; leave it out"
        )
    if how["scheduler"] is not None and (
        given("limit_s") or given("memory_bytes") or given("jobs")
    ):
        raise click.UsageError(
            "--jobs, --limit and --memory are for workers of this computer; a cluster has its own"
        )
    order = Order(
        replace(drawings, file=FilePath()),
        settings,
        unit,
        FilePath(how["program"].name),
        how["force"],
    )
    limits = WorkerLimits(how["jobs"] or cores(), how["limit_s"], int(how["memory_bytes"]))
    return BatchJob(where, out, order, how["pattern"], limits, how["scheduler"])


def _write_report(folder: FilePath, where: str | None, out: str | None, desk: Desk) -> None:
    """Write the page of a batch that was done."""
    from morfax.batch.page import write_page

    if where is not None or out is not None:
        raise click.UsageError("--report makes the page of a folder; give it alone")
    page, drawings = write_page(folder)
    desk.figures({"report": str(page), "drawings": drawings})
