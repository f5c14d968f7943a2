"""One line as it was followed: the head's way along it, how it ended, and what the drawing says on the way.

Signals: what a Follower did, and the marks along it, in; out the line as the operator and the program need
it: mm at the motion rate.

    lead line    ├───────●───────┐loop       begins at a reference point, or bears a tick, and runs into its loop
    guide line   ├───────────────●           begins at a reference point and ends
    guides of a line                         left for a guide line, to its end and back

Source: patent ES 361967, section on use: reference point, lead line, guide lines to drill points and back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from morfax.motion.arrays import Array
from morfax.motion.faults import LineFault
from morfax.motion.polyline import lengths_mm
from morfax.tracer.following.follower import Followed
from morfax.tracer.following.thinning import THINNED
from morfax.tracer.junctions.gaps import Break, breaks
from morfax.tracer.junctions.guides import Guide
from morfax.tracer.marks.marks import Mark, marks_along
from morfax.tracer.sensing.leg import TURNS_OFF, turn
from morfax.tracer.sensing.side import Side

HEADING = 300  # positions that tell the heading at an end: half a mm at 10 mm/s
NEARLY_MM = 5.0  # a line that ends so near to its beginning may be a closed one
AT_JUNCTION = 1.5  # widths: as near to a junction a line is come to it
TURN_MM = 1.5  # to both sides of a junction, that tell whether the way turns there
REFERENCE_MM = 3.0  # a stroke nearer to a reference point is one of its own


@dataclass(frozen=True, slots=True)
class Line:
    """One line as it was followed: positions (n, 2) mm at the motion rate, how it ended ("closed", "ended",
    "joined", "lost"), its number on the drawing.
    """

    xy_mm: Array
    ending: str
    width_mm: float
    length_mm: float
    fault: LineFault | None = None
    number: int = 1
    loop_from: int | None = None
    marks: tuple[Mark, ...] = ()
    guides: tuple[Guide, ...] = ()
    reference_mm: tuple[float, float] | None = None  # the reference point from which it begins
    junctions_mm: tuple[
        tuple[float, float], ...
    ] = ()  # in the order in which the head came to them
    ink_mm: float = 0.0  # length of the ink that is joined to it, its own included, by its area
    is_solid: bool = False  # that ink is the rim of a filled shape
    # of its stops; None: counted on from those of the line before
    numbers: tuple[int, ...] | None = None
    breaks: tuple[Break, ...] = ()  # where it ends, and ink goes on

    @classmethod
    def of(
        cls, run: Followed, number: int = 1, reference_mm: tuple[float, float] | None = None
    ) -> Line:
        """What the head did, as a line of the drawing, with the marks along it; those at the reference point
        are that point's.
        """
        marks = [
            mark
            for mark in marks_along(run.view, run.positions_mm)
            if reference_mm is None or not _near(mark, reference_mm)
        ]
        return cls(
            run.positions_mm,
            run.ending,
            run.view.width_mm,
            run.travel_mm,
            run.fault,
            number,
            run.loop_from,
            tuple(marks),
            run.guides,
            reference_mm,
            run.junctions_mm,
            breaks=breaks(run.view, run.positions_mm, run.ending == "ended")
            if run.ending in ("ended", "lost")
            else (),
        )

    @classmethod
    def of_dot(cls, centre_mm: Array, width_mm: float, number: int) -> Line:
        """A dot that stands alone, a drill point without a guide line."""
        place_mm = (float(centre_mm[0]), float(centre_mm[1]))
        return cls(
            np.tile(centre_mm, (2, 1)),
            "ended",
            width_mm,
            0.0,
            None,
            number,
            marks=(Mark("dot", place_mm, 0.0),),
        )

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the line was begun, mm."""
        return self.place(0)

    @property
    def places_mm(self) -> Array:
        """Places along it, (n, 2) mm."""
        return self.xy_mm[::THINNED]

    @property
    def own_mm(self) -> Array:
        """Places that are its own, (n, 2) mm: all of them, or up to the first junction if it did not come
        back; beyond that it may have been another's.
        """
        places = self.places_mm
        if self.ending in ("closed", "ended") or not self.junctions_mm:
            return places
        there = np.hypot(*(places - self.junctions_mm[0]).T) < AT_JUNCTION * self.width_mm
        return places[: int(np.argmax(there)) + 1] if there.any() else places

    @property
    def gap_mm(self) -> float | None:
        """How far the end of an open line is from its beginning, if it leads there within `NEARLY_MM`: a gap
        in a closed line, perhaps; else None.
        """
        across = self.xy_mm[0] - self.xy_mm[-1]
        gap_mm = float(np.hypot(*across))
        if self.ending != "ended" or not 0 < gap_mm < min(NEARLY_MM, 0.1 * self.length_mm):
            return None
        moving = self.xy_mm[np.r_[True, np.any(np.diff(self.xy_mm, axis=0) != 0, axis=1)]]
        ends = (
            moving[min(HEADING, len(moving) - 1)] - moving[0],
            moving[-1] - moving[max(-HEADING, -len(moving))],
        )
        ahead = [float(way @ across) > 0.7 * gap_mm * float(np.hypot(*way)) for way in ends]
        return gap_mm if all(ahead) else None

    @property
    def is_lead(self) -> bool:
        """Whether it is a lead line and the loop that it leads to."""
        if self.loop_from is None:
            return False
        return self.reference_mm is not None or any(
            mark.kind == "tick" and mark.at < self.loop_from for mark in self.marks
        )

    @property
    def is_guide(self) -> bool:
        """Whether it is a guide line from the reference point, or a dot alone."""
        return self.is_dot or (self.reference_mm is not None and self.ending == "ended")

    @property
    def is_dot(self) -> bool:
        """Whether it is a dot that stands alone, and no line."""
        return self.ending == "ended" and len(self.xy_mm) == 2 and self.length_mm == 0

    @property
    def goes_back(self) -> bool:
        """Whether the tool goes back along it to where it began."""
        return self.is_lead or (self.is_guide and not self.is_dot)

    @property
    def begin_mm(self) -> tuple[float, float]:
        """Where its program begins: at its reference point, or at its start, mm."""
        return self.reference_mm or self.start_mm

    @property
    def end_mm(self) -> tuple[float, float]:
        """Where its program ends, mm."""
        return self.begin_mm if self.goes_back else self.place(len(self.xy_mm) - 1)

    def turns_at(self, place_mm: tuple[float, float], side: Side) -> bool:
        """Whether the way turns to a side at a junction, to go on there or along a guide line and back."""
        away = np.hypot(*(self.xy_mm - place_mm).T)
        near = np.flatnonzero(away < AT_JUNCTION * self.width_mm)
        come_mm = lengths_mm(self.xy_mm)
        for visit in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1) if len(near) else ():
            i = visit[np.argmin(away[visit])]
            before, after = np.searchsorted(come_mm, come_mm[i] + np.array([-TURN_MM, TURN_MM]))
            there, on = (
                self.xy_mm[i] - self.xy_mm[before],
                self.xy_mm[min(after, len(come_mm) - 1)] - self.xy_mm[i],
            )
            turned = turn(math.atan2(there[1], there[0]), math.atan2(on[1], on[0]))
            if abs(turned) > TURNS_OFF and (turned > 0) == (side == "left"):
                return True
        return False

    def without_guides(self, first: int, last: int) -> list[Array]:
        """Stretches (n, 2) mm from one position to another, between the guide lines that are left for on the
        way.
        """
        left_for = [guide for guide in self.guides if first < guide.leave <= last]
        begins, ends = (
            [first, *(guide.back for guide in left_for)],
            [*(guide.leave for guide in left_for), last + 1],
        )
        return [
            self.xy_mm[begin:end]
            for begin, end in zip(begins, ends, strict=True)
            if begin < end
        ]

    def place(self, at: float) -> tuple[float, float]:
        """Where the axis is at a position, fractions included, mm."""
        rows = np.arange(len(self.xy_mm))
        return float(np.interp(at, rows, self.xy_mm[:, 0])), float(
            np.interp(at, rows, self.xy_mm[:, 1])
        )


def _near(mark: Mark, reference_mm: tuple[float, float]) -> bool:
    return (
        float(np.hypot(mark.place_mm[0] - reference_mm[0], mark.place_mm[1] - reference_mm[1]))
        < REFERENCE_MM
    )
