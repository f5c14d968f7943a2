"""The verb `play`: a tape moves the machine, and the machine's path is written."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.types import NUMBER, PLACES, SHARE, TIME
from morfax.console.terminal.desk import Desk, desk_options
from morfax.jobs import files as medium
from morfax.jobs.playing import PIPE, Controls, Passage, tape_options
from morfax.motion.faults import Fault
from morfax.motion.motion import Path
from morfax.reports import following

if TYPE_CHECKING:
    from morfax.player.controls import Playback

SUFFIXES = (".csv", ".svg", ".png")
MOTORS = ("electric", "hydraulic")  # player.phase_lock; the first is the default
OPTIONS = {
    "resume_at_s": "--resume-at",
    "acceleration_mm_s2": "--acceleration",
    "settings": "--motor",
    "zero_mm": "--zero",
    "true_norm": "--norm",
    "override": "--feed-override",
}
FOR_TAPES = {"resume_at_s", "acceleration_mm_s2", "settings", "zero_mm"}

EXAMPLES = """\b
Examples:
  morfax play cam.wav -o cam.csv -o cam.svg -o cam.png
  morfax play cam.wav --feed-override 120% --motor hydraulic --zero 0,0,-0.05
  morfax play cam.ngc --following servos.png --following servos.csv
  arecord -c4 -r48000 -fS16_LE | morfax play - --reference 6kHz --cycles-per-mm 20
  morfax play found.wav --reference 6kHz --cycles-per-mm 20 --from 40,62 -o found.csv
