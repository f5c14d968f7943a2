"""The drawing's file: how a job opens the drawing that somebody brings.

Signals: a file and how it is read in, all plain values; the drawing with its corrections, and notes and
progress for a listener, out.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.settings import correction_settings, flattening
from morfax.jobs.settings.correction_settings import CorrectionSettings
from morfax.jobs.settings.flattening import FlattenSettings
from morfax.jobs.settings.line_settings import LineSettings
from morfax.jobs.settings.on_pages import of_page
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.drawing.ruling import PaperKind
    from morfax.tracer.drawing.scale import Known, Scale
    from morfax.tracer.drawing.scan import Scan
    from morfax.tracer.flatten.flat import Flattening

# pieces of work that take long for a large sheet, or a page of many drawn lines
READ, MEASURED = "reading the drawing", "measuring the ink"


@dataclass(frozen=True, slots=True)
class DrawingFile:
    """A drawing and how it is read: its scale if the file states none or a wrong one, ink, filled shapes."""

    file: FilePath
    dpi: float | None = None
    width_mm: float | None = None
    ink: str | None = None
    edge: bool = False
    both: bool = False  # of filled shapes among lines the edges, and of the lines their middle
    all_ink: bool = False  # filled shapes among lines are ink, and no dark paper
    paper: PaperKind = "auto"  # printed lines of squared or ruled paper are left out
    page: int | None = None  # of a file of several; None: the first, and it is said
    known: Known | None = None  # two places and their distance, instead of dpi or width
    flatten: FlattenSettings = field(default_factory=FlattenSettings)
    corrections: CorrectionSettings = field(default_factory=CorrectionSettings)

    def open(self, listener: Listener = SILENT) -> Drawing:
        """Open the drawing with its corrections; raises WrongUse for two scales, DrawingFault and FileFault
        for a bad file, CardFault for corrections that are not its own.
        """
        from morfax.tracer.drawing import inks
        from morfax.tracer.drawing.drawing import Drawing
        from morfax.tracer.drawing.reading import Reading

        self.check()
        ink = None if self.ink is None else inks.parsed(self.ink)
        scan, made = self._scanned(listener)
        with listener.progress(MEASURED, 1.0):
            if self.both:
                from morfax.tracer.drawing.shapes_among_lines import drawing_of_both

                drawing = drawing_of_both(scan, self.scale(), ink)
            elif self.all_ink:
                from morfax.tracer.drawing.shapes_among_lines import drawing_of_all_ink

                drawing = drawing_of_all_ink(scan, self.scale(), ink, self.paper)
            else:
                reading = Reading(self.edge, self.paper)
                drawing = Drawing.of(scan, self.scale(), ink, reading)
        if made is not None:  # a copy would measure its ink once more
            drawing = replace(drawing, flattening=made)
        for note in drawing.notes:
            listener.note(of_page(note, drawing))
        return self._corrected(drawing, scan, listener)

    def for_lines(self, line: LineSettings) -> DrawingFile:
        """The same, read for all the ink where that is asked for; with edges for both edges and lines."""
        is_all = line.lines == "all"
        return replace(self, both=self.edge and is_all, all_ink=is_all and not self.edge)

    def check(self) -> None:
        """Raise WrongUse for options that do not go together, before the file is read."""
        self.scale()
        if self.edge and self.paper in ("squared", "ruled"):
            raise WrongUse(
                f"--paper {self.paper} is for drawn lines, --edge for filled shapes; give one of them"
            )

    def scale(self) -> Scale:
        """The scale that is given; raises WrongUse for two."""
        from morfax.tracer.drawing.scale import Scale

        scale = Scale(self.dpi, self.width_mm, self.known)
        if len(scale.given()) > 1:
            raise WrongUse(f"{' and '.join(scale.given())} were both given; give one of them")
        return scale

    def scanned(self, listener: Listener = SILENT) -> Scan:
        """The picture as it is read, made flat if it is a photograph."""
        return self._scanned(listener)[0]

    def _scanned(self, listener: Listener) -> tuple[Scan, Flattening | None]:
        """The picture as it is read, made flat if it is a photograph, and how well."""
        scale_given = bool(self.scale().given())
        self.flatten.check(scale_given)
        scan = self._read(listener, coloured=self._by_colour)
        return self._flattened(scan, scale_given, listener)

    @property
    def _by_colour(self) -> bool:
        """Whether an ink is told from others by its colour."""
        from morfax.tracer.drawing import inks

        return inks.is_colour(self.ink)

    def _read(self, listener: Listener, *, coloured: bool) -> Scan:
        """The picture as the file has it; a page full of drawn lines is rendered for a while."""
        from morfax.tracer.drawing import raster

        with listener.progress(READ, 1.0):
            return raster.read(self.file, coloured=coloured, page=self.page, dpi=self.dpi)

    def _corrected(self, drawing: Drawing, scan: Scan, listener: Listener) -> Drawing:
        """The drawing with its corrections, if it has any."""
        corrections = self.corrections.of(self.file, scan.page, listener)
        if corrections is None:
            return drawing
        from morfax.tracer.drawing.corrected import corrected

        drawing = corrected(drawing, corrections, (scan.columns, scan.rows))
        if drawing.corrected is not None:
            correction_settings.tell(drawing.corrected, listener)
        return drawing

    def _flattened(
        self, scan: Scan, scale_given: bool, listener: Listener
    ) -> tuple[Scan, Flattening | None]:
        """The scan of a photograph made flat, and how well; any other scan as it is."""
        wanted = self.flatten.of(scan, scale_given)
        if wanted is None:
            if scale_given:
                flattening.warn_of_tilt(scan, listener)
            flattening.warn_of_table(scan, listener)
            return scan, None
        if not self._by_colour:
            scan = self._read(listener, coloured=True)
        flat, made = flattening.made_flat(scan, wanted, self.flatten.bar_mm, listener)
        return (flat if self._by_colour else flattening.in_grey(flat, made)), made
