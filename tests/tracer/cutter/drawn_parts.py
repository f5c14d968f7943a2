"""A part with a guide line, as the head runs it, and the way beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.motion import join
from morfax.motion.polyline import Nearest
from morfax.tracer.cutter.cutter import Cutter, CutterSide, with_cutter
from morfax.tracer.following.line import Line
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.marks.marks import Mark
from morfax.tracer.operator.card import Card
from morfax.tracer.operator.operator import Operator
from morfax.tracer.operator.work import Halt
from morfax.tracer.program.program import Trace
from tests.tracer.inked import UM
from tests.tracer.program.test_program import WORK, at, run_through

FEED_MM_S = 10.0
NEARER_MM = 1.0 * UM  # than the radius to a contour; asked of the cutter's ways: 1 um
SAMPLE_MM = FEED_MM_S / 6000  # from one position to the next
# where the guide line leaves the square's upper side, for a drill point inside
LEFT_TO = 14.0, 8.0
WAY = run_through(
    (0, 4),
    (10, 4),
    (10, 8),
    LEFT_TO,
    (14, 5),
    LEFT_TO,
    (18, 8),
    (18, 0),
    (10, 0),
    (10, 4 - SAMPLE_MM),
)  # a lead line, and a square of 8 mm, clockwise
FROM = at(WAY, (10, 4))
OUT = at(WAY, (14, 5))
BACK = OUT + at(WAY[OUT:], LEFT_TO)


def marked(tick_mm: float = 5.0, *, guide: bool = False, way: Array = WAY) -> Line:
    """The square with a tick on its lead line, and one on its right side; with the guide line, or straight
    on.
    """
    marks = [
        Mark("tick", (tick_mm, 4.0), float(at(way[:FROM], (tick_mm, 4)))),
        Mark("tick", (18.0, 3.0), 0.0),
    ]
    if not guide:
        way = np.vstack([way[: at(way[:OUT], LEFT_TO)], way[BACK:]])
    marks[1] = replace(marks[1], at=float(FROM + at(way[FROM:], (18, 3))))
    guides = (GuideLine(at(way[:OUT], LEFT_TO), OUT, BACK),) if guide else ()
    return Line(
        way,
        "joined",
        0.5,
        50.0,
        loop_from=FROM,
        marks=tuple(marks),
        guides=guides,
        reference_mm=(-3.0, 4.0),
    )


def beside(
    line: Line,
    side: CutterSide,
    diameter_mm: float = 4.0,
    card: str = "",
    passes_mm: tuple[float, ...] = (),
) -> tuple[Array, dict[int | None, Halt], Trace]:
    """The motion of a cutter beside a line, (n, 3) mm, its stops by number, and the program."""
    work = replace(WORK, passes_mm=passes_mm)
    made, _ = with_cutter(
        Trace((line,), Operator(work, Card.parse(card))), Cutter(diameter_mm, side), FEED_MM_S
    )
    stops = {
        a.halt.number: a.halt
        for actions in made.actions
        for a in actions
        if a.halt.number is not None
    }
    return join(made).positions_mm, stops, made


def least_mm(positions: Array, contour_mm: Array, radius_mm: float) -> float:
    """How near the tool comes to a closed contour while it moves in the work, less its radius, mm."""
    moves = np.flatnonzero(np.any(np.diff(positions[:, :2], axis=0) != 0, axis=1))
    cutting = positions[moves][positions[moves, 2] < 0, :2]
    near = Nearest([np.vstack([contour_mm, contour_mm[:1]])], radius_mm)
    return float(near.distances_mm(cutting).min()) - radius_mm
