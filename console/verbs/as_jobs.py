"""Words as jobs: what somebody would type, parsed by the verb's own parameters into its job, which does not
run.

Signals: the words after a verb in; out the verb's job, or WrongUse with the line that a terminal would
show. The panel asks this, so that a page and a terminal refuse the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path as FilePath
from typing import Any

import click

from morfax.console.options.desk import desk_options
from morfax.console.options.drawing import drawing_options
from morfax.console.options.groups import Verb
from morfax.console.options.placement import unit_options
from morfax.console.options.tape import tape_options
from morfax.console.options.tracing import trace_options
from morfax.console.verbs.correct import asked_corrections
from morfax.jobs.correct import CorrectJob
from morfax.jobs.lines import LinesJob
from morfax.jobs.machine.playing import ByHand
from morfax.jobs.play import ControlSettings, PlayJob
from morfax.jobs.run import RunJob
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.trace import TraceJob, TraceOutputs
from morfax.jobs.wrong_use import WrongUse


@dataclass(frozen=True, slots=True)
class WordsAsJobs:
    """The parsers of the verbs `lines`, `run`, `trace`, `correct` and `play`, by their parameters."""

    verbs: Mapping[str, click.Command]

    def lines(self, words: list[str]) -> LinesJob:
        """The job of `morfax lines WORDS`."""
        parsed: LinesJob = self._parsed("lines", _LINES, words)
        return parsed

    def run(self, words: list[str]) -> RunJob:
        """The job of `morfax run WORDS`, which takes down the following errors."""
        parsed: RunJob = self._parsed("run", _RUN, words)
        return parsed

    def correct(self, words: list[str]) -> CorrectJob:
        """The job of `morfax correct WORDS`."""
        parsed: CorrectJob = self._parsed("correct", _CORRECT, words)
        return parsed

    def play(self, words: list[str]) -> PlayJob:
        """The job of `morfax play WORDS`."""
        parsed: PlayJob = self._parsed("play", _PLAY, words)
        return parsed

    def trace(self, words: list[str]) -> TraceJob:
        """The job of `morfax trace WORDS`, of one drawing."""
        parsed: TraceJob = self._parsed("trace", _TRACE, words)
        return parsed

    def _parsed(self, verb: str, make: Callable[..., Any], words: list[str]) -> Any:
        """The job that a verb's words make."""
        parser = Verb(verb, params=self.verbs[verb].params, callback=make)
        try:
            return parser.main(args=words, prog_name=f"morfax {verb}", standalone_mode=False)
        except click.ClickException as refused:
            raise WrongUse(refused.format_message().rstrip(".")) from None


def _of_trace(
    drawings: tuple[Any, ...],
    output: FilePath | None,
    path_file: FilePath | None,
    picture: FilePath | None,
    force: bool,
    settings: Any,
    unit: Any,
    **_: Any,
) -> TraceJob:
    """The job of one drawing's tracing."""
    outputs = TraceOutputs(output, path_file, picture, force)
    return TraceJob(drawings[0], outputs, settings, unit)


def _of_run(
    drawing: Any, folder: FilePath | None, settings: Any, unit: Any, **_: Any
) -> RunJob:
    """The job of the whole way."""
    return RunJob(drawing, folder, settings, unit, charted=True)


def _of_lines(
    drawing: Any,
    follow: bool,
    line_width_mm: float | None,
    gap_mm: float | None,
    picture: FilePath | None,
    **_: Any,
) -> LinesJob:
    """The job that looks at a drawing."""
    line = LineSettings(line_width_mm=line_width_mm, gap_mm=gap_mm)
    return LinesJob(drawing, line, follow, picture)


def _of_correct(
    drawing: Any, undo: int, remove: tuple[int, ...], listed: bool, **options: Any
) -> CorrectJob:
    """The job that edits the corrections of a drawing."""
    options.pop("desk")
    return CorrectJob(drawing, asked_corrections(options), remove, undo)


def _of_play(
    tape: FilePath,
    outputs: tuple[FilePath, ...],
    charts: tuple[FilePath, ...],
    raw: bool,
    by_hand: ByHand,
    drawn_unit: str | None,
    **options: Any,
) -> PlayJob:
    """The job that plays a program."""
    control = ControlSettings(
        **{each.name: options[each.name] for each in fields(ControlSettings)}
    )
    return PlayJob(tape, outputs, charts, raw, control, by_hand, drawn_unit)


_TRACE = drawing_options("drawings")(trace_options(unit_options(desk_options(_of_trace))))
_RUN = drawing_options("drawing")(trace_options(unit_options(desk_options(_of_run))))
_CORRECT = drawing_options("drawing")(desk_options(_of_correct))
_PLAY = tape_options(desk_options(_of_play))
_LINES = drawing_options("drawing")(desk_options(_of_lines))
