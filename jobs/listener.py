"""The Listener: what a job says while it works, and to whom.

A job tells how far a piece of work is and what is worth a word; the face that started it shows this on a
terminal, sends it to a page or writes it down. Whoever listens may raise KeyboardInterrupt: it passes through
the job, which removes its unfinished files.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from morfax.motion.motion import Motion

Advance = Callable[
    [float], None
]  # how much of a piece of work is done, in the unit of its total


class Listener(Protocol):
    """Whoever hears what a job does."""

    def progress(self, what: str, total: float) -> AbstractContextManager[Advance]:
        """Begin a named piece of work; the function that it gives hears how much of `total` is done."""

    def note(self, text: str) -> None:
        """Hear what is worth a line."""

    def detail(self, text: str) -> None:
        """Hear what only some want to know."""

    def warning(self, text: str) -> None:
        """Hear what may not be meant so, with what to do about it."""

    def compiling(self, what: str, packages: tuple[str, ...]) -> None:
        """Hear that kernels of these packages will run; those that are not kept are compiled first."""


class Silent:
    """A listener that says nothing."""

    def progress(self, what: str, total: float) -> AbstractContextManager[Advance]:
        """Pass over how far the work is."""
        return nullcontext(_pass_over)

    def note(self, text: str) -> None:
        """Pass over a note."""

    def detail(self, text: str) -> None:
        """Pass over a detail."""

    def warning(self, text: str) -> None:
        """Pass over a warning."""

    def compiling(self, what: str, packages: tuple[str, ...]) -> None:
        """Pass over kernels that are compiled."""


SILENT = Silent()


def watched(
    stream: Iterable[Motion], listener: Listener, what: str, total_s: float
) -> Iterator[Motion]:
    """Pass a stream of motion on, and tell the listener how many of its seconds have passed."""
    done_s = 0.0
    with listener.progress(what, total_s) as advance:
        for block in stream:
            yield block
            done_s += block.duration_s
            advance(min(done_s, total_s))  # of a program the total is about right only


def never_back(advance: Advance) -> Callable[[float, float], None]:
    """Who hears how far the head has come of a length, mm, and tells the share, never less than before: what
    is looked at before the head runs counts, too.
    """
    most = 0.0

    def tell(come_mm: float, all_mm: float) -> None:
        nonlocal most
        most = max(most, come_mm / all_mm)
        advance(most)

    return tell


def _pass_over(done: float) -> None:
    """Say nothing of work that is done."""
