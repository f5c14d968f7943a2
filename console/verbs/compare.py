"""The verb `compare`: how far two contours are apart."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.cutting import KERF, kerf_is_cutter
from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import DRAWN_UNIT, drawing_options
from morfax.console.options.files import FILE, PICTURES, ReportFile, Result
from morfax.console.options.groups import Verb, given, option, renamed
from morfax.console.options.output import FORCE
from morfax.console.options.systems import Systems
from morfax.console.options.tape import FOR_MACHINE, tape_options
from morfax.console.options.types import CUTTER, LENGTH, LINES, PLACE, SPEED, ZERO
from morfax.jobs.compare import CompareJob
from morfax.jobs.results import NAMES
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import HeadSettings, TraceSettings
from morfax.jobs.systems import SystemsJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.playing import ByHand
    from morfax.jobs.settings.drawing_file import DrawingFile

BEYOND_TOLERANCE = 1
OF_SYSTEMS = ("report", "head_mm", "lines", "speed_mm_s")  # options that only --systems takes

EXAMPLES = """\b
Examples:
  morfax compare scan.png part.ngc --machine qtplasmac
  morfax compare scan.png cam.wav --tolerance 50um --picture cam-error.png
  morfax compare part.dxf played.csv
  morfax compare scan.png --systems all -o five-machines.html
"""


@click.command("compare", cls=Verb, epilog=EXAMPLES)
@click.argument("a", type=FILE)
@click.argument("b", type=FILE, required=False)
@option(
    "Systems",
    "--systems",
    type=Systems(),
    help="Trace the drawing A once, record it in the medium of each system and play it on its control: "
    "all, or "
    f"some of {','.join(NAMES)}.",
)
@option(
    "Output",
    "--tolerance",
    "tolerance_mm",
    type=LENGTH,
    help="End with exit code 1 if a place is further off than this.",
)
@option(
    "Output",
    "--picture",
    type=Result(*PICTURES),
    help="Draw the path with its error in colour, or all contours of --systems (.png, .svg, .pdf).",
)
@option(
    "Output",
    "-o",
    "report",
    type=ReportFile(".html"),
    help="With --systems: write a report with all pictures, in one file (.html).",
)
@FORCE
@option(
    "Systems",
    "--start",
    "head_mm",  # start_mm is where a tape starts
    type=PLACE,
    help="With --systems: where the head looks for the line, as in trace.",
)
@option(
    "Systems",
    "--lines",
    type=LINES,
    help="With --systems: several lines: all, contours, outer or numbers, as in trace. --lines all --edge "
    "also compares a path with lines and with the outlines of the solid areas among them.",
)
@option(
    "Systems",
    "--speed",
    "speed_mm_s",
    type=SPEED,
    help="With --systems: tracing speed.  [default: 10mm/s]",
)
@option(
    "Tool",
    "--cutter",
    "cutter_mm",
    type=CUTTER,
    help="Diameter of the cutter that the path is for: what its edge touches is compared with the drawing.",
)
@KERF
@option(
    "Drawing",
    "--zero",
    type=ZERO,
    help="Where the path's zero is on the drawing: sheet (its lower-left corner), reference (the drawing's "
    "reference point), lower-left or centre (of the part, where G-code of ours says that place at its head), "
    "or X,Y in mm, as trace printed it as zero_place_mm.  [default: what the program says, or sheet]",
)
@DRAWN_UNIT
@renamed("--origin", "--zero")
@drawing_options("a")
@FOR_MACHINE
@tape_options
@desk_options
@click.pass_context
def command(
    ctx: click.Context,
    a: DrawingFile,
    b: FilePath | None,
    by_hand: ByHand,
    desk: Desk,
    **options: Any,
) -> None:
    """Say how far two contours are apart: paths, programs, or one of them a drawing.

    A and B are path files (.csv), drawings from CAD (.dxf, .svg), programs (.wav, .ngc …; they are played
    first) or, one of them, a drawing on paper. Only motion with the tool in the work counts. Between two
    paths the distance is measured both ways. Against a drawing on paper it is the distance to the middle of
    the ink, measured across the path in the image; ink that no path covers is counted.

    With --systems the verb compares the control systems: A is a drawing, and B is left out. The table has a
    row for each system; if a system refuses or faults, its row says why.
    """
    kerf_is_cutter(options)
    if options["systems"] is not None:
        within = _systems(a, b, by_hand, options, desk)
    elif b is None:
        raise click.UsageError("there is nothing to compare with; give B, or --systems all")
    else:
        within = _two(a, b, by_hand, options, desk)
    ctx.exit(BEYOND_TOLERANCE if within is False else 0)


def _two(
    a: DrawingFile, b: FilePath, by_hand: ByHand, options: dict[str, Any], desk: Desk
) -> bool | None:
    """Compare A with B, draw and print; whether that is within the tolerance, None without one."""
    picture: FilePath | None = options["picture"]
    both = a.for_lines(LineSettings(lines=options["lines"]))
    if any(given(name) for name in OF_SYSTEMS if not (both.both and name == "lines")):
        raise click.UsageError(
            "-o, --start, --lines and --speed are for --systems; without it nothing is traced (but --edge"
            " --lines all compares with lines and outlines)"
        )
    compared = {
        name: options[name] for name in ("tolerance_mm", "cutter_mm", "zero", "drawn_unit")
    }
    result = CompareJob(both, b, picture=picture, by_hand=by_hand, **compared).run(desk)
    if picture is not None:
        from morfax.reports.pictures import draw_compared

        draw_compared(result, f"{a.file.name} and {b.name}", picture)
    desk.figures(result.figures)
    return result.within


def _systems(
    a: DrawingFile, b: FilePath | None, by_hand: ByHand, options: dict[str, Any], desk: Desk
) -> bool | None:
    """Set the systems side by side, draw and print; whether all are within the tolerance."""
    if b is not None:
        raise click.UsageError("--systems compares one drawing; leave B out")
    if options["cutter_mm"] is not None or options["zero"] is not None or by_hand.given():
        raise click.UsageError(
            "--cutter, --zero and what a tape does not say are of B; with --systems leave them out"
        )
    if options["drawn_unit"] is not None:
        raise click.UsageError("--unit is for drawings from CAD; with --systems leave it out")
    line = LineSettings(start_mm=options["head_mm"], lines=options["lines"])
    settings = TraceSettings(line, HeadSettings(speed_mm_s=options["speed_mm_s"]))
    outputs = {"report": options["report"], "picture": options["picture"]}
    job = SystemsJob(
        a, options["systems"], options["tolerance_mm"], settings=settings, **outputs
    )
    result = job.run(desk)
    for output in filter(None, outputs.values()):
        from morfax.reports.pictures import draw_systems

        draw_systems(result, output)
    rows = dict(result.rows)
    if desk.json:
        rows = {"traced": rows["traced"], **{r.suffix: r.figures for r in result.results}}
    desk.figures({**result.figures, **rows})
    for fault in result.faults:
        raise fault
    return result.within
