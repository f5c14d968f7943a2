"""The operator's desk: what a verb tells while it works and when it has done.

Figures go to stdout, as text or as JSON; notes, details and progress bars to stderr. A bar shows on a
terminal only.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from morfax.console.terminal import kernels
from morfax.reports import table

if TYPE_CHECKING:
    from morfax.motion.motion import Motion

Advance = Callable[[float], None]


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

    def figures(self, figures: table.Figures) -> None:
        """Print the result on stdout."""
        click.echo(table.as_json(figures) if self.json else table.as_text(figures))

    def warn_of_compiling(self, what: str, *packages: str) -> None:
        """Say that the first run takes longer, if it will."""
        if kernels.are_cold(packages) and not kernels.told(packages):
            self.note(f"compiling {what} (first run only, some ten seconds) ...")

    @contextmanager
    def bar(self, what: str, total: float) -> Iterator[Advance]:
        """Show how far a piece of work has come; gives the function to tell it, in the unit of `total`."""
        if self.quiet or not sys.stderr.isatty():
            yield lambda done: None
            return
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.percentage:3.0f} %"),
        )
        with Progress(
            *columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True
        ) as progress:
            task = progress.add_task(what, total=total)
            yield lambda done: progress.update(task, completed=done)

    def watched(self, stream: Iterable[Motion], what: str, total_s: float) -> Iterator[Motion]:
        """Pass a stream of motion on, with a bar for its time."""
        done_s = 0.0
        with self.bar(what, total_s) as advance:
            for block in stream:
                yield block
                done_s += block.duration_s
                advance(done_s)


def desk_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb --quiet, --verbose and --json, and hand it the `desk`."""

    @click.option(
        "-q",
        "--quiet",
        is_flag=True,
        help="No notes and no progress bar; faults are still told.",
    )
    @click.option("-v", "--verbose", is_flag=True, help="Tell more on stderr.")
    @click.option(
        "--json",
        is_flag=True,
        help="Print the figures on stdout as one JSON object, units in the keys.",
    )
    @functools.wraps(verb)
    def with_desk(*args: Any, quiet: bool, verbose: bool, json: bool, **options: Any) -> Any:
        return verb(*args, desk=Desk(quiet, verbose, json), **options)

    return with_desk
