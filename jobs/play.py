"""The job `play`: a tape or program moves the machine, and the machine's path is written.

A drawing from CAD has no control of its own: it is recorded on a tape first, and the tape is played.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Literal

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.playing import ByHand, Playing
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.machine.running import on_machine_as_read
from morfax.jobs.media import files as medium
from morfax.jobs.media import outlines
from morfax.jobs.media.live import PIPE, Intake
from morfax.jobs.readings import following
from morfax.jobs.readings.passage import Passage
from morfax.jobs.record import RecordJob
from morfax.jobs.wrong_use import WrongUse, settings_checked

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Path
    from morfax.player.controls import Playback
    from morfax.player.monitor.chart import Chart
    from morfax.tracer.operator.operator import Panel

MOTORS = ("electric", "hydraulic")  # player.tape.phase_lock; the first is the default
OPTIONS = {
    "resume_at_s": "--resume-at",
    "acceleration_mm_s2": "--acceleration",
    "motor": "--motor",
    "zero_mm": "--zero-adjustment",
    "wheel_eccentricity_mm": "--wheel-eccentricity",
    "wheel_division_mm": "--wheel-division",
    "lamp": "--lamp",
    "norm": "--norm",
    "feed_override": "--feed-override",
    "historic": "--historic",
    "control": "--control",
}
PICTURES = (".png", ".svg", ".pdf")
CUBIC = ".cubic"
FOR_PULSES = {"norm", "feed_override", "historic"}
# fields of player.tape.sector_wheel's SectorWheel
FOR_WHEELS = {
    "wheel_eccentricity_mm": "eccentricity_mm",
    "wheel_division_mm": "division_mm",
    "lamp": "light",
}
FOR_TAPES = {"resume_at_s", "acceleration_mm_s2", "motor", "zero_mm", *FOR_WHEELS}


@dataclass(frozen=True, slots=True)
class ControlSettings:
    """What somebody sets on the control; None: not set."""

    resume_at_s: float | None = None
    acceleration_mm_s2: float | None = None
    norm: Literal["weights", "true"] | None = None
    feed_override: float | None = None
    motor: str | None = None
    zero_mm: tuple[float, ...] | None = None
    wheel_eccentricity_mm: float | None = None  # of the sector wheels on the machine's screws
    wheel_division_mm: float | None = None
    lamp: float | None = None  # share of its light
    historic: bool = False  # the patent's own pulses, registers and scales
    control: Literal["herbert"] | None = None  # None: the file's own

    def given(self) -> dict[str, Any]:
        """What was set."""
        return {
            name: value
            for name, value in asdict(self).items()
            if value is not None and value is not False
        }

    def for_file(self, file: FilePath, by_hand: ByHand) -> dict[str, Any]:
        """The settings as the control of a file takes them; raises WrongUse for one that it does not take."""
        given = self.given()
        _refuse_foreign(file, given)
        if "resume_at_s" in given and by_hand.start_mm is None:
            raise WrongUse(
                "--resume-at needs the place where the machine stands then; give --from X,Y,Z"
            )
        if "norm" in given:
            given["true_norm"] = given.pop("norm") == "true"
        if "feed_override" in given:
            given["override"] = given.pop("feed_override")
        if "motor" in given:
            from morfax.player.tape.phase_lock import MOTORS as LOCKS

            given["settings"] = LOCKS[given.pop("motor")]
        if wheel := {FOR_WHEELS[name]: given.pop(name) for name in FOR_WHEELS if name in given}:
            from morfax.player.tape.sector_wheel import SectorWheel

            with settings_checked():
                given["wheel"] = SectorWheel(**wheel)
        if "historic" in given and file.suffix.lower() != CUBIC:
            from morfax.player.gcode.pulses import HISTORIC_CONTROL

            given["settings"] = HISTORIC_CONTROL
            given.pop("historic")
        return given


@dataclass(frozen=True, slots=True)
class PlayResult:
    """What a playing gave: figures, names for path and charts, and the fault that ended it early.

    The job has written the path files (.csv) and the programs. A face draws the pictures among `paths` from
    `path`, which is there if some are wanted, and writes `charts` from the chart of the following errors and
    the speeds held.
    """

    figures: Figures
    paths: tuple[FilePath, ...]
    charts: tuple[FilePath, ...]
    path: Path | None
    chart: Chart | None
    speeds: following.Speeds | None
    fault: Fault | None
    picture: FilePath | None = None  # of `path` with the following errors of the chart along it


@dataclass(frozen=True, slots=True)
class PlayJob:
    """Play a tape or a program on its own control, a drawing from CAD by way of a tape."""

    tape: FilePath  # or the pipe
    # for the machine's path: .csv, .svg, .png, or a program or drawing in any other medium
    outputs: tuple[FilePath, ...] = ()
    charts: tuple[FilePath, ...] = ()  # for the following errors: .csv and pictures
    raw: bool = False
    control: ControlSettings = field(default_factory=ControlSettings)
    by_hand: ByHand = field(default_factory=ByHand)
    drawn_unit: str | None = None  # of a drawing from CAD; None: the file's own
    intake: Intake = field(default_factory=Intake)  # of the pipe: it may be a device
    picture: FilePath | None = None  # of the path, with the following error along it

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> PlayResult:
        """Play and write; raises WrongUse, and the fault if nothing was played before it."""
        # 1. what is set
        medium.outgoing_together((*self.outputs, *self.charts, self.picture), self.tape)
        is_live = str(self.tape) == PIPE
        if not is_live:
            medium.refuse_drawing(self.tape, medium.kind_by_name(self.tape))
            outlines.check_unit(self.drawn_unit, self.tape)
        settings = self.control.for_file(self.tape, self.by_hand)
        is_charted = bool(self.charts) or self.picture is not None
        chart = following.new_chart(self.raw) if is_charted else None
        # 2. the machine runs
        with settings_checked(), _as_tape(self.tape, self.drawn_unit, listener) as tape:
            playing = Playing(tape, self.by_hand, self.raw, chart, settings, self.intake)
            passage, playback, fault, path = self._played(playing, listener)
        # 3. what it ran
        paths = _marked(self.outputs, fault)
        charts = _marked(self.charts, fault)
        (picture,) = (None,) if self.picture is None else _marked((self.picture,), fault)
        speeds = following.speeds_held(playback) if _has_picture(charts) else None
        figures = {
            medium.called(self.tape): self.intake.called if is_live else str(self.tape),
            "paths": [str(file) for file in paths] or None,
            "following": [str(file) for file in charts] or None,
            "picture": None if picture is None else str(picture),
            **({} if fault else self._on_machine(playback)),
            **_figures(passage, playback, fault),
        }
        if not fault and not passage.worked:
            listener.warning(
                "the tool never comes into the work: if the tape runs backwards, the tool goes up where it "
                "should go down; turn the tape round, and look at the Z of the program"
            )
        return PlayResult(figures, paths, charts, path, chart, speeds, fault, picture)

    def _played(
        self, playing: Playing, listener: Listener
    ) -> tuple[Passage, Playback, Fault | None, Path | None]:
        """Play and write the path as it comes; keep the whole of it only for a picture or a program."""
        is_shown = self.picture is not None
        if not is_shown and all(file.suffix.lower() in medium.PATHS for file in self.outputs):
            return *playing.into(self.outputs, listener), None
        played = playing.whole(listener)
        from morfax.motion.pathfile import write_path

        for file in _marked(self.outputs, played.fault):
            if file.suffix.lower() in medium.PATHS:
                write_path(played.path, file)
            elif not is_picture(file):
                self._record(played.path, file, listener)
        return Passage.of(played.path), played.playback, played.fault, played.path

    def _on_machine(self, playback: Playback) -> Figures:
        """The machine that a G-code program is for, and how long it runs there."""
        program = getattr(playback, "as_read", None)
        return on_machine_as_read(program, self.by_hand.machine) if program else {}

    def _record(self, path: Path, file: FilePath, listener: Listener) -> None:
        """Record the machine's path in the medium that a name says, for the usual machine of that."""
        from morfax.recorder.gcode.made import Made

        unit = RecordingUnit(made=Made(f"{self.tape.name}, played"))
        unit.record(path.motion(), file, listener)


