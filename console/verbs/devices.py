"""The verb `devices`: the sound devices, a test tone and meters."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.groups import Verb, option
from morfax.console.options.types import FREQUENCY, TIME
from morfax.console.terminal.meters import Meters
from morfax.jobs.devices import LONGEST_TONE_S, DevicesJob
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.console.terminal.desk import Desk

EXAMPLES = """\b
Examples:
  morfax devices
  morfax devices --json
  morfax devices --test-tone usb --for 60s
  morfax devices --meters usb --for 60s
"""


@click.command("devices", cls=Verb, epilog=EXAMPLES)
@option(
    "Tape",
    "--test-tone",
    "tone",
    metavar="DEVICE",
    help="Play the reference on all tracks, at the level of a tape, out of this device.",
)
@option(
    "Tape",
    "--meters",
    metavar="DEVICE",
    help="Show the levels that come from this device.",
)
@option(
    "Tape",
    "--for",
    "lasts_s",
    type=TIME,
    default="30s",
    show_default=True,
    help="How long tone and meters last.",
)
@option(
    "Tape",
    "--channels",
    "tracks",
    type=click.IntRange(1, 16),
    default=4,
    show_default=True,
    help="How many tracks.",
)
@option(
    "Tape",
    "--reference-frequency",
    "reference_hz",
    type=FREQUENCY,
    default="6kHz",
    show_default=True,
    help="Frequency of the tone.",
)
@desk_options
def command(
    tone: str | None,
    meters: str | None,
    lasts_s: float,
    tracks: int,
    reference_hz: float,
    desk: Desk,
) -> None:
    """List the sound devices; play a test tone, and show the levels of its tracks.

    Name a device by its number, its name or a part of it. With --test-tone, set the recorder to its usual
    recording level; with --meters, set its playback to about -6 dB on every track.
    """
    if not 0 < lasts_s <= LONGEST_TONE_S:
        raise WrongUse(f"--for is {lasts_s:g} s; it may be up to {LONGEST_TONE_S:g}s")
    if tone is not None and tracks < 2:
        raise WrongUse("a test tone has 2 tracks or more; give --channels 2")
    with Meters(sys.stderr, is_shown=not desk.quiet) as shown:
        job = DevicesJob(tone, meters, lasts_s, tracks, reference_hz, shown.show)
        result = job.run(desk)
    if result.figures.get("devices") == [] and not desk.json:
        desk.note("no sound device is there; connect one, or start the sound server")
        return
    desk.figures(result.figures)
