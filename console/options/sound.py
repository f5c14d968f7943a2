"""The options of tapes that go to a sound device, or come from one."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import click

from morfax.console.options.groups import option
from morfax.console.options.types import TIME
from morfax.jobs.media.live import STANDSTILL_S, Intake, Outlet
from morfax.motion.usual import WAIT_S

DEVICE = "a sound device: its number, its name or a part of it, as `morfax devices` lists them"


def intake_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of a device that a tape comes from, and hand it the `intake`."""

    @option("Tape", "--device", metavar="DEVICE", help=f"Take the tape in from {DEVICE}.")
    @option(
        "Tape",
        "--wait",
        "wait_s",
        type=TIME,
        help=f"How long to wait for the tape on the device.  [default: {WAIT_S:g}s]",
    )
    @functools.wraps(verb)
    def with_intake(
        *args: Any, device: str | None, wait_s: float | None, **options: Any
    ) -> Any:
        intake = Intake(device, WAIT_S if wait_s is None else wait_s)
        return verb(*args, intake=intake, **options)

    return with_intake


def outlet_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of where a tape goes, and hand it the `outlet`."""

    @option("Tape", "--device", metavar="DEVICE", help=f"Play the tape out of {DEVICE}.")
    @option(
        "Tape",
        "--label",
        type=click.Path(path_type=FilePath, dir_okay=False),
        help="Write what the tape's tracks do not say: format, start and end (.json), for play --label.",
    )
    @option(
        "Tape",
        "--stereo",
        is_flag=True,
        help="Record two stereo files, of -o cam.wav: cam.1-2.wav (reference, X) and cam.3-4.wav (Y, Z).",
    )
    @option(
        "Tape",
        "--standstill",
        "standstill_s",
        type=TIME,
        help=f"Standstill at both ends of a tape.  [default: 1s; with --device {STANDSTILL_S:g}s]",
    )
    @functools.wraps(verb)
    def with_outlet(
        *args: Any,
        device: str | None,
        stereo: bool,
        label: FilePath | None,
        standstill_s: float | None,
        **options: Any,
    ) -> Any:
        outlet = Outlet(device, stereo, label, standstill_s)
        return verb(*args, outlet=outlet, **options)

    return with_outlet
