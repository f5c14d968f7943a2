"""The controls: which of them plays a program of which suffix.

Signals: a program file in, blocks of Motion out: the simulated machine's own motion, whatever the control. A
control is only imported when a program asks for it; each has the signature

    play_xxx(file, **by_hand) -> Playback

A file of any other suffix is taken for a magnetic tape; its control says what is wrong with it.
"""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Protocol

from morfax.motion.arrays import Array
from morfax.motion.files import check_name
from morfax.motion.motion import Motion
from morfax.player.monitor.chart import Chart
from morfax.player.monitor.following_limit import FollowingLimit
from morfax.player.monitor.monitor import Monitor

if TYPE_CHECKING:
    from morfax.recorder.sound.source import Source


class Playback(Protocol):
    """A program in its machine: iterate for the motion; figures, one per axis, are those of the last run.

    `following_error_mm` is the largest, `end_mm` where the machine stands, `end_error_mm` the same against
    the end that the program states (None before the end, or if it states none). The `monitor` (Herbert's)
    watches every drive by the `limit`; a `chart` put in takes the run down; `conditions` are what is wrong
    with the drives, and may be changed while it runs; `notes` on the program are for the operator.
    """

    start_mm: Array
    end_mm: Array
    end_error_mm: Array | None
    limit: FollowingLimit
    monitor: Monitor
    chart: Chart | None
    conditions: list[Any]
    notes: tuple[str, ...]

    @property
    def duration_s(self) -> float: ...

    @property
    def following_error_mm(self) -> Array: ...

    def __iter__(self) -> Iterator[Motion]: ...


@dataclass(frozen=True, slots=True)
class Control:
    """A control: its description, and the function that plays a file on it."""

    what: str
    module: str
    function: str

    def player(self) -> Callable[..., Playback]:
        """Import the control."""
        player: Callable[..., Playback] = getattr(
            importlib.import_module(self.module), self.function
        )
        return player


TAPE = Control("phase-locked drives", "morfax.player.tape.playback", "play")

PULSES = Control(
    "pulse interpolator and pulse servos", "morfax.player.gcode.pulses", "play_pulses"
)

# controls that somebody asks for, whose files have another of their own
ASKED_FOR = {
    "herbert": Control(
        "position servos and a ramp counter",
        "morfax.player.gcode.positioning",
        "play_positions",
    ),
}

CONTROLS: dict[str, Control] = {
    ".wav": TAPE,
    ".rf64": TAPE,
    ".flac": TAPE,
    ".steps": Control(
        "stepping motors at selected pulse rates", "morfax.player.steps.stepping", "play_steps"
    ),
    ".cubic": Control(
        "difference interpolator and servo", "morfax.player.cubics.cubic", "play_cubic"
    ),
    **dict.fromkeys((".ngc", ".nc", ".gcode", ".tap", ".cnc", ".plt", ".hpgl"), PULSES),
}


def control_of(file: str | os.PathLike[str]) -> Control:
    """The control that plays a file, by its suffix."""
    return CONTROLS.get(FilePath(file).suffix.lower(), TAPE)


def play(
    file: str | os.PathLike[str] | Callable[[], Source],
    *,
    control: str | None = None,
    **by_hand: Any,
) -> Playback:
    """Put a program in the machine, under its own control or one asked for by name (`ASKED_FOR`).

    `file`: its name; of a tape also what opens its source. Raises TapeFault, ProgramFault, FileFault.
    """
    if callable(file):
        return TAPE.player()(file, **by_hand)
    check_name(file)
    chosen = control_of(file) if control is None else ASKED_FOR[control]
    return chosen.player()(file, **by_hand)
