"""The operator's desk: the Listener of a terminal, which also prints the figures of a result.

Figures go to stdout, as JSON, or as text unless quiet; notes, details and progress bars to stderr. A bar
shows on a terminal only.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import click

from morfax.jobs import kernels
from morfax.jobs.figures import Figures
from morfax.jobs.listener import Advance
from morfax.reports import table


@dataclass(frozen=True, slots=True)
class Desk:
    """How much the operator wants to hear."""

    quiet: bool = False
    verbose: bool = False
    json: bool = False

    def note(self, text: str) -> None:
        """Say a line on stderr, unless quiet."""
        if not self.quiet:
            click.echo(text, err=True)

    def detail(self, text: str) -> None:
        """Say a line on stderr that only --verbose asks for."""
        if self.verbose and not self.quiet:
            click.echo(text, err=True)

    def figures(self, figures: Figures, *, aside: bool = False) -> None:
        """Print the result on stdout; unless quiet, or where JSON is asked for.

        `aside`: on stderr, as the result itself takes stdout.
        """
        if self.json or not self.quiet:
            said = table.as_json(figures) if self.json else table.as_text(figures)
            click.echo(said, err=aside)

    def warning(self, text: str) -> None:
        """Say a line on stderr, quiet or not: what was written may be wrong."""
        click.echo(text, err=True)

    def compiling(self, what: str, packages: tuple[str, ...]) -> None:
        """Say that the first run takes longer, if it will."""
        kernels.announce(what, self.note)

    @contextmanager
    def progress(self, what: str, total: float) -> Iterator[Advance]:
        """Show how far a piece of work is; the function that it gives hears how much of `total` is done."""
        if self.quiet or not sys.stderr.isatty():
            yield lambda done: None
            return
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            Progress,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.percentage:3.0f} %"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
            task = progress.add_task(what, total=total)
            yield lambda done: progress.update(task, completed=done)
