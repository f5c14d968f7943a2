"""The verb `correct`: what the head got wrong on a drawing is put right, in a file beside the drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.files import FILE
from morfax.console.options.groups import Decorator, Verb, option
from morfax.console.options.types import CORRECTED, CORRECTED_ALONG, CORRECTION_WIDTH
from morfax.jobs.correct import CorrectJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.settings.drawing_file import DrawingFile
    from morfax.tracer.corrections.corrections import Correction

EXAMPLES = """\b
Examples:
  morfax correct scan.png --rub 40mm,62mm --rubber 3mm --why coffee
  morfax correct scan.png --turn straight 512px,300px
  morfax correct scan.png --not-stop 300px,220px
  morfax correct scan.png --undo
"""


def _placed(name: str, text: str, kind: Any = CORRECTED) -> Decorator:
    """An option that makes a correction at a place, or along several."""
    return option("Correction", name, type=kind, multiple=True, metavar="X,Y", help=text)


@click.command("correct", cls=Verb, epilog=EXAMPLES)
@click.argument("drawing", type=FILE)
@_placed(
    "--rub",
    "Rub out ink: under the rubber at a place, or along several, in quotes.",
    CORRECTED_ALONG,
)
@_placed(
    "--rub-area", "Rub out all ink inside three or more places, in quotes.", CORRECTED_ALONG
)
@_placed(
    "--bridge",
    "Draw ink from place to place, in quotes: '812px,1004px 850px,1010px'; one place is a dot. From line to "
    "line the stroke is as wide and dark as they are, and leaves them in their own direction.",
    CORRECTED_ALONG,
)
@option(
    "Correction",
    "--turn",
    "turns",
    nargs=2,
    type=(click.Choice(["straight", "left", "right"]), CORRECTED),
    multiple=True,
    metavar="WAY X,Y",
    help="How the head goes through the junction there: straight, left or right as it comes.",
)
@_placed("--stop", "The head stops there.")
@_placed("--drill", "A drill point is there: a stop as at a dot.")
@_placed("--not-stop", "No stop is there, whatever the ink looks like.")
@option(
    "Correction",
    "--start",
    type=CORRECTED,
    metavar="X,Y",
    help="The head is put down there, if trace has no --start and no --lines.",
)
@option(
    "Correction",
    "--reference-point",
    "reference",
    type=CORRECTED,
    metavar="X,Y",
    help="The reference point, if trace has no --reference-point.",
)
@option(
    "Correction",
    "--rubber",
    type=CORRECTION_WIDTH,
    metavar="WIDTH",
    help="Diameter of the rubber, such as 3mm or 40px.  [default: 2mm]",
)
@option(
    "Correction",
    "--pen",
    type=CORRECTION_WIDTH,
    metavar="WIDTH",
    help="Width of the pen.  [default: the line's]",
)
@option(
    "Correction",
    "--from",
    "coming_from",
    type=CORRECTED,
    metavar="X,Y",
    help="The turn counts only for a head that comes from this side.  [default: from any]",
)
@option(
    "Correction",
    "--direction",
    type=click.Choice(["cw", "ccw"]),
    help="Which way round from --start.  [default: as it comes]",
)
@option(
    "Correction", "--why", default="", help="The reason, which is kept with the correction."
)
@option(
    "Correction",
    "--remove",
    type=click.IntRange(min=1),
    multiple=True,
    help="Remove the correction of this number.",
)
@option(
    "Correction",
    "--undo",
    count=True,
    help="Remove the last correction; give it several times for several.",
)
@option("Correction", "--list", "listed", is_flag=True, help="Only list the corrections.")
@drawing_options("drawing")
@desk_options
def command(drawing: DrawingFile, desk: Desk, listed: bool, undo: int, **options: Any) -> None:
    """Correct what the head gets wrong on a drawing: rub out, bridge, turn, stop.

    From then on trace, run, lines and compare of the drawing use the corrections. They are in a text file
    beside the drawing, in its name with .morfax.toml (or in the file of --corrections), which you may edit.
    Without anything to do, the verb lists the corrections.

    Places are X,Y: with px columns from the left and rows from the top of the picture, as picture viewers
    show; in mm from the sheet's lower-left corner. Rubber and pen work in the order of the file.
    """
    remove = options.pop("remove")
    add = () if listed else asked_corrections(options)
    if listed and (undo or remove):
        raise click.UsageError("--list changes nothing; leave --undo and --remove out")
    desk.figures(CorrectJob(drawing, add, remove, undo).run(desk).figures)


def asked_corrections(options: dict[str, Any]) -> tuple[Correction, ...]:
    """The corrections that are asked for; wrong use where width, side or direction has nothing to go with."""
    from morfax.tracer.corrections.corrections import Correction

    why, made = options["why"], list[Correction]()
    for kind, width in (
        ("rub", options["rubber"]),
        ("rub_area", None),
        ("bridge", options["pen"]),
    ):
        do: Any = kind.replace("_", "-")
        made += [Correction(do, places, width, why=why) for places in options[kind]]
    made += [
        Correction(do, (place,), coming_from=options["coming_from"], why=why)
        for do, place in options["turns"]
    ]
    for kind in ("stop", "drill", "not_stop"):
        do = kind.replace("_", "-")
        made += [Correction(do, (place,), why=why) for place in options[kind]]
    if options["reference"] is not None:
        made.append(Correction("reference", (options["reference"],), why=why))
    if options["start"] is not None:
        direction = options["direction"]
        made.append(Correction("start", (options["start"],), direction=direction, why=why))
    _refuse_idle(options, bool(made))
    return tuple(made)


def _refuse_idle(options: dict[str, Any], any_made: bool) -> None:
    """Refuse an option that has nothing to go with."""
    goes_with = {
        "--rubber": (options["rubber"], options["rub"], "--rub"),
        "--pen": (options["pen"], options["bridge"], "--bridge"),
        "--from": (options["coming_from"], options["turns"], "--turn"),
        "--direction": (options["direction"], options["start"], "--start"),
        "--why": (options["why"], any_made, "a correction"),
    }
    for name, (given, there, what) in goes_with.items():
        if given and not there:
            raise click.UsageError(
                f"{name} goes with {what}; give that too, or leave {name} out"
            )
