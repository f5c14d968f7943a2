"""The sheet shown where the head found no line, so that a place to start can be read off it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.media.files import incomplete
from morfax.motion.faults import LineFault

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.run import RunJob
    from morfax.jobs.trace import TraceJob


@contextmanager
def sheet_shown(job: TraceJob | RunJob, picture: FilePath | None, desk: Desk) -> Iterator[None]:
    """Draw the sheet where a job ends with no line to follow, if a name for a picture is given."""
    try:
        yield
    except LineFault as fault:
        if picture is not None:
            show_sheet(job, fault, picture, desk)
        raise


def show_sheet(job: TraceJob | RunJob, fault: LineFault, picture: FilePath, desk: Desk) -> None:
    """Draw the sheet with the place at which a job found no line."""
    from morfax.reports.pictures import draw_start

    file, start_mm = incomplete(picture), job.settings.line.start_mm
    if fault.nearest_mm is not None and fault.x_mm is not None and fault.y_mm is not None:
        start_mm = (fault.x_mm, fault.y_mm)
    draw_start(job.drawing, start_mm, fault, file)
    desk.note(f"the sheet is drawn in {file}; read a place for --start off its axes")
