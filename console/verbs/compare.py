"""The verb `compare`: how far two contours are apart."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import click
from click.core import ParameterSource

from morfax.console.options.types import CUTTER, LENGTH, LINES, ORIGIN, PLACE, SPEED
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import comparison, systems
from morfax.jobs import files as medium
from morfax.jobs.drawing import Sheet, sheet_options
from morfax.jobs.playing import Controls, tape_options
from morfax.jobs.tracing import Head
from morfax.motion.motion import Path
from morfax.motion.units import format_length_mm

BEYOND_TOLERANCE = 1
DEPTH_MM, CLEARANCE_MM, GAP_MM = (
    5.0,
    2.0,
    0.5,
)  # of the head that traces for --systems, as trace has them

EXAMPLES = """\b
Examples:
  morfax compare scan.png cam.csv
  morfax compare scan.png cam.wav --tolerance 50um -o cam-error.png
  morfax compare traced.csv played.csv --json
  morfax compare scan.png --systems all -o five-machines.html
"""
OF_SYSTEMS = ("head_mm", "lines", "speed_mm_s")


@click.command("compare", epilog=EXAMPLES)
@click.argument("a", type=medium.FILE)
@click.argument("b", type=medium.FILE, required=False)
@click.option(
    "--systems",
    "asked",
    type=systems.Systems(),
    help="Trace the drawing A once, record it in the medium of each system and play it on its control: all, or some of "
    f"{','.join(systems.NAMES)}.",
)
@click.option(
    "--tolerance",
    "tolerance_mm",
    type=LENGTH,
    help="End with exit code 1 if any place is further off.",
)
@click.option(
    "-o",
    "picture",
    type=medium.FILE,
    help="Draw the path with its error in colour, or all contours of --systems (.png, .svg, .pdf); of --systems also a "
    "report in one file (.html).",
)
@click.option(
    "--start",
    "head_mm",
    type=PLACE,
    help="Of --systems: where the head looks for the line, as in trace.",
)
@click.option(
    "--lines",
    type=LINES,
    help="Of --systems: several lines, all, outer or numbers, as in trace.",
)
@click.option(
    "--speed",
    "speed_mm_s",
    type=SPEED,
    default="10mm/s",
    show_default=True,
    help="Of --systems: tracing speed.",
)
@click.option(
    "--cutter",
    "cutter_mm",
    type=CUTTER,
    help="Diameter of the cutter that the path is for: what its edge touches is compared with the drawing.",
)
@click.option(
    "--origin",
    type=ORIGIN,
    help="Where the path's zero is on the drawing: X,Y in mm, or reference, the drawing's reference point.  [default: "
    "the sheet's lower-left corner]",
)
@sheet_options
@tape_options
@desk_options
@click.pass_context
def command(
    ctx: click.Context,
    a: FilePath,
    b: FilePath | None,
    asked: tuple[str, ...] | None,
    tolerance_mm: float | None,
    picture: FilePath | None,
    head_mm: tuple[float, float] | None,
    lines: str | tuple[int, ...] | None,
    speed_mm_s: float,
    cutter_mm: float | None,
    origin: Any,
    sheet: Sheet,
    controls: Controls,
    desk: Desk,
) -> None:
    """Say how far two contours are apart: paths, tapes, or one of them a drawing.

    A and B are path files (.csv), tapes (.wav; they are played first) or, one of them, a drawing. Only what
    is run with the tool in the work counts. Between two paths the distance is measured both ways. Against a
    drawing it is the distance to the ink's own centre, measured across the path in the image, and the ink
    that no path covers is counted.

    With --systems the systems are set side by side: A is a drawing and there is no B: the table has a row for
    each system, and one that refuses or faults says why in its row.
    """
    if asked is not None:
        _refuse(b is not None, "--systems compares one drawing; leave B out")
        _refuse(
            head_mm is not None and lines is not None,
            "--start picks one line, --lines several; give one of them",
        )
        of_path = cutter_mm is not None or origin is not None or bool(controls.by_hand())
        _refuse(
            of_path,
            "--cutter, --origin and what a tape does not say are of B; with --systems leave them out",
        )
        head = Head(head_mm, speed_mm_s, DEPTH_MM, CLEARANCE_MM, None, GAP_MM, lines)
        beyond = systems.compare(
            systems.Wanted(a, asked, picture, tolerance_mm), sheet, head, desk
        )
        ctx.exit(BEYOND_TOLERANCE if beyond else 0)
    if b is None:
        raise click.UsageError("there is nothing to compare with; give B, or --systems all")
    given = [
        name
        for name in OF_SYSTEMS
        if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE
    ]
    _refuse(
        bool(given),
        "--start, --lines and --speed are for --systems; without it nothing is traced",
    )
    drawing_file, paths = _sorted(a, b)
    if picture is not None:
        medium.outgoing(medium.with_suffix_in(picture, (".png", ".svg", ".pdf")), a, b)
    _refuse(
        origin is not None and drawing_file is None,
        "--origin is a place on a drawing; without one leave it out",
    )
    _refuse(
        cutter_mm is not None and drawing_file is None,
        "--cutter is for a path beside a drawing's line; leave it out",
    )
    drawing = sheet.open(drawing_file) if drawing_file else None
    opened = [_path(file, controls, desk) for file in paths]
    if origin is not None:
        opened = [_from(origin, drawing, opened[0])]
    found = (
        comparison.from_drawing(drawing, opened[0], radius_mm=(cutter_mm or 0.0) / 2)
        if drawing
        else comparison.from_path(opened[0], opened[1])
    )
    if picture is not None:
        _draw(picture, f"{a.name} and {b.name}", found, opened, drawing)
    files = {"a": str(a), "b": str(b), "picture": None if picture is None else str(picture)}
    desk.figures({**files, **_judged(found, tolerance_mm), **found.figures})
    if tolerance_mm is not None and found.largest_mm > tolerance_mm:
        ctx.exit(BEYOND_TOLERANCE)


def _refuse(wrong: bool, why: str) -> None:
    """Raise UsageError for options that do not go together."""
    if wrong:
        raise click.UsageError(why)


def _sorted(a: FilePath, b: FilePath) -> tuple[FilePath | None, list[FilePath]]:
    """The drawing, if one of the two is one, and the paths and tapes in the order given."""
    drawings = [file for file in (a, b) if medium.kind_of(file) == "drawing"]
    if len(drawings) == 2:
        raise click.UsageError(
            f"{a} and {b} are both drawings; trace one of them first, or give a path or a tape"
        )
    return (drawings[0] if drawings else None), [
        file for file in (a, b) if file not in drawings
    ]


def _path(file: FilePath, controls: Controls, desk: Desk) -> Path:
    """Read a path file, or play a tape or another program."""
    if medium.kind_of(file) in ("tape", "program"):
        return controls.play_whole(file, desk)
    from morfax.motion.pathfile import read_path

    return read_path(file)


def _from(origin: Any, drawing: Any, path: Path) -> Path:
    """A path whose zero is at a place of the drawing, in the sheet's own coordinates."""
    from morfax.motion.placement import Placement
    from morfax.tracer.following.start import reference_on

    x_mm, y_mm = reference_on(drawing) if origin == "reference" else origin
    return Placement(origin_mm=(-x_mm, -y_mm)).path(path)


def _draw(
    file: FilePath, names: str, found: comparison.Comparison, paths: list[Path], drawing: Any
) -> None:
    """Draw the first path with its error in colour over what it was compared with."""
    from morfax.reports.overlay import Picture, draw

    title = f"{names}: largest distance {format_length_mm(found.largest_mm)}"
    reference = paths[1] if len(paths) > 1 else None
    draw(Picture(title, paths[0], drawing, reference, found.points_mm, found.error_mm), file)


def _judged(found: comparison.Comparison, tolerance_mm: float | None) -> dict[str, Any]:
    """The largest distance, and whether it is within the tolerance."""
    within = None if tolerance_mm is None else found.largest_mm <= tolerance_mm
    return {
        "tolerance_mm": tolerance_mm,
        "within_tolerance": within,
        "largest_mm": found.largest_mm,
    }
