"""A tape or program played, for every job that plays one: the machine's path, and what ended it early.

What the machine ran before a fault is kept: the path has it up to there, and the result has the fault.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, TextIO

from morfax.jobs.listener import Listener, watched
from morfax.jobs.machine.machining import chosen
from morfax.jobs.media import files as medium
from morfax.jobs.media import outlines
from morfax.jobs.media.live import PIPE, Intake
from morfax.jobs.readings.passage import Passage
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import Fault
from morfax.motion.files import written_beside

if TYPE_CHECKING:
    from morfax.motion.motion import Motion, Path
    from morfax.player.controls import Playback
    from morfax.player.monitor.chart import Chart
    from morfax.recorder.sound.source import Source
    from morfax.recorder.tape.tape import Tape


@dataclass(frozen=True, slots=True)
class Played:
    """The machine's path, the playback with its figures, and the fault that ended it early."""

    path: Path
    playback: Playback
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class ByHand:
    """What somebody sets by hand for a tape whose text chunk does not say it, or for a G-code program."""

    reference_hz: float | None = None
    cycles_per_mm: float | None = None
    start_mm: tuple[float, ...] | None = None
    order: tuple[int, ...] | None = None
    still: tuple[str, ...] | None = None
    alike: tuple[str, ...] | None = None
    closed: bool | None = None
    # that a G-code program is for: a built-in one's name, or a .toml file
    machine: str | None = None
    second: FilePath | None = None  # the other file of a tape in two stereo files
    # a file that says what a text chunk would, or a tape that has one
    label: FilePath | None = None

    def given(self) -> dict[str, Any]:
        """What was set of the tape itself."""
        values = asdict(self)
        del values["label"], values["second"]
        return {name: value for name, value in values.items() if value is not None}

    def refuse_label(self, verb: str) -> None:
        """Raise WrongUse for a label or a second file where a verb takes none."""
        if self.label is not None or self.second is not None:
            raise WrongUse(
                f"{verb} takes no --label and no --second; give one file that says its format"
            )

    def labelled(self) -> str:
        """What the label says; empty without one. Raises TapeFault, FileFault."""
        if self.label is None:
            return ""
        from morfax.recorder.tape.stated import label_of

        return label_of(self.label)

    def opener(self, file: FilePath) -> Callable[[], Source] | None:
        """What opens the source of a tape that is more than its file; None: the file says all."""
        text = self.labelled()
        if not text and self.second is None:
            return None
        from morfax.recorder.sound.source import FileSource

        second, reference_hz = self.second, self.reference_hz

        def opened() -> Source:
            source: Source = FileSource(file)
            if second is not None:
                from morfax.player.tape.stereo import StereoSource
                from morfax.recorder.tape.stated import stated_hz

                hz = reference_hz or stated_hz(text or source.text)
                source = StereoSource(source, FileSource(second), hz)
            source.text = text or source.text
            return source

        return opened

    def beside(self, files: Sequence[FilePath]) -> list[ByHand]:
        """What is set for each of some files: the machine for G-code alone; WrongUse if there is none."""
        if self.machine is not None and not any(map(medium.has_machine, files)):
            raise WrongUse(
                f"--machine is for G-code, {', '.join(medium.BLOCKS)}; no file here is G-code: leave it out"
            )
        return [
            self if medium.has_machine(file) else replace(self, machine=None) for file in files
        ]

    def open_tape(self, file: FilePath) -> Tape:
        """Open a tape for reading; a context manager."""
        from morfax.recorder.tape.tape import Tape

        given = self.given()
        given.pop("closed", None)
        given.pop("machine", None)
        opener = self.opener(file)
        return Tape.open(file, **given) if opener is None else Tape.of(opener(), **given)

    def for_file(self, file: FilePath) -> dict[str, Any]:
        """What was set; raises WrongUse where the file is no tape, or no G-code for a machine."""
        from morfax.player.controls import TAPE, control_of

        given = self.given()
        machine = given.pop("machine", None)
        if machine is not None:
            if not medium.has_machine(file):
                raise WrongUse(
                    f"--machine is for G-code, {', '.join(medium.BLOCKS)}; {file} is not G-code: leave it out"
                )
            chosen(machine, program=file)
        if (given or self.label or self.second) and control_of(file) != TAPE:
            raise WrongUse(
                "--reference-frequency, --cycles-per-mm, --from, --tracks, --still, --alike, --closed, "
                f"--label and --second are for tapes; {file} is not a tape"
            )
        return given if machine is None else {"machine": machine}


