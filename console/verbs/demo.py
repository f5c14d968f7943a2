"""The verb `demo`: the whole way on a sample drawing that is part of morfax."""

from __future__ import annotations

from importlib import resources
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import FILE
from morfax.console.options.groups import Verb, option
from morfax.console.verbs.run import run_and_show
from morfax.jobs.run import RunJob
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import ProgramSettings, TraceSettings
from morfax.motion.faults import FileFault

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk

FOLDER = FilePath("morfax-demo")
DRAWING, CARD, RESULTS = "program.png", "program.toml", "results"
ONE_LINE = "cam.png"  # what the tutorial takes for a scan

EXAMPLES = """\b
Examples:
  morfax demo
  morfax demo -o first-try
"""


@click.command("demo", cls=Verb, epilog=EXAMPLES)
@option(
    "Output",
    "-o",
    "folder",
    type=FILE,
    help=f"Folder for the demo, a new or an empty one.  [default: {FOLDER}, or {FOLDER}-2 and so on]",
)
@desk_options
def command(folder: FilePath | None, desk: Desk) -> None:
    """Trace a sample drawing, play the tape, compare, and show what came out.

    The folder then holds the drawing with its operator's card, and in `results` what `morfax run` makes of
    them: the tape, the traced and the played path, the picture with the error in colour, and the figures.
    Beside them is cam.png, a scan of one closed line for the tutorial.
    """
    place = _new_folder(folder)
    drawing, card = _unpacked(DRAWING, place), _unpacked(CARD, place)
    _unpacked(ONE_LINE, place)
    settings = TraceSettings(program=ProgramSettings(card_file=card))
    result = run_and_show(RunJob(DrawingFile(drawing), place / RESULTS, settings), desk)
    traced = result.figures["traced_path"]
    desk.note(
        f"the drawing is {drawing}; the machine's path over it, with its error in colour, is {result.picture}"
    )
    desk.note("try next:")
    desk.note(
        f"  morfax record {traced} -o {place / 'program.ngc'}    (G-code of the same motion)"
    )
    desk.note(
        f"  morfax trace {drawing} --card {card} --cutter 6mm --picture {place / 'cutter.png'}"
    )
    desk.note("  morfax run SCAN.png --width 120mm    (a drawing of your own)")


def _new_folder(folder: FilePath | None) -> FilePath:
    """Make the folder; raises FileFault for one that holds files already, or that cannot be made."""
    number, place = 1, folder or FOLDER
    while folder is None and place.exists():
        number += 1
        place = FOLDER.with_name(f"{FOLDER.name}-{number}")
    try:
        place.mkdir(exist_ok=True)
        if any(place.iterdir()):
            raise FileFault(f"{place} holds files already; give a new folder with -o")
    except OSError as error:
        if isinstance(error, FileFault):
            raise
        raise FileFault(
            f"cannot make the folder {place}: {error.strerror}; give another one with -o"
        ) from error
    return place


def _unpacked(name: str, folder: FilePath) -> FilePath:
    """A sample that is part of morfax, copied into a folder; its name there."""
    file = folder / name
    file.write_bytes(resources.files("morfax.samples").joinpath(name).read_bytes())
    return file
