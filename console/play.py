"""The verb `play`: a tape moves the machine, and the machine's path is written."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

import click

from console import medium
from console.desk import Desk, desk_options
from console.playing import Controls, Played, tape_options
from motion.motion import Path

SUFFIXES = (".csv", ".svg", ".png")

EXAMPLES = """\b
Examples:
  morfax play cam.wav -o cam.csv
  morfax play cam.wav -o cam.csv -o cam.svg -o cam.png
  morfax play found.wav --reference 6kHz --cycles-per-mm 20 --from 40,62 -o found.csv
"""


@click.command("play", epilog=EXAMPLES)
@click.argument("tape", type=medium.FILE)
@click.option(
    "-o", "outputs", type=medium.FILE, multiple=True, help="Write the machine's path: .csv, .svg (true size) or .png."
)
@click.option("--raw", is_flag=True, help="Keep every sample of the motion.  [default: thinned to within 0.2 um]")
@tape_options
@desk_options
def command(tape: FilePath, outputs: tuple[FilePath, ...], raw: bool, controls: Controls, desk: Desk) -> None:
    """Play a tape into the simulated machine and write the path it runs.

    The path is that of the machine's own lead screws, phase-locked to the tape. Without -o only the figures are
    printed. If the machine faults, the path up to there is kept, with `.incomplete` in its name.
    """
    for file in outputs:
        medium.outgoing(medium.with_suffix_in(file, SUFFIXES), tape)
    played = controls.play(tape, desk, raw=raw)
    written = [medium.incomplete(file) if played.fault else file for file in outputs]
    for file in written:
        write(played.path, file, f"{tape.name}, played")
    desk.figures({"tape": str(tape), "paths": [str(file) for file in written] or None, **figures(played)})
    if played.fault:
        raise played.fault


def figures(played: Played) -> dict[str, Any]:
    """What a playing gave, as figures."""
    playback, path = played.playback, played.path
    return {
        "incomplete": True if played.fault else None,
        "duration_s": float(path.t_s[-1] - path.t_s[0]),
        "length_mm": _length_mm(path),
        "start_place_mm": path.positions_mm[0],
        "end_place_mm": path.positions_mm[-1],
        "largest_following_error_mm": float(max(playback.following_error_mm)),
    }


def write(path: Path, file: FilePath, title: str) -> None:
    """Write a path as what the file's suffix says."""
    if file.suffix.lower() == ".csv":
        from motion.pathfile import write_path

        write_path(path, file)
    elif file.suffix.lower() == ".svg":
        from console.svg import write_svg

        write_svg(path, file)
    else:
        from console.overlay import Picture, draw

        draw(Picture(title, path), file)


def _length_mm(path: Path) -> float:
    """Length in the work, mm; 0 where the tool never comes down."""
    from motion.contour import length_mm

    return length_mm(path) if path.tool.any() else 0.0
