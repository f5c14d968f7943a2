"""Several drawings traced with the same options, each to results with a name of its own.

Signals: drawings, names with {} for each drawing's name, and settings in; the outcome of each drawing out, as
it is done. A drawing that fails does not stop the others. All names are checked before the first is traced.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.recording import RecordingUnit
from morfax.jobs.media import files as medium
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.trace import NAME, TraceJob, TraceOutputs, TraceResult
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import Fault

if TYPE_CHECKING:
    from morfax.tracer.operator.operator import Panel


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one drawing: a result, or the fault that kept it from one."""

    job: TraceJob
    result: TraceResult | None
    fault: Fault | None

    def figures(self) -> dict[str, Any]:
        """Figures of the drawing, with the fault as text."""
        told = {} if self.result is None else self.result.figures
        fault = {} if self.fault is None else {"fault": str(self.fault)}
        return {"drawing": str(self.job.drawing.file), **told, **fault}


@dataclass(frozen=True, slots=True)
class TraceEachJob:
    """Trace several drawings; `outputs` has a folder for the programs, or names with {} in them."""

    drawings: tuple[DrawingFile, ...]
    outputs: TraceOutputs = field(default_factory=TraceOutputs)
    settings: TraceSettings = field(default_factory=TraceSettings)
    unit: RecordingUnit = field(default_factory=RecordingUnit)

    def jobs(self) -> list[TraceJob]:
        """A job for each drawing; raises WrongUse for names that do not differ, FileFault for a bad one."""
        jobs = [self._job(drawing) for drawing in self.drawings]
        taken = dict[FilePath, FilePath]()
        sources = [drawing.file for drawing in self.drawings]
        for job in jobs:
            named = job.outputs.checked(job.drawing.file)
            for file in (named.program, named.path, named.picture):
                if file is None:
                    continue
                medium.outgoing(file, *sources)
                if file.absolute() in taken:
                    raise WrongUse(
                        f"{taken[file.absolute()]} and {job.drawing.file} would both be written to {file}; "
                        "trace them one by one, or rename one"
                    )
                taken[file.absolute()] = job.drawing.file
        return jobs

    def each(
        self, listener: Listener = SILENT, panel: Panel | None = None
    ) -> Iterator[Outcome]:
        """Trace one drawing after the other; raises WrongUse, other faults are in the outcomes."""
        jobs = self.jobs()
        for number, job in enumerate(jobs, 1):
            listener.note(f"{number} of {len(jobs)}: {job.drawing.file}")
            try:
                result = job.run(listener, panel)
            except Fault as fault:
                yield Outcome(job, None, fault)
            else:
                yield Outcome(job, result, result.fault)

    def _job(self, drawing: DrawingFile) -> TraceJob:
        """The job of one drawing."""
        stem, outputs = drawing.file.stem, self.outputs
        program = outputs.program
        if program is not None and program.is_dir():
            made = program / f"{stem}.wav"
            program = medium.made_up(made, drawing.file, force=outputs.force)
        else:
            program = self._named(program, stem)
        names = TraceOutputs(
            program,
            self._named(outputs.path, stem),
            self._named(outputs.picture, stem),
            outputs.force,
        )
        return TraceJob(drawing, names, self.settings, self.unit)

    def _named(self, name: FilePath | None, stem: str) -> FilePath | None:
        """A name with the drawing's in it, and its folder made; raises WrongUse for one name for several
        drawings.
        """
        if name is None:
            return None
        if NAME in str(name):
            named = FilePath(str(name).replace(NAME, stem))
            with suppress(OSError):  # then the name is refused as for one drawing
                named.parent.mkdir(exist_ok=True)
            return named
        raise WrongUse(
            f"{name} is one name for the results of {len(self.drawings)} drawings; put {NAME} in it for the "
            f"drawing's name, such as {name.with_name(NAME + name.suffix)}"
        )
