"""The verb `record`: a path file becomes a tape."""

from __future__ import annotations

from pathlib import Path as FilePath

import click

from console import medium
from console.desk import Desk, desk_options
from console.playing import CYCLES_PER_MM
from console.quantities import FREQUENCY, SPEED

TAPES = (".wav", ".rf64", ".flac")

EXAMPLES = """\b
Examples:
  morfax record cam.csv -o cam.wav
  morfax record outline.csv -o slow.wav --feed 300mm/min
  morfax record cam.csv -o coarse.wav --reference 400Hz --cycles-per-mm 8
"""


@click.command("record", epilog=EXAMPLES)
@click.argument("path", type=medium.FILE)
@click.option("-o", "output", type=medium.FILE, help="The tape (.wav).  [default: the path's name with .wav, here]")
@click.option(
    "--feed", "feed_mm_s", type=SPEED, default="10mm/s", show_default=True, help="Speed of a path without times."
)
@click.option(
    "--reference", "reference_hz", type=FREQUENCY, default="6kHz", show_default=True, help="Reference frequency."
)
@click.option(
    "--cycles-per-mm", type=CYCLES_PER_MM, default=20.0, show_default=True, help="Cycles of phase per mm of travel."
)
@click.option("--force", is_flag=True, help="Write over a tape that is there already under a name not given with -o.")
@desk_options
def command(
    path: FilePath,
    output: FilePath | None,
    feed_mm_s: float,
    reference_hz: float,
    cycles_per_mm: float,
    force: bool,
    desk: Desk,
) -> None:
    """Record a path file on a tape.

    PATH is a CSV file with the columns t_s, x_mm, y_mm, z_mm, tool (x_mm and y_mm, or x and y, are enough; without
    times the path is run at the feed).
    """
    from motion.contour import length_mm
    from motion.pathfile import read_path
    from recorder.tape import TapeFormat, record

    tape = _tape(output, path, force)
    read = read_path(path, feed_mm_s)
    desk.warn_of_compiling("the recorder", "motion", "recorder")
    stream = desk.watched(read.motion(), f"recording {tape.name}", float(read.t_s[-1] - read.t_s[0]))
    recording = record(stream, tape, TapeFormat(reference_hz=reference_hz, cycles_per_mm=cycles_per_mm))
    desk.figures(
        {
            "tape": str(tape),
            "duration_s": recording.duration_s,
            "length_mm": length_mm(read) if read.tool.any() else 0.0,
            "start_place_mm": read.positions_mm[0],
            "end_place_mm": read.positions_mm[-1],
        }
    )


def _tape(output: FilePath | None, path: FilePath, force: bool) -> FilePath:
    """The name for the tape, which can be written; raises FileFault if not."""
    if output is None:
        return medium.made_up(FilePath(f"{path.stem}.wav"), path, force=force)
    return medium.outgoing(medium.with_suffix_in(output, TAPES), path)
