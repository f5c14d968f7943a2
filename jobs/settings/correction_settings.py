"""Which corrections a drawing is read with: those of the file beside it, of another file, or none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse
from morfax.motion.faults import CardFault, FileFault

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.listener import Listener
    from morfax.tracer.corrections.corrections import Corrections
    from morfax.tracer.corrections.on_sheet import OnSheet
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.following.line import Line


@dataclass(frozen=True, slots=True)
class CorrectionSettings:
    """The file of corrections: the one beside the drawing if none is named; with `used` False none at all."""

    file: FilePath | None = None
    used: bool = True

    def file_of(self, drawing: FilePath) -> FilePath:
        """The name of the file of a drawing."""
        from morfax.tracer.corrections import beside

        return beside(drawing) if self.file is None else self.file

    def found(self, drawing: FilePath) -> FilePath | None:
        """The file of a drawing, if it is used and is there."""
        file = self.file_of(drawing)
        try:
            is_there = file.is_file()
        except OSError:  # too long a name
            is_there = False
        return file if self.used and is_there else None

    def of(self, drawing: FilePath, page: int, listener: Listener) -> Corrections | None:
        """The corrections of a page of a drawing, and a word on them to the listener; None without any.

        Raises CardFault for a mistake in the file or for one of another page, FileFault if it cannot be read.
        """
        if self.file is not None and not self.used:
            raise WrongUse(
                "--corrections and --no-corrections were both given; give one of them"
            )
        file = self.found(drawing)
        if self.used and self.file is not None:
            file = self.file
        if file is None:
            return None
        from morfax.tracer.corrections.correction_file import read_corrections

        corrections = read_corrections(file)
        why_not = _of_another(corrections, drawing, page)
        if why_not is not None:
            if self.file is not None:
                raise CardFault(f"{file} {why_not}; give another file with --corrections")
            listener.note(
                f"{file} {why_not}, and is not used; this drawing's own go into a file with --corrections"
            )
            return None
        picture = corrections.picture
        if picture is not None and picture.sha256 not in ("", sha256_of(drawing)):
            listener.warning(
                f"{drawing} is not the file that its corrections were made on ({file}): look at the picture"
                " whether they still fit, or leave them out with --no-corrections"
            )
        return corrections


def sha256_of(file: FilePath) -> str:
    """The sum of a file's bytes; raises FileFault if it cannot be read."""
    import hashlib

    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise FileFault(f"cannot read {file}: {error.strerror}; check the name") from None


def tell(laid: OnSheet, listener: Listener) -> None:
    """Say how many corrections a drawing is read with, and which of them changed no ink."""
    corrections = laid.corrections
    if not corrections.each:
        return
    counts = ", ".join(f"{count} {kind}" for kind, count in corrections.counts().items())
    what = "correction" if len(corrections.each) == 1 else "corrections"
    listener.note(f"{len(corrections.each)} {what} of {corrections.file}: {counts}")
    for stroke in laid.strokes:
        if stroke.number not in laid.ink_changed:
            is_pen = stroke.do == "bridge"
            why = "there is as much ink already" if is_pen else "there is no ink under it"
            listener.warning(without_effect(laid, stroke.number, why))


def without_effect(laid: OnSheet, number: int, why: str) -> str:
    """One line on a correction that changed nothing, with its place."""
    x, y = laid.place_of(number)
    do = laid.corrections.each[number - 1].do
    which = f"correction {number} of {laid.corrections.file}, {do} at {x:.2f}, {y:.2f} mm"
    return f"{which}, changed nothing: {why}"


def not_served(laid: OnSheet, lines: Sequence[Line] | None) -> Iterator[str]:
    """One line for each turn or stop that no line that was followed went by; `lines` None: all the ink."""
    served = frozenset[int]().union(*(line.served for line in lines or ()))
    turns = {turn.number for turn in laid.turns}
    for number in sorted({*turns, *(stop.number for stop in laid.stops)} - served):
        why = "no line that the head followed has a mark to strike out there"
        if laid.corrections.each[number - 1].do != "not-stop":
            why = "no line that the head followed is there"
        if number in turns:
            why = "the head came to no junction there with such a way out"
        if lines is None:
            why = "--lines all follows crosses and ticks as lines; give --lines contours"
        yield without_effect(laid, number, why)


def named(name: str, laid: OnSheet | None) -> str:
    """A drawing's name in the head of a program, with the fingerprint of its corrections."""
    if laid is None or not laid.corrections.each:
        return name
    return f"{name} with corrections {laid.fingerprint}"


def figures(drawing: Drawing | None) -> Figures:
    """What a result says of the corrections that it was made with; nothing without any."""
    laid = None if drawing is None else drawing.corrected
    if laid is None or not laid.corrections.each:
        return {}
    return {
        "corrections": len(laid.corrections.each),
        "corrections_file": laid.corrections.file,
        "corrections_fingerprint": laid.fingerprint,
    }


def _of_another(corrections: Corrections, drawing: FilePath, page: int) -> str | None:
    """Why corrections belong to another drawing, or to another page of it; None if they do not."""
    picture = corrections.picture
    if picture is None:
        return None
    if picture.page != page:
        return f"belongs to page {picture.page}, and this is page {page}"
    is_other = picture.name != drawing.name and picture.sha256 != sha256_of(drawing)
    return f"belongs to {picture.name}, and this is {drawing.name}" if is_other else None