@dataclass(frozen=True, slots=True)
class Playing:
    """A file in its machine, and how it is played."""

    file: FilePath  # or the pipe
    by_hand: ByHand = field(default_factory=ByHand)  # what the tape does not say
    raw: bool = False  # keep every sample
    chart: Chart | None = None  # to take down the following errors
    settings: Mapping[str, Any] = field(default_factory=dict)  # as the control takes them
    intake: Intake = field(default_factory=Intake)  # of the pipe: it may be a device

    def whole(self, listener: Listener) -> Played:
        """Play to the end or to a fault; raises the fault if nothing was played before it."""
        playback, stream, met = self._stream(listener)
        path = _path(stream, self.raw, met)
        return Played(path, playback, met[0] if met else None)

    def without_fault(self, listener: Listener) -> Path:
        """Play to the end; raises the fault."""
        played = self.whole(listener)
        if played.fault is not None:
            raise played.fault
        return played.path

    def into(
        self, outputs: Sequence[FilePath], listener: Listener
    ) -> tuple[Passage, Playback, Fault | None]:
        """Play, and write the path (.csv) as it comes, so that a long tape takes no more memory.

        A path that a fault ended early is marked in its name. A fault before any motion is raised.
        """
        from morfax.motion.motion import thinned

        playback, stream, met = self._stream(listener)
        pieces, passage = _whole(stream) if self.raw else thinned(stream), Passage()
        with ExitStack() as files:
            opened = [files.enter_context(_written(output, met)) for output in outputs]
            for piece in pieces:
                for out in opened:
                    _write_rows(piece, out, header=passage.is_empty)
                passage.add(piece)
            if passage.is_empty:
                raise met[0] if met else ValueError("the tape holds no motion")
        return passage, playback, met[0] if met else None

    def _stream(self, listener: Listener) -> tuple[Playback, Iterator[Motion], list[Fault]]:
        """The machine, its motion up to the end or a fault, and the fault once it is met."""
        listener.compiling("the controls", ("motion", "player"))
        playback = self._put_in()
        playback.chart = self.chart
        if order := getattr(playback, "found_order", None):
            tracks = ",".join(map(str, order))
            listener.warning(
                f"the tracks of {self.file.name} are in another order, by its check signal or its end: it is "
                f"played as by --tracks {tracks}"
            )
        met: list[Fault] = []
        motion = _until_fault(_noting(playback, listener), met)
        name = self.intake.called if str(self.file) == PIPE else self.file.name
        what = f"playing {name}"
        return playback, watched(motion, listener, what, playback.duration_s), met

    def _put_in(self) -> Playback:
        """Put the file, or the pipe, in its machine."""
        from morfax.player.controls import play

        by_hand = self.by_hand
        if str(self.file) != PIPE:
            given = by_hand.for_file(self.file)
            opener = by_hand.opener(self.file)
            return play(self.file if opener is None else opener, **given, **self.settings)
        if by_hand.machine is not None:
            raise WrongUse("--machine is for files of G-code, not for a pipe; leave it out")
        if by_hand.second is not None:
            raise WrongUse("--second is for files, not for a pipe or a device; leave it out")
        from morfax.player.tape.playback import play_live

        return play_live(self.intake.source(by_hand.labelled()), **by_hand.given())


def read_or_play(
    file: FilePath,
    by_hand: ByHand,
    listener: Listener,
    feed_mm_s: float | None = None,
    drawn_unit: str | None = None,
) -> Path:
    """Read a path file or a drawing from CAD, at the feed if it has no times; or play a tape or a program."""
    from morfax.motion.pathfile import FEED_MM_S, read_path

    kind, feed_mm_s = medium.kind_of(file), feed_mm_s or FEED_MM_S
    medium.refuse_drawing(file, kind)
    if kind in ("tape", "program"):
        return Playing(file, by_hand).without_fault(listener)
    if kind == "outline":
        return outlines.read_path(file, drawn_unit, feed_mm_s, listener)
    return read_path(file, feed_mm_s)


@contextmanager
def _written(file: FilePath, met: list[Fault]) -> Iterator[TextIO]:
    """A path file to write to, under its name once it is whole: marked if a fault was met."""
    with (
        written_beside(file, lambda: medium.incomplete(file) if met else file) as beside,
        beside.open("w", encoding="ascii", newline="") as out,
    ):
        yield out


def _write_rows(piece: Path, out: TextIO, *, header: bool) -> None:
    """Write a piece of a path."""
    from morfax.motion.pathfile import write_rows

    write_rows(piece, out, header=header)


def _whole(stream: Iterable[Motion]) -> Iterator[Path]:
    """Every sample of a stream, as pieces of a path."""
    from morfax.motion.motion import Path

    for block in stream:
        if len(block.positions_mm):
            yield Path(block.times_s, block.positions_mm, block.axes)


def _noting(playback: Playback, listener: Listener) -> Iterator[Motion]:
    """The motion; the notes on the program come before it, or when its first block is read."""
    noted = playback.notes
    for note in noted:
        listener.note(note)
    for block in playback:
        for note in playback.notes[len(noted) :]:
            listener.note(note)
        noted = playback.notes
        yield block


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
