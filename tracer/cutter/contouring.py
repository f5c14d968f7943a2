"""Contouring: which way round closed lines are cut, where a cut begins, and how the tool comes to it and
leaves it.

Signals: what somebody asks for in; paths turned round, and refusals, out.

    climb           the tool on the left of its travel, the part on its right: with a spindle that turns
                    clockwise the teeth come out of the part where they cut. Outside of the part clockwise,
                    inside its holes counter-clockwise. A plasma torch whose gas swirls clockwise has its good
                    side there too
    conventional    the other way round

Open lines, lines that cross themselves, and lines with the operator's arrow keep the direction in which the
head followed them.

Source: the words and the rule are the trade's, for a spindle that turns clockwise (M3).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

from morfax.motion.faults import MotionFault
from morfax.tracer.cutter.contour import Beside, Cut
from morfax.tracer.following.line import Line

Milling = Literal["climb", "conventional"]
StartAt = Literal["corner", "straight", "nearest"]


@dataclass(frozen=True, slots=True)
class Lead:
    """A lead-in or lead-out: a quarter circle of this radius that touches the cut, or a straight line of this
    length that meets it at 45 degrees; mm.
    """

    size_mm: float
    kind: Literal["arc", "line"] = "arc"


@dataclass(frozen=True, slots=True)
class Contouring:
    """What is asked for; None leaves a line as it was followed."""

    milling: Milling | None = None
    lead_in: Lead | None = None
    lead_out: Lead | None = None
    start_at: StartAt | None = None  # None: with leads on the longest straight
    # the direction is the machine's, and counts only where a line has one
    by_machine: bool = False
    mirrored: bool = False  # the program is mirrored afterwards, which turns every line round

    @property
    def has_leads(self) -> bool:
        """Whether a lead-in or a lead-out is asked for."""
        return self.lead_in is not None or self.lead_out is not None

    @property
    def moves_start(self) -> bool:
        """Whether a cut begins elsewhere than the head did."""
        return self.has_leads or self.start_at is not None

    @property
    def asks(self) -> bool:
        """Whether anything is asked for."""
        return self.milling is not None or self.moves_start

    def turns(self, tool_left: bool) -> bool:
        """Whether a closed line is turned round that has the tool on the left of its travel, or not."""
        on_left = (self.milling == "climb") != self.mirrored
        return self.milling is not None and tool_left != on_left


AS_FOLLOWED = Contouring()


def turned_round(beside: Beside, contouring: Contouring) -> Beside:
    """The paths of a closed contour in the direction that is asked for; of an open one as they are."""
    keeps_direction = not beside.cut.closed or beside.cut.line.as_told
    if keeps_direction or not contouring.turns(beside.left):
        return beside
    from morfax.motion.offset import OffsetPath

    paths = [
        OffsetPath(path.points_mm[::-1].copy(), path.closed, path.guide)
        for path in beside.paths
    ]
    return replace(beside, paths=paths, turned=True)


def refuse_open(cuts: Sequence[Cut], lines: Sequence[Line], contouring: Contouring) -> None:
    """Raise MotionFault if there is no closed line to cut as is asked for; not if one was lost."""
    asks = contouring.moves_start or (contouring.milling and not contouring.by_machine)
    if not asks or any(cut.closed for cut in cuts):
        return
    if any(line.ending == "lost" for line in lines):
        return
    asked = "a lead" if contouring.has_leads else "--start-at"
    if contouring.milling and not contouring.by_machine:
        asked = f"--{contouring.milling}"
    are = "the line is open" if len(cuts) == 1 else f"all {len(cuts)} lines are open"
    raise MotionFault(
        f"{asked} is for closed lines, and {are}: leave it out; --direction, or --start at its"
        " other end, gives an open line its direction"
    )


def refuse_without_room(lines: Sequence[Line], contouring: Contouring) -> None:
    """Raise MotionFault if leads are asked for and no closed line has room for even a shorter one."""
    if not contouring.has_leads:
        return
    closed = [line for line in lines if line.ending == "closed"]
    if not closed or any(line.is_lead or line.leads is not None for line in lines):
        return
    name = "lead-in" if contouring.lead_in is not None else "lead-out"
    lead = contouring.lead_in or contouring.lead_out
    assert lead is not None
    numbers = ", ".join(sorted({str(line.number) for line in closed}))
    raise MotionFault(
        f"there is no room for a {name} of {lead.size_mm:g} mm, nor for a shorter one, in the scrap beside"
        f" line {numbers}: give a --{name} that is shorter, or leave it out"
    )
