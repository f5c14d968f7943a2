"""The verb `record`: a path file, or a program played on its own control, becomes a program in any medium."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.types import FEED, FREQUENCY, LENGTH
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import files as medium
from morfax.jobs.playing import CYCLES_PER_MM, Controls
from morfax.jobs.recording import Unit, rehearsed, unit_options

if TYPE_CHECKING:
    from morfax.motion.motion import Path

EXAMPLES = """\b
Examples:
  morfax record cam.csv -o cam.wav
  morfax record cam.wav -o cam.steps --tolerance 20um
  morfax record outline.csv -o slow.wav --feed 300mm/min
  morfax record cam.wav -o left-hand.wav --mirror x --pickup photocell
"""


@click.command("record", epilog=EXAMPLES)
@click.argument("source", type=medium.FILE)
@click.option(
    "-o",
    "output",
    type=medium.FILE,
    help="The program (.wav, .steps, .cubic, .ngc).  [default: the source's name with .wav, here]",
)
@click.option(
    "--feed",
    "feed_mm_s",
    type=FEED,
    default="10mm/s",
    show_default=True,
    help="Speed of a path without times.",
)
@click.option(
    "--reference",
    "reference_hz",
    type=FREQUENCY,
    default="6kHz",
    show_default=True,
    help="Reference frequency.",
)
@click.option(
    "--cycles-per-mm",
    type=CYCLES_PER_MM,
    help="Cycles of phase per mm of travel.  [default: those of the pick-up: 20, of the scale 10]",
)
@click.option(
    "--tolerance",
    "tolerance_mm",
    type=LENGTH,
    help="How far the program's path may be off; not for tapes.  [default: the medium's own]",
)
@click.option(
    "--force",
    is_flag=True,
    help="Write over a tape that is there already under a name not given with -o.",
)
@unit_options
@desk_options
def command(
    source: FilePath,
    output: FilePath | None,
    feed_mm_s: float,
    reference_hz: float,
    cycles_per_mm: float | None,
    tolerance_mm: float | None,
    force: bool,
    unit: Unit,
    desk: Desk,
) -> None:
    """Record a path file, or another program, in the medium that the name after -o says.

    SOURCE is a CSV file with the columns t_s, x_mm, y_mm, z_mm, tool (x_mm and y_mm, or x and y, are enough;
    without times the path is run at the feed), and u_mm, v_mm … for further axes (A, B, C, U, V, W), which
    only a tape takes; or a program in any medium, which is first played on its own control.
    """
    from morfax.motion.contour import length_mm
    from morfax.recorder.media import record

    program = _program(output, source, force)
    unit.check(program)
    settings = _settings(program, unit, reference_hz, cycles_per_mm, tolerance_mm)
    read = unit.placement.path(_path(source, feed_mm_s, desk))
    if "fmt" in settings:
        settings["fmt"] = replace(settings["fmt"], axes=read.axes, start_mm=())
    unit.warn(desk)
    desk.warn_of_compiling("the recorder", "motion", "recorder")
    stream = desk.watched(
        read.motion(), f"recording {program.name}", float(read.t_s[-1] - read.t_s[0])
    )
    if "fmt" in settings:
        stream = rehearsed(stream, settings["fmt"], desk)
    recording = record(stream, program, **settings)
    length = length_mm(read) if read.tool.any() else 0.0
    is_tape = program.suffix.lower() in medium.TAPES
    desk.figures(
        {
            medium.called(program): str(program),
            "duration_s": recording.duration_s,
            "length_mm": length,
            "start_place_mm": read.positions_mm[0],
            "end_place_mm": read.positions_mm[-1],
            "bits_per_mm": 8 * recording.bytes / length if length else None,
            "as_tape_bits_per_mm": _tape_bits(recording.duration_s) / length
            if length and not is_tape
            else None,
            **medium.told(recording),
            **unit.figures(),
        }
    )


def _tape_bits(duration_s: float) -> float:
    """Bits of a magnetic tape of the usual format that runs so long, to set beside those of another medium."""
    from morfax.recorder.tape.tape import TapeFormat

    fmt = TapeFormat()
    return 16 * fmt.tracks * fmt.sample_rate_hz * (duration_s + 2 * fmt.dwell_s)


def _program(output: FilePath | None, source: FilePath, force: bool) -> FilePath:
    """The name for the program, which can be written; raises FileFault if not."""
    from morfax.recorder.media import MEDIA

    if output is None:
        return medium.made_up(FilePath(f"{source.stem}.wav"), source, force=force)
    return medium.outgoing(medium.with_suffix_in(output, tuple(MEDIA)), source)


def _settings(
    program: FilePath,
    unit: Unit,
    reference_hz: float,
    cycles_per_mm: float | None,
    tolerance_mm: float | None,
) -> dict[str, Any]:
    """What the recorder of this medium is told."""
    if program.suffix.lower() not in medium.TAPES:
        return {} if tolerance_mm is None else {"tolerance_mm": tolerance_mm}
    if tolerance_mm is not None:
        raise click.UsageError(
            "--tolerance is not for tapes: a tape holds the motion itself; leave it out"
        )
    try:
        return {"fmt": unit.tape_format(reference_hz=reference_hz, cycles_per_mm=cycles_per_mm)}
    except ValueError as refused:
        raise click.UsageError(f"there is no such tape: {refused}") from None


def _path(source: FilePath, feed_mm_s: float, desk: Desk) -> Path:
    """Read a path file, or play a program."""
    if medium.kind_of(source) in ("tape", "program"):
        return Controls().play_whole(source, desk)
    from morfax.motion.pathfile import read_path

    return read_path(source, feed_mm_s)
