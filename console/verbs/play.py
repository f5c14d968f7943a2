"""The verb `play`: a tape moves the machine, and the machine's path is written."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import DRAWN_UNIT
from morfax.console.options.files import FILE, PATHS, PICTURES, ProgramPath, Result
from morfax.console.options.groups import Verb, option, renamed
from morfax.console.options.output import FORCE
from morfax.console.options.sound import intake_options
from morfax.console.options.tape import FOR_MACHINE, tape_options
from morfax.console.options.types import NUMBER, PLACES, REACH, SHARE, TIME
from morfax.jobs.play import MOTORS, ControlSettings, PlayJob
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.playing import ByHand
    from morfax.jobs.media.live import Intake

EXAMPLES = """\b
Examples:
  morfax play cam.wav -o cam.csv -o cam.svg -o cam.png
  morfax play cam.ngc --control herbert --following servos.png --picture cam.png
  morfax play found.wav --reference-frequency 6kHz --cycles-per-mm 20 --from 40,62 -o found.csv
  morfax play --device usb --label cam.json -o cam.csv
"""


@click.command("play", cls=Verb, epilog=EXAMPLES)
@click.argument("tape", type=FILE, required=False)
@option(
    "Output",
    "-o",
    "outputs",
    type=ProgramPath(".csv", ".svg", ".png"),
    multiple=True,
    help="Write the machine's path: .csv, .svg (true size) or .png; or record it in another medium: a tape "
    "(.wav), .steps, .cubic, G-code (.ngc), .dxf, .plt.",
)
@option(
    "Output",
    "--path",
    "path_file",
    type=Result(*PATHS),
    help="Write the machine's path (.csv), as -o does.",
)
@option(
    "Output",
    "--following",
    "charts",
    type=Result(*PICTURES, *PATHS),
    multiple=True,
    help="Draw (.png, .svg, .pdf) or write (.csv) the following error of each axis against its limit; "
    "of an .ngc "
    "program the picture also shows the speed held.",
)
@option(
    "Output",
    "--picture",
    type=Result(*PICTURES),
    help="Draw the machine's path (.png, .svg, .pdf) with the following error of X and Y along it in colour, "
    "the worst places enlarged.",
)
@option(
    "Output",
    "--raw",
    is_flag=True,
    help="Keep every sample of the motion.  [default: thinned to within 0.2 um, following errors every "
    "10 ms]",
)
@FORCE
@option(
    "Machine",
    "--resume-at",
    "resume_at_s",
    type=TIME,
    help="Go on from this tape time, such as 83.2s; --from says where the machine stands.",
)
@option(
    "Machine",
    "--acceleration",
    "acceleration_mm_s2",
    type=NUMBER,
    help="The most that the program asks of an axis, mm/s²: a lower figure bridges longer dropouts.  "
    "[default: 5000]",
)
@option(
    "Machine",
    "--norm",
    type=click.Choice(["weights", "true"]),
    help="Resultant speed of an .ngc program: by the patent's weights, or true.  [default: weights]",
)
@option(
    "Machine",
    "--feed-override",
    type=SHARE,
    help="Speed against the program's, along the same path: of a tape 10% to 200%, of an .ngc program "
    "0% to 100%.  "
    "[default: 100%]",
)
@option(
    "Machine",
    "--control",
    type=click.Choice(["herbert"]),
    help="Play an .ngc program on another control: herbert, position servos whose ramps are counted by the "
    "transducers' increments; each line and arc is run from rest to rest.  [default: the pulse control]",
)
@option(
    "Machine",
    "--historic",
    is_flag=True,
    help="The patents' own units: of an .ngc program pulses of 12.7 um and registers of 16 bits (1967), of "
    "a .cubic program stores whose digits come round, 64 counts to a pitch and 6.8 points per second (1957).",
)
@renamed("--override", "--feed-override")
@option(
    "Machine",
    "--motor",
    type=click.Choice(MOTORS),
    help=f"Motors of the machine that plays a tape: lag, acceleration and top speed.  [default: {MOTORS[0]}]",
)
@option(
    "Machine",
    "--zero-adjustment",
    "zero_mm",
    type=PLACES,
    help="Zero adjustment of a tape's axes, X,Y or X,Y,Z … in mm: how far the machine stands from where "
    "the tape "
    "has it.",
)
@option(
    "Machine",
    "--wheel-eccentricity",
    "wheel_eccentricity_mm",
    type=REACH,
    help="How far the arm of each pick-up turns off the axis of its sector wheel (radius 30 mm): an error "
    "once in a turn of the screw.  [default: 0mm]",
)
@option(
    "Machine",
    "--wheel-division",
    "wheel_division_mm",
    type=REACH,
    help="How far the sectors' edges stand off their places at most, along the rim.  [default: 0mm]",
)
@option(
    "Machine",
    "--lamp",
    type=SHARE,
    help="Light of the pick-ups' lamps: below 10% their cells give no signal, and the drives lose their "
    "lock.  [default: 100%]",
)
@intake_options
@FOR_MACHINE
@DRAWN_UNIT
@renamed("--zero", "--zero-adjustment")
@tape_options
@desk_options
def command(
    tape: FilePath | None,
    outputs: tuple[FilePath, ...],
    path_file: FilePath | None,
    charts: tuple[FilePath, ...],
    picture: FilePath | None,
    raw: bool,
    by_hand: ByHand,
    drawn_unit: str | None,
    intake: Intake,
    desk: Desk,
    **control: Any,
) -> None:
    """Play a program on the simulated machine and write the path that the machine runs.

    The path is that of the machine's own lead screws, which a tape moves by phase lock. Without -o the verb
    only prints figures. TAPE may be any program, or -, a pipe: a WAV, or raw 16-bit samples of four tracks.
    With --device the tape comes from a sound device, as a recorder plays it. A drawing from CAD (.dxf, .svg)
    is recorded on a tape first, as `morfax record` does it. If the machine faults, the path before the fault
    is kept, with `.incomplete` in its name.

    `duration` is what the simulated machine takes, whose rapids run at 20 mm/s; of G-code `machine duration`
    is what the machine takes that it is for, as `morfax check` says it.
    """
    if (tape is None) == (intake.device is None):
        raise WrongUse("give a TAPE, or a --device that it comes from")
    tape = FilePath("-") if tape is None else tape
    paths = outputs if path_file is None else (*outputs, path_file)
    settings = ControlSettings(
        **{field.name: control[field.name] for field in fields(ControlSettings)}
    )
    asked = PlayJob(tape, paths, charts, raw, settings, by_hand, drawn_unit, intake, picture)
    result = asked.run(desk)
    if result.path is not None or result.chart is not None:
        from morfax.reports.pictures import draw_played

        draw_played(result, tape.name)
    desk.figures(result.figures)
    if result.fault is not None:
        raise result.fault
