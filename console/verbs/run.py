"""The verb `run`: the whole way, from the drawing over the tape to the machine, and how well the three agree."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.head import head_options
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import comparison
from morfax.jobs import files as medium
from morfax.jobs.drawing import Sheet, sheet_options
from morfax.jobs.playing import Controls, Played
from morfax.jobs.recording import Unit, unit_options
from morfax.jobs.traced import Traced
from morfax.jobs.tracing import Head
from morfax.motion.faults import FileFault
from morfax.motion.files import written_beside
from morfax.motion.units import format_length_mm
from morfax.reports import table

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing

EXAMPLES = """\b
Examples:
  morfax run samples/cam.png -o demo
  morfax run scan.png --width 120mm --start 40,62 -o cam
"""


@dataclass(frozen=True, slots=True)
class Folder:
    """Where the results of one drawing go, all under its name."""

    folder: FilePath
    stem: str

    def file(self, ending: str) -> FilePath:
        """A file of this drawing."""
        return self.folder / f"{self.stem}{ending}"


@click.command("run", epilog=EXAMPLES)
@click.argument("drawing", type=medium.FILE)
@click.option(
    "-o",
    "folder",
    type=medium.FILE,
    help="Folder for the results; it is made.  [default: the drawing's name, here]",
)
@sheet_options
@head_options
@unit_options
@desk_options
def command(
    drawing: FilePath, folder: FilePath | None, sheet: Sheet, head: Head, unit: Unit, desk: Desk
) -> None:
    """Go the whole way: trace a drawing, play the tape, compare all three.

    The folder then holds the tape (.wav), the traced and the played path (.csv), the picture of the played
    path with its error in colour (.png) and the figures (.json). What was there under these names is written
    over. Mirrored, scaled or turned paths are compared with the drawing as they were before.
    """
    opened = sheet.open(drawing)
    place = _make(folder or FilePath(drawing.stem), drawing)
    traced = head.trace(opened, desk, place.file(".png"))
    unit = unit.at(traced.origin_mm)
    tape = traced.record(place.file(".wav"), unit, desk)
    written = {
        "tape": str(tape),
        "traced_path": str(traced.write(place.file(".traced.csv"), unit)),
    }
    played = Controls().play(tape, desk)
    written["played_path"] = str(_write(played, traced, place))
    unit.warn(desk)
    played = replace(
        played, path=unit.placement.about(traced.path.positions_mm[0]).back(played.path)
    )
    figures = {
        "drawing": str(drawing),
        **written,
        **_compare(opened, traced, played, place, desk),
        **unit.figures(),
    }
    with written_beside(traced.name(place.file(".json"))) as beside:
        beside.write_text(table.as_json(figures) + "\n", encoding="utf-8")
    desk.figures(figures)
    for fault in (traced.fault, played.fault):
        if fault is not None:
            raise fault


def _make(folder: FilePath, drawing: FilePath) -> Folder:
    """Make the folder; raises FileFault if it cannot be."""
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise FileFault(
            f"cannot make the folder {folder}: {error.strerror}; give another one with -o"
        ) from error
    place = Folder(folder, drawing.stem)
    medium.outgoing(place.file(".png"), drawing)
    return place


def _write(played: Played, traced: Traced, place: Folder) -> FilePath:
    """Write the played path; its name."""
    from morfax.motion.pathfile import write_path

    file = place.file(".played.csv")
    file = medium.incomplete(file) if played.fault else traced.name(file)
    write_path(played.path, file)
    return file


def _compare(
    drawing: Drawing, traced: Traced, played: Played, place: Folder, desk: Desk
) -> dict[str, Any]:
    """Compare all three, and draw the played path with its error from the ink; the figures."""
    desk.detail("comparing drawing, traced path and played path")
    radius_mm = traced.cutter.radius_mm if traced.cutter else 0.0
    from_ink = comparison.from_drawing(drawing, played.path, "played", radius_mm)
    picture = traced.name(place.file(".png"))
    _draw(picture, f"{place.stem}, played", drawing, (traced, played), from_ink)
    return {
        "picture": str(picture),
        **traced.figures(),
        **comparison.from_drawing(drawing, traced.path, "traced", radius_mm).figures,
        **from_ink.figures,
        **comparison.from_path(played.path, traced.path, ("played", "traced")).figures,
    }


def _draw(
    file: FilePath,
    name: str,
    drawing: Drawing,
    paths: tuple[Traced, Played],
    from_ink: comparison.Comparison,
) -> None:
    """Draw the played path over the drawing, with its distance from the ink's centre in colour."""
    from morfax.reports.overlay import Picture, draw

    title = f"{name}: largest distance from the ink's centre {format_length_mm(from_ink.largest_mm)}"
    traced, played = paths
    shown = Picture(
        title,
        played.path,
        drawing,
        None,
        from_ink.points_mm,
        from_ink.error_mm,
        numbers_mm=traced.places_mm,
        stops_mm=traced.marked_mm,
    )
    draw(shown, file)
