"""The zero of a program: where on the sheet, or on the part that is cut, the machine's zero is.

    sheet         the lower-left corner of the sheet as it was scanned: mirror, scale and turn leave it there
    lower-left    the lowest X and the lowest Y of the part, as it lies after mirror, scale and turn
    centre        halfway between the lowest and the highest X and Y of the part
    reference     the reference point on the drawing
    X,Y           a place on the sheet; these two are mirrored, scaled and turned with the drawing

The part is what is cut of the lines themselves: a cutter's path, leads and lead lines do not count.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from morfax.jobs.media import files as medium
from morfax.jobs.wrong_use import WrongUse
from morfax.motion.long_array import blocks

if TYPE_CHECKING:
    from morfax.jobs.figures import Figures
    from morfax.jobs.settings.settings import TraceSettings
    from morfax.motion.motion import Path
    from morfax.motion.placement import Placement
    from morfax.tracer.drawing.drawing import Drawing
    from morfax.tracer.program.program import Trace

Place = tuple[float, float]
Zero = Literal["sheet", "reference", "lower-left", "centre"] | Place
OF_PART = ("lower-left", "centre")


@dataclass(frozen=True, slots=True)
class ZeroOnSheet:
    """The zero that is asked for, its place on the sheet, and the lines of the part.

    Where the part's places are is made out when it is asked: of a path nobody asks.
    """

    asked: Zero
    place_mm: Place = (0.0, 0.0)
    followed: Trace | None = None

    @classmethod
    def of(cls, settings: TraceSettings, drawing: Drawing, followed: Trace) -> ZeroOnSheet:
        """The zero of a program; raises LineFault without the reference point that is asked for.

        The reference point is the one given, or that from which the program begins, or the only one drawn.
        """
        from morfax.tracer.following.start import reference_on

        zero, place_mm = settings.program.zero, (0.0, 0.0)
        if zero == "reference":
            given_mm = settings.line.reference_mm or followed.reference_mm
            place_mm = given_mm or reference_on(drawing)
        elif not isinstance(zero, str):
            place_mm = zero
        return cls(zero, place_mm, followed)

    def origin_mm(self, placement: Placement) -> Place:
        """What a placement about a known point takes off, so that the zero is where it is asked for."""
        if self.asked == "sheet":
            return self.place_mm
        if self.asked not in OF_PART or self.followed is None:
            return placed_mm(self.place_mm, placement)
        return on_part_mm(self.asked, _bounds_mm(self.followed, placement))

    def part_size_mm(self, placement: Placement) -> Place | None:
        """Width and height of the part as it is placed, mm; None if it is not known."""
        if self.followed is None:
            return None
        width_mm, height_mm = np.ptp(_bounds_mm(self.followed, placement), axis=0).tolist()
        return width_mm, height_mm


def _bounds_mm(trace: Trace, placement: Placement) -> NDArray[np.float64]:
    """The lowest X and Y of the part as it is placed, and the highest, (2, 2) mm."""
    outermost = list[NDArray[np.float64]]()
    for line_mm in _part_mm(trace):
        for block in blocks(line_mm):
            for along in (block @ row for row in placement.matrix):
                outermost += [
                    block[np.argmin(along)].copy(),
                    block[np.argmax(along)].copy(),
                ]
    placed = placement.places(np.array(outermost))
    return np.array([placed.min(axis=0), placed.max(axis=0)])


def _part_mm(trace: Trace) -> tuple[NDArray[np.float64], ...]:
    """Places of what is cut along the lines, (n, 2) mm each; of drill points alone the points."""
    from morfax.tracer.cutter.contour import planned

    cuts = [cut.places_mm for _, cut in planned(trace) if cut is not None]
    return tuple(cuts) or (trace.xy_mm,)


def on_part_mm(zero: Zero, places_mm: NDArray[np.float64]) -> Place:
    """The lower-left corner or the centre of a part's places (n, 2) mm."""
    low, high = places_mm.min(axis=0), places_mm.max(axis=0)
    x, y = low if zero == "lower-left" else 0.5 * (low + high)
    return float(x), float(y)


def of_path_mm(zero: Zero, path: Path, placement: Placement) -> Place:
    """What a placement takes off a path, so that its zero is there; raises WrongUse without what it is of.

    The part is what is run with the tool in the work, without leads.
    """
    from morfax.motion.lead_parts import without_leads

    if zero == "sheet":
        return (0.0, 0.0)
    if zero == "reference":
        raise WrongUse(
            "--zero reference is a point on a drawing, and a path has none; give lower-left, centre, or its "
            "place X,Y"
        )
    placement = placement.about(path.positions_mm[0])
    if not isinstance(zero, str):
        return placed_mm(zero, placement)
    runs = without_leads(path).runs()
    places_mm = np.vstack(runs) if runs else path.xy_mm
    return on_part_mm(zero, placement.places(places_mm))


def placed_mm(place_mm: Place, placement: Placement) -> Place:
    """Where a placement about a known point puts a place of the sheet."""
    x_mm, y_mm = placement.places(np.array([place_mm]))[0].tolist()
    return x_mm, y_mm


def on_sheet_mm(zero: Zero, placement: Placement) -> Place | None:
    """Where the zero lies, before a placement about a known point; None if that is the sheet's own."""
    if zero == "sheet":
        return None
    x_mm, y_mm = placement.places_back(np.zeros((1, 2)))[0].tolist()
    return x_mm, y_mm


def figures(zero: Zero, placement: Placement) -> Figures:
    """Where the zero lies, as a figure."""
    place_mm = on_sheet_mm(zero, placement)
    return {} if place_mm is None else {"zero_place_mm": place_mm}


def said_by(program: FilePath) -> Place | None:
    """Where on the sheet the zero of a program of ours is, as its head says; None if it does not say so."""
    from morfax.player.gcode.gcode_text import text_of
    from morfax.recorder.gcode.program_head import zero_on_sheet_mm

    if not medium.is_gcode(program):
        return None
    return zero_on_sheet_mm(text_of(program).splitlines())


def refuse_of_part(zero: Zero | None, program: FilePath) -> None:
    """Raise WrongUse for the zero of a part where only the sheet is known."""
    if zero in OF_PART:
        raise WrongUse(
            f"--zero {zero} is a place of the part, and neither the drawing nor {program.name} says where "
            "the part is; give the place that trace printed as zero_place_mm, such as --zero 12.3,45.6"
        )
