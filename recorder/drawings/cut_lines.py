"""Cut lines: what a motion cuts, as chains of lines and arcs without the ways between them.

Signals in: a motion in mm. Signals out: lines in sheet coordinates, mm, each from where the tool goes into
the work to where it comes out; a line that ends where it begins is closed, a hole is a line of one place.

Source: our own. Questions: depth and passes are left to the program that reads the drawing; a line that is
run on at several depths is one line, as long as the tool stays down.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

from morfax.motion.faults import MotionFault
from morfax.motion.motion import IN_WORK_BELOW_MM
from morfax.motion.segments import Source
from morfax.recorder.gcode.closing import CLOSED_MM
from morfax.recorder.gcode.plan import BlockPlan, Writing, plan
from morfax.recorder.gcode.program_text import Block

Place = tuple[float, float]


class CutPiece(NamedTuple):
    """A line to a place, or an arc that turns by an angle, rad, + left (0: a line); mm."""

    end_mm: Place
    turned_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class CutLine:
    """A chain of pieces from a place on, mm."""

    begin_mm: Place
    pieces: tuple[CutPiece, ...]

    @property
    def closed(self) -> bool:
        """Whether the line ends where it begins."""
        return (
            len(self.pieces) > 1
            and math.dist(self.begin_mm, self.pieces[-1].end_mm) <= CLOSED_MM
        )


def cut_lines_of(source: Source, writing: Writing) -> tuple[list[CutLine], BlockPlan]:
    """What a motion cuts, and the plan; raises MotionFault if it cuts nothing."""
    planned = plan(source, writing)
    lines = list(dict.fromkeys(_cut_of(planned)))  # the pecks of one hole are one place
    if not lines:
        raise MotionFault(
            f"nothing is cut: Z stays above {IN_WORK_BELOW_MM:g} mm, and a drawing shows what is cut; "
            "move the zero of Z so that the tool comes down to 0, or write a tape or G-code, which hold all "
            "motion"
        )
    return lines, planned


def _cut_of(planned: BlockPlan) -> Iterator[CutLine]:
    """What a plan cuts, as often as it does."""
    begin_mm: tuple[float, float] | None = None
    pieces = list[CutPiece]()
    place = (float(planned.start_mm[0]), float(planned.start_mm[1]), float(planned.start_mm[2]))
    for block in planned.blocks:
        cuts = block.code != "G0" and min(place[2], block.place_mm[2]) <= IN_WORK_BELOW_MM
        if cuts and begin_mm is None:
            begin_mm = place[:2]
        if not cuts and begin_mm is not None:
            yield CutLine(begin_mm, tuple(pieces))
            begin_mm, pieces = None, []
        if cuts and block.place_mm[:2] != place[:2]:
            pieces.append(_piece(place, block))
        place = block.place_mm
    if begin_mm is not None:
        yield CutLine(begin_mm, tuple(pieces))


def _piece(begin_mm: tuple[float, float, float], block: Block) -> CutPiece:
    """The line or arc of a block."""
    end_mm = block.place_mm[0], block.place_mm[1]
    if block.code not in ("G2", "G3"):
        return CutPiece(end_mm)
    x, y = block.centre_mm
    centre = begin_mm[0] + x, begin_mm[1] + y
    first = math.atan2(-y, -x)
    last = math.atan2(end_mm[1] - centre[1], end_mm[0] - centre[0])
    sense = 1 if block.code == "G3" else -1
    return CutPiece(end_mm, sense * (sense * (last - first) % math.tau))


def radius_mm(begin_mm: Place, piece: CutPiece) -> float:
    """Radius of an arc."""
    return math.dist(begin_mm, piece.end_mm) / abs(2 * math.sin(piece.turned_rad / 2))
