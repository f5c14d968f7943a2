"""The job `run`: the whole way from the drawing to the machine, and how well all three agree."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.machining import tell_what_is_lost
from morfax.jobs.machine.playing import ByHand, Played, Playing
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.media import files as medium
from morfax.jobs.readings import comparison, following
from morfax.jobs.settings import correction_settings, flattening
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.motion.faults import FileFault

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.readings.comparison import Comparison
    from morfax.jobs.tracing.traced import Traced
    from morfax.motion.faults import Fault
    from morfax.motion.motion import Path
    from morfax.motion.placement import Placement
    from morfax.player.monitor.chart import Chart
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.operator.operator import Panel


@dataclass(frozen=True, slots=True)
class RunResult:
    """What a run gave: figures, the played path as it lies on the drawing, its distance from the ink.

    `picture` and `report` are the names under which the picture and the figures as JSON belong; a face writes
    both. The faults are that of a line that was lost and that of a drive.
    """

    figures: Figures
    drawing: Drawing
    traced: Traced
    played: Path
    from_ink: Comparison
    picture: FilePath
    report: FilePath
    faults: tuple[Fault, ...]
    chart: Chart | None = None  # of the following errors, where it was asked for
    placement: Placement | None = None  # of the drawing on the machine
    program: FilePath | None = None  # that the machine ran


@dataclass(frozen=True, slots=True)
class RunJob:
    """Trace a drawing, play the tape or program, compare all three; the results go into a folder, under its
    name.
    """

    drawing: DrawingFile
    folder: FilePath | None = None  # None: the drawing's name, in the current folder
    settings: TraceSettings = field(default_factory=TraceSettings)
    unit: RecordingUnit = field(default_factory=RecordingUnit)
    charted: bool = False  # take down the following errors

    def file(self, ending: str) -> FilePath:
        """The name of a result."""
        stem = self.drawing.file.stem
        return (self.folder or FilePath(stem)) / f"{stem}{ending}"

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> RunResult:
        """Go the whole way; the faults of a lost line and of a drive are in the result, others are raised.

        Its three steps hand on nearly all that they make, and are read once from top to bottom.
        """
        # 1. trace and record
        program_file, tracing = self.prepared(panel)
        tell_what_is_lost(self.settings, self.unit, program_file, listener)
        drawing = self.drawing.for_lines(tracing.settings.line).open(listener)
        self._make_folder()
        traced = tracing.trace(drawing, listener)
        source = correction_settings.named(self.drawing.file.name, drawing.corrected)
        tool = self.settings.tool.described(self.unit.scale)
        unit = traced.placed(self.unit, program_file, source, tool)
        program, _ = traced.record(program_file, unit, listener)
        traced_file = traced.write(self.file(".traced.csv"), unit)
        # 2. play
        by_hand = ByHand(machine=unit.machine) if medium.has_machine(program) else ByHand()
        chart = following.new_chart(raw=False) if self.charted else None
        played = Playing(program, by_hand, chart=chart).whole(listener)
        played_file = self._write(played, traced)
        unit.warn(program, listener, self.settings)
        # 3. compare, as the drawing was before it was mirrored, scaled and turned
        about = unit.placement.about(traced.path.positions_mm[0])
        path = about.back(played.path)
        picture = traced.name(self.file(".png"))
        listener.detail("comparing drawing, traced path and played path")
        ink = comparison.measured_on(drawing)
        from_ink = comparison.from_drawing(ink, path, "played", _radius_mm(traced))
        figures: dict[str, Any] = {
            "drawing": str(self.drawing.file),
            medium.called(program): str(program),
            "traced_path": str(traced_file),
            "played_path": str(played_file),
            "picture": str(picture),
            **flattening.figures(drawing, picture),
            **correction_settings.figures(drawing),
            **_compared(ink, traced, path, from_ink),
            **traced.zero_figures(unit),
            **unit.figures(),
        }
        faults = tuple(fault for fault in (traced.fault, played.fault) if fault is not None)
        report = traced.name(self.file(".json"))
        seen = (figures, drawing, traced, path, from_ink, picture, report, faults)
        return RunResult(*seen, chart=chart, placement=about, program=program)

    def prepared(self, panel: Panel | None = None) -> tuple[FilePath, Tracing]:
        """The program's name, and the head as it is set; raises WrongUse, CardFault and FileFault."""
        program_file = self._program_file()
        tracing = Tracing.prepared(self._settled(program_file), panel)
        self.unit.check(program_file)
        return program_file, tracing.on_machine(self.unit, program_file)

    def usual_lines(self) -> str | None:
        """The lines that the cutter or the machine is for, where none are asked for; None: the one line."""
        lines = self._settled(self._program_file()).line.lines
        return lines if isinstance(lines, str) else None

    def _settled(self, program_file: FilePath) -> TraceSettings:
        """The settings, with the lines that the machine of a program is for."""
        return self.settings.with_usual_lines(self.unit.usual_lines(program_file))

    def _program_file(self) -> FilePath:
        """The name of the program: a tape, or in the words of a machine if there is one."""
        if self.unit.machine is None:
            return self.file(".wav")
        return self.file(self.unit.chosen().suffix)

    def _make_folder(self) -> None:
        """Make the folder; raises FileFault if it cannot be made, or a result would replace the drawing."""
        picture = self.file(".png")
        try:
            picture.parent.mkdir(exist_ok=True)
        except OSError as error:
            raise FileFault(
                f"cannot make the folder {picture.parent}: {error.strerror}; give another one with -o"
            ) from error
        medium.outgoing(picture, self.drawing.file)

    def _write(self, played: Played, traced: Traced) -> FilePath:
        """Write the played path; its name."""
        from morfax.motion.pathfile import write_path

        file = self.file(".played.csv")
        file = medium.incomplete(file) if played.fault else traced.name(file)
        write_path(played.path, file)
        return file


def _compared(
    drawing: Drawing, traced: Traced, played: Path, from_ink: Comparison
) -> dict[str, Any]:
    """Figures of the traced drawing, and of all three compared."""
    traced_from_ink = comparison.from_drawing(
        drawing, traced.path, "traced", _radius_mm(traced)
    )
    between = comparison.from_path(played, traced.path, ("played", "traced"))
    return {
        **traced.figures(),
        **traced_from_ink.figures,
        **from_ink.figures,
        **between.figures,
    }


def _radius_mm(traced: Traced) -> float:
    """The radius of the cutter, 0 without one."""
    return traced.cutter.radius_mm if traced.cutter else 0.0
