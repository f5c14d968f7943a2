"""The verb `age`: what a real recorder and the years do to a tape."""

from __future__ import annotations

import re
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.files import FILE
from morfax.console.options.groups import Verb, option, renamed
from morfax.console.options.types import FREQUENCY, TIME, TRACKS, Quantity
from morfax.jobs.age import CODECS, SETS, AgeJob
from morfax.motion.units import parse_frequency_hz

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk

EXAMPLES = """\b
Examples:
  morfax age cam.wav -o worn.wav --preset cassette --seed 7
  morfax age cam.wav -o fast.wav --speed-error 1.5% --flutter 0.2%
  morfax age cam.wav -o holes.wav --dropouts 60 --dropout-length 5ms --dropout-depth 40dB
  morfax age cam.wav -o mixed.wav --order 2,1,3,4 --inverted 3
"""


def _share(text: str) -> float:
    """A share of "1.5%" or a bare number."""
    try:
        return float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        raise ValueError(
            f"{text[:40]!r} is no share; give 1.5%, or a bare number such as 0.015"
        ) from None


def _decibels(text: str) -> float:
    """Decibels of "46dB" or a bare number."""
    found = re.fullmatch(r"([+-]?[\d.]+)\s*(?:dB)?", text.strip(), re.IGNORECASE)
    try:
        return float(found[1]) if found else float("x")
    except ValueError:
        raise ValueError(
            f"{text[:40]!r} is no level; give 46dB or a bare number of dB"
        ) from None


def _band_hz(text: str) -> tuple[float, float]:
    """The two ends of "300Hz,3.4kHz"."""
    low, _, high = text.partition(",")
    ends = parse_frequency_hz(low), parse_frequency_hz(high or low)
    if not 0 < ends[0] < ends[1]:
        raise ValueError(f"{text[:40]!r} is no band; give its two ends, such as 300Hz,3.4kHz")
    return ends


SHARE, DECIBELS = Quantity("share", _share), Quantity("dB", _decibels)
BAND = Quantity("band", _band_hz)

PARTS: tuple[tuple[str, str, Any, str], ...] = (
    ("--speed-error", "speed", SHARE, "Speed error, such as 1.5% or -1.5%."),
    ("--wow", "wow", SHARE, "Unevenness of speed from 0.5 to 4 Hz, RMS."),
    ("--flutter", "flutter", SHARE, "Unevenness of speed from 4 to 100 Hz, RMS."),
    ("--scrape", "scrape", SHARE, "Unevenness of speed from 100 to 2000 Hz, RMS."),
    ("--skew", "skew_s", TIME, "Each track later than the one before, such as 12us."),
    ("--weave", "weave_s", TIME, "The skew wandering, RMS from track to track."),
    ("--noise", "noise_db", DECIBELS, "Noise, dB below the carrier."),
    ("--level", "level_db", DECIBELS, "Level, dB against what it was."),
    ("--uneven", "uneven_db", DECIBELS, "Level rising and falling slowly, dB RMS."),
    (
        "--crosstalk",
        "crosstalk_db",
        DECIBELS,
        "Crosstalk from the neighbouring tracks, dB below.",
    ),
    ("--print-through", "print_db", DECIBELS, "Echo of the layers above and below, dB below."),
    ("--dropouts", "dropouts_per_min", click.FloatRange(min=0), "Dropouts in a minute."),
    (
        "--dropout-length",
        "dropout_s",
        TIME,
        "Length of the dropouts: half of them are shorter, half longer.",
    ),
    ("--dropout-depth", "dropout_db", DECIBELS, "Their depth, dB."),
    ("--hum", "hum_db", DECIBELS, "Hum, dB below the carrier."),
    ("--hum-frequency", "hum_hz", FREQUENCY, "Frequency of the hum."),
    ("--dc", "dc", SHARE, "Direct current, share of full scale."),
    ("--distortion", "third", SHARE, "Third harmonic, share of the carrier."),
    ("--bandwidth", "bandwidth_hz", FREQUENCY, "Where the tape is 3 dB down, such as 12.5kHz."),
    (
        "--band",
        "band_hz",
        BAND,
        "Steep ends of the band, such as 300Hz,3.4kHz of a telephone.",
    ),
    (
        "--codec",
        "codec",
        click.Choice(CODECS),
        "Coded and decoded, two tracks to a stereo file; the number is kbit/s.",
    ),
    ("--clip", "clip", SHARE, "Clipped at this share of full scale."),
    ("--stamped", "stamped_hz", FREQUENCY, "A wrong sample rate in the header."),
    ("--order", "order", TRACKS, "The tracks in another order, such as 2,1,3,4."),
    ("--inverted", "inverted", TRACKS, "Tracks with the wrong polarity, such as 1,3."),
    ("--cut-start", "cut_start_s", TIME, "A start that is missing."),
    ("--cut-end", "cut_end_s", TIME, "An end that is missing."),
)


def part_options(verb: Any) -> Any:
    """Give a verb an option for each part of the wear."""
    for name, part, kind, said in reversed(PARTS):
        verb = option("Wear", name, part, type=kind, default=None, help=said)(verb)
    return verb


@click.command("age", cls=Verb, epilog=EXAMPLES)
@click.argument("tape", type=FILE)
@option(
    "Output",
    "-o",
    "output",
    type=FILE,
    required=True,
    help="The worn tape (.wav, .rf64, .w64, .flac, .aiff).",
)
@option(
    "Wear",
    "--preset",
    "machine",
    type=click.Choice(SETS),
    help="All that a kind of machine does, by the figures in docs/background/transport.md; single parts "
    "take precedence.",
)
@option(
    "Wear",
    "--seed",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Another seed gives another tape.",
)
@option(
    "Wear",
    "--all-tracks",
    "dropout_all",
    is_flag=True,
    default=None,
    help="Dropouts on all tracks at once.",
)
@part_options
@renamed("--as", "--preset")
@renamed("--speed", "--speed-error")
@desk_options
def command(
    tape: FilePath, output: FilePath, machine: str | None, seed: int, desk: Desk, **parts: Any
) -> None:
    """Add the wear of a real recorder to a tape: noise, flutter, dropouts.

    Each option adds one kind of wear; without any the tape is only copied. docs/background/transport.md
    describes the presets.
    """
    worn = {name: value for name, value in parts.items() if value is not None}
    if "stamped_hz" in worn:
        worn["stamped_hz"] = round(worn["stamped_hz"])
    job = AgeJob(tape, output, machine, tuple(worn.items()), seed)
    desk.figures(job.run(desk).figures)
