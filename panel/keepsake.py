"""The keepsake: one file of HTML with the result in it, which opens without a server or a network."""

from __future__ import annotations

from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.panel.bench import Bench


def write(bench: Bench) -> None:
    """Write the page of the last result; raises WrongUse if there is none."""
    raise WrongUse("there is no result yet; run first")
