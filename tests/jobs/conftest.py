"""What the tests of jobs share with those of the command line: an empty folder, a path file, its tape."""

from tests.console.conftest import here, path_file, tape_file

__all__ = ["here", "path_file", "tape_file"]
