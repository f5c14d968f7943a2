"""A value that is held for a while: who runs in the block finds it in its variable, in that thread only."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

T = TypeVar("T")


@contextmanager
def held(variable: ContextVar[T], value: T) -> Iterator[None]:
    """Have a variable hold a value, and afterwards what it held before."""
    before = variable.set(value)
    try:
        yield
    finally:
        variable.reset(before)
