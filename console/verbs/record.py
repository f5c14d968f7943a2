"""The verb `record`: a path file, or a program played on its own control, becomes a program in any medium."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import DRAWN_UNIT
from morfax.console.options.files import FILE, ProgramOrPipe
from morfax.console.options.groups import Verb, option, renamed
from morfax.console.options.placement import unit_options
from morfax.console.options.sound import outlet_options
from morfax.console.options.tape import CYCLES_PER_MM
from morfax.console.options.types import FREQUENCY, ZERO
from morfax.jobs.record import RecordJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.recording import RecordingUnit
    from morfax.jobs.media.live import Outlet
    from morfax.jobs.settings.zero import Zero

EXAMPLES = """\b
Examples:
  morfax record cam.csv -o cam.wav
  morfax record cam.wav -o cam.steps --fit-tolerance 20um
  morfax record part.dxf -o left-hand.wav --mirror x --pickup photocell
  morfax record cam.csv --device usb --label cam.json
"""


@click.command("record", cls=Verb, epilog=EXAMPLES)
@click.argument("source", type=FILE)
@option(
    "Output",
    "-o",
    "output",
    type=ProgramOrPipe(),
    help="The program (.wav, .steps, .cubic, .ngc), or - for a tape through a pipe.  [default: the "
    "source's name with .wav, here]",
)
@outlet_options
@option(
    "Tape",
    "--reference-frequency",
    "reference_hz",
    type=FREQUENCY,
    default="6kHz",
    show_default=True,
    help="Reference frequency.",
)
@renamed("--reference", "--reference-frequency")
@option(
    "Tape",
    "--cycles-per-mm",
    type=CYCLES_PER_MM,
    help="Cycles of phase per mm of travel.  [default: those of the pick-up: 20, of the scale 10]",
)
@option(
    "Output",
    "--force",
    is_flag=True,
    help="Without -o: write over a tape that is there already.",
)
@option(
    "Program",
    "--zero",
    type=ZERO,
    default="sheet",
    show_default=True,
    help="The zero of the program: sheet (the source's own), lower-left or centre (of what is run with the "
    "tool in the work, leads aside), or a place X,Y of the source in mm.",
)
@option(
    "Program",
    "--orders",
    type=click.Choice(["differences", "counts"]),
    help="Orders of a .steps program: differences of the counts (5 to 8 holes a row), or the counts "
    "themselves (13), of which a wrong hole spoils one row only.  [default: differences]",
)
@DRAWN_UNIT
@unit_options
@desk_options
def command(
    source: FilePath,
    output: FilePath | None,
    reference_hz: float,
    cycles_per_mm: float | None,
    force: bool,
    unit: RecordingUnit,
    drawn_unit: str | None,
    zero: Zero,
    orders: Literal["differences", "counts"] | None,
    outlet: Outlet,
    desk: Desk,
) -> None:
    """Record a path file, or another program, in the medium that the name after -o says.

    SOURCE is one of three. A CSV file with the columns t_s, x_mm, y_mm, z_mm, tool (x_mm and y_mm, or x and
    y, are enough; a path without times runs at the feed), and u_mm, v_mm … for further axes (A, B, C, U, V,
    W), which only a tape takes. Or a drawing from CAD (.dxf, .svg): its lines run at the feed, inner ones
    first, with the tool up between them. Or a program in any medium: its own control plays it first.

    With --device the tape is played out of a sound device as it is made, so that a recorder can take it.
    """
    job = RecordJob(
        source,
        output,
        force,
        reference_hz,
        cycles_per_mm,
        unit,
        drawn_unit,
        zero,
        orders,
        outlet,
    )
    desk.figures(job.run(desk).figures, aside=str(output) == "-")
