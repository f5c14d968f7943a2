"""Files on the command line: those put in, and names for results, whose suffix says what is written."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import click

from morfax.motion.files import printable


class FileName(click.Path):
    """The name of a file that is put in."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """The name as a path; wrong use for one that no system has."""
        if "\0" in str(value):
            self.fail(NO_NAME.format(printable(str(value)).replace("\0", "\\0")), param, ctx)
        return super().convert(value, param, ctx)


NO_NAME = "{} is no name of a file: it holds a byte of 0"
FILE = FileName(path_type=FilePath)

PICTURES = (".png", ".svg", ".pdf")
PATHS = (".csv",)


def machine_names(
    ctx: click.Context, param: click.Parameter, incomplete: str
) -> list[click.shell_completion.CompletionItem]:
    """Have the shell complete the machines of that beginning; a file, if there is none."""
    from click.shell_completion import CompletionItem

    from morfax.recorder.gcode.machine import names

    found = [CompletionItem(name) for name in names() if name.startswith(incomplete)]
    return found or [CompletionItem(incomplete, type="file")]


class Result(click.ParamType):
    """The name for a result, which ends in one of some suffixes."""

    name = "file"

    def __init__(self, *suffixes: str) -> None:
        self.suffixes = tuple(dict.fromkeys(suffixes))  # some kinds of result share a suffix

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> FilePath:
        """The name as a path; wrong use if its suffix is another one."""
        if "\0" in str(value):
            self.fail(NO_NAME.format(printable(str(value)).replace("\0", "\\0")), param, ctx)
        file = FilePath(value)
        if file.suffix.lower() not in self.suffixes:
            self.fail(f"{str(file)!r} must end in {', '.join(self.suffixes)}", param, ctx)
        return file

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[click.shell_completion.CompletionItem]:
        """Have the shell complete names of files."""
        from click.shell_completion import CompletionItem

        return [CompletionItem(incomplete, type="file")]


class Report(Result):
    """The name for a report; a picture is refused with the option that draws it."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> FilePath:
        """The name as a path; wrong use if it is no report's."""
        if FilePath(value).suffix.lower() in PICTURES:
            self.fail(f"{str(value)!r} is a picture; give it with --picture", param, ctx)
        return super().convert(value, param, ctx)


class ProgramPath(Result):
    """The name for a program or a drawing, which says its medium; or for one of some other results."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> FilePath:
        """The name as a path; wrong use if its suffix is that of no medium."""
        from morfax.recorder.media import DRAWINGS, MEDIA

        return Result(*MEDIA, *DRAWINGS, *self.suffixes).convert(value, param, ctx)


class ProgramOrPipe(ProgramPath):
    """The name for a program or a drawing, or `-`, a pipe for a tape."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> FilePath:
        """The name as a path; wrong use if it is neither."""
        return FilePath(value) if str(value) == "-" else super().convert(value, param, ctx)


class ProgramOrFolder(ProgramPath):
    """The name for a program or a drawing, or a folder that is there."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> FilePath:
        """The name as a path; wrong use if it is neither."""
        file = FilePath(value)
        return file if file.is_dir() else super().convert(value, param, ctx)
