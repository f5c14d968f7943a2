"""The verb `panel`: the operator's panel in a browser."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.files import FILE
from morfax.console.options.groups import GroupedOption, Verb, option
from morfax.motion.faults import DrawingFault, FileFault

if TYPE_CHECKING:
    from morfax.console.verbs.as_jobs import WordsAsJobs
    from morfax.panel.commands import OptionField
    from morfax.panel.server import Address

EXAMPLES = """\b
Examples:
  morfax panel samples/program.png
  morfax panel scans/ --folder work
  morfax panel scan.png --port 8017 --no-browser
"""
GROUP = "Server"
EXTRA = "the panel needs starlette, uvicorn and websockets: pip install 'morfax[panel]'"
FOLDER = "morfax.panel"  # where no drawing is named


@click.command("panel", cls=Verb, epilog=EXAMPLES)
@click.argument("drawing", type=FILE, required=False)
@option(
    "Output",
    "--folder",
    type=FILE,
    help="Folder of the panel: its state, drawings that are dropped on the page, results; it is made.  "
    "[default: the drawing's name with .panel, here]",
)
@option(
    GROUP,
    "--port",
    type=click.IntRange(0, 65535),
    default=0,
    help="Port to listen at; 0 takes a free one.  [default: a free one]",
)
@option(
    GROUP,
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address to listen at. Other computers can open the panel at any but this one; that needs --token.",
)
@option(
    GROUP,
    "--token",
    metavar="TEXT",
    help="Token of the page's address, 16 characters or more.  [default: a random one]",
)
@option(
    GROUP,
    "--browser/--no-browser",
    default=True,
    help="Open the page in the browser, or only print its address.",
)
def command(
    drawing: FilePath | None,
    folder: FilePath | None,
    port: int,
    host: str,
    token: str | None,
    browser: bool,
) -> None:
    """Open the operator's panel in a browser: see the sheet, choose lines, run, watch, save.

    DRAWING is a scan or photo, or a folder of drawings to choose from. The page does what the other verbs do,
    and shows the command for it. The panel's folder keeps your settings after each step, so that a new start
    shows them again. Ctrl-C ends the server.
    """
    try:
        from morfax.panel import server
        from morfax.panel.bench import Bench
    except ModuleNotFoundError as missing:
        if missing.name in ("starlette", "uvicorn", "websockets"):
            raise click.UsageError(EXTRA) from None
        raise
    from dataclasses import replace

    address = replace(server.checked(host, token), port=port)
    sources = _sources(drawing)
    place = folder or FilePath(
        FOLDER if drawing is None else f"{drawing.resolve().name.split('.')[0]}.panel"
    )
    _make(place)
    bench = Bench(place, sources, _command_line())
    if len(sources) == 1 and bench.drawing is None:  # else what lay there stays
        from morfax.panel.history import HistoryStep

        bench.history.add(HistoryStep(next(iter(sources)), {}))
    server.serve(bench, address, _said, browser)


def _sources(drawing: FilePath | None) -> dict[str, FilePath]:
    """The drawings that the page may choose from, by name; raises FileFault and DrawingFault."""
    from morfax.panel.uploads import SUFFIXES

    if drawing is None:
        return {}
    if not drawing.exists():
        raise FileFault(f"{drawing} does not exist; check the name")
    if drawing.is_file():
        return {drawing.name: drawing}
    found = {
        f.name: f
        for f in sorted(drawing.iterdir())
        if f.is_file() and f.suffix.lower() in SUFFIXES
    }
    if not found:
        raise DrawingFault(
            f"there is no drawing in the folder {drawing}; give one with PNG, JPEG, TIFF or PDF files"
        )
    return found


def _make(folder: FilePath) -> None:
    """Make the panel's folder."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileFault(
            f"cannot make the folder {folder}: {error.strerror}; give another one with --folder"
        ) from error


def _said(address: Address) -> None:
    """Print the address, and what it opens to others."""
    click.echo(address.url)
    click.echo("the panel is at this address until Ctrl-C", err=True)
    if address.host not in ("127.0.0.1", "localhost"):
        click.echo(
            "whoever knows this address can read the drawings, run the head and write files into the "
            "panel's folder",
            err=True,
        )


def _command_line() -> _OfVerbs:
    """The command line's own parser, for the page."""
    from morfax.console.verbs import correct, lines, play, run, trace
    from morfax.console.verbs.as_jobs import WordsAsJobs

    verbs = {"lines": lines.command, "run": run.command, "trace": trace.command}
    verbs["correct"], verbs["play"] = correct.command, play.command
    return _OfVerbs(WordsAsJobs(verbs))


class _OfVerbs:
    """The parsers of the verbs, and their options as fields."""

    def __init__(self, words: WordsAsJobs) -> None:
        self.lines, self.run, self.trace = words.lines, words.run, words.trace
        self.correct, self.play = words.correct, words.play
        params = words.verbs["trace"].params
        self._options = {p.opts[0]: p for p in params if isinstance(p, GroupedOption)}

    def fields(self) -> list[OptionField]:
        """The options that the page offers, in their order."""
        from morfax.panel.commands import OFFERED

        return [
            self._field(group, name)
            for group, names in OFFERED.items()
            for name in names
            if name in self._options
        ]

    def _field(self, group: str, name: str) -> OptionField:
        """An option as a field."""
        from morfax.panel.commands import OWN_FILES, OptionField
        from morfax.panel.page_words import in_page_words
        from morfax.recorder.gcode.machine import names

        param = self._options[name]
        context = click.Context(click.Command("trace"), max_content_width=1000)
        record = param.get_help_record(context)
        told = in_page_words(" ".join((record[1] if record else "").split()))
        if param.is_flag:
            return OptionField(name, group, "switch", told)
        if name in OWN_FILES:
            choices = tuple(names()) if name == "--machine" else ()
            return OptionField(name, group, "file", told, choices)
        choices = tuple(map(str, getattr(param.type, "choices", ())))
        return OptionField(name, group, "choice" if choices else "text", told, choices)
