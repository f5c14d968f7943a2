"""The job `lines`: what is on a drawing before anything is traced, with the numbers that --lines takes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener, never_back
from morfax.jobs.media import files as medium
from morfax.jobs.remarks.on_survey import remarks_on_lines
from morfax.jobs.remarks.scale_doubts import scale_doubts
from morfax.jobs.settings import correction_settings
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.settings import TraceSettings
from morfax.jobs.tracing import trace_figures
from morfax.jobs.tracing.skips import gap_across_skips

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.ink.left_out import Area
    from morfax.tracer.operator.operator import Panel
    from morfax.tracer.program.setup import Setup
    from morfax.tracer.program.survey import Entry, Survey


@dataclass(frozen=True, slots=True)
class LinesResult:
    """What is on a drawing: figures, the survey, and the name under which its picture belongs."""

    figures: Figures
    drawing: Drawing
    survey: Survey
    picture: FilePath | None


@dataclass(frozen=True, slots=True)
class LinesJob:
    """Say what is on a drawing; with `follow` after all lines have been followed, and nothing recorded."""

    drawing: DrawingFile
    line: LineSettings = field(default_factory=LineSettings)
    follow: bool = False
    picture: FilePath | None = None

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> LinesResult:
        """Look, and follow if asked; raises DrawingFault, FileFault and WrongUse."""
        from morfax.tracer.program.setup import Setup
        from morfax.tracer.program.survey import survey

        of_head = TraceSettings(self.line).of_head()
        if self.picture is not None:
            medium.outgoing(self.picture, self.drawing.file)
        drawing, areas = self._without_areas(self.drawing.for_lines(self.line).open(listener))
        listener.compiling("the head", ("motion", "tracer"))
        gap_mm = gap_across_skips(drawing, self.line, of_head)
        of_head = of_head if gap_mm is None else replace(of_head, gap_mm=gap_mm)
        setup = Setup(drawing.sheet, of_head)
        with listener.progress("looking for lines", 1.0):
            seen = survey(setup)
        if self.follow and seen.entries:
            seen = _followed(seen, setup, listener)
        width_mm = None if drawing.edges_mm else seen.width_mm  # an edge has none
        for text in (*scale_doubts(drawing, width_mm), *remarks_on_lines(seen)):
            listener.warning(text)
        written = {} if self.picture is None else {"picture": str(self.picture)}
        corrected = correction_settings.figures(drawing)
        figures = {"drawing": str(self.drawing.file), **written, **corrected}
        figures |= _figures(drawing, seen) | trace_figures.solid_areas(areas)
        return LinesResult(figures, drawing, seen, self.picture)

    @staticmethod
    def _without_areas(drawing: Drawing) -> tuple[Drawing, tuple[Area, ...]]:
        """The lines of a drawing that was read for both, and its solid areas; any other as it is."""
        if not drawing.both:
            return drawing, ()
        from morfax.tracer.ink.lines_and_rims import lines_and_areas

        return lines_and_areas(drawing)


def _followed(seen: Survey, setup: Setup, listener: Listener) -> Survey:
    """The survey with all lines followed, and its progress told."""
    from morfax.tracer.program.survey_followed import followed

    with listener.progress("following the lines", 1.0) as advance:
        return followed(seen, replace(setup, progress=never_back(advance)))


def _figures(drawing: Drawing, seen: Survey) -> dict[str, Any]:
    """What was seen, as figures: the sheet, what has no number, and a row for each number."""
    return {
        "sheet_width_mm": drawing.width_mm,
        "sheet_height_mm": drawing.height_mm,
        "line_width_mm": None if drawing.edges_mm else seen.width_mm,
        "dots": sum(entry.kind == "dot" for entry in seen.entries),
        "likely_letters": len(seen.lettering),
        "patches_left_out": len(seen.left_out),
        "ink_left_out_mm": seen.left_out_mm,
        "ink_not_followed_mm": seen.not_followed_mm,
        "lines": [_row(entry, on_edges=bool(drawing.edges_mm)) for entry in seen.entries],
    }


def _row(entry: Entry, *, on_edges: bool) -> dict[str, Any]:
    """One number, as figures."""
    return {
        "line": entry.number,
        "kind": entry.kind,
        "length_mm": entry.length_mm,
        "inside": entry.inside,
        "line_width_mm": None if on_edges else entry.width_mm,
        "joined_to": entry.joined_to,
        "place_mm": entry.place_mm,
        "in_contours": entry.is_in_contours,
        "remark": ", ".join(_said_of(entry)) or None,
    }


def _said_of(entry: Entry) -> list[str]:
    """What is to be known of a line beside its figures."""
    said = {
        "rim of a solid area": entry.is_solid,
        "taken for a letter": entry.is_letter,
        "no place for the head": not entry.can_begin and not entry.is_letter,
        "lettering?": entry.is_lettering and not entry.is_letter,
        "reference point": entry.is_reference,
        f"piece of line {entry.piece_of}": entry.piece_of is not None,
    }
    return [text for text, holds in said.items() if holds]
