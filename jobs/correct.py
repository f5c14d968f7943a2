"""The job `correct`: corrections are added to the file beside a drawing, taken away, or listed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.settings.correction_settings import sha256_of
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.wrong_use import WrongUse, settings_checked
from morfax.motion.faults import CardFault, DrawingFault

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.tracer.corrections.corrections import (
        Correction,
        Corrections,
        PictureFile,
        Place,
    )
    from morfax.tracer.corrections.on_sheet import OnSheet, SheetSize
    from morfax.tracer.drawing.scan import Scan


@dataclass(frozen=True, slots=True)
class CorrectResult:
    """What the file of corrections holds now: figures, the corrections, and where they lie on the sheet.

    Without a scale the sheet has none: `laid` is None then, and no place is told in mm.
    """

    figures: Figures
    corrections: Corrections
    laid: OnSheet | None
    file: FilePath


@dataclass(frozen=True, slots=True)
class CorrectJob:
    """Take corrections away, by number or the last few, and add some; without either say what there is.

    Places are pixels of the picture as it is read, or mm on the sheet; the file has pixels.
    """

    drawing: DrawingFile
    add: tuple[Correction, ...] = ()
    remove: tuple[int, ...] = ()
    undo: int = 0  # how many of the last ones are taken away

    def run(self, listener: Listener = SILENT) -> CorrectResult:
        """Edit the file, whole or not at all; raises WrongUse, CardFault, FileFault and DrawingFault."""
        from morfax.tracer.corrections.correction_file import parse_corrections

        if not self.drawing.corrections.used:
            raise WrongUse(
                "correct makes corrections, and --no-corrections reads none; leave --no-corrections out"
            )
        file = self.drawing.corrections.file_of(self.drawing.file)
        scan = self.drawing.scanned(listener)
        size, has_scale = self._size(scan)
        # 1. what there is
        text = _text_of(file)
        before = parse_corrections(text, file.name)
        numbers = self._taken(before)
        # 2. in the frame of the picture that the file states
        picture = before.picture or self._picture(scan)
        with settings_checked():
            for one in self.add:
                one.check()
        added = tuple(_in_frame(one, size, picture) for one in self.add)
        kept = tuple(o for n, o in enumerate(before.each, 1) if n not in numbers)
        after = replace(before, each=(*kept, *added), picture=picture, file=file.name)
        laid = size.laid(after)
        # 3. written
        if numbers or added:
            self._write(file, text, numbers, added, picture)
        figures = self._figures(file, after, laid if has_scale else None)
        figures |= {"added": len(added) or None, "removed": list(numbers) or None}
        return CorrectResult(figures, after, laid if has_scale else None, file)

    def _size(self, scan: Scan) -> tuple[SheetSize, bool]:
        """The sheet's size; where no scale is known, in pixels. And whether one is."""
        from morfax.tracer.corrections.on_sheet import SheetSize

        try:
            x_mm, y_mm = self.drawing.scale().pitches_mm(scan)
        except DrawingFault:
            if any(one.has_mm for one in self.add):
                raise
            return SheetSize(scan.columns, scan.rows, scan.columns, scan.rows), False
        width_mm = scan.columns * x_mm
        height_mm = scan.rows * y_mm
        return SheetSize(width_mm, height_mm, scan.columns, scan.rows), True

    def _picture(self, scan: Scan) -> PictureFile:
        """The picture that the corrections belong to."""
        from morfax.motion.files import printable
        from morfax.tracer.corrections.corrections import PictureFile

        name = printable(self.drawing.file.name)
        checked = sha256_of(self.drawing.file)
        return PictureFile(name, scan.columns, scan.rows, checked, scan.page)

    def _taken(self, before: Corrections) -> tuple[int, ...]:
        """The numbers of the corrections that are taken away."""
        count = len(before.each)
        has = f"there {'is' if count == 1 else 'are'} {count or 'none'}"
        if self.undo > count:
            raise WrongUse(
                f"--undo {self.undo} takes back more corrections than there are: {has}; give no more"
            )
        last = range(count - self.undo + 1, count + 1)
        for number in self.remove:
            if not 1 <= number <= count:
                raise WrongUse(
                    f"there is no correction {number}: {has}; `morfax correct` without options lists them"
                )
        return tuple(sorted({*self.remove, *last}))

    def _write(
        self,
        file: FilePath,
        text: str,
        numbers: tuple[int, ...],
        added: tuple[Correction, ...],
        picture: PictureFile,
    ) -> None:
        """Write the edited text."""
        from morfax.tracer.corrections import correction_file

        try:
            left = correction_file.without(text, numbers) if numbers else text
            edited = correction_file.with_added(left, added, picture)
            held = correction_file.parse_corrections(edited, file.name)
        except CardFault as fault:
            raise _not_edited(file) from fault
        before = correction_file.parse_corrections(text, file.name)
        kept = [one for n, one in enumerate(before.each, 1) if n not in numbers]
        if [str(o) for o in held.each] != [str(o) for o in (*kept, *_as_written(added))]:
            raise _not_edited(file)
        correction_file.write_text(file, edited)

    def _figures(
        self, file: FilePath, after: Corrections, laid: OnSheet | None
    ) -> dict[str, Any]:
        """What the file holds."""
        rows = [
            {
                "correction": number,
                "do": one.do,
                "at": " ".join(map(str, one.at[:3])) + (" …" if len(one.at) > 3 else ""),
                "place_mm": None if laid is None else laid.place_of(number),
                "width": None if one.width is None else str(one.width),
                "why": one.why or None,
            }
            for number, one in enumerate(after.each, 1)
        ]
        return {
            "drawing": str(self.drawing.file),
            "corrections_file": str(file),
            "corrections": len(rows),
            "each": rows or None,
        }


def _text_of(file: FilePath) -> str:
    """The text of a file, empty if there is none; raises CardFault if it is too large or no text."""
    from morfax.motion.toml_fields import opened
    from morfax.tracer.corrections.correction_file import CALLED

    if not file.exists():
        return ""
    opened(file, CALLED, "--corrections")
    return file.read_text(encoding="utf-8-sig")


def _in_frame(one: Correction, size: SheetSize, picture: PictureFile) -> Correction:
    """A correction with its places in pixels of the picture that the file states."""
    from morfax.tracer.corrections.corrections import Place, Span

    across = picture.columns / size.columns
    down = picture.rows / size.rows

    def framed(place: Place) -> Place:
        px = size.in_pixels(place)
        return Place(px.x * across, px.y * down)

    width = None if one.width is None else Span(size.span_in_pixels(one.width).amount * across)
    come = None if one.coming_from is None else framed(one.coming_from)
    return replace(one, at=tuple(map(framed, one.at)), width=width, coming_from=come)


def _as_written(added: tuple[Correction, ...]) -> list[Correction]:
    """Corrections with the figures that a file has of their places."""
    from morfax.tracer.corrections.correction_file import as_toml, parse_corrections
    from morfax.tracer.corrections.corrections import Corrections

    return list(parse_corrections(as_toml(Corrections(added))).each) if added else []


def _not_edited(file: FilePath) -> CardFault:
    """The fault of a file that is written in another way than entries."""
    return CardFault(
        f"{file} cannot be edited: its corrections are not written as [[correction]] entries of their own"
        " lines; write them so, or edit the file by hand"
    )
