"""A tape played for a verb: the options that a bare tape needs, the bar, and the path that the machine ran.

What the machine ran before a fault is kept: the path then holds the motion up to there, and the fault is
given beside.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, fields
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, TextIO

import click
import numpy as np

from morfax.console.options.types import FREQUENCY, NUMBER, PLACES, TRACKS
from morfax.console.terminal.desk import Desk
from morfax.jobs import files as medium
from morfax.motion.arrays import Array
from morfax.motion.faults import Fault
from morfax.motion.files import written_beside
from morfax.motion.pathfile import write_rows

if TYPE_CHECKING:
    from morfax.motion.motion import Motion, Path
    from morfax.player.controls import Playback
    from morfax.player.monitor.chart import Chart
    from morfax.recorder.tape.tape import Tape

CYCLES_PER_MM = NUMBER
PIPE = "-"


@dataclass(frozen=True, slots=True)
class Played:
    """What a tape gave: the machine's path, the playback with its figures, and the fault that ended it early."""

    path: Path
    playback: Playback
    fault: Fault | None


@dataclass(slots=True)
class Passage:
    """What a path was, taken down piece by piece: when and where it began and ended, and its length in the
    work.
    """

    start_s: float = 0.0
    end_s: float = 0.0
    start_mm: Array | None = None
    end_mm: Array | None = None
    length_mm: float = 0.0
    worked: bool = False  # the tool has been in the work
    _last_in_work_mm: Array | None = None

    @classmethod
    def of(cls, path: Path) -> Passage:
        """That of a whole path."""
        passage = cls()
        passage.add(path)
        return passage

    @property
    def is_empty(self) -> bool:
        """Whether nothing has been taken down."""
        return self.start_mm is None

    def add(self, piece: Path) -> None:
        """Take down the next piece."""
        if self.start_mm is None:
            self.start_s, self.start_mm = float(piece.t_s[0]), piece.positions_mm[0]
        self.end_s, self.end_mm = float(piece.t_s[-1]), piece.positions_mm[-1]
        joined = (
            []
            if self._last_in_work_mm is None or not piece.tool[0]
            else [self._last_in_work_mm, piece.xy_mm[0]]
        )
        for run in [*piece.runs(), *([np.array(joined)] if joined else [])]:
            self.length_mm += float(np.hypot(*np.diff(run, axis=0).T).sum())
        self.worked = self.worked or bool(piece.tool.any())
        self._last_in_work_mm = piece.xy_mm[-1] if piece.tool[-1] else None


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
        from morfax.recorder.tape.tape import Tape

        return Tape.open(
            file, **{name: value for name, value in self.by_hand().items() if name != "closed"}
        )

    def play(
        self,
        file: FilePath,
        desk: Desk,
        *,
        raw: bool = False,
        chart: Chart | None = None,
        **settings: Any,
    ) -> Played:
        """Play a tape, or what comes through a pipe (-), to its end or to its fault; `settings` as `play`
        takes them.

        The chart takes down the following errors. Raises the fault if nothing was played before it.
        """
        playback, stream, met = self._stream(file, desk, chart, settings)
        path = _path(stream, raw, met)
        return Played(path, playback, met[0] if met else None)

    def play_into(
        self,
        file: FilePath,
        desk: Desk,
        outputs: Sequence[FilePath],
        *,
        raw: bool = False,
        chart: Chart | None = None,
        **settings: Any,
    ) -> tuple[Passage, Playback, Fault | None]:
        """Play a tape as `play` does, and write its path (.csv) as it comes, so that a tape of any length
        takes no more memory.

        A path that a fault ended early is marked in its name. Gives what the path was; raises the fault if
        nothing was played before it.
        """
        from morfax.motion.motion import thinned

        playback, stream, met = self._stream(file, desk, chart, settings)
        pieces, passage = _whole(stream) if raw else thinned(stream), Passage()
        with ExitStack() as files:
            opened = [files.enter_context(_written(output, met)) for output in outputs]
            for piece in pieces:
                for out in opened:
                    write_rows(piece, out, header=passage.is_empty)
                passage.add(piece)
            if passage.is_empty:
                raise met[0] if met else ValueError("the tape holds no motion")
        return passage, playback, met[0] if met else None

    def _stream(
        self, file: FilePath, desk: Desk, chart: Chart | None, settings: dict[str, Any]
    ) -> tuple[Playback, Iterator[Motion], list[Fault]]:
        """A file in its machine, the motion that this makes up to its end or its fault, and the fault once it
        is met.
        """
        desk.warn_of_compiling("the controls", "motion", "player")
        playback = self._put_in(file, settings)
        playback.chart = chart
        if order := getattr(playback, "found_order", None):
            tracks = ",".join(map(str, order))
            desk.note(
                f"{file.name} has its tracks in another order; by where it ends it is --tracks {tracks}"
            )
        met: list[Fault] = []
        stream = desk.watched(
            _until_fault(playback, met), f"playing {file.name}", playback.duration_s
        )
        return playback, stream, met

    def _put_in(self, file: FilePath, settings: dict[str, Any]) -> Playback:
        """Put a file, or the pipe, in its machine."""
        from morfax.player.controls import play

        if str(file) != PIPE:
            return play(file, **self.of_tape(file), **settings)
        from morfax.player.tape.playback import play_pipe

        return play_pipe(sys.stdin.buffer, **self.by_hand())

    def of_tape(self, file: FilePath) -> dict[str, Any]:
        """What was given by hand; raises UsageError for a file that is no tape."""
        from morfax.player.controls import TAPE, control_of

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


@contextmanager
def _written(file: FilePath, met: list[Fault]) -> Iterator[TextIO]:
    """A path file to write to, under its name once it is whole: marked if a fault was met."""
    with (
        written_beside(file, lambda: medium.incomplete(file) if met else file) as beside,
        beside.open("w", encoding="ascii", newline="") as out,
    ):
        yield out


def _whole(stream: Iterable[Motion]) -> Iterator[Path]:
    """Every sample of a stream, as pieces of a path."""
    from morfax.motion.motion import Path

    for block in stream:
        if len(block.positions_mm):
            yield Path(block.times_s, block.positions_mm, block.axes)


def _until_fault(stream: Iterable[Motion], met: list[Fault]) -> Iterator[Motion]:
    """Pass a stream on to its end or to its fault, which goes into `met`."""
    try:
        yield from stream
    except Fault as fault:
        met.append(fault)


def _path(stream: Iterable[Motion], raw: bool, met: list[Fault]) -> Path:
    """The stream as a path, thinned or `raw`; raises the fault if there was no motion before it."""
    from morfax.motion.motion import Path, join, thin

    try:
        if not raw:
            return thin(stream)
        whole = join(stream)
        return Path(whole.times_s, whole.positions_mm, whole.axes)
    except ValueError:
        if met:
            raise met[0] from None
        raise
