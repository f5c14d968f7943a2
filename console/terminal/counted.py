"""A batch at the terminal: drawings done and failed, a minute, and the time that is left.

On a terminal the line is written anew as it changes; elsewhere, such as in a log, once a minute. A drawing
that failed has a line of its own above it.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Generator
from contextlib import closing
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from morfax.batch.row import BatchRow
    from morfax.batch.tally import Tally
    from morfax.console.terminal.desk import Desk

EVERY_S = {True: 0.2, False: 60.0}  # on a terminal, and elsewhere
CLEAR = "\r\x1b[K"  # back to the beginning of the line, and clear it


def count_all(rows: Generator[BatchRow, None, None], tally: Tally, desk: Desk) -> None:
    """Count rows as they come; name each drawing that failed now, and say how far the batch is."""
    live = sys.stderr.isatty() and not desk.quiet
    first = dict[str, str]()  # the first drawing with each fault
    said_s, clear = (0.0, CLEAR) if live else (time.monotonic(), "")
    with closing(rows):  # whatever happens ends the drawings that run
        for row in rows:
            tally.count(row)
            if not (row.is_well or row.kept):
                click.echo(f"{clear}morfax: {_why(row, first)}", err=True)
            now_s = time.monotonic()
            if not desk.quiet and now_s - said_s >= EVERY_S[live]:
                said_s = now_s
                click.echo(f"{clear}{told(tally)}", nl=not live, err=True)
    if live:
        click.echo(CLEAR, nl=False, err=True)


def _why(row: BatchRow, first: dict[str, str]) -> str:
    """Why a drawing failed; of a fault that was told, whose it was."""
    why = f"{row.ending}: {row.fault.removeprefix(row.file).strip()}"
    told = first.setdefault(why, row.file)
    return f"{row.file}: {why}" if told == row.file else f"{row.file}: {row.ending}, as {told}"


def told(tally: Tally) -> str:
    """How far a batch is, in one line."""
    of = "" if tally.total is None else f" of {tally.total}"
    left = "" if tally.left_s is None else f", {_time(tally.left_s)} left"
    failed = f", {tally.failed} failed" if tally.failed else ""
    return f"{tally.ended}{of} drawings{failed}, {tally.per_minute:.0f} a minute{left}"


def _time(seconds: float) -> str:
    """A time that nobody needs exactly."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = seconds / 60
    return f"{minutes:.0f} min" if minutes < 90 else f"{minutes / 60:.1f} h"
