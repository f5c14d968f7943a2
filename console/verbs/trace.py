"""The verb `trace`: a drawing becomes a tape."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.head import head_options
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import files as medium
from morfax.jobs.drawing import Sheet, sheet_options
from morfax.jobs.recording import Unit, unit_options
from morfax.jobs.traced import Traced
from morfax.jobs.tracing import Head

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

EXAMPLES = """\b
Examples:
  morfax trace samples/cam.png
  morfax trace scan.png --width 120mm --start 40,62 -o cam.wav --path cam.csv
  morfax trace samples/bracket.png --lines all --picture bracket-lines.png
  morfax trace scan.jpg --dpi 600 --card part.toml --picture cam-traced.png
"""


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where the results go: the tape, the path, or both, and the picture."""

    tape: FilePath | None
    path: FilePath | None
    picture: FilePath | None


@click.command("trace", epilog=EXAMPLES)
@click.argument("drawing", type=medium.FILE)
@click.option(
    "-o",
    "output",
    type=medium.FILE,
    help="The tape (.wav), another program (.steps, .cubic, .ngc), or a path file only (.csv).  [default: the "
    "drawing's name with .wav, in this folder]",
)
@click.option(
    "--path", "path_file", type=medium.FILE, help="Write the head's path as well (.csv)."
)
@click.option(
    "--picture", type=medium.FILE, help="Draw the path over the drawing (.png, .svg, .pdf)."
)
@click.option(
    "--force",
    is_flag=True,
    help="Write over a tape that is there already under a name not given with -o.",
)
@sheet_options
@head_options
@unit_options
@desk_options
def command(
    drawing: FilePath,
    output: FilePath | None,
    path_file: FilePath | None,
    picture: FilePath | None,
    force: bool,
    sheet: Sheet,
    head: Head,
    unit: Unit,
    desk: Desk,
) -> None:
    """Follow the line of a drawing and record the head's motion on a tape.

    DRAWING is an image file (PNG, JPEG, TIFF) of known resolution. A closed line is followed until it closes,
    an open one from end to end. If the line is lost, what was traced until then is kept, with `.incomplete`
    in the names; of several lines (--lines) the others are cut all the same. The picture numbers them. If
    there is no line to start on, --picture shows the sheet, so that a place for --start can be read off it.
    The picture is the drawing's; tape and path are mirrored, scaled and turned as asked for.
    """
    outputs = _outputs(drawing, output, path_file, picture, force)
    unit.check(outputs.tape)
    opened = sheet.open(drawing)
    desk.detail(f"{drawing}: sheet of {opened.width_mm:.2f} x {opened.height_mm:.2f} mm")
    traced = head.trace(opened, desk, outputs.picture)
    unit = unit.at(traced.origin_mm)
    written = _write(traced, outputs, opened, unit, desk)
    unit.warn(desk)
    desk.figures({"drawing": str(drawing), **written, **traced.figures(), **unit.figures()})
    if traced.fault is not None:
        raise traced.fault


def _outputs(
    drawing: FilePath,
    output: FilePath | None,
    path_file: FilePath | None,
    picture: FilePath | None,
    force: bool,
) -> Outputs:
    """Names for the results, each of which can be written; raises FileFault if not."""
    from morfax.recorder.media import MEDIA

    pictures = (".png", ".svg", ".pdf")
    for option, file, suffixes in (
        ("-o", output, (*MEDIA, ".csv")),
        ("--path", path_file, (".csv",)),
        ("--picture", picture, pictures),
    ):
        if file is not None:
            medium.outgoing(medium.with_suffix_in(file, suffixes, option), drawing)
    if output is None:
        output = medium.made_up(FilePath(f"{drawing.stem}.wav"), drawing, force=force)
    if output.suffix.lower() == ".csv":
        return Outputs(None, output, picture)
    return Outputs(output, path_file, picture)


def _write(
    traced: Traced, outputs: Outputs, drawing: Drawing, unit: Unit, desk: Desk
) -> dict[str, str]:
    """Write what was asked for; the names under which it stands."""
    written = {}
    if outputs.tape is not None:
        written[medium.called(outputs.tape)] = str(traced.record(outputs.tape, unit, desk))
    if outputs.path is not None:
        written["path"] = str(traced.write(outputs.path, unit))
    if outputs.picture is not None:
        from morfax.reports.overlay import Picture, draw

        name = drawing.file.name if drawing.file else "drawing"
        picture = Picture(
            f"{name}, traced",
            traced.path,
            drawing,
            numbers_mm=traced.places_mm,
            stops_mm=traced.marked_mm,
        )
        draw(picture, traced.name(outputs.picture))
        written["picture"] = str(traced.name(outputs.picture))
    return written