"""


@click.command("play", epilog=EXAMPLES)
@click.argument("tape", type=medium.FILE)
@click.option(
    "-o",
    "outputs",
    type=medium.FILE,
    multiple=True,
    help="Write the machine's path: .csv, .svg (true size) or .png.",
)
@click.option(
    "--path", "path_file", type=medium.FILE, help="Write the machine's path (.csv), as -o does."
)
@click.option(
    "--following",
    "followed",
    type=medium.FILE,
    multiple=True,
    help="Draw (.png, .svg, .pdf) or write (.csv) the following error of each axis against its limit; of an .ngc "
    "program the picture also shows the speed held.",
)
@click.option(
    "--raw",
    is_flag=True,
    help="Keep every sample of the motion.  [default: thinned to within 0.2 um, following errors every 10 ms]",
)
@click.option(
    "--resume-at",
    "resume_at_s",
    type=TIME,
    help="Go on from this tape time, such as 83.2s; --from says where it stands.",
)
@click.option(
    "--acceleration",
    "acceleration_mm_s2",
    type=NUMBER,
    help="The most that the program asks of an axis, mm/s²: less of it bridges longer dropouts.  [default: 5000]",
)
@click.option(
    "--norm",
    type=click.Choice(["weights", "true"]),
    help="Resultant speed of an .ngc program: by the patent's weights, or true.  [default: weights]",
)
@click.option(
    "--feed-override",
    "--override",
    "override",
    type=SHARE,
    help="Speed against the program's, along the same path: of a tape 10% to 200%, of an .ngc program 0% to 100%.  "
    "[default: 100%]",
)
@click.option(
    "--motor",
    type=click.Choice(MOTORS),
    help=f"Motors of the machine that plays a tape: lag, acceleration and top speed.  [default: {MOTORS[0]}]",
)
@click.option(
    "--zero",
    "zero_mm",
    type=PLACES,
    help="Zero adjustment of a tape's axes, X,Y or X,Y,Z … in mm: the machine stands so far from where the tape has it.",
)
@tape_options
@desk_options
def command(
    tape: FilePath,
    outputs: tuple[FilePath, ...],
    path_file: FilePath | None,
    followed: tuple[FilePath, ...],
    raw: bool,
    resume_at_s: float | None,
    acceleration_mm_s2: float | None,
    norm: str | None,
    override: float | None,
    motor: str | None,
    zero_mm: tuple[float, ...] | None,
    controls: Controls,
    desk: Desk,
) -> None:
    """Play a tape into the simulated machine and write the path it runs.

    The path is that of the machine's own lead screws, phase-locked to the tape. Without -o only the figures
    are printed. TAPE - is a pipe: a WAV, or raw 16-bit samples of four tracks. If the machine faults, the
    path up to there is kept, with `.incomplete` in its name.
    """
    outputs = _outputs(tape, outputs, path_file, followed)
    settings: dict[str, Any] = {
        "resume_at_s": resume_at_s,
        "acceleration_mm_s2": acceleration_mm_s2,
        "true_norm": None if norm is None else norm == "true",
        "override": override,
        "settings": motor,
        "zero_mm": zero_mm,
    }
    given = _given(
        tape, {name: value for name, value in settings.items() if value is not None}, controls
    )
    given |= {"raw": raw, "chart": following.new_chart(raw) if followed else None}
    try:
        passage, playback, fault = _played(tape, outputs, controls, desk, given)
    except ValueError as refused:
        if isinstance(refused, Fault):
            raise
        raise click.UsageError(str(refused)) from None
    written = [medium.incomplete(file) if fault else file for file in outputs]
    charts = _write_following(playback, fault, followed, tape.name)
    results = {"paths": [str(file) for file in written] or None, "following": charts or None}
    desk.figures(
        {medium.called(tape): str(tape), **results, **figures(passage, playback, fault)}
    )
    if fault:
        raise fault
    if not passage.worked:
        desk.note(
            "the tool never comes into the work; a tape that runs backwards goes up where it should go down"
        )


def _outputs(
    tape: FilePath,
    outputs: tuple[FilePath, ...],
    path_file: FilePath | None,
    followed: tuple[FilePath, ...],
) -> tuple[FilePath, ...]:
    """Names for the machine's path, each of which can be written, as those for its errors can; raises
    FileFault if not.
    """
    named = (
        *(("-o", file, SUFFIXES) for file in outputs),
        *(("--path", file, (".csv",)) for file in (path_file,) if file is not None),
        *(("--following", file, following.SUFFIXES) for file in followed),
    )
    for option, file, suffixes in named:
        medium.outgoing(medium.with_suffix_in(file, suffixes, option), tape)
    return outputs if path_file is None else (*outputs, path_file)


def _given(tape: FilePath, given: dict[str, Any], controls: Controls) -> dict[str, Any]:
    """The settings that were given, as the control takes them; raises UsageError for one that it does not
    take.
    """
    _refuse_foreign(tape, given)
    if "resume_at_s" in given and controls.start_mm is None:
        raise click.UsageError(
            "--resume-at wants to be told where the machine stands then; give --from X,Y,Z"
        )
    if "settings" not in given:
        return given
    from morfax.player.tape.phase_lock import MOTORS as LOCKS

    return {**given, "settings": LOCKS[given["settings"]]}


def _played(
    tape: FilePath,
    outputs: tuple[FilePath, ...],
    controls: Controls,
    desk: Desk,
    given: dict[str, Any],
) -> tuple[Passage, Playback, Fault | None]:
    """Play a tape and write the machine's path: as it comes if nothing else is asked for, as a picture wants
    the whole of it.
    """
    if all(file.suffix.lower() == ".csv" for file in outputs):
        return controls.play_into(tape, desk, outputs, **given)
    played = controls.play(tape, desk, **given)
    for file in outputs:
        write(
            played.path,
            medium.incomplete(file) if played.fault else file,
            f"{tape.name}, played",
        )
    return Passage.of(played.path), played.playback, played.fault


def _refuse_foreign(tape: FilePath, given: dict[str, Any]) -> None:
    """Raise UsageError for a setting that is for another control than the one that plays the file."""
    from morfax.player.controls import CONTROLS, TAPE, control_of

    control = control_of(tape)
    if str(tape) == PIPE and given:
        raise click.UsageError(f"{_options(given)} is for files, not for a pipe")
    if control != TAPE and not given.keys().isdisjoint(FOR_TAPES):
        raise click.UsageError(
            f"{_options(given.keys() & FOR_TAPES)} is for tapes; {tape} is none"
        )
    if control != CONTROLS[".ngc"] and "true_norm" in given:
        raise click.UsageError(
            f"--norm is for programs of lines and arcs, .ngc; {tape} is none"
        )
    if control not in (TAPE, CONTROLS[".ngc"]) and "override" in given:
        raise click.UsageError(
            f"--feed-override is for tapes and for programs of lines and arcs, .ngc; {tape} is none"
        )


def _options(given: Iterable[str]) -> str:
    """The options of some settings."""
    return ", ".join(sorted(OPTIONS[name] for name in given))


def figures(passage: Passage, playback: Playback, fault: Fault | None) -> dict[str, Any]:
    """What a playing gave, as figures."""
    return {
        "incomplete": True if fault else None,
        "duration_s": passage.end_s - passage.start_s,
        "length_mm": passage.length_mm,
        "start_place_mm": passage.start_mm,
        "end_place_mm": passage.end_mm,
        "largest_following_error_mm": float(max(playback.following_error_mm)),
        **following.figures(playback),
        "bridged_dropouts": len(getattr(playback, "bridged", ())) or None,
    }


def _write_following(
    playback: Playback, fault: Fault | None, files: tuple[FilePath, ...], name: str
) -> list[str]:
    """Write the following errors where they were asked for; the names under which they stand."""
    written = [medium.incomplete(file) if fault else file for file in files]
    pictures = any(file.suffix.lower() != ".csv" for file in files)
    for file in written:
        assert playback.chart is not None
        title = f"{name}: following error against its limit"
        following.write(
            playback.chart, file, title, following.speeds_held(playback) if pictures else None
        )
    return [str(file) for file in written]


def write(path: Path, file: FilePath, title: str) -> None:
    """Write a path as what the file's suffix says."""
    if file.suffix.lower() == ".csv":
        from morfax.motion.pathfile import write_path

        write_path(path, file)
    elif file.suffix.lower() == ".svg":
        from morfax.reports.svg import write_svg

        write_svg(path, file)
    else:
        from morfax.reports.overlay import Picture, draw

        draw(Picture(title, path), file)
