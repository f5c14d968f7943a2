"""One line as it was followed: the head's way along it, the ending, and the marks that the drawing has on it.

Signals: what a Follower did in; out the line as the operator and the program need it, mm at the motion rate.

    lead line    ├───────●───────┐loop       begins at a reference point or has a tick; runs into its loop
    guide line   ├───────────────●           begins at a reference point and ends
    guides of a line                         guide lines that the head took off it, to their end and back
    leads of a line    ╰──┤loop├──╯          lead-in and lead-out that a cut was given: cut with the line

Source: patent ES 361967, section on use: reference point, lead line, guide lines to drill points and back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from morfax.motion.arrays import Array, between, bounds
from morfax.motion.faults import LineFault
from morfax.motion.long_array import is_mapped, one_in
from morfax.motion.polyline import lengths_mm
from morfax.motion.usual import THINNED
from morfax.tracer.corrections.on_sheet import StopAt
from morfax.tracer.following.followed import Followed
from morfax.tracer.following.roughness import roughness_mm
from morfax.tracer.following.told_stops import with_told
from morfax.tracer.head.leaders import Led, share_of_cell
from morfax.tracer.junctions.gaps import Break, breaks
from morfax.tracer.junctions.guides import GuideLine
from morfax.tracer.limits import AHEAD_RAD, CLEAR_WIDTHS
from morfax.tracer.marks.marks import Mark, marks_along
from morfax.tracer.sensing.leg import TURNS_OFF, turn
from morfax.tracer.sensing.side import Side

# All limits below were chosen by trial on the test drawings.
HEADING = 300  # positions that show the heading at an end: half a mm at 10 mm/s
NEARLY_MM = 5.0  # a line that ends so near to its beginning may be a closed one, ...
NEARLY = 0.1  # ... if that is no more than this share of its length, ...
AHEAD = math.cos(AHEAD_RAD)  # ... and lies ahead
TURN_MM = 1.5  # before and after a junction: shows whether the line turns there
REFERENCE_MM = 3.0  # a mark nearer to a reference point is a stroke of that point


@dataclass(frozen=True, slots=True)
class Leads:
    """Lead-in and lead-out of a closed line: the positions between which it comes round, and their sizes, mm.

    The size is the radius of an arc or the length of a straight lead, as asked for; 0 without one.
    """

    first: int
    last: int
    in_mm: float = 0.0
    out_mm: float = 0.0


@dataclass(frozen=True)
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
    guides: tuple[GuideLine, ...] = ()
    reference_mm: tuple[float, float] | None = None  # the reference point from which it begins
    junctions_mm: tuple[tuple[float, float], ...] = ()  # in the order the head came to them
    ink_mm: float = 0.0  # length of its patch of ink, by the patch's area
    is_solid: bool = False  # the patch is the rim of a filled shape
    numbers: tuple[int, ...] | None = None  # of its stops; None: on from the line before
    breaks: tuple[Break, ...] = ()  # where it ends, and ink goes on
    led: Led = field(default_factory=Led)  # who led the head along it
    served: frozenset[int] = frozenset()  # numbers of the corrections that it went by
    leads: Leads | None = None  # that a cut was given; those drawn on paper are `loop_from`
    on_edge: bool = False  # round a solid area among lines; its width is no line's
    roughness_mm: float | None = None  # of the edge that it is (see `roughness`)
    # along lines that were felt before: it runs the other way round just so
    is_of_net: bool = False
    as_told: bool = False  # the operator's arrow says where it begins, and which way it goes

    @classmethod
    def of(
        cls,
        run: Followed,
        number: int = 1,
        reference_mm: tuple[float, float] | None = None,
        stops: tuple[StopAt, ...] = (),
    ) -> Line:
        """What the head did, as a line of the drawing with its marks, but for the reference point's, and with
        the stops of the operator's corrections.
        """
        marks = [] if run.view.on_edge else marks_along(run.view, run.positions_mm)
        if reference_mm is not None:
            marks = [m for m in marks if math.dist(m.place_mm, reference_mm) >= REFERENCE_MM]
        told, served = with_told(marks, run.positions_mm, run.view.width_mm, stops)
        found = tuple[Break, ...]()
        if run.ending in ("ended", "lost"):
            found = breaks(run.view, run.positions_mm, run.ending == "ended")
        return cls(
            run.positions_mm,
            run.ending,
            run.view.width_mm,
            run.travel_mm,
            run.fault,
            number,
            run.loop_from,
            told,
            run.guides,
            reference_mm,
            run.junctions_mm,
            breaks=found,
            led=run.led,
            served=run.served | served,
            roughness_mm=roughness_mm(run),
        )

    @classmethod
    def bare(cls, run: Followed) -> Line:
        """The same without marks, stops and gaps: what is asked for its way alone."""
        line = run.positions_mm, run.ending, run.view.width_mm, run.travel_mm, run.fault
        return cls(
            *line, loop_from=run.loop_from, guides=run.guides, junctions_mm=run.junctions_mm
        )

    @classmethod
    def of_dot(cls, centre_mm: Array, width_mm: float, number: int) -> Line:
        """A dot that stands alone, a drill point without a guide line."""
        dot = Mark("dot", (float(centre_mm[0]), float(centre_mm[1])), 0.0)
        twice_mm = np.tile(centre_mm, (2, 1))
        return cls(twice_mm, "ended", width_mm, 0.0, number=number, marks=(dot,))

    @property
    def cell_share(self) -> float | None:
        """The share of its way that the swinging cell led the head; None if nothing says who led."""
        if not self.led.firsts:
            return None
        return share_of_cell(self.led.lengths_mm(self.xy_mm))

    @property
    def start_mm(self) -> tuple[float, float]:
        """Where the line was begun, mm."""
        return self.place(0)

    @property
    def places_mm(self) -> Array:
        """Places along it, (n, 2) mm."""
        in_memory = self._in_memory
        return one_in(self.xy_mm, THINNED) if in_memory is None else in_memory

    @cached_property
    def _in_memory(self) -> Array | None:
        """The same of a line in memory. Those of a line in a file would take 0.3 MB a metre, and are read."""
        return None if is_mapped(self.xy_mm) else self.xy_mm[::THINNED]

    @cached_property
    def box_mm(self) -> tuple[Array, Array]:
        """The lowest and the highest of these places, mm; not to be changed."""
        return bounds(self.places_mm)

    def passes_its_end(self, within_mm: float, beyond_mm: float) -> Array | None:
        """An end (x, y) that its own way comes as near to, more than so far on; None if it passes neither."""
        places, come_mm = self.places_mm, lengths_mm(self.places_mm)
        for end, gone_mm in ((places[0], come_mm), (places[-1], come_mm[-1] - come_mm)):
            between_mm = np.minimum(gone_mm, come_mm[-1] - gone_mm)  # from both ends
            near = np.hypot(*(places - end).T) < within_mm
            if np.any(near & (gone_mm > beyond_mm) & (between_mm > within_mm)):
                return np.asarray(end)
        return None

    @property
    def loop_mm(self) -> Array:
        """Places along its loop, without the lead line before that, (n, 2) mm."""
        if not self.loop_from:
            return self.places_mm
        return one_in(self.xy_mm[self.loop_from :], THINNED)

    @property
    def own_mm(self) -> Array:
        """Places certainly its own, (n, 2) mm: up to the first junction of a line that did not come back."""
        places = self.places_mm
        if self.ending in ("closed", "ended") or not self.junctions_mm:
            return places
        there = np.hypot(*(places - self.junctions_mm[0]).T) < CLEAR_WIDTHS * self.width_mm
        return places[: int(np.argmax(there)) + 1] if there.any() else places

    @property
    def gap_mm(self) -> float | None:
        """How far the end of an open line is from its beginning, if that may be a gap in a closed line."""
        across = self.xy_mm[0] - self.xy_mm[-1]
        gap_mm = float(np.hypot(*across))
        widest_mm = min(NEARLY_MM, NEARLY * self.length_mm)
        if self.ending != "ended" or not 0 < gap_mm < widest_mm:
            return None
        moving = self.xy_mm[np.r_[True, np.any(np.diff(self.xy_mm, axis=0) != 0, axis=1)]]
        if len(moving) <= HEADING:
            return None
        begins = moving[HEADING] - moving[0]
        ends = moving[-1] - moving[-HEADING]
        for way in (begins, ends):
            if way @ across <= AHEAD * gap_mm * float(np.hypot(*way)):
                return None
        return gap_mm

    @property
    def is_lead(self) -> bool:
        """Whether it is a lead line and the loop to which that leads."""
        if self.loop_from is None:
            return False
        return self.reference_mm is not None or any(
            mark.kind == "tick" and mark.at < self.loop_from for mark in self.marks
        )

    @property
    def first(self) -> int:
        """The position where its passes begin: behind the lead line or the lead-in."""
        if self.leads is not None:
            return self.leads.first
        return (self.loop_from or 0) if self.is_lead else 0

    @property
    def last(self) -> int:
        """The position where its passes end: before the lead-out."""
        return len(self.xy_mm) - 1 if self.leads is None else self.leads.last

    @property
    def is_guide(self) -> bool:
        """Whether it is a guide line from the reference point, or a dot alone."""
        return self.is_dot or (self.reference_mm is not None and self.ending == "ended")

    @property
    def comes_round(self) -> bool:
        """Whether its end is its beginning, or that of its loop."""
        return self.ending == "closed" or self.is_lead

    @property
    def is_dot(self) -> bool:
        """Whether it is a dot that stands alone, and no line."""
        return self.ending == "ended" and len(self.xy_mm) == 2 and self.length_mm == 0

    @property
    def is_open(self) -> bool:
        """Whether it is known to be open, so that nothing can lie inside it."""
        return self.ending == "ended"

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
        """Whether the line turns to a side at a junction, to go on there or along a guide line and back."""
        away = np.hypot(*(self.xy_mm - place_mm).T)
        near = np.flatnonzero(away < CLEAR_WIDTHS * self.width_mm)
        if not len(near):
            return False
        come_mm = lengths_mm(self.xy_mm)
        for visit in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
            turned = self._turned_at(int(visit[np.argmin(away[visit])]), come_mm)
            if abs(turned) > TURNS_OFF and (turned > 0) == (side == "left"):
                return True
        return False

    def _turned_at(self, at: int, come_mm: Array) -> float:
        """By how much the line turns at a position, rad; `come_mm` is its length up to each position."""
        around_mm = come_mm[at] + np.array([-TURN_MM, TURN_MM])
        before, after = np.searchsorted(come_mm, around_mm)
        arrives = self.xy_mm[at] - self.xy_mm[before]
        leaves = self.xy_mm[min(after, len(come_mm) - 1)] - self.xy_mm[at]
        return turn(math.atan2(arrives[1], arrives[0]), math.atan2(leaves[1], leaves[0]))

    def without_guides(self, first: int, last: int) -> list[Array]:
        """Stretches (n, 2) mm from one position to another, between the guide lines taken on the way."""
        return [self.xy_mm[a:b] for a, b in self.ranges(first, last)]

    def ranges(self, first: int, last: int) -> list[tuple[int, int]]:
        """The positions of those stretches: of each its first, and the one after its last."""
        taken = [guide for guide in self.guides if first < guide.leave <= last]
        begins = [first, *(guide.back for guide in taken)]
        ends = [*(guide.leave for guide in taken), last + 1]
        return [(a, b) for a, b in zip(begins, ends, strict=True) if a < b]

    def place(self, at: float) -> tuple[float, float]:
        """Where the axis is at a position, fractions included, mm."""
        x, y = (between(column, at) for column in self.xy_mm.T)
        return x, y
