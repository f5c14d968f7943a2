"""Endings: what is to be done once a piece of work is over, whether it went well or not.

Signals in: the error that ended the work, or None. Signals out: files closed, devices given back, or a fault.

Source: the context managers of Python, whose `__exit__` takes the error in three parts. Questions: none.
"""

from __future__ import annotations

from types import TracebackType
from typing import Protocol, Self


class Ending(Protocol):
    """Something for a `with` that gives itself, and whose `end` is called when that is left."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self.end(error)

    def end(self, error: BaseException | None) -> None:
        """Do what is to be done; `error` is what ended the work, None if it went well."""
        raise NotImplementedError
