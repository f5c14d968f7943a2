"""Files of the operator's own that options name: a card, settings of the head, a machine.

Signals in: a name and a text (TOML) from a page, and what it is to be, or "any". Signals out: a file in the
panel's folder `own`, under a harmless name, there only if the command line takes it as a card, as settings or
as a machine; and options whose names of such files have become paths.

Questions: a file that fits several is taken for the first of card, settings, machine.
"""

from __future__ import annotations

import re
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault, Fault
from morfax.motion.files import written_beside
from morfax.motion.toml_fields import LARGEST_BYTES
from morfax.panel import commands
from morfax.panel.uploads import LONGEST_NAME, harmless_text, unused

if TYPE_CHECKING:
    from morfax.panel.commands import CommandLine, Options

MOST_BYTES = LARGEST_BYTES
SUFFIX = ".toml"
CALLED = {
    "--card": "card",
    "--settings": "file of settings",
    "--machine": "machine",
}


def own_files(folder: FilePath) -> dict[str, FilePath]:
    """The files that pages have given to a panel's folder, by name."""
    every = sorted((folder / "own").glob(f"[!.]*{SUFFIX}"))
    return {file.name: file for file in every if file.is_file()}


def as_paths(options: Options, own: dict[str, FilePath]) -> Options:
    """The options with the paths of the operator's own files in place of their names."""
    return {
        name: str(own[value])
        if name in commands.OWN_FILES and isinstance(value, str) and value in own
        else value
        for name, value in options.items()
    }


def take(
    folder: FilePath, name: str, content: bytes, option: str, command_line: CommandLine
) -> tuple[str, FilePath]:
    """Keep a file as what an option takes ("any": the first that fits); the option, and the file.

    Raises CardFault, or what the command line raises, if it is none; nothing is kept then.
    """
    if len(content) > MOST_BYTES:
        raise CardFault(
            f"the file is larger than {MOST_BYTES // 1_000_000} MB; give a shorter one"
        )
    file = unused(folder / "own" / _harmless(name))
    file.parent.mkdir(parents=True, exist_ok=True)
    with written_beside(file) as beside:
        beside.write_bytes(content)
    try:
        return _fitting(option, file, command_line), file
    except (Fault, WrongUse):
        file.unlink(missing_ok=True)
        raise


def _fitting(option: str, file: FilePath, command_line: CommandLine) -> str:
    """The option that takes a file; raises for a file that none takes."""
    if option != "any":
        _check(option, file, command_line)
        return option
    refused = list[str]()
    for each, called in CALLED.items():
        try:
            _check(each, file, command_line)
        except (Fault, WrongUse) as error:
            refused.append(f"as a {called}: {error}")
        else:
            return each
    raise CardFault(f"the file is no card, no settings and no machine; {'; '.join(refused)}")


def _check(option: str, file: FilePath, command_line: CommandLine) -> None:
    """Have the command line read a file; raises what a terminal would say."""
    program = FilePath("x.plt" if option == "--machine" and _is_plotter(file) else "x.ngc")
    words = commands.trace_words(FilePath("drawing.png"), {option: str(file)}, program)
    command_line.trace(words).prepared()


def _is_plotter(file: FilePath) -> bool:
    """Whether a machine's file is a plotter's; raises CardFault for a mistake in it."""
    from morfax.jobs.machine.machining import chosen

    return chosen(str(file)).is_hpgl


def _harmless(name: str) -> str:
    """A name for a file made of a name that anybody sent; raises CardFault for one that is no .toml."""
    last = re.split(r"[/\\]", name)[-1]
    stem, dot, suffix = last.rpartition(".")
    if f"{dot}{suffix.lower()}" != SUFFIX:
        raise CardFault(
            f"{harmless_text(last)!r} is no .toml; give a card, settings or a machine"
        )
    stem = re.sub(r"[^A-Za-z0-9._-]+", "-", stem).strip(".-")[:LONGEST_NAME]
    return f"{stem or 'own'}{SUFFIX}"
