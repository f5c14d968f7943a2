"""The options of a tape that does not say everything itself."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import fields
from typing import Any

from morfax.console.options.files import FILE, machine_names
from morfax.console.options.groups import option, renamed
from morfax.console.options.types import AXES, FREQUENCY, NUMBER, PLACES, TRACKS
from morfax.jobs.machine.playing import ByHand

CYCLES_PER_MM = NUMBER


FOR_MACHINE = option(
    "Machine",
    "--machine",
    metavar="MACHINE",
    shell_complete=machine_names,
    help="The machine that a G-code program is for, as `morfax machines` lists them, or its .toml file: "
    "its words tell when the tool is in the work.  [default: what the program says]",
)


def tape_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of a tape that does not say everything itself, and hand it the `by_hand`."""

    @option(
        "Tape",
        "--reference-frequency",
        "reference_hz",
        type=FREQUENCY,
        help="Reference frequency of the tape, such as 6kHz.  [default: what the tape says]",
    )
    @renamed("--reference", "--reference-frequency")
    @option(
        "Tape",
        "--cycles-per-mm",
        type=CYCLES_PER_MM,
        help="Cycles of phase per mm of travel, such as 20.  [default: what the tape says]",
    )
    @option(
        "Tape",
        "--from",
        "start_mm",
        type=PLACES,
        help="Where the machine stands at the start, mm: X,Y or X,Y,Z …  [default: what the tape says, "
        "else 0,0]",
    )
    @option(
        "Tape",
        "--second",
        type=FILE,
        help="The other file of a tape in two stereo files; their check signal joins them.",
    )
    @option(
        "Tape",
        "--label",
        type=FILE,
        help="Take what the tape does not say from a label (.json, see record --label), or from another "
        "copy of the tape.",
    )
    @option(
        "Tape",
        "--tracks",
        "order",
        type=TRACKS,
        help="On which tracks of the file reference, X, Y … are, such as 2,1,3,4.  [default: 1,2,3 …]",
    )
    @option(
        "Tape",
        "--still",
        type=AXES,
        help="Axes meant to stand from start to end, such as y or x,y.  [default: what the tape says]",
    )
    @option(
        "Tape",
        "--alike",
        type=AXES,
        help="Axes that are meant to run alike, such as x,y.  [default: what the tape says]",
    )
    @option(
        "Tape",
        "--closed",
        is_flag=True,
        default=None,
        help="The program returns to its start: checked where the tape does not say where it ends.",
    )
    @functools.wraps(verb)
    def with_tape(*args: Any, **options: Any) -> Any:
        set_ = {
            field.name: options.pop(field.name)
            for field in fields(ByHand)
            if field.name in options
        }
        return verb(*args, by_hand=ByHand(**set_), **options)

    return with_tape
