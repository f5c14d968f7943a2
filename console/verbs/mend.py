"""The verb `mend`: a tape that tells what its dropouts lost is recorded anew."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import FILE
from morfax.console.options.groups import Verb, option
from morfax.console.options.tape import tape_options
from morfax.console.options.types import NUMBER
from morfax.jobs.mend import MendJob

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk
    from morfax.jobs.machine.playing import ByHand

EXAMPLES = """\b
Examples:
  morfax mend worn.wav -o mended.wav
  morfax mend found.wav -o mended.wav --reference-frequency 6kHz --cycles-per-mm 20 --closed
  morfax mend worn.wav -o mended.wav --acceleration 500
"""


@click.command("mend", cls=Verb, epilog=EXAMPLES)
@click.argument("tape", type=FILE)
@option(
    "Output",
    "-o",
    "output",
    type=FILE,
    required=True,
    help="The mended tape (.wav, .rf64, .w64, .flac, .aiff).",
)
@option(
    "Machine",
    "--acceleration",
    "acceleration_mm_s2",
    type=NUMBER,
    help="The most that the program asks of an axis, mm/s²: with a lower figure fewer dropouts stay in "
    "doubt.  "
    "[default: 5000]",
)
@tape_options
@desk_options
def command(
    tape: FilePath,
    output: FilePath,
    acceleration_mm_s2: float | None,
    by_hand: ByHand,
    desk: Desk,
) -> None:
    """Record a tape anew without its dropouts.

    A check signal says where the axes are behind each dropout. morfax fills in the path within the dropout
    with the least acceleration, and reports its largest possible error. A bare tape can be mended if its end,
    or with --closed its start, shows which dropout lost how many whole cycles. If more than one way is
    possible, nothing is written and the exit code is 5.
    """
    job = MendJob(tape, output, acceleration_mm_s2, by_hand)
    desk.figures(job.run(desk).figures)
