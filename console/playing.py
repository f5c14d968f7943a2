"""A tape played for a verb: the options that a bare tape needs, the bar, and the path that the machine ran.

What the machine ran before a fault is kept: the path then holds the motion up to there, and the fault is given beside.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import click

from console.desk import Desk
from console.quantities import FREQUENCY, NUMBER, PLACES, TRACKS
from motion.faults import Fault

if TYPE_CHECKING:
    from motion.motion import Motion, Path
    from player.chart import Chart
    from player.controls import Playback
    from recorder.tape import Tape

CYCLES_PER_MM = NUMBER
PIPE = "-"


@dataclass(frozen=True, slots=True)
class Played:
    """What a tape gave: the machine's path, the playback with its figures, and the fault that ended it early."""

    path: Path
    playback: Playback
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class Controls:
    """What the operator sets by hand for a tape whose text chunk does not say it."""

    reference_hz: float | None = None
    cycles_per_mm: float | None = None
    start_mm: tuple[float, ...] | None = None
    order: tuple[int, ...] | None = None
    closed: bool | None = None

    def by_hand(self) -> dict[str, Any]:
        """What was given."""
        return {name: value for name, value in asdict(self).items() if value is not None}

    def open_tape(self, file: FilePath) -> Tape:
        """Open a tape for reading; a context manager."""
        from recorder.tape import Tape

        return Tape.open(file, **{name: value for name, value in self.by_hand().items() if name != "closed"})

    def play(
        self, file: FilePath, desk: Desk, *, raw: bool = False, chart: Chart | None = None, **settings: Any
    ) -> Played:
        """Play a tape, or what comes through a pipe (-), to its end or to its fault; `settings` as `play` takes them.

        The chart takes down the following errors. Raises the fault if nothing was played before it.
        """
        desk.warn_of_compiling("the controls", "motion", "player")
        playback = self._put_in(file, settings)
        playback.chart = chart
        if order := getattr(playback, "found_order", None):
            tracks = ",".join(map(str, order))
            desk.note(f"{file.name} has its tracks in another order; by where it ends it is --tracks {tracks}")
        met: list[Fault] = []
        stream = desk.watched(_until_fault(playback, met), f"playing {file.name}", playback.duration_s)
        path = _path(stream, raw, met)
        return Played(path, playback, met[0] if met else None)

    def _put_in(self, file: FilePath, settings: dict[str, Any]) -> Playback:
        """Put a file, or the pipe, in its machine."""
        from player.controls import play

        if str(file) != PIPE:
            return play(file, **self._by_hand(file), **settings)
        from player.machine import play_pipe

        return play_pipe(sys.stdin.buffer, **self.by_hand())

    def _by_hand(self, file: FilePath) -> dict[str, Any]:
        """What was given by hand, which only the control of a tape takes."""
        from player.controls import TAPE, control_of

        given = self.by_hand()
        if given and control_of(file) != TAPE:
            raise click.UsageError(
                f"--reference, --cycles-per-mm, --from, --tracks and --closed are for tapes; {file} is none"
            )
        return given

    def play_whole(self, file: FilePath, desk: Desk) -> Path:
        """Play a tape to its end, mm; raises its fault."""
        played = self.play(file, desk)
        if played.fault is not None:
            raise played.fault
        return played.path


def tape_options(verb: Callable[..., Any]) -> Callable[..., Any]:
    """Give a verb the options of a tape that does not say everything itself, and hand it the `controls`."""

    @click.option(
        "--reference",
        "reference_hz",
        type=FREQUENCY,
        help="Reference frequency of the tape, such as 6kHz.  [default: what the tape says]",
    )
    @click.option(
        "--cycles-per-mm",
        type=CYCLES_PER_MM,
        help="Cycles of phase per mm of travel, such as 20.  [default: what the tape says]",
    )
    @click.option(
        "--from",
        "start_mm",
        type=PLACES,
        help="Where the machine stands at the start, mm: X,Y or X,Y,Z …  [default: what the tape says, else 0,0]",
    )
    @click.option(
        "--tracks",
        "order",
        type=TRACKS,
        help="On which tracks of the file reference, X, Y … are, such as 2,1,3,4.  [default: 1,2,3 …]",
    )
    @click.option(
        "--closed",
        is_flag=True,
        default=None,
        help="The program returns to its start; that is checked where the tape does not say where it ends.",
    )
    @functools.wraps(verb)
    def with_controls(*args: Any, **options: Any) -> Any:
        given = {field.name: options.pop(field.name) for field in fields(Controls)}
        return verb(*args, controls=Controls(**given), **options)

    return with_controls


def _until_fault(stream: Iterable[Motion], met: list[Fault]) -> Iterator[Motion]:
    """Pass a stream on to its end or to its fault, which goes into `met`."""
    try:
        yield from stream
    except Fault as fault:
        met.append(fault)


def _path(stream: Iterable[Motion], raw: bool, met: list[Fault]) -> Path:
    """The stream as a path, thinned or `raw`; raises the fault if there was no motion before it."""
    from motion.motion import Path, join, thin

    try:
        if not raw:
            return thin(stream)
        whole = join(stream)
        return Path(whole.times_s, whole.positions_mm, whole.axes)
    except ValueError:
        if met:
            raise met[0] from None
        raise
