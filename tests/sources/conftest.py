"""Fixtures of the sources' tests: claims are shown by commands, and by the sheet of the Morfax patent."""

from tests.console.conftest import here, morfax
from tests.sources.drawn_tape import run, sheet, tape

__all__ = ["here", "morfax", "run", "sheet", "tape"]
