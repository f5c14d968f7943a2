"""The job `trace`: a drawing becomes a program and a path."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.machining import tell_what_is_lost
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.media import files as medium
from morfax.jobs.settings import flattening
from morfax.jobs.settings.correction_settings import figures as figures_of
from morfax.jobs.settings.correction_settings import named
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing.tracing import Tracing
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.tracing.traced import Traced
    from morfax.motion.faults import Fault
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.operator.operator import Panel

NAME = "{}"  # in a result's name: it stands for the drawing's name, without its suffix


@dataclass(frozen=True, slots=True)
class TraceOutputs:
    """Names for the results: the program (or a path file alone, .csv), the path, the picture.

    Without a program's name the job makes one of the drawing's, in the current folder, which it writes over
    only by `force`. The face draws the picture.
    """

    program: FilePath | None = None
    path: FilePath | None = None
    picture: FilePath | None = None
    force: bool = False

    def checked(self, drawing: FilePath) -> TraceOutputs:
        """The names under which results can be written; raises FileFault if one cannot, WrongUse for one
        name twice.
        """
        medium.outgoing_together((self.program, self.path, self.picture), drawing)
        program = self.program
        if program is None:
            program = medium.made_up(FilePath(f"{drawing.stem}.wav"), drawing, force=self.force)
        if program.suffix.lower() in medium.PATHS:
            if self.path is not None:
                raise WrongUse(
                    f"{program} and {self.path} would both hold the head's path; give -o a program, such as "
                    f"{program.with_suffix('.ngc')}, or leave --path out"
                )
            return TraceOutputs(None, program, self.picture)
        return TraceOutputs(program, self.path, self.picture)


@dataclass(frozen=True, slots=True)
class TraceResult:
    """What a tracing gave: figures, what the head traced, and the name under which its picture belongs.

    The fault is that of a line that was lost: the files then hold what was traced before it.
    """

    figures: Figures
    drawing: Drawing
    traced: Traced
    picture: FilePath | None
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class TraceJob:
    """Follow the line of a drawing and record the head's motion."""

    drawing: DrawingFile
    outputs: TraceOutputs = field(default_factory=TraceOutputs)
    settings: TraceSettings = field(default_factory=TraceSettings)
    unit: RecordingUnit = field(default_factory=RecordingUnit)

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> TraceResult:
        """Trace and write; raises WrongUse and every fault but that of a line that was lost on its way."""
        outputs, tracing = self.prepared(panel)
        drawing = self.drawing.for_lines(tracing.settings.line).open(listener)
        size = f"{drawing.width_mm:.2f} x {drawing.height_mm:.2f} mm"
        listener.detail(f"{self.drawing.file}: sheet of {size}")
        if outputs.program is not None:
            tell_what_is_lost(self.settings, self.unit, outputs.program, listener)
        return self.written(outputs, drawing, tracing.trace(drawing, listener), listener)

    def prepared(self, panel: Panel | None = None) -> tuple[TraceOutputs, Tracing]:
        """The names for the results, and the head as it is set; raises WrongUse, CardFault and FileFault."""
        usual = self.settings.with_usual_lines(self.unit.usual_lines(self.outputs.program))
        tracing = Tracing.prepared(usual, panel)
        outputs = self.outputs.checked(self.drawing.file)
        self.unit.check(outputs.program)
        return outputs, tracing.on_machine(self.unit, outputs.program)

    def _source(self, drawing: Drawing) -> str:
        """What the program's head says that it was made from."""
        return named(self.drawing.file.name, drawing.corrected)

    def written(
        self, outputs: TraceOutputs, drawing: Drawing, traced: Traced, listener: Listener
    ) -> TraceResult:
        """Write what was traced, also by an equal tracing before this one; raises the recorders' faults."""
        source, tool = self._source(drawing), self.settings.tool.described(self.unit.scale)
        unit = traced.placed(self.unit, outputs.program, source, tool)
        written = dict[str, Any]()
        timed = dict[str, Any]()
        if outputs.program is not None:
            program, report = traced.record(outputs.program, unit, listener)
            written[medium.called(outputs.program)] = str(program)
            if medium.has_machine(outputs.program):  # whose time is not the head's
                timed["duration_s"] = report.duration_s
        if outputs.path is not None:
            written["path"] = str(traced.write(outputs.path, unit))
        picture = None if outputs.picture is None else traced.name(outputs.picture)
        if picture is not None:
            written["picture"] = str(picture)
        unit.warn(outputs.program, listener, self.settings)
        flat = {**flattening.figures(drawing, picture), **figures_of(drawing)}
        figures = {"drawing": str(self.drawing.file), **written, **flat, **traced.figures()}
        figures |= {**timed, **traced.zero_figures(unit), **unit.figures()}
        return TraceResult(figures, drawing, traced, picture, traced.fault)
