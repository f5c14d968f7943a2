"""The claims are shown by commands: the command line's fixtures."""

from tests.console.conftest import here, morfax

__all__ = ["here", "morfax"]
