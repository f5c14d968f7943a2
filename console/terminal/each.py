"""Several drawings at the terminal: a row for each in one table, a line for each that fails, an exit code."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from morfax.console.terminal.sheet import show_sheet
from morfax.motion.faults import Fault, LineFault

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.trace_each import Outcome, TraceEachJob
    from morfax.tracer.operator.operator import Panel

SHOWN = ("drawing", "ending", "length_mm", "duration_s")  # of each drawing, in the table


def trace_each(job: TraceEachJob, desk: Desk, panel: Panel | None) -> None:
    """Trace, draw and print; ends with the exit code of the first drawing that failed."""
    rows, faults = list[dict[str, Any]](), list[Fault]()
    for outcome in job.each(desk, panel):
        rows.append(outcome.figures())
        _draw(outcome, desk)
        if outcome.fault is not None:
            faults.append(outcome.fault)
            click.echo(f"morfax: {outcome.job.drawing.file}: {outcome.fault}", err=True)
    if not desk.json:
        rows = [_shown(row) for row in rows]
    desk.figures({"traced": len(rows) - len(faults), "failed": len(faults), "drawings": rows})
    if faults:
        raise click.exceptions.Exit(faults[0].exit_code)


def _draw(outcome: Outcome, desk: Desk) -> None:
    """Draw the picture of one drawing, if one is asked for: its path, or the sheet without a line."""
    if outcome.result is not None and outcome.result.picture is not None:
        from morfax.reports.pictures import draw_traced

        draw_traced(outcome.result)
    picture = outcome.job.outputs.picture
    if outcome.result is None and isinstance(outcome.fault, LineFault) and picture is not None:
        show_sheet(outcome.job, outcome.fault, picture, desk)


def _shown(row: dict[str, Any]) -> dict[str, Any]:
    """A row of the table: what most want to know."""
    written = next(
        (row[key] for key in ("tape", "program", "drawn", "path") if key in row), None
    )
    failed = "failed" if "fault" in row and "ending" not in row else None
    return {
        **{key: row.get(key) for key in SHOWN},
        "ending": row.get("ending", failed),
        "written": written,
    }
