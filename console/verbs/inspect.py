"""The verb `inspect`: what is on a tape.

The carriers are measured in windows of 4096 frames, and say what they are even where nothing else is known of
the tape:

    level        root mean square of the track, against that of a full-scale sine                       (dB)
    frequency    the peak of the window's spectrum, by a parabola through the logarithms of three bins  (Hz)

The travel of each axis comes from the phases, and so needs the format: from the text chunk, or by hand.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click
import numpy as np
from numpy.typing import NDArray

from morfax.console.terminal.desk import Desk, desk_options
from morfax.console.verbs import inspect_programs as programs
from morfax.jobs import files as medium
from morfax.jobs.playing import Controls, tape_options
from morfax.motion.faults import TapeFault
from morfax.reports.table import Figures

if TYPE_CHECKING:
    from morfax.recorder.tape.tape import Tape

from morfax.motion.arrays import Array

WINDOW_FRAMES = 4096  # 85 ms at 48 kHz: bins of 12 Hz
BLOCK_FRAMES = 16 * WINDOW_FRAMES
SILENT_DB = -80.0  # below it there is no carrier whose frequency could be told

EXAMPLES = """\b
Examples:
  morfax inspect cam.wav
  morfax inspect found.wav --reference 6kHz --cycles-per-mm 20
  morfax inspect cam.wav --json
  morfax inspect cam.steps -o cam-tape.svg
