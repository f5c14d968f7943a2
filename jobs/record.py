"""The job `record`: a path file, or a program played on its own control, becomes a program in any medium."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Literal

from morfax.jobs.listener import SILENT, Listener, watched
from morfax.jobs.machine.playing import ByHand, read_or_play
from morfax.jobs.machine.recording import RecordingUnit, rehearsed
from morfax.jobs.media import files as medium
from morfax.jobs.media import outlines
from morfax.jobs.media.live import PIPE, Outlet
from morfax.jobs.settings.zero import Zero, of_path_mm
from morfax.jobs.settings.zero import figures as zero_figures
from morfax.jobs.wrong_use import WrongUse, settings_checked
from morfax.motion.usual import FEED_MM_S, MOTION_RATE_HZ, REFERENCE_HZ

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.motion.motion import Motion, Path
    from morfax.recorder.media import Report
    from morfax.recorder.tape.recording import LiveRecording
    from morfax.tracer.operator.operator import Panel

LIVE_TAPE = FilePath("live.wav")  # no file: it says that what goes out is a tape


@dataclass(frozen=True, slots=True)
class RecordResult:
    """What a recording gave: figures, and the program's name."""

    figures: Figures
    program: FilePath


@dataclass(frozen=True, slots=True)
class RecordJob:
    """Record a path file, a drawing from CAD or another program in the medium that the output's name says."""

    source: FilePath
    # or the pipe; None: a device, or the source's name with .wav, in the current folder
    output: FilePath | None = None
    force: bool = False  # write over a name that nobody gave
    reference_hz: float = REFERENCE_HZ
    cycles_per_mm: float | None = None  # None: the pick-up's own
    unit: RecordingUnit = field(default_factory=RecordingUnit)
    drawn_unit: str | None = None  # of a drawing from CAD; None: the file's own
    zero: Zero = "sheet"  # of the program; sheet: the source's own zero
    # of a step program; None: differences
    orders: Literal["differences", "counts"] | None = None
    outlet: Outlet = field(default_factory=Outlet)  # where a tape goes, if it is not one file

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> RecordResult:
        """Record; raises WrongUse and every fault."""
        from morfax.motion.contour import length_mm

        # 1. what is set
        program = self._program()
        has_feed = medium.has_machine(program)
        (self.unit if has_feed else replace(self.unit, feed_mm_s=None)).check(program)
        settings = self._recorder_settings(program)
        outlines.check_unit(self.drawn_unit, self.source)
        feed_mm_s = self.unit.feed_mm_s or FEED_MM_S
        if "fmt" in settings and not settings["fmt"].checked and not self.unit.plain:
            listener.note(
                f"a reference of {self.reference_hz:g} Hz has no room for the check signal: the tape is bare,"
                " and nothing on it vouches for itself; a lower --reference-frequency has it, or say --plain"
            )
        # 2. the recording
        if has_feed and medium.is_outline(self.source) and self.unit.chosen(program).z:
            listener.warning(
                f"{self.source.name} states no depth: the tool runs along its lines at Z0; set the zero of "
                "Z at the depth of the cut, or trace a scan with --depth"
            )
        read = read_or_play(self.source, ByHand(), listener, feed_mm_s, self.drawn_unit)
        unit = self.unit.at(of_path_mm(self.zero, read, self.unit.placement))
        placed = unit.placement.path(read)
        unit.warn(program, listener)
        recording = self._recorded(placed, program, settings, listener)
        # 3. what was recorded
        length = length_mm(placed) if placed.tool.any() else 0.0
        figures = {
            **self._called(program),
            "duration_s": recording.duration_s,
            "length_mm": length,
            **_size(placed),
            "start_place_mm": placed.positions_mm[0],
            "end_place_mm": placed.positions_mm[-1],
            **_density(recording, program, length),
            **medium.recorder_figures(recording),
            **zero_figures(self.zero, unit.placement.about(read.positions_mm[0])),
            **unit.figures(),
        }
        return RecordResult(figures, program)

    @property
    def _is_live(self) -> bool:
        """Whether the tape goes into a pipe or to a device."""
        return self.outlet.device is not None or str(self.output) == PIPE

    def _program(self) -> FilePath:
        """The name for the program; raises FileFault if it cannot be written, WrongUse for two places."""
        self.outlet.check(self.output)
        if self._is_live:
            return LIVE_TAPE
        if self.output is None:
            name = FilePath(f"{self.source.stem}.wav")
            return medium.made_up(name, self.source, force=self.force)
        if self.outlet.stereo:
            for half in self._halves(self.output):
                medium.outgoing(half, self.source)
            return self.output
        return medium.outgoing(self.output, self.source)

    def _called(self, program: FilePath) -> dict[str, Any]:
        """Where the program is."""
        outlet = self.outlet
        label = {"label": None if outlet.label is None else str(outlet.label)}
        if self._is_live:
            where = "the pipe" if outlet.device is None else f"device {outlet.device}"
            return {"tape": where, **label}
        if outlet.stereo:
            return {"tapes": [str(half) for half in self._halves(program)], **label}
        return {medium.called(program): str(program), **label}

    @staticmethod
    def _halves(program: FilePath) -> tuple[FilePath, FilePath]:
        """The names of two stereo files; raises WrongUse where the medium is no tape."""
        from morfax.recorder.tape.halves import half_names

        if not medium.is_tape(program):
            raise WrongUse(
                f"--stereo is for tapes, {', '.join(medium.TAPES)}; give -o such a name, or leave it out"
            )
        return half_names(program)

    def _recorder_settings(self, program: FilePath) -> dict[str, Any]:
        """Settings as the recorder of this medium takes them."""
        steps = {} if self.orders is None else {"orders": self.orders}
        if steps and program.suffix.lower() != ".steps":
            raise WrongUse(
                "--orders is for step programs, .steps; give -o such a name, or leave it out"
            )
        if not medium.is_tape(program):
            from morfax.recorder.gcode.made import Made

            unit = replace(self.unit, made=Made(self.source.name))
            return steps | unit.program_settings(program)
        try:
            fmt = self.unit.tape_format(
                reference_hz=self.reference_hz, cycles_per_mm=self.cycles_per_mm
            )
        except ValueError as refused:
            raise WrongUse(
                f"such a tape cannot be recorded: {refused}; leave --reference-frequency and --cycles-per-mm "
                "out for a usual one"
            ) from None
        return {"fmt": fmt}

    def _recorded(
        self, path: Path, program: FilePath, settings: dict[str, Any], listener: Listener
    ) -> Report | LiveRecording:
        """Record a path; what the recorder made."""
        from morfax.recorder.media import record

        listener.compiling("the recorder", ("motion", "recorder"))
        if "fmt" not in settings:
            with settings_checked():  # such as a tolerance finer than the last decimal
                return record(_told(path, program.name, listener), program, **settings)
        fmt = replace(settings["fmt"], axes=path.axes, start_mm=())
        with settings_checked():
            fmt = self.outlet.suited(fmt)
        name = self.outlet.device or program.name
        stream = _told(path, name, listener, fmt.motion_rate_hz)
        stream = rehearsed(stream, fmt, listener)
        if self._is_live:
            done = self.outlet.record(stream, fmt)
        elif self.outlet.stereo:
            from morfax.recorder.tape.halves import record_halves

            done = record_halves(stream, program, fmt)
        else:
            from morfax.recorder.tape.tape import record as record_tape

            done = record_tape(stream, program, fmt)
        self.outlet.write_label(done.format)
        return done


