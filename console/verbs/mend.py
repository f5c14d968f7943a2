"""The verb `mend`: a tape whose end tells what its dropouts lost is recorded anew."""

from __future__ import annotations

from pathlib import Path as FilePath

import click

from morfax.console.options.types import NUMBER
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import files as medium
from morfax.jobs.playing import Controls, tape_options

EXAMPLES = """\b
Examples:
  morfax mend worn.wav -o mended.wav
  morfax mend found.wav -o mended.wav --reference 6kHz --cycles-per-mm 20 --closed
  morfax mend worn.wav -o mended.wav --acceleration 500
"""


@click.command("mend", epilog=EXAMPLES)
@click.argument("tape", type=medium.FILE)
@click.option(
    "-o",
    "output",
    type=medium.FILE,
    required=True,
    help="The mended tape (.wav, .rf64, .w64, .flac, .aiff).",
)
@click.option(
    "--acceleration",
    "acceleration_mm_s2",
    type=NUMBER,
    help="The most that the program asks of an axis, mm/s²: less of it leaves fewer dropouts in doubt.  [default: 5000]",
)
@tape_options
@desk_options
def command(
    tape: FilePath,
    output: FilePath,
    acceleration_mm_s2: float | None,
    controls: Controls,
    desk: Desk,
) -> None:
    """Record a tape anew whose end tells which dropout lost how many whole cycles.

    The end is that which the tape states, or with --closed its start. Where cycles could have been lost in
    more than one way, nothing is written and the exit code is 5.
    """
    from morfax.player.tape.mend import mend

    medium.outgoing(output, tape)
    desk.warn_of_compiling("the controls", "motion", "player", "recorder")
    with desk.bar(f"mending {tape.name}", 1.0) as advance:
        mended = mend(
            tape,
            output,
            **controls.by_hand(),
            acceleration_mm_s2=acceleration_mm_s2,
            progress=lambda done_s, total_s: advance(done_s / (total_s or 1)),
        )
    rows = [
        {
            "dropout": number,
            "axis": one.axis,
            "time_s": one.time_s,
            "cycles": one.cycles,
            "unknown_mm": one.unknown_mm,
        }
        for number, one in enumerate(mended.mends, 1)
    ]
    told = {
        "tape": str(output),
        "duration_s": mended.recording.duration_s,
        "dropouts": mended.dropouts,
    }
    desk.figures(
        {
            **told,
            "cycles_put_back": sum(abs(one.cycles) for one in mended.mends),
            "mends": rows or None,
        }
    )