"""


@dataclass(frozen=True, slots=True)
class Carrier:
    """The carrier of one track: level and frequency of each window, dB and Hz (not a number where silent)."""

    level_db: Array
    frequency_hz: Array

    def figures(self) -> dict[str, Any]:
        """Levels, and between which frequencies the carrier moves."""
        heard = self.frequency_hz[np.isfinite(self.frequency_hz)]
        return {
            "level_db": float(np.median(self.level_db)),
            "lowest_level_db": float(self.level_db.min()),
            "from_hz": float(heard.min()) if len(heard) else None,
            "to_hz": float(heard.max()) if len(heard) else None,
        }


@click.command("inspect", epilog=EXAMPLES)
@click.argument("tape", type=medium.FILE)
@click.option(
    "-o",
    "picture",
    type=medium.FILE,
    help="Draw the punched tape of a .steps program (.png, .svg).",
)
@tape_options
@desk_options
def command(tape: FilePath, picture: FilePath | None, controls: Controls, desk: Desk) -> None:
    """Say what is on a tape: tracks, carriers, levels, travel, format.

    A tape that cannot be played is told as far as it goes, and then why it cannot. Of a program in another
    medium (.steps, .cubic, .ngc) its format and what it does are told.
    """
    if medium.kind_of(tape) == "program":
        controls.of_tape(tape)
        desk.figures(programs.inspect(tape, picture, desk))
        return
    if picture is not None:
        raise click.UsageError(f"{tape} has no punched tape to draw; -o is for .steps")
    stated: dict[str, Any] = {}
    travels: dict[str, Figures] = {}
    fault: TapeFault | None = None
    try:
        with controls.open_tape(tape) as opened:
            stated, travels = _stated(opened), _travels(opened, desk)
    except TapeFault as met:
        fault = met
    file, carriers = _listen(tape, fault)
    names = [
        *("reference", *travels)[: len(carriers)],
        *("" for _ in carriers[1 + len(travels) :]),
    ]
    tracks = {
        f"track_{number}_{name}".rstrip("_"): {**carrier.figures(), **travels.get(name, {})}
        for number, (name, carrier) in enumerate(zip(names, carriers, strict=True), 1)
    }
    desk.figures({"tape": str(tape), **file, **stated, **tracks})
    if fault is not None:
        raise fault


def _stated(tape: Tape) -> dict[str, Any]:
    """What the format says, from the text chunk or by hand."""
    fmt = tape.format
    return {
        "reference_hz": fmt.reference_hz,
        "cycles_per_mm": fmt.cycles_per_mm,
        "largest_speed_mm_s": fmt.largest_speed_mm_s,
        "start_place_mm": fmt.start_mm,
        "end_place_mm": fmt.end_mm,
        "text": tape.text or "none",
    }


def _travels(tape: Tape, desk: Desk) -> dict[str, Figures]:
    """How far each axis goes from its start, mm, by the phases of its track."""
    from morfax.player.tape.discriminator import Discriminator, discriminate

    fmt = tape.format
    desk.warn_of_compiling("the discriminator", "player")
    discriminator = Discriminator(
        fmt.sample_rate_hz, fmt.reference_hz, fmt.samples_per_motion, fmt.tracks
    )
    low, high = np.full(len(fmt.axes), np.inf), np.full(len(fmt.axes), -np.inf)
    zero: Array | None = None
    for phases in discriminate(tape.stored_blocks(BLOCK_FRAMES), discriminator):
        zero = phases.cycles[0] if zero is None else zero
        low, high = (
            np.fmin(low, phases.cycles.min(axis=0)),
            np.fmax(high, phases.cycles.max(axis=0)),
        )
    if zero is None:
        return {name: {} for name in fmt.axes}
    lowest, highest = (low - zero) / fmt.cycles_per_mm, (high - zero) / fmt.cycles_per_mm
    return {
        name: {"lowest_travel_mm": float(lowest[i]), "highest_travel_mm": float(highest[i])}
        for i, name in enumerate(fmt.axes)
    }


def _listen(file: FilePath, fault: TapeFault | None) -> tuple[dict[str, Any], list[Carrier]]:
    """Kind and length of the file, and the carrier of each track; raises the fault if it is no sound file."""
    import soundfile

    try:
        with soundfile.SoundFile(file) as sound:
            kind = {"kind": f"{sound.format} {sound.subtype}", "tracks": sound.channels}
            blocks = sound.blocks(BLOCK_FRAMES, dtype="float32", always_2d=True)
            carriers = _carriers(blocks, sound.samplerate, sound.channels)
            duration_s = sound.frames / sound.samplerate
            return {
                **kind,
                "sample_rate_hz": sound.samplerate,
                "duration_s": duration_s,
            }, carriers
    except soundfile.SoundFileError as error:
        raise (
            fault
            or TapeFault(f"{file} cannot be read as a sound file: {error}; record it again")
        ) from None


def _carriers(
    blocks: Iterable[NDArray[np.float32]], rate_hz: float, tracks: int
) -> list[Carrier]:
    """Measure the tracks, window by window; what is left over at the end is shorter than a window and left
    out.
    """
    levels, frequencies = [np.full((1, tracks), -np.inf)], [np.full((1, tracks), np.nan)]
    for block in blocks:
        windows = block[: len(block) // WINDOW_FRAMES * WINDOW_FRAMES].reshape(
            -1, WINDOW_FRAMES, tracks
        )
        if len(windows):
            level_db = 10 * np.log10(2 * (windows.astype(float) ** 2).mean(axis=1) + 1e-30)
            levels.append(level_db)
            frequencies.append(
                np.where(level_db > SILENT_DB, _peak_hz(windows, rate_hz), np.nan)
            )
    level, frequency = (np.vstack(rows[1:] or rows) for rows in (levels, frequencies))
    return [Carrier(level[:, track], frequency[:, track]) for track in range(tracks)]


def _peak_hz(windows: NDArray[np.float32], rate_hz: float) -> Array:
    """Frequency of the highest peak of each window (windows, frames, tracks), Hz."""
    spectrum = np.abs(np.fft.rfft(windows * np.hanning(WINDOW_FRAMES)[:, None], axis=1)) + 1e-30
    peak = spectrum[:, 1:-1].argmax(axis=1)[:, None] + 1
    left, middle, right = (
        np.log(np.take_along_axis(spectrum, peak + step, axis=1))[:, 0] for step in (-1, 0, 1)
    )
    curve = left - 2 * middle + right
    shift = np.where(curve < 0, (left - right) / (2 * np.where(curve < 0, curve, 1)), 0)
    return np.asarray((peak[:, 0] + shift) * rate_hz / WINDOW_FRAMES)