def _told(
    path: Path, name: str, listener: Listener, rate_hz: float = MOTION_RATE_HZ
) -> Iterable[Motion]:
    """The motion of a path; the listener hears how far it is."""
    lasts_s = float(path.t_s[-1] - path.t_s[0])
    return watched(path.motion(rate_hz), listener, f"recording {name}", lasts_s)


def _density(
    recording: Report | LiveRecording, program: FilePath, length_mm: float
) -> dict[str, Any]:
    """Bits per mm of a program in a file, and of a tape of the same motion beside it."""
    size = getattr(recording, "bytes", None)
    if not length_mm or size is None:
        return {"bits_per_mm": None, "as_tape_bits_per_mm": None}
    as_tape = None if medium.is_tape(program) else _tape_bits(recording.duration_s) / length_mm
    return {"bits_per_mm": 8 * size / length_mm, "as_tape_bits_per_mm": as_tape}


def _size(path: Path) -> dict[str, float]:
    """How wide and high what is cut is: a drawing in another unit than it says shows there."""
    import numpy as np

    runs = list(path.runs())
    if not runs:
        return {}
    width_mm, height_mm = np.ptp(np.vstack(runs), axis=0).tolist()
    return {"width_mm": width_mm, "height_mm": height_mm}


def _tape_bits(duration_s: float) -> float:
    """Bits of a magnetic tape of the usual format that runs so long, to set beside another medium's."""
    from morfax.recorder.tape.tape import TapeFormat

    fmt = TapeFormat()
    return 16 * fmt.tracks * fmt.sample_rate_hz * (duration_s + 2 * fmt.dwell_s)
