"""The job `compare`: how far two contours are apart: paths, tapes, or one of them a drawing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from morfax.jobs.listener import SILENT, Listener
from morfax.jobs.machine.playing import ByHand, Playing, read_or_play
from morfax.jobs.media import files as medium
from morfax.jobs.media import outlines
from morfax.jobs.readings import comparison
from morfax.jobs.settings import correction_settings, flattening
from morfax.jobs.settings.drawing_file import DrawingFile
from morfax.jobs.settings.zero import OF_PART, Zero, refuse_of_part, said_by
from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.readings.comparison import Comparison
    from morfax.motion.motion import Path
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.operator.operator import Panel


# of a program that is compared: the control's servos then stay within 10 um of it
FASTEST_MM_S = 20.0


@dataclass(frozen=True, slots=True)
class CompareResult:
    """What a comparison gave: figures, the error along the first path, and what it was compared with.

    Whether it is `within` the tolerance is None without one. A face draws the picture.
    """

    figures: Figures
    found: Comparison
    paths: tuple[Path, ...]
    drawing: Drawing | None
    within: bool | None
    is_beside: bool = False  # whether a cutter's edge was compared, and not the path itself


@dataclass(frozen=True, slots=True)
class CompareJob:
    """Compare two path files, drawings from CAD, tapes or programs; or one of them with a drawing."""

    a: DrawingFile  # a path or tape too: its scale and ink then say nothing
    b: FilePath
    tolerance_mm: float | None = None
    picture: FilePath | None = None
    cutter_mm: float | None = None  # diameter of the cutter that the path is for
    # where the path's zero is on the drawing; None: the sheet's corner
    zero: Zero | None = None
    by_hand: ByHand = field(default_factory=ByHand)
    drawn_unit: str | None = None  # of a drawing from CAD; None: the file's own

    def run(self, listener: Listener = SILENT, panel: Panel | None = None) -> CompareResult:
        """Compare; raises WrongUse and every fault."""
        drawing_file, files = self._sorted()
        outlines.check_unit(self.drawn_unit, *files)
        if self.picture is not None:
            medium.outgoing(self.picture, self.a.file, self.b)
        if drawing_file is None:
            self._refuse_drawing_options()
        zero = None if drawing_file is None else self._zero(files[0], listener)
        drawing = None if drawing_file is None else drawing_file.open(listener)
        paths = [
            self._path(file, by_hand, listener)
            for file, by_hand in zip(files, self.by_hand.beside(files), strict=True)
        ]
        if drawing is None:
            found = comparison.from_path(paths[0], paths[1], listener=listener)
        else:
            paths = [_on_sheet(drawing, paths[0], zero)]
            radius_mm = (self.cutter_mm or 0.0) / 2
            ink = comparison.measured_on(drawing)
            found = comparison.from_drawing(ink, paths[0], radius_mm=radius_mm)
        if found.is_elsewhere:
            listener.warning(_elsewhere(found.measured_share, self.zero, zero))
        within = None if self.tolerance_mm is None else found.is_within(self.tolerance_mm)
        figures: dict[str, Any] = {
            "a": str(self.a.file),
            "b": str(self.b),
            "picture": None if self.picture is None else str(self.picture),
            "tolerance_mm": self.tolerance_mm,
            "within_tolerance": within,
            "largest_mm": found.largest_mm,
            **flattening.figures(drawing, self.picture),
            **correction_settings.figures(drawing),
            **found.figures,
        }
        is_beside = drawing is not None and bool(self.cutter_mm)
        return CompareResult(figures, found, tuple(paths), drawing, within, is_beside)

    def _path(self, file: FilePath, by_hand: ByHand, listener: Listener) -> Path:
        """The path in a file, or that of the machine: of a program no faster than it is held well."""
        if medium.has_machine(file):
            settings = {"fastest_mm_s": FASTEST_MM_S}
            return Playing(file, by_hand, settings=settings).without_fault(listener)
        return read_or_play(file, by_hand, listener, drawn_unit=self.drawn_unit)

    def _sorted(self) -> tuple[DrawingFile | None, list[FilePath]]:
        """The drawing, if one of the two is one, and the paths and tapes in the order given."""
        both = (self.a.file, self.b)
        drawings = [file for file in both if medium.kind_of(file) == "drawing"]
        if len(drawings) == len(both):
            raise WrongUse(
                f"{self.a.file} and {self.b} are both drawings; trace one of them first, or give a path or a "
                "tape"
            )
        rest = [file for file in both if file not in drawings]
        return (replace(self.a, file=drawings[0]) if drawings else None), rest

    def _refuse_drawing_options(self) -> None:
        """Raise WrongUse for settings that only a drawing takes."""
        if self.zero is not None:
            raise WrongUse("--zero is a place on a drawing; without one leave it out")
        if self.cutter_mm is not None:
            raise WrongUse("--cutter is for a path beside a drawing's line; leave it out")

    def _zero(self, file: FilePath, listener: Listener) -> Zero | None:
        """Where the path's zero is on the drawing: as asked for, or as the program's own head says it."""
        is_named = self.zero in OF_PART
        if self.zero is not None and not is_named:
            return self.zero
        said_mm = said_by(file)
        if said_mm is None:
            refuse_of_part(self.zero, file)
            return self.zero
        x_mm, y_mm = said_mm
        listener.note(f"{file.name} says that its zero is at {x_mm:g},{y_mm:g} mm of the sheet")
        return said_mm


def _elsewhere(share: float, given: Zero | None, taken: Zero | None) -> str:
    """What may be wrong with a path of which so small a share lies along the drawing's ink; `taken` is its
    zero, as it was given, or else as the path's own head says it.
    """
    lies = f"only {100 * share:.0f} % of the path lies along the drawing's ink"
    wrong = "the path leaves the ink, or belongs to another drawing"
    if taken is None:
        wrong += ", or has another zero than the sheet's lower left corner: --zero X,Y gives it"
    elif given is not None and given not in OF_PART:
        wrong += ", or has another zero than the --zero that was given"
    return f"{lies}: {wrong}; --picture shows where"


def _on_sheet(drawing: Drawing, path: Path, zero: Zero | None) -> Path:
    """The path in the sheet's own coordinates."""
    if zero is None or zero == "sheet":
        return path
    from morfax.motion.placement import Placement
    from morfax.tracer.following.start import reference_on

    place_mm = reference_on(drawing) if isinstance(zero, str) else zero
    return Placement(origin_mm=(-place_mm[0], -place_mm[1])).path(path)