@contextmanager
def _as_tape(file: FilePath, unit: str | None, listener: Listener) -> Iterator[FilePath]:
    """A tape of a drawing from CAD, for as long as it is played; any other file as it is."""
    if not medium.is_outline(file):
        yield file
        return
    with tempfile.TemporaryDirectory(prefix="morfax-") as folder:
        tape = FilePath(folder) / f"{file.stem}.wav"
        RecordJob(file, tape, drawn_unit=unit).run(listener)
        yield tape


def is_picture(file: FilePath) -> bool:
    """Whether a file of this name shows a path or a chart, and is not a path file or a program."""
    return file.suffix.lower() in PICTURES


def _marked(files: tuple[FilePath, ...], fault: Fault | None) -> tuple[FilePath, ...]:
    """The names of files, marked if a fault ended the run early."""
    return tuple(medium.incomplete(file) if fault else file for file in files)


def _has_picture(files: tuple[FilePath, ...]) -> bool:
    """Whether there is a picture among files for a path or a chart."""
    return any(map(is_picture, files))


def _refuse_foreign(tape: FilePath, given: dict[str, Any]) -> None:
    """Raise WrongUse for a setting that is for another control than the one that plays the file."""
    from morfax.player.controls import CONTROLS, TAPE, control_of

    control, pulses = control_of(tape), CONTROLS[".ngc"]
    if str(tape) == PIPE and given:
        raise WrongUse(
            f"{_options(given)} is for files, not for a pipe or a device; leave it out"
        )
    if control != TAPE and not given.keys().isdisjoint(FOR_TAPES):
        raise WrongUse(
            f"{_options(given.keys() & FOR_TAPES)} is for tapes, and {tape} is none; leave it out"
        )
    blocks = "programs of lines and arcs, .ngc"
    # setting, as it was written, the controls that have it, and in words what they play
    for name, option, has_it, what in (
        ("control", f"--control {given.get('control')}", (pulses,), blocks),
        ("norm", "--norm", (pulses,), blocks),
        ("historic", "--historic", (pulses, CONTROLS[CUBIC]), f"{blocks}, and for .cubic"),
        ("feed_override", "--feed-override", (TAPE, pulses), f"tapes and for {blocks}"),
    ):
        if name in given and control not in has_it:
            raise WrongUse(f"{option} is for {what}, and {tape} is none; leave it out")
    if "control" in given and not given.keys().isdisjoint(FOR_PULSES):
        raise WrongUse(
            f"{_options(given.keys() & FOR_PULSES)} is for the pulse control; leave --control out"
        )


def _options(given: Iterable[str]) -> str:
    """The options of some settings."""
    return ", ".join(sorted(OPTIONS[name] for name in given))


def _figures(passage: Passage, playback: Playback, fault: Fault | None) -> dict[str, Any]:
    """What a playing gave, as figures."""
    return {
        "incomplete": True if fault else None,
        "duration_s": passage.end_s - passage.start_s,
        "length_mm": passage.length_mm,
        "start_place_mm": passage.start_mm,
        "end_place_mm": passage.end_mm,
        "largest_following_error_mm": float(max(playback.following_error_mm)),
        **following.figures(playback),
        "bridged_dropouts": len(getattr(playback, "bridged", ())) or None,
    }
