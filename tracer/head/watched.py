"""The window on the head: whoever watches the head at work.

Signals in: what the carriage does: put down at a place, moved over positions (n, 2) mm at the motion rate,
and what the follower says of it in words. Signals out: the same, to the watcher, if there is one.

The head does not know who watches. A watcher may hold the head up by not returning, and end the run by
raising KeyboardInterrupt, which passes through the head as it does through a job.

Source: our own; the patent's operator stands beside the head and sees it. Questions: a run is watched in the
thread in which `watching` was entered, and in no other.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Protocol

from morfax.motion.held import held

if TYPE_CHECKING:
    from morfax.motion.arrays import Array
    from morfax.tracer.head.carriage import Carriage


class Watcher(Protocol):
    """Whoever sees what the head does."""

    def put_down(self, carriage: Carriage) -> None:
        """See the head put down at the beginning of a run; each attempt is a run of its own."""

    def taken_up(self, carriage: Carriage) -> None:
        """See the head go on from where an earlier run had come; its positions are the carriage's."""

    def moved(self, carriage: Carriage, positions: Array) -> None:
        """See the head run over positions (n, 2) mm, enlarged as the head sees them."""

    def says(self, what: str) -> None:
        """Hear in words what the head does now."""


_WATCHER: ContextVar[Watcher | None] = ContextVar("watcher", default=None)


def watcher() -> Watcher | None:
    """Whoever watches now; None if nobody does."""
    return _WATCHER.get()


def watching(who: Watcher) -> AbstractContextManager[None]:
    """Have the heads that are put down from here on watched."""
    return held(_WATCHER, who)
