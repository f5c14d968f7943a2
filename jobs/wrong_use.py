"""Wrong use: settings of a job that do not go together, or that a machine does not have."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class WrongUse(ValueError):
    """A job that cannot be done as it is set; the message names the setting and says what to do."""


@contextmanager
def settings_checked() -> Iterator[None]:
    """Have a plain ValueError come out as wrong use."""
    try:
        yield
    except ValueError as refused:
        if type(refused) is not ValueError:  # a fault, or another mistake
            raise
        raise WrongUse(str(refused)) from None
